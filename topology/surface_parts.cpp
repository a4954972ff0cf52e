// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/surface_parts.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

#include "incise/topology/flat_triangles.h"

namespace incise::topology {

namespace {

/// One side of a triangle, from `low` to `high` if it is forward.
struct TriangleEdge {
    std::int64_t low, high;
    std::size_t triangle;
    bool is_forward;
};

Vec3 surface_point(const SurfaceData& surface, std::int64_t p) {
    return surface.points[static_cast<std::size_t>(p)];
}

Vec3 twice_area(const SurfaceData& surface, const std::array<std::int64_t, 3>& t) {
    const Vec3 a = surface_point(surface, t[0]);
    return (surface_point(surface, t[1]) - a).cross(surface_point(surface, t[2]) - a);
}

/// The surface with equal points as one, and without triangles of no area.
SurfaceData merged_surface(const SurfaceData& given) {
    const SurfaceData source = without_flat_triangles(given);
    SurfaceData merged;
    std::map<std::array<double, 3>, std::int64_t> known;
    const auto number_of = [&](std::int64_t p) {
        const Vec3 x = surface_point(source, p);
        // Adding 0 turns -0 into 0.
        const auto [it, is_new] =
            known.try_emplace({x.x() + 0.0, x.y() + 0.0, x.z() + 0.0},
                              static_cast<std::int64_t>(merged.points.size()));
        if (is_new) merged.points.push_back(x);
        return it->second;
    };
    for (const auto& t : source.triangles)
        merged.triangles.push_back({number_of(t[0]), number_of(t[1]), number_of(t[2])});
    return merged;
}

std::vector<TriangleEdge> sorted_edges(const SurfaceData& surface) {
    std::vector<TriangleEdge> edges;
    edges.reserve(3 * surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::ranges::sort(edges, {},
                      [](const TriangleEdge& e) { return std::tuple(e.low, e.high, e.triangle); });
    return edges;
}

void count_fault(EdgeFault& fault, const SurfaceData& surface, const TriangleEdge& edge) {
    if (fault.count++ == 0)
        fault.place = 0.5 * (surface_point(surface, edge.low) + surface_point(surface, edge.high));
}

/// A triangle across an edge, and whether both face the same side.
struct Across {
    std::size_t triangle;
    bool faces_same_side;
};

/// Gives each triangle its part, and turns triangles so that those of a part face one side.
void assign_parts(SurfaceParts& found, const std::vector<std::vector<Across>>& across) {
    constexpr auto none = static_cast<std::size_t>(-1);
    auto& triangles = found.surface.triangles;
    found.part_of_triangle.assign(triangles.size(), none);
    std::vector<char> is_turned(triangles.size(), 0);
    std::vector<std::size_t> waiting;
    for (std::size_t first = 0; first < triangles.size(); ++first) {
        if (found.part_of_triangle[first] != none) continue;
        const std::size_t part = found.parts.size();
        found.parts.emplace_back();
        found.part_of_triangle[first] = part;
        waiting.assign(1, first);
        while (!waiting.empty()) {
            const auto t = waiting.back();
            waiting.pop_back();
            for (const Across& other : across[t]) {
                if (found.part_of_triangle[other.triangle] != none) continue;
                found.part_of_triangle[other.triangle] = part;
                is_turned[other.triangle] =
                    static_cast<char>(is_turned[t] != static_cast<char>(!other.faces_same_side));
                waiting.push_back(other.triangle);
            }
        }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!is_turned[t]) continue;
        std::swap(triangles[t][1], triangles[t][2]);
        ++found.num_turned;
    }
}

/// Sums over the triangles of each part.
void measure_parts(SurfaceParts& found) {
    std::vector<Vec3> origins(found.parts.size());
    for (std::size_t t = 0; t < found.surface.triangles.size(); ++t) {
        const auto& corners = found.surface.triangles[t];
        SurfacePart& part = found.parts[found.part_of_triangle[t]];
        Vec3& o = origins[found.part_of_triangle[t]];
        if (part.num_triangles++ == 0) o = surface_point(found.surface, corners[0]);
        for (const auto p : corners) part.box.extend(surface_point(found.surface, p));
        const Vec3 a = surface_point(found.surface, corners[0]) - o,
                   b = surface_point(found.surface, corners[1]) - o,
                   c = surface_point(found.surface, corners[2]) - o;
        part.signed_volume += a.dot(b.cross(c)) / 6.0;
        found.area += 0.5 * twice_area(found.surface, corners).norm();
    }
    for (const SurfacePart& part : found.parts) found.box.extend(part.box);
}

}  // namespace

SurfaceParts parts_of(const SurfaceData& surface) {
    SurfaceParts found;
    found.surface = merged_surface(surface);
    const auto edges = sorted_edges(found.surface);
    std::vector<std::vector<Across>> across(found.surface.triangles.size());
    std::vector<TriangleEdge> unpaired;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end].low == edges[i].low &&
               edges[end].high == edges[i].high)
            ++end;
        if (end - i == 2) {
            const bool same = edges[i].is_forward != edges[i + 1].is_forward;
            across[edges[i].triangle].push_back({edges[i + 1].triangle, same});
            across[edges[i + 1].triangle].push_back({edges[i].triangle, same});
        } else {
            count_fault(end - i == 1 ? found.open_edges : found.branching_edges, found.surface,
                        edges[i]);
            unpaired.insert(unpaired.end(), edges.begin() + static_cast<std::ptrdiff_t>(i),
                            edges.begin() + static_cast<std::ptrdiff_t>(end));
        }
    }
    assign_parts(found, across);
    for (const TriangleEdge& edge : unpaired)
        found.parts[found.part_of_triangle[edge.triangle]].is_closed = false;
    // After the triangles are turned, a pair that still faces opposite sides cannot be mended.
    const auto turned = sorted_edges(found.surface);
    for (std::size_t i = 0; i + 1 < turned.size(); ++i) {
        const bool is_pair =
            turned[i].low == turned[i + 1].low && turned[i].high == turned[i + 1].high;
        const bool is_first =
            i == 0 || turned[i - 1].low != turned[i].low || turned[i - 1].high != turned[i].high;
        const bool is_last = i + 2 == turned.size() || turned[i + 2].low != turned[i].low ||
                             turned[i + 2].high != turned[i].high;
        if (!is_pair || !is_first || !is_last) continue;
        if (turned[i].is_forward != turned[i + 1].is_forward) continue;
        count_fault(found.one_sided_edges, found.surface, turned[i]);
        found.parts[found.part_of_triangle[turned[i].triangle]].is_closed = false;
    }
    measure_parts(found);
    return found;
}

std::string fault_of(const SurfaceParts& parts) {
    const auto text = [](const EdgeFault& fault, const char* what, const char* remedy) {
        std::ostringstream out;
        const Vec3& x = fault.place;
        out << what << " at " << fault.count << (fault.count == 1 ? " edge" : " edges")
            << ", the first at (" << x.x() << ", " << x.y() << ", " << x.z() << "); " << remedy;
        return out.str();
    };
    if (parts.open_edges.count > 0)
        return text(parts.open_edges, "the surface is open",
                    "close its holes in a program for surfaces");
    if (parts.branching_edges.count > 0)
        return text(parts.branching_edges, "more than two triangles meet",
                    "leave only the outer ones, or save surfaces that touch as files of their own");
    if (parts.one_sided_edges.count > 0)
        return text(parts.one_sided_edges, "the surface has only one side, which shows",
                    "make a surface that has an inside");
    return "";
}

}  // namespace incise::topology
