// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/surface_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <sstream>

#include "incise/base/error.h"
#include "incise/topology/flat_triangles.h"
#include "incise/topology/surface_parts.h"
#include "tetmesh/coordinate_tolerance.h"
#include "tetmesh/crossing_check.h"
#include "tetmesh/first_points.h"
#include "tetmesh/sharp_edges.h"
#include "tetmesh/surface_interior.h"

namespace incise::tetmesh {

namespace {

using topology::SurfaceParts;

/// A closed part of a surface.
struct ClosedPart {
    std::size_t surface = 0, part = 0;
    std::vector<std::size_t> triangles;
    std::shared_ptr<const SurfaceInterior> interior;
    double signed_volume = 0.0;
    int region = 0;
    std::optional<std::size_t> parent;  ///< the innermost part round it
};

/// Points that are meant to be on an edge are beside it by their last digits: the surface would
/// cross itself there.
topology::SurfaceData without_needles(const topology::SurfaceData& surface) {
    Box box;
    for (const Vec3& x : surface.points) box.extend(x);
    return topology::without_flat_triangles(surface, coordinate_tolerance(box));
}

void refuse(const std::optional<Crossing>& crossing, const std::vector<NamedSurface>& named) {
    if (!crossing) return;
    std::ostringstream text;
    const Vec3& x = crossing->place;
    text << named[crossing->first_surface].name << ": the surface crosses "
         << (crossing->first_surface == crossing->second_surface
                 ? "itself"
                 : named[crossing->second_surface].name)
         << " at (" << x.x() << ", " << x.y() << ", " << x.z() << "): " << crossing->num_pairs
         << (crossing->num_pairs == 1 ? " pair" : " pairs")
         << " of triangles have more than an edge in common; mend it in a program for surfaces, or "
            "make surfaces that only touch or enclose each other";
    throw InputError(text.str());
}

std::vector<ClosedPart> closed_parts(const std::vector<SurfaceParts>& surfaces) {
    std::vector<ClosedPart> parts;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const std::size_t first = parts.size();
        for (std::size_t p = 0; p < surfaces[s].parts.size(); ++p)
            parts.push_back({s, p, {}, {}, surfaces[s].parts[p].signed_volume, 0, {}});
        for (std::size_t t = 0; t < surfaces[s].part_of_triangle.size(); ++t)
            parts[first + surfaces[s].part_of_triangle[t]].triangles.push_back(t);
    }
    for (ClosedPart& part : parts)
        part.interior =
            std::make_shared<SurfaceInterior>(surfaces[part.surface].surface, part.triangles);
    return parts;
}

/// True if most of the points just inside of a part are inside of another one. Points of its
/// surface would not do: surfaces may touch.
bool is_within(const ClosedPart& inner, const ClosedPart& outer, const SurfaceParts& surface) {
    constexpr std::size_t num_samples = 21;
    // Small beside the part, and large beside what rounding does to its points.
    const double depth = 1e-4 * inner.interior->box().diagonal().norm();
    std::size_t num_taken = 0, num_within = 0;
    const std::size_t stride = std::max<std::size_t>(1, inner.triangles.size() / num_samples);
    for (std::size_t i = 0; i < inner.triangles.size(); i += stride) {
        const auto& corners = surface.surface.triangles[inner.triangles[i]];
        const auto at = [&](std::size_t k) {
            return surface.surface.points[static_cast<std::size_t>(corners[k])];
        };
        const Vec3 outwards = (at(1) - at(0)).cross(at(2) - at(0)).normalized() *
                              (inner.signed_volume < 0.0 ? -1.0 : 1.0);
        const Vec3 x = (at(0) + at(1) + at(2)) / 3.0 - depth * outwards;
        if (inner.interior->side_of(x) != Side::inside) continue;
        ++num_taken;
        if (outer.interior->side_of(x) == Side::inside) ++num_within;
    }
    return 2 * num_within > num_taken;
}

/// Finds the innermost part round each part, and gives regions.
/// @param order  the parts by volume, the smallest first
void assign_regions(std::vector<ClosedPart>& parts, const std::vector<std::size_t>& order,
                    const std::vector<SurfaceParts>& surfaces) {
    for (std::size_t i = 0; i < order.size(); ++i) {
        ClosedPart& inner = parts[order[i]];
        for (std::size_t k = i + 1; k < order.size() && !inner.parent; ++k) {
            const ClosedPart& outer = parts[order[k]];
            if (!outer.interior->box().intersects(inner.interior->box())) continue;
            if (is_within(inner, outer, surfaces[inner.surface])) inner.parent = order[k];
        }
    }
    int num_regions = 0;
    for (ClosedPart& part : parts) {
        const bool is_cavity = part.parent && part.signed_volume < 0.0;
        if (is_cavity) continue;
        part.region = surfaces.size() > 1 ? static_cast<int>(part.surface) + 1 : ++num_regions;
    }
}

PartPoints first_points_of(const ClosedPart& part, const SurfaceParts& surface) {
    ExtremePoints extremes;
    for (const std::size_t t : part.triangles)
        for (const auto p : surface.surface.triangles[t])
            extremes.add(surface.surface.points[static_cast<std::size_t>(p)],
                         static_cast<std::size_t>(p));
    PartPoints points{part.region, {}};
    for (const std::size_t p : extremes.numbers())
        points.points.push_back(surface.surface.points[p]);
    return points;
}

/// The triangles of several surfaces, with their corners.
std::vector<std::array<Vec3, 3>> triangles_of(const std::vector<SurfaceParts>& surfaces) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const SurfaceParts& parts : surfaces)
        for (const auto& t : parts.surface.triangles) {
            auto& corners = triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = parts.surface.points[static_cast<std::size_t>(t[k])];
        }
    return triangles;
}

/// Visits points of triangles that are not further apart than a spacing.
void visit_triangles(const std::vector<std::array<Vec3, 3>>& triangles, double spacing,
                     const SurfaceVisitor& visit) {
    for (const auto& [a, b, c] : triangles) {
        const Vec3 normal = (b - a).cross(c - a).normalized();
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const auto num = static_cast<std::int64_t>(std::ceil(longest / spacing));
        for (std::int64_t i = 0; i < num; ++i)
            for (std::int64_t j = 0; i + j < num; ++j) {
                const auto weight = [&](std::int64_t k) {
                    return (static_cast<double>(k) + 1.0 / 3.0) / static_cast<double>(num);
                };
                visit(a + weight(i) * (b - a) + weight(j) * (c - a), normal);
            }
    }
}

/// The topology of the surface between the body and its outside: that of the parts with a region
/// on one side only.
SurfaceTopology outer_topology(const std::vector<ClosedPart>& parts,
                               const std::vector<SurfaceParts>& surfaces) {
    SurfaceTopology sum;
    for (const ClosedPart& part : parts) {
        const int around = part.parent ? parts[*part.parent].region : 0;
        if ((part.region == 0) == (around == 0)) continue;
        std::vector<std::array<std::int64_t, 3>> triangles;
        for (const std::size_t t : part.triangles)
            triangles.push_back(surfaces[part.surface].surface.triangles[t]);
        sum += topology_of(triangles);
    }
    return sum;
}

}  // namespace

BodyShape shape_of(const std::vector<NamedSurface>& named, std::optional<double> angle) {
    std::vector<SurfaceParts> surfaces;
    for (const auto& [name, surface] : named) {
        surfaces.push_back(topology::parts_of(without_needles(surface)));
        if (const auto fault = fault_of(surfaces.back()); !fault.empty())
            throw InputError(name + ": " + fault);
    }
    const auto contacts = contacts_of(surfaces);
    refuse(contacts.crossing, named);

    auto parts = closed_parts(surfaces);
    std::vector<std::size_t> order(parts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {},
                             [&](std::size_t p) { return std::abs(parts[p].signed_volume); });
    assign_regions(parts, order, surfaces);

    BodyShape body;
    for (const ClosedPart& part : parts) {
        body.box.extend(part.interior->box());
        const double volume = std::abs(part.signed_volume);
        if (part.region != 0) body.volumes[part.region] += volume;
        if (part.parent && parts[*part.parent].region != 0)
            body.volumes[parts[*part.parent].region] -= volume;
        body.first_points.push_back(first_points_of(part, surfaces[part.surface]));
    }
    for (const SurfaceParts& surface : surfaces) body.area += surface.area;
    if (angle) body.sharp_edges = sharp_edges(surfaces, *angle);
    body.is_manifold = parts.size() == 1;
    if (!contacts.do_parts_touch) body.topology = outer_topology(parts, surfaces);
    body.visit_surface = [triangles = triangles_of(surfaces)](double spacing,
                                                              const SurfaceVisitor& visit) {
        visit_triangles(triangles, spacing, visit);
    };

    struct Layer {
        std::shared_ptr<const SurfaceInterior> interior;
        int region;
    };
    std::vector<Layer> layers;  // the innermost first
    for (const std::size_t p : order) layers.push_back({parts[p].interior, parts[p].region});
    body.region_at = [layers = std::move(layers)](const Vec3& x) {
        for (const auto& [interior, region] : layers)
            if (interior->side_of(x) != Side::outside) return region;
        return 0;
    };
    return body;
}

}  // namespace incise::tetmesh
