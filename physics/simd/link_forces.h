// Strain and forces of HEML on lanes, from the edges of one element in each lane. Equations:
// docs/theory.md, Lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/elements/simd_heml_elements.h"
#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

/// A symmetric 3 x 3 matrix: 11, 22, 33, 12, 23, 31.
template <class Scalar>
struct Symmetric {
    Scalar d1, d2, d3, s12, s23, s31;
};

/// The vectors of corners 1 to 3: edges from corner 0, or forces.
template <class Number>
using LinkVectors = std::array<Lanes3<Number>, 3>;

/// Returns G = (V^T V)^-1 of the part of a group that starts at lane `first`.
template <class Number>
[[gnu::always_inline]] inline Symmetric<Lanes<Number>> load_metric(const MetricGroup<Number>& group,
                                                                   std::size_t first) {
    const auto load = [&](int k) { return Lanes<Number>::load(group.G[k] + first); };
    return {load(0), load(1), load(2), load(3), load(4), load(5)};
}

/// Returns u = V^-1 a0 of the part of a group that starts at lane `first`.
template <class Number>
[[gnu::always_inline]] inline Lanes3<Number> load_fibres(const FibreGroup<Number>& fibres,
                                                         std::size_t first) {
    const auto load = [&](int k) { return Lanes<Number>::load(fibres.u[k] + first); };
    return {load(0), load(1), load(2)};
}

/// Returns the strain of the part of a group that starts at lane `first`. `dl` has the changes of
/// the squared edge lengths, m2. If these are zero, the strain is exactly zero, except for the
/// given volume ratio.
template <class Law, class Number>
[[gnu::always_inline]] inline LinkStrain<Lanes<Number>> strain_of_links(
    const MetricGroup<Number>& group, [[maybe_unused]] const FibreGroup<Number>* fibres,
    std::size_t first, const std::array<Lanes<Number>, 6>& dl, Lanes<Number> volume_ratio) {
    using Scalar = Lanes<Number>;
    const Symmetric<Scalar> G = load_metric(group, first);
    // E = 2 V^T (C - 1) V
    const Symmetric<Scalar> E{dl[0] + dl[0],         dl[1] + dl[1],         dl[2] + dl[2],
                              dl[0] + dl[1] - dl[3], dl[1] + dl[2] - dl[4], dl[2] + dl[0] - dl[5]};
    LinkStrain<Scalar> strain;
    strain.a = G.d1 * dl[0] + G.d2 * dl[1] + G.d3 * dl[2] +
               (G.s12 * E.s12 + G.s23 * E.s23 + G.s31 * E.s31);
    strain.b = 0.0;
    if constexpr (NeedsB<Law>) {
        const Scalar p11 = G.d1 * E.d1 + G.s12 * E.s12 + G.s31 * E.s31,  // G E
            p12 = G.d1 * E.s12 + G.s12 * E.d2 + G.s31 * E.s23,           //
            p13 = G.d1 * E.s31 + G.s12 * E.s23 + G.s31 * E.d3,           //
            p21 = G.s12 * E.d1 + G.d2 * E.s12 + G.s23 * E.s31,           //
            p22 = G.s12 * E.s12 + G.d2 * E.d2 + G.s23 * E.s23,           //
            p23 = G.s12 * E.s31 + G.d2 * E.s23 + G.s23 * E.d3,           //
            p31 = G.s31 * E.d1 + G.s23 * E.s12 + G.d3 * E.s31,           //
            p32 = G.s31 * E.s12 + G.s23 * E.d2 + G.d3 * E.s23,           //
            p33 = G.s31 * E.s31 + G.s23 * E.s23 + G.d3 * E.d3;
        strain.b =
            0.25 * (p11 * p11 + p22 * p22 + p33 * p33 + 2.0 * (p12 * p21 + p23 * p32 + p31 * p13));
    }
    strain.J = volume_ratio;
    strain.f = 0.0;
    if constexpr (HasFibres<Law>) {
        const Lanes3<Number> u = load_fibres(*fibres, first);
        strain.f = u.x * u.x * dl[0] + u.y * u.y * dl[1] + u.z * u.z * dl[2] +
                   (u.x * u.y * E.s12 + u.y * u.z * E.s23 + u.z * u.x * E.s31);
    }
    return strain;
}

/// Returns the forces on corners 1 to 3, N, of the part of a group that starts at lane `first`:
///     f_i = -2 Vol ((w_a + 2 w_b (B - 1)) w_i + w_f u_i F a0) - w_J dvol/dx_i,
/// with w_i = sum of G_ij v_j, the columns of F V^-T, and B = F F^T = sum of v_i w_i^T.
/// The strain comes from B, since strain from links loses more digits in thin elements.
/// The function has more than 60 lines, since its values have to stay in registers.
template <class Law, class Number>
[[gnu::always_inline]] inline LinkVectors<Number> link_forces(
    const Law& law, double J0, const MetricGroup<Number>& group,
    [[maybe_unused]] const FibreGroup<Number>* fibres, std::size_t first,
    const LinkVectors<Number>& edges) {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    const Vector &v1 = edges[0], &v2 = edges[1], &v3 = edges[2];  // no bindings: lambdas take them
    const Symmetric<Scalar> G = load_metric(group, first);
    const auto columns = [&](const Symmetric<Scalar>& T) -> LinkVectors<Number> {
        return {T.d1 * v1 + T.s12 * v2 + T.s31 * v3, T.s12 * v1 + T.d2 * v2 + T.s23 * v3,
                T.s31 * v1 + T.s23 * v2 + T.d3 * v3};
    };

    LinkStrain<Scalar> strain;
    LinkVectors<Number> w;
    Symmetric<Scalar> e;  // B - 1
    if constexpr (NeedsB<Law>) {
        w = columns(G);
        const auto product = [&](auto row, auto column) -> Scalar {
            return v1.*row * w[0].*column + v2.*row * w[1].*column + v3.*row * w[2].*column;
        };
        constexpr auto x = &Vector::x, y = &Vector::y, z = &Vector::z;
        e = {product(x, x) - 1.0, product(y, y) - 1.0, product(z, z) - 1.0,
             product(x, y),       product(y, z),       product(z, x)};
        strain.a = e.d1 + e.d2 + e.d3;
        strain.b = e.d1 * e.d1 + e.d2 * e.d2 + e.d3 * e.d3 +
                   2.0 * (e.s12 * e.s12 + e.s23 * e.s23 + e.s31 * e.s31);
    } else {
        // The same trace of B - 1, for laws that need no other entry of B.
        strain.a = G.d1 * dot(v1, v1) + G.d2 * dot(v2, v2) + G.d3 * dot(v3, v3) +
                   2.0 * (G.s12 * dot(v1, v2) + G.s23 * dot(v2, v3) + G.s31 * dot(v3, v1)) - 3.0;
        strain.b = 0.0;
    }
    strain.J = dot(cross(v1, v2), v3) * Scalar::load(group.per_six_volumes + first);
    strain.f = 0.0;
    Vector u, fibre;
    if constexpr (HasFibres<Law>) {
        u = load_fibres(*fibres, first);
        fibre = u.x * v1 + u.y * v2 + u.z * v3;  // F a0
        strain.f = dot(fibre, fibre) - 1.0;
    }

    const LawResponse<Scalar> r = law.response(strain, J0);
    const Scalar twice = -2.0 * Scalar::load(group.volume + first), a = twice * r.w_a;
    LinkVectors<Number> f;
    if constexpr (NeedsB<Law>) {
        const Scalar b = 2.0 * twice * r.w_b;
        const Symmetric<Scalar> t{b * e.d1 + a, b * e.d2 + a, b * e.d3 + a,
                                  b * e.s12,    b * e.s23,    b * e.s31};
        for (std::size_t i = 0; i < 3; ++i)
            f[i] = {t.d1 * w[i].x + t.s12 * w[i].y + t.s31 * w[i].z,
                    t.s12 * w[i].x + t.d2 * w[i].y + t.s23 * w[i].z,
                    t.s31 * w[i].x + t.s23 * w[i].y + t.d3 * w[i].z};
    } else {
        f = columns({a * G.d1, a * G.d2, a * G.d3, a * G.s12, a * G.s23, a * G.s31});
    }
    if constexpr (HasFibres<Law>) {
        const Vector along = twice * r.w_f * fibre;
        f = {f[0] + u.x * along, f[1] + u.y * along, f[2] + u.z * along};
    }
    if constexpr (NeedsJ<Law>) {
        const Scalar p = (-1.0 / 6.0) * r.w_J;
        f = {f[0] + p * cross(v2, v3), f[1] + p * cross(v3, v1), f[2] + p * cross(v1, v2)};
    }
    return f;
}

}  // namespace incise::physics::INCISE_PROCESSOR
