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
bool triangles_meet(const EventTriangle& s, const EventTriangle& t,
                    std::array<double, 3>& weights) {
    const std::array<const Event*, 6> events = {s[0], s[1], s[2], t[0], t[1], t[2]};
    int common_sign = 0;
    std::array<bool, 6> is_known{};
    // Exact arithmetic only where necessary: mostly, the clear signs already exclude a meeting.
    for (const bool is_exact : {false, true})
        for (std::size_t k = 0; k < 6; ++k) {
            if (is_known[k]) continue;
            std::array<const Event*, 5> others{};
            for (std::size_t i = 0, n = 0; i < 6; ++i)
                if (i != k) others[n++] = events[i];
            const std::optional<ShiftedSign> minor =
                is_exact ? orientation<4>(others) : clear_orientation<4>(others);
            if (!minor) continue;
            const int sign = (k % 2 == 1) != (k >= 3) ? -minor->sign : minor->sign;
            if (sign == 0 || sign == -common_sign) return false;
            common_sign = sign;
            is_known[k] = true;
            if (k < 3) weights[k] = std::abs(minor->value);
        }
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
    std::array<double, 3> weights;
    // Both triangles of a surface contain its diagonal from (a, before) to (b, after).
    for (const std::size_t i : {1u, 2u})
        for (const std::size_t j : {1u, 2u}) {
            if (!triangles_meet({&p[0], &p[i], &p[i + 1]}, {&q[0], &q[j], &q[j + 1]}, weights))
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
    using Point = ShiftedPoint<3>;
    const auto point = [](const Vec3& x, bool is_tissue) {
        return Point{{x.x(), x.y(), x.z()}, is_tissue};
    };
    const Point from = point(p, false), to = point(q, false);
    const Point u = point(triangle[0], true), v = point(triangle[1], true),
                w = point(triangle[2], true);
    const int side = orientation<3>({&from, &u, &v, &w}).sign;
    if (side == 0 || orientation<3>({&to, &u, &v, &w}).sign != -side) return false;
    const int turn = orientation<3>({&from, &to, &u, &v}).sign;
    return turn != 0 && orientation<3>({&from, &to, &v, &w}).sign == turn &&
           orientation<3>({&from, &to, &w, &u}).sign == turn;
}

}  // namespace incise::cutting
