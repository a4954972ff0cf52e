// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/star_filling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "incise/topology/geometry.h"

namespace incise::topology {

namespace {

using Triangle = std::array<std::int64_t, 3>;

class Search {
  public:
    Search(std::span<const Triangle> triangles, std::span<const Vec3> points) : points_(points) {
        double area = 0.0, volume = 0.0;
        const Vec3& o = at(triangles[0][0]);
        for (const auto& [a, b, c] : triangles) {
            area += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
            volume += (at(a) - o).dot((at(b) - o).cross(at(c) - o)) / 6.0;
            for (const std::int64_t p : {a, b, c}) corners_.push_back(p);
        }
        std::ranges::sort(corners_);
        const auto rest = std::ranges::unique(corners_);
        corners_.erase(rest.begin(), rest.end());
        radius_ = 3.0 * volume / area;
        volume_ = volume;
    }

    /// True if the surface was filled, from the state `now` on.
    bool fill(StarFilling& now) {
        if (!(radius_ > 0.0) || ++num_tries_ > max_tries) return false;
        const std::vector<Plane> planes = planes_of(now.triangles);
        if (planes.size() < now.triangles.size()) return false;  // flat ones
        now.centre = deepest(planes, now.centre);
        const auto [worst, depth] = lowest(planes, now.centre);
        if (depth > least_depth * radius_) return true;
        const std::vector<Triangle> facet = facet_at(now.triangles, planes, worst);
        for (const auto& [score, corner] : ways_off(now, facet)) {
            StarFilling next = now;
            for (const Triangle& t : facet) take_off(next, t, corner);
            if (fill(next)) {
                now = std::move(next);
                return true;
            }
        }
        return false;
    }

  private:
    struct Plane {
        Vec3 normal, at;  // outwards
        double depth(const Vec3& x) const { return normal.dot(at - x); }
    };

    const Vec3& at(std::int64_t p) const { return points_[static_cast<std::size_t>(p)]; }

    std::optional<Plane> plane_of(const Triangle& t) const {
        const Vec3 area = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
        const double size = area.norm();
        if (!(size > 0.0)) return std::nullopt;
        return Plane{area / size, at(t[0])};
    }
    std::vector<Plane> planes_of(const std::vector<Triangle>& triangles) const {
        std::vector<Plane> planes;
        planes.reserve(triangles.size());
        for (const Triangle& t : triangles)
            if (const auto plane = plane_of(t)) planes.push_back(*plane);
        return planes;
    }

    static std::pair<std::size_t, double> lowest(const std::vector<Plane>& planes, const Vec3& x) {
        std::pair<std::size_t, double> lowest{0, std::numeric_limits<double>::infinity()};
        for (std::size_t i = 0; i < planes.size(); ++i)
            if (const double depth = planes[i].depth(x); depth < lowest.second) lowest = {i, depth};
        return lowest;
    }

    /// Returns a point that is well inside of all planes, or the one least outside that was met.
    /// Source: Agmon 1954, The relaxation method for linear inequalities.
    Vec3 deepest(const std::vector<Plane>& planes, const Vec3& start) const {
        Vec3 best = start;
        double best_depth = lowest(planes, start).second;
        if (best_depth > least_depth * radius_) return best;
        for (const double aim : {0.3, 0.1, 0.03, 0.01, 0.001}) {
            constexpr int max_steps = 200;
            Vec3 x = best;
            for (int step = 0; step < max_steps; ++step) {
                const auto [i, depth] = lowest(planes, x);
                if (depth > best_depth) {
                    best = x;
                    best_depth = depth;
                }
                if (depth >= 0.5 * aim * radius_) return x;
                x -= (aim * radius_ - depth) * planes[i].normal;
            }
        }
        return best;
    }

    /// Returns the triangles that hang together with one and face the same way.
    static std::vector<Triangle> facet_at(const std::vector<Triangle>& triangles,
                                          const std::vector<Plane>& planes, std::size_t first) {
        constexpr double least_cosine = 0.99;
        std::vector<std::size_t> found{first};
        for (std::size_t i = 0; i < found.size(); ++i)
            for (std::size_t t = 0; t < triangles.size(); ++t)
                if (planes[t].normal.dot(planes[first].normal) > least_cosine &&
                    num_common(triangles[t], triangles[found[i]]) == 2 &&
                    std::ranges::find(found, t) == found.end())
                    found.push_back(t);
        std::vector<Triangle> facet;
        for (const std::size_t t : found) facet.push_back(triangles[t]);
        return facet;
    }
    static std::ptrdiff_t num_common(const Triangle& a, const Triangle& b) {
        return std::ranges::count_if(
            a, [&](std::int64_t p) { return std::ranges::find(b, p) != b.end(); });
    }

    /// Returns the corners with which a facet makes tetrahedra that can be taken off, the best
    /// first.
    std::vector<std::pair<double, std::int64_t>> ways_off(
        const StarFilling& now, const std::vector<Triangle>& facet) const {
        std::vector<std::pair<double, std::int64_t>> ways;
        for (const std::int64_t p : corners_) {
            // Seen from inside, a triangle runs clockwise.
            if (std::ranges::any_of(facet, [&](const Triangle& t) {
                    return -tetrahedron_volume(at(t[0]), at(t[1]), at(t[2]), at(p)) <=
                           least_volume * volume_;
                }))
                continue;
            // By how much less the centre lies behind what is left.
            double score = 0.0;
            bool is_free = true;
            for (const Triangle& t : facet)
                for (std::size_t k = 0; k < 3 && is_free; ++k) {
                    const std::int64_t a = t[k], b = t[(k + 1) % 3];
                    if (std::ranges::any_of(
                            facet, [&](const Triangle& other) { return has_edge(other, b, a); }))
                        continue;
                    if (has(now.triangles, {b, a, p})) {
                        score += behind({b, a, p}, now.centre);
                    } else {
                        is_free = plane_of({a, b, p}) && !has(now.triangles, {a, b, p});
                        score -= behind({a, b, p}, now.centre);
                    }
                }
            if (is_free) ways.emplace_back(score, p);
        }
        std::ranges::sort(ways, [](const auto& a, const auto& b) {
            return a.first != b.first ? a.first > b.first : a.second < b.second;
        });
        constexpr std::size_t max_ways = 6;
        if (ways.size() > max_ways) ways.resize(max_ways);
        return ways;
    }
    static bool has_edge(const Triangle& t, std::int64_t from, std::int64_t to) {
        for (std::size_t k = 0; k < 3; ++k)
            if (t[k] == from && t[(k + 1) % 3] == to) return true;
        return false;
    }

    /// Returns how far a point lies behind the plane of a triangle, over the radius.
    double behind(const Triangle& t, const Vec3& x) const {
        const auto plane = plane_of(t);
        return plane ? std::max(0.0, -plane->depth(x)) / radius_ : 0.0;
    }

    static Triangle from_lowest(Triangle t) {
        std::ranges::rotate(t, std::ranges::min_element(t));
        return t;
    }
    static bool has(const std::vector<Triangle>& triangles, const Triangle& t) {
        return std::ranges::find(triangles, from_lowest(t), from_lowest) != triangles.end();
    }

    /// Takes the tetrahedron of a triangle and a corner off what is left.
    static void take_off(StarFilling& now, Triangle t, std::int64_t p) {
        now.tetrahedra.push_back({t[0], t[2], t[1], p});
        const auto remove = [&](const Triangle& gone) {
            return std::erase_if(now.triangles, [&](const Triangle& one) {
                       return from_lowest(one) == from_lowest(gone);
                   }) > 0;
        };
        remove(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int64_t a = t[k], b = t[(k + 1) % 3];
            if (!remove({b, a, p})) now.triangles.push_back({a, b, p});
        }
    }

    // Of the radius, and of the volume of the surface: thinner tetrahedra are flat to rounding.
    static constexpr double least_depth = 1e-8, least_volume = 1e-13;
    static constexpr int max_tries = 30;  // more of them find hardly more

    std::span<const Vec3> points_;
    std::vector<std::int64_t> corners_;
    double radius_ = 0.0;  // of the ball inside, if it touched all triangles, m
    double volume_ = 0.0;  // m3
    int num_tries_ = 0;
};

}  // namespace

std::optional<StarFilling> fill_surface(std::vector<Triangle> triangles,
                                        std::span<const Vec3> points, const Vec3& start) {
    Search search(triangles, points);
    StarFilling filling{{}, std::move(triangles), start};
    if (search.fill(filling)) return filling;
    return std::nullopt;
}

}  // namespace incise::topology
