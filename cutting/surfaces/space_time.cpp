// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/space_time.h"

#include <optional>

#include "incise/cutting/surfaces/shifted_sign.h"

namespace incise::cutting {

namespace {

/// A point in space and time. Its time is 0 before the step and 1 after it.
using Event = ShiftedPoint<4>;
using EventTriangle = std::array<const Event*, 3>;

/// True if two triangles in four dimensions meet. Their six events satisfy one affine relation,
/// whose coefficients are the minors with alternating signs. The triangles meet if the coefficients
/// of the first are all of one sign and those of the second all of the other. The first three
/// coefficients are then the weights of the meeting point in the first triangle.
/// @param num_unknown  6, or 3 if the signs of the last three are known to agree with the others
bool triangles_meet(const EventTriangle& s, const EventTriangle& t, std::size_t num_unknown,
                    std::array<double, 3>& weights) {
    const std::array<const Event*, 6> events = {s[0], s[1], s[2], t[0], t[1], t[2]};
    const auto minor = [&](std::size_t k) {
        std::array<const Event*, 5> others{};
        for (std::size_t i = 0, n = 0; i < 6; ++i)
            if (i != k) others[n++] = events[i];
        return others;
    };
    int common_sign = 0;
    std::array<bool, 6> is_clear{};
    const auto agrees = [&](std::size_t k, int sign) {
        if ((k % 2 == 1) != (k >= 3)) sign = -sign;
        if (sign == 0 || sign == -common_sign) return false;
        common_sign = sign;
        return true;
    };
    // Exact arithmetic only where necessary: mostly, the clear signs already exclude a meeting.
    for (std::size_t k = 0; k < num_unknown; ++k)
        if (const auto clear = clear_orientation<4>(minor(k))) {
            if (!agrees(k, clear->sign)) return false;
            is_clear[k] = true;
            if (k < 3) weights[k] = std::abs(clear->value);
        }
    for (std::size_t k = 0; k < num_unknown; ++k)
        if (!is_clear[k] && !agrees(k, orientation_sign<4>(minor(k)))) return false;
    for (std::size_t k = 0; k < 3; ++k)
        if (!is_clear[k]) weights[k] = std::abs(orientation_value<4>(minor(k)));
    return true;
}

using Place = ShiftedPoint<3>;

Place place(const Vec3& x, bool is_tissue) { return {{x.x(), x.y(), x.z()}, is_tissue}; }

/// True if a segment passes through a triangle in space. The ends are on different sides of the
/// triangle, and the triangle's edges are all on the same side of the segment.
bool passes_through(const std::array<Place, 2>& ends, const std::array<Place, 3>& triangle) {
    const auto& [from, to] = ends;
    const auto& [u, v, w] = triangle;
    const std::array<std::array<const Place*, 4>, 5> tetrahedra = {
        {{&from, &u, &v, &w},
         {&to, &w, &v, &u},  // turned round, so that the signs are equal
         {&from, &to, &u, &v},
         {&from, &to, &v, &w},
         {&from, &to, &w, &u}}};
    std::array<int, 2> common_sign{};  // of the first two, and of the others
    const auto agrees = [&](std::size_t k, int sign) {
        int& common = common_sign[k < 2 ? 0 : 1];
        if (sign == 0 || sign == -common) return false;
        common = sign;
        return true;
    };
    std::array<bool, 5> is_clear{};
    // Exact arithmetic only where necessary, as in triangles_meet().
    for (std::size_t k = 0; k < 5; ++k)
        if (const auto clear = clear_orientation<3>(tetrahedra[k])) {
            if (!agrees(k, clear->sign)) return false;
            is_clear[k] = true;
        }
    for (std::size_t k = 0; k < 5; ++k)
        if (!is_clear[k] && !agrees(k, orientation_sign<3>(tetrahedra[k]))) return false;
    return true;
}

std::array<Event, 4> corners(const MovingSegment& s, bool is_tissue) {
    const auto event = [&](const Vec3& x, double time) {
        return Event{{x.x(), x.y(), x.z(), time}, is_tissue};
    };
    return {event(s.a[0], 0.0), event(s.b[0], 0.0), event(s.b[1], 1.0), event(s.a[1], 1.0)};
}

/// Calls visit(edge parameter of the tissue's segment, time) for each intersection.
template <class Visit>
void for_crossings(const MovingSegment& tissue, const MovingSegment& blade, Visit visit) {
    const auto p = corners(tissue, true), q = corners(blade, false);
    const auto in_space = [](const Event& e) {
        return Place{{e.x[0], e.x[1], e.x[2]}, e.is_tissue};
    };
    const bool is_at_rest = tissue.a[0] == tissue.a[1] && tissue.b[0] == tissue.b[1];
    std::array<double, 3> weights;
    // Tissue at rest can only meet what the blade sweeps where it passes through that in space:
    // docs/theory.md.
    const auto may_meet = [&](std::size_t j) {
        return !is_at_rest || passes_through({in_space(p[0]), in_space(p[1])},
                                             {in_space(q[0]), in_space(q[j]), in_space(q[j + 1])});
    };
    const std::array<bool, 2> may_meet_triangle{may_meet(1), may_meet(2)};
    // Both triangles of a surface contain its diagonal from (a, before) to (b, after).
    for (const std::size_t i : {1u, 2u})
        for (const std::size_t j : {1u, 2u}) {
            if (!may_meet_triangle[j - 1] ||
                !triangles_meet({&p[0], &p[i], &p[i + 1]}, {&q[0], &q[j], &q[j + 1]},
                                is_at_rest ? 3 : 6, weights))
                continue;
            // Corners 1 and 2 are those of b.
            const double towards_b = i == 1 ? weights[1] + weights[2] : weights[1];
            const double sum = weights[0] + weights[1] + weights[2];
            const double late = i == 1 ? weights[2] : weights[1] + weights[2];
            visit(sum > 0.0 ? towards_b / sum : 0.5, sum > 0.0 ? late / sum : 0.5);
        }
}

}  // namespace

void append_crossings(const MovingSegment& tissue, const MovingSegment& blade,
                      std::vector<Crossing>& crossings) {
    // The cut runs along the blade and along its motion relative to the tissue.
    const auto normal = [&](double place) -> Vec3 {
        const auto shift = [](const MovingPoint& x) -> Vec3 { return x[1] - x[0]; };
        const Vec3 along = blade.b[0] - blade.a[0] + blade.b[1] - blade.a[1];
        const Vec3 motion = 0.5 * (shift(blade.a) + shift(blade.b)) -
                            (1.0 - place) * shift(tissue.a) - place * shift(tissue.b);
        return along.cross(motion);
    };
    for_crossings(tissue, blade, [&](double place, double time) {
        crossings.push_back({place, normal(place), time});
    });
}

bool cross(const MovingSegment& tissue, const MovingSegment& blade) {
    bool is_odd = false;
    for_crossings(tissue, blade, [&](double, double) { is_odd = !is_odd; });
    return is_odd;
}

bool pierces(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle) {
    return passes_through(
        {place(p, false), place(q, false)},
        {place(triangle[0], true), place(triangle[1], true), place(triangle[2], true)});
}

}  // namespace incise::cutting
