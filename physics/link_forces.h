// Strain and forces of hyper-elastic links from the edges of as many elements as there are lanes:
// between fetching positions and adding up forces. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "physics/heml_lanes.h"
#include "physics/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

/// Symmetric 3 x 3: 11, 22, 33, 12, 23, 31.
template <class Scalar>
struct Symmetric {
    Scalar d1, d2, d3, s12, s23, s31;
};

/// Vectors of the corners but corner 0: edges from it, or forces.
template <class Number>
using LinkVectors = std::array<Lanes3<Number>, 3>;

/// What forces and energies read of the part of a group that starts at lane `first`, and the strain
/// there.
template <class Law, class Number>
struct StrainedLinks {
    using Scalar = Lanes<Number>;

    Symmetric<Scalar> G;
    Scalar p11, p12, p13, p21, p22, p23, p31, p32, p33;  ///< G E, E = 2 V^T (C - 1) V
    Lanes3<Number> u;                                    ///< of laws with fibres
    LinkStrain<Scalar> strain;

    /// @param dl changes of the squared links
    [[gnu::always_inline]] inline StrainedLinks(const LinkGroup<Number>& group,
                                                [[maybe_unused]] const FibreGroup<Number>* fibres,
                                                std::size_t first, const std::array<Scalar, 6>& dl,
                                                Scalar volume_ratio) {
        const auto load = [first](const auto& row) { return Scalar::load(row + first); };
        const Symmetric<Scalar> E{dl[0] + dl[0],         dl[1] + dl[1],
                                  dl[2] + dl[2],         dl[0] + dl[1] - dl[3],
                                  dl[1] + dl[2] - dl[4], dl[2] + dl[0] - dl[5]};
        G = {load(group.G[0]), load(group.G[1]), load(group.G[2]),
             load(group.G[3]), load(group.G[4]), load(group.G[5])};
        p11 = G.d1 * E.d1 + G.s12 * E.s12 + G.s31 * E.s31;
        p12 = G.d1 * E.s12 + G.s12 * E.d2 + G.s31 * E.s23;
        p13 = G.d1 * E.s31 + G.s12 * E.s23 + G.s31 * E.d3;
        p21 = G.s12 * E.d1 + G.d2 * E.s12 + G.s23 * E.s31;
        p22 = G.s12 * E.s12 + G.d2 * E.d2 + G.s23 * E.s23;
        p23 = G.s12 * E.s31 + G.d2 * E.s23 + G.s23 * E.d3;
        p31 = G.s31 * E.d1 + G.s23 * E.s12 + G.d3 * E.s31;
        p32 = G.s31 * E.s12 + G.s23 * E.d2 + G.d3 * E.s23;
        p33 = G.s31 * E.s31 + G.s23 * E.s23 + G.d3 * E.d3;
        if constexpr (NeedsB<Law>)
            strain.a = 0.5 * (p11 + p22 + p33);
        else
            strain.a = G.d1 * dl[0] + G.d2 * dl[1] + G.d3 * dl[2] +
                       (G.s12 * E.s12 + G.s23 * E.s23 + G.s31 * E.s31);
        strain.b =
            0.25 * (p11 * p11 + p22 * p22 + p33 * p33 + 2.0 * (p12 * p21 + p23 * p32 + p31 * p13));
        strain.J = volume_ratio;
        strain.f = 0.0;
        if constexpr (HasFibres<Law>) {
            u = {load(fibres->u[0]), load(fibres->u[1]), load(fibres->u[2])};
            strain.f = u.x * u.x * dl[0] + u.y * u.y * dl[1] + u.z * u.z * dl[2] +
                       (u.x * u.y * E.s12 + u.y * u.z * E.s23 + u.z * u.x * E.s31);
        }
    }
};

/// Products of edges, each two of which span a face of the element.
template <class Number>
[[gnu::always_inline]] inline LinkVectors<Number> across(const LinkVectors<Number>& edges) {
    const auto& [v1, v2, v3] = edges;
    return {cross(v2, v3), cross(v3, v1), cross(v1, v2)};
}

/// Forces on the corners but corner 0, N, of the part of a group that starts at lane `first`.
template <class Law, class Number>
[[gnu::always_inline]] inline LinkVectors<Number> link_forces(
    const Law& law, double J0, const LinkGroup<Number>& group, std::size_t first,
    const LinkVectors<Number>& edges, [[maybe_unused]] const LinkVectors<Number>& across_edges,
    const StrainedLinks<Law, Number>& links) {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    const auto& [v1, v2, v3] = edges;
    const auto& [G, p11, p12, p13, p21, p22, p23, p31, p32, p33, u, strain] = links;

    const LawResponse<Scalar> r = law.response(strain, J0);
    // T = -Vol ((2 w_a + 2 w_b G E) G + 2 w_f u u^T), and f_i = sum of T_ij v_j - w_J dvol/dx_i.
    const Scalar twice = -2.0 * Scalar::load(group.volume + first), a = twice * r.w_a;
    Symmetric<Scalar> T;
    if constexpr (NeedsB<Law>) {
        const Scalar b = twice * r.w_b;
        const Scalar q11 = b * p11 + a, q12 = b * p12, q13 = b * p13,  // a + b G E
            q21 = b * p21, q22 = b * p22 + a, q23 = b * p23,           //
            q31 = b * p31, q32 = b * p32, q33 = b * p33 + a;
        T = {q11 * G.d1 + q12 * G.s12 + q13 * G.s31, q21 * G.s12 + q22 * G.d2 + q23 * G.s23,
             q31 * G.s31 + q32 * G.s23 + q33 * G.d3, q11 * G.s12 + q12 * G.d2 + q13 * G.s23,
             q21 * G.s31 + q22 * G.s23 + q23 * G.d3, q31 * G.d1 + q32 * G.s12 + q33 * G.s31};
    } else {
        T = {a * G.d1, a * G.d2, a * G.d3, a * G.s12, a * G.s23, a * G.s31};
    }
    if constexpr (HasFibres<Law>) {
        const Scalar f = twice * r.w_f;
        T.d1 += f * u.x * u.x;
        T.d2 += f * u.y * u.y;
        T.d3 += f * u.z * u.z;
        T.s12 += f * u.x * u.y;
        T.s23 += f * u.y * u.z;
        T.s31 += f * u.z * u.x;
    }
    Vector f1 = T.d1 * v1 + T.s12 * v2 + T.s31 * v3, f2 = T.s12 * v1 + T.d2 * v2 + T.s23 * v3,
           f3 = T.s31 * v1 + T.s23 * v2 + T.d3 * v3;
    if constexpr (NeedsJ<Law>) {
        const Scalar p = (-1.0 / 6.0) * r.w_J;
        f1 = f1 + p * across_edges[0];
        f2 = f2 + p * across_edges[1];
        f3 = f3 + p * across_edges[2];
    }
    return {f1, f2, f3};
}

/// The same from the edges alone.
template <class Law, class Number>
[[gnu::always_inline]] inline LinkVectors<Number> link_forces(const Law& law, double J0,
                                                              const LinkGroup<Number>& group,
                                                              const FibreGroup<Number>* fibres,
                                                              std::size_t first,
                                                              const LinkVectors<Number>& edges) {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    const auto& [v1, v2, v3] = edges;
    const auto dl = [&](const Vector& v, int link) -> Scalar {
        return rounded_dot(v, v) - Scalar::load(group.rest_links[link] + first);
    };
    const LinkVectors<Number> across_edges = across<Number>(edges);
    const StrainedLinks<Law, Number> links(
        group, fibres, first,
        {dl(v1, 0), dl(v2, 1), dl(v3, 2), dl(v2 - v1, 3), dl(v3 - v2, 4), dl(v1 - v3, 5)},
        dot(across_edges[2], v3) * Scalar::load(group.per_six_volumes + first));
    return link_forces(law, J0, group, first, edges, across_edges, links);
}

}  // namespace incise::physics::INCISE_PROCESSOR
