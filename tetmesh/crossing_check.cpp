// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/crossing_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "tetmesh/coordinate_tolerance.h"

namespace incise::tetmesh {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A triangle of a surface. Numbers of points and parts count through all surfaces.
struct Facet {
    std::array<Vec3, 3> corners;
    std::array<std::size_t, 3> points;
    std::size_t part = 0, surface = 0;
};

std::vector<Facet> facets_of(const std::vector<topology::SurfaceParts>& surfaces) {
    std::vector<Facet> facets;
    std::size_t first_point = 0, first_part = 0;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const auto& [surface, part_of_triangle, parts] =
            std::tie(surfaces[s].surface, surfaces[s].part_of_triangle, surfaces[s].parts);
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            auto& facet = facets.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto p = static_cast<std::size_t>(surface.triangles[t][k]);
                facet.corners[k] = surface.points[p];
                facet.points[k] = first_point + p;
            }
            facet.part = first_part + part_of_triangle[t];
            facet.surface = s;
        }
        first_point += surface.points.size();
        first_part += parts.size();
    }
    return facets;
}

Kernel::Point_3 to_point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

Kernel::Triangle_3 to_triangle(const Facet& f) {
    return {to_point(f.corners[0]), to_point(f.corners[1]), to_point(f.corners[2])};
}

/// True if two triangles with a common edge lie on each other.
bool are_folded(const Facet& a, const Facet& b, const std::vector<std::size_t>& shared) {
    const auto other = [&](const Facet& f) {
        for (std::size_t k = 0; k < 3; ++k)
            if (std::ranges::find(shared, f.points[k]) == shared.end()) return k;
        return std::size_t{0};
    };
    const auto k = other(a);
    const auto p = to_point(a.corners[k]), q = to_point(b.corners[other(b)]),
               r = to_point(a.corners[(k + 1) % 3]), s = to_point(a.corners[(k + 2) % 3]);
    return CGAL::orientation(r, s, p, q) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(r, s, p, q) == CGAL::POSITIVE;
}

/// True if two triangles with a common corner have more in common.
bool meet_beyond_corner(const Facet& a, const Facet& b, std::size_t corner) {
    const auto opposite_meets = [&](const Facet& f, const Facet& g) {
        const auto k =
            static_cast<std::size_t>(std::ranges::find(f.points, corner) - f.points.begin());
        return CGAL::do_intersect(
            to_triangle(g),
            Kernel::Segment_3(to_point(f.corners[(k + 1) % 3]), to_point(f.corners[(k + 2) % 3])));
    };
    return opposite_meets(a, b) || opposite_meets(b, a);
}

bool cross_within_part(const Facet& a, const Facet& b) {
    std::vector<std::size_t> shared;
    for (const auto p : a.points)
        if (std::ranges::find(b.points, p) != b.points.end()) shared.push_back(p);
    if (shared.size() == 3) return true;
    if (shared.size() == 2) return are_folded(a, b, shared);
    if (shared.size() == 1) return meet_beyond_corner(a, b, shared[0]);
    return CGAL::do_intersect(to_triangle(a), to_triangle(b));
}

/// The part of the line of the planes of two triangles that is in one of them, from first to
/// second. The distances are those of its corners from the other plane.
std::pair<double, double> interval_on_line(const Facet& f, const Vec3& line,
                                           const std::array<double, 3>& distances) {
    double low = 0.0, high = 0.0;
    bool is_first = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const double d = distances[k], e = distances[next];
        if ((d > 0.0) == (e > 0.0)) continue;
        const Vec3 x = f.corners[k] + d / (d - e) * (f.corners[next] - f.corners[k]);
        const double place = line.dot(x);
        low = is_first ? place : std::min(low, place);
        high = is_first ? place : std::max(high, place);
        is_first = false;
    }
    return {low, high};
}

/// True if each triangle passes through the other by more than the tolerance.
bool pass_through(const Facet& a, const Facet& b, double tolerance) {
    const auto normal_of = [](const Facet& f) {
        return Vec3((f.corners[1] - f.corners[0]).cross(f.corners[2] - f.corners[0]).normalized());
    };
    const Vec3 m = normal_of(a), n = normal_of(b);
    std::array<double, 3> from_b, from_a;
    for (std::size_t k = 0; k < 3; ++k) {
        from_b[k] = n.dot(a.corners[k] - b.corners[0]);
        from_a[k] = m.dot(b.corners[k] - a.corners[0]);
    }
    for (const auto& distances : {from_a, from_b}) {
        const auto [low, high] = std::ranges::minmax(distances);
        if (low > -tolerance || high < tolerance) return false;
    }
    const Vec3 line = m.cross(n).normalized();
    const auto [a_low, a_high] = interval_on_line(a, line, from_b);
    const auto [b_low, b_high] = interval_on_line(b, line, from_a);
    return std::min(a_high, b_high) - std::max(a_low, b_low) > tolerance;
}

/// True if two triangles have a point in common, or come as near as the tolerance at a corner.
bool do_touch(const Facet& a, const Facet& b, double tolerance) {
    const auto is_corner_near = [&](const Facet& f, const Facet& g) {
        return std::ranges::any_of(f.corners, [&](const Vec3& x) {
            return CGAL::squared_distance(to_point(x), to_triangle(g)) <= tolerance * tolerance;
        });
    };
    return CGAL::do_intersect(to_triangle(a), to_triangle(b)) || is_corner_near(a, b) ||
           is_corner_near(b, a);
}

/// A point that two crossing triangles have in common, nearly.
Vec3 place_of(const Facet& a, const Facet& b) {
    const auto point_in = [](const Facet& f, const Facet& g) -> std::optional<Vec3> {
        const auto triangle = to_triangle(g);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &p = f.corners[k], &q = f.corners[(k + 1) % 3];
            if (!CGAL::do_intersect(triangle, Kernel::Segment_3(to_point(p), to_point(q))))
                continue;
            const Vec3 n = (g.corners[1] - g.corners[0]).cross(g.corners[2] - g.corners[0]);
            const double d = n.dot(p - g.corners[0]), e = n.dot(q - g.corners[0]);
            return d == e ? p : Vec3(p + d / (d - e) * (q - p));
        }
        return std::nullopt;
    };
    if (const auto x = point_in(a, b)) return *x;
    if (const auto x = point_in(b, a)) return *x;
    return (a.corners[0] + a.corners[1] + a.corners[2]) / 3.0;
}

}  // namespace

SurfaceContacts contacts_of(const std::vector<topology::SurfaceParts>& surfaces) {
    const auto facets = facets_of(surfaces);
    const double tolerance = coordinate_tolerance(box_of(surfaces));
    using Item = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Facet*>;
    std::vector<Item> boxes;
    boxes.reserve(facets.size());
    for (const Facet& f : facets) {
        Box box;
        for (const Vec3& x : f.corners) box.extend(x);
        const Vec3 low = box.min().array() - tolerance, high = box.max().array() + tolerance;
        boxes.emplace_back(CGAL::Bbox_3(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()),
                           &f);
    }

    SurfaceContacts contacts;
    std::size_t num_pairs = 0;
    std::pair<const Facet*, const Facet*> first{nullptr, nullptr};
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Item& i, const Item& j) {
        const Facet* a = std::min(i.handle(), j.handle());
        const Facet* b = std::max(i.handle(), j.handle());
        const bool are_of_one_part = a->part == b->part;
        if (!are_of_one_part && !contacts.do_parts_touch)
            contacts.do_parts_touch = do_touch(*a, *b, tolerance);
        const bool do_cross =
            are_of_one_part ? cross_within_part(*a, *b) : pass_through(*a, *b, tolerance);
        if (!do_cross) return;
        ++num_pairs;
        if (first.first == nullptr || std::pair(a, b) < first) first = {a, b};
    });
    if (num_pairs > 0)
        contacts.crossing = Crossing{num_pairs, first.first->surface, first.second->surface,
                                     place_of(*first.first, *first.second)};
    return contacts;
}

}  // namespace incise::tetmesh
