// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/flat_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace incise::topology {

namespace {

using Corners = std::array<std::int64_t, 3>;

// A triangle that is less slender than this is no needle, however small it is.
constexpr double needle = 1e-3;

const Vec3& point_of(const SurfaceData& surface, std::int64_t p) {
    return surface.points[static_cast<std::size_t>(p)];
}

/// Twice the area of a triangle, as a vector, over the square of a power of two that is about the
/// length of its edges: so that it is 0 in no unit but for triangles without area.
struct ScaledArea {
    Vec3 normal = Vec3::Zero();
    double longest = 0.0;   ///< edge, scaled
    int exponent = 0;       ///< of the scale
    std::size_t first = 0;  ///< the end of the longest edge that the next corner follows

    ScaledArea(const SurfaceData& surface, const Corners& t) {
        std::array<Vec3, 3> edges;  // edge k begins at corner k
        double largest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            edges[k] = point_of(surface, t[(k + 1) % 3]) - point_of(surface, t[k]);
            largest = std::max(largest, edges[k].cwiseAbs().maxCoeff());
        }
        if (!(largest > 0.0)) return;
        exponent = std::ilogb(largest);
        for (Vec3& e : edges) e = e.unaryExpr([&](double x) { return std::scalbn(x, -exponent); });
        normal = edges[0].cross(-edges[2]);
        for (std::size_t k = 0; k < 3; ++k)
            if (edges[k].norm() > longest) {
                longest = edges[k].norm();
                first = k;
            }
    }

    bool is_zero() const { return normal.isZero(0.0); }
    /// True if the apex is not further than the tolerance from the longest edge.
    bool is_flat(double tolerance) const {
        if (is_zero()) return true;
        const double altitude = normal.norm() / longest;
        return altitude <= needle * longest && std::scalbn(altitude, exponent) <= tolerance;
    }
};

/// Divides triangles at the apexes of flat ones that lie on their edges.
class FlatTriangleDivision {
  public:
    FlatTriangleDivision(SurfaceData& surface, double tolerance)
        : surface_(surface), tolerance_(tolerance), number_(surface.points.size()) {
        std::map<std::array<double, 3>, std::int64_t> known;
        for (std::size_t p = 0; p < number_.size(); ++p) {
            const Vec3 x = surface.points[p].array() + 0.0;  // changes -0 to 0
            number_[p] = known.try_emplace({x.x(), x.y(), x.z()}, static_cast<std::int64_t>(p))
                             .first->second;
        }
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) insert(t);
    }

    /// True if a flat triangle is none any more, or gone. Two flat ones with the same longest edge
    /// become shorter instead.
    bool divide_across(std::size_t t) {
        const auto area = area_of(t);
        const Corners flat = surface_.triangles[t];
        const auto a = flat[area.first], c = flat[(area.first + 1) % 3],
                   b = flat[(area.first + 2) % 3];
        if (has_repeated(flat)) return false;
        const auto& sharing = triangles_at_[edge_of(a, c)];
        if (sharing.size() != 2) return false;
        const std::size_t other = sharing[0] == t ? sharing[1] : sharing[0];
        const auto old = area_of(other);
        const Corners across = surface_.triangles[other];
        const auto replaced = [&](std::int64_t corner) {
            Corners corners = across;
            for (auto& p : corners)
                if (is_same(p, corner)) p = b;
            return corners;
        };
        const Corners at_c = replaced(a), at_a = replaced(c);
        std::int64_t apex = across[0];
        for (const auto p : across)
            if (!is_same(p, a) && !is_same(p, c)) apex = p;
        if (is_same(apex, b)) {  // two flat triangles on each other: their neighbours meet
            for (const std::size_t gone : {t, other}) {
                erase(gone);
                surface_.triangles[gone] = {b, b, b};
            }
            return true;
        }
        if (triangles_at_.contains(edge_of(apex, b))) return false;
        const ScaledArea first(surface_, at_a), second(surface_, at_c);
        if (old.is_zero()) {
            if (edge_of(across[old.first], across[(old.first + 1) % 3]) != edge_of(a, c))
                return false;
        } else if (first.is_flat(tolerance_) || second.is_flat(tolerance_) ||
                   !(first.normal.dot(old.normal) > 0.0) ||
                   !(second.normal.dot(old.normal) > 0.0)) {
            return false;
        }
        erase(t);
        erase(other);
        surface_.triangles[other] = at_a;
        surface_.triangles[t] = at_c;
        insert(t);
        insert(other);
        return true;
    }

  private:
    using Edge = std::pair<std::int64_t, std::int64_t>;

    ScaledArea area_of(std::size_t t) const { return {surface_, surface_.triangles[t]}; }
    std::int64_t number_of(std::int64_t p) const { return number_[static_cast<std::size_t>(p)]; }
    bool is_same(std::int64_t p, std::int64_t q) const { return number_of(p) == number_of(q); }
    bool has_repeated(const Corners& c) const {
        return is_same(c[0], c[1]) || is_same(c[1], c[2]) || is_same(c[2], c[0]);
    }
    Edge edge_of(std::int64_t p, std::int64_t q) const {
        return std::minmax({number_of(p), number_of(q)});
    }
    void insert(std::size_t t) {
        const Corners& c = surface_.triangles[t];
        if (has_repeated(c)) return;  // what is across one edge then meets what is across another
        for (std::size_t k = 0; k < 3; ++k)
            triangles_at_[edge_of(c[k], c[(k + 1) % 3])].push_back(t);
    }
    void erase(std::size_t t) {
        const Corners& c = surface_.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto it = triangles_at_.find(edge_of(c[k], c[(k + 1) % 3]));
            std::erase(it->second, t);
            if (it->second.empty()) triangles_at_.erase(it);
        }
    }

    SurfaceData& surface_;
    double tolerance_;
    std::vector<std::int64_t> number_;  // by point, the first one at the same position
    std::map<Edge, std::vector<std::size_t>> triangles_at_;
};

}  // namespace

SurfaceData without_flat_triangles(SurfaceData surface, double tolerance) {
    auto& triangles = surface.triangles;
    std::vector<std::size_t> flat;
    const auto is_flat = [&](std::size_t t) {
        return ScaledArea(surface, triangles[t]).is_flat(tolerance);
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (is_flat(t)) flat.push_back(t);
    if (flat.empty()) return surface;
    FlatTriangleDivision division(surface, tolerance);
    // Each pass resolves at least one triangle, and mostly all. Needles could take turns for ever.
    constexpr int max_passes = 1000;
    bool has_changed = true;
    for (int pass = 0; pass < max_passes && has_changed; ++pass) {
        has_changed = false;
        for (const std::size_t t : flat)
            if (is_flat(t) && division.divide_across(t)) has_changed = true;
    }
    std::erase_if(triangles, [&](const Corners& t) { return ScaledArea(surface, t).is_zero(); });
    return surface;
}

}  // namespace incise::topology
