// Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/heml_lanes.h"
#include "physics/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

/// Symmetric 3 x 3: 11, 22, 33, 12, 23, 31.
struct Symmetric {
    Lanes d1, d2, d3, s12, s23, s31;

    static Symmetric load(const double (&from)[6][LinkGroup::size], std::size_t first) {
        return {Lanes::load(from[0] + first), Lanes::load(from[1] + first),
                Lanes::load(from[2] + first), Lanes::load(from[3] + first),
                Lanes::load(from[4] + first), Lanes::load(from[5] + first)};
    }
};

/// The part of a group that starts at lane `first`.
template <class Law>
[[gnu::always_inline]] inline void add_forces_of(const Law& law, double J0, const LinkGroup& group,
                                                 [[maybe_unused]] const FibreGroup* fibres,
                                                 std::size_t first, const LocalVector* positions,
                                                 LocalVector* forces) {
    const auto corner = [&](int k) { return gather(positions, group.nodes[k] + first); };
    const Lanes3 x0 = corner(0);
    const Lanes3 v1 = corner(1) - x0, v2 = corner(2) - x0, v3 = corner(3) - x0;

    // Changes of the squared links, and with them E' = V^T (C - 1) V.
    const auto dl = [&](const Lanes3& v, int link) {
        return dot(v, v) - Lanes::load(group.rest_links[link] + first);
    };
    const Lanes l1 = dl(v1, 0), l2 = dl(v2, 1), l3 = dl(v3, 2);
    const Symmetric E{l1,
                      l2,
                      l3,
                      0.5 * (l1 + l2 - dl(v2 - v1, 3)),
                      0.5 * (l2 + l3 - dl(v3 - v2, 4)),
                      0.5 * (l3 + l1 - dl(v1 - v3, 5))};
    const Symmetric G = Symmetric::load(group.G, first);

    LinkStrain<Lanes> strain;
    strain.a = G.d1 * E.d1 + G.d2 * E.d2 + G.d3 * E.d3 +
               2.0 * (G.s12 * E.s12 + G.s23 * E.s23 + G.s31 * E.s31);
    // P = G E' and b = tr(P P).
    const Lanes p11 = G.d1 * E.d1 + G.s12 * E.s12 + G.s31 * E.s31,
                p12 = G.d1 * E.s12 + G.s12 * E.d2 + G.s31 * E.s23,
                p13 = G.d1 * E.s31 + G.s12 * E.s23 + G.s31 * E.d3,
                p21 = G.s12 * E.d1 + G.d2 * E.s12 + G.s23 * E.s31,
                p22 = G.s12 * E.s12 + G.d2 * E.d2 + G.s23 * E.s23,
                p23 = G.s12 * E.s31 + G.d2 * E.s23 + G.s23 * E.d3,
                p31 = G.s31 * E.d1 + G.s23 * E.s12 + G.d3 * E.s31,
                p32 = G.s31 * E.s12 + G.s23 * E.d2 + G.d3 * E.s23,
                p33 = G.s31 * E.s31 + G.s23 * E.s23 + G.d3 * E.d3;
    strain.b = p11 * p11 + p22 * p22 + p33 * p33 + 2.0 * (p12 * p21 + p23 * p32 + p31 * p13);
    const Lanes volume = Lanes::load(group.volume + first);
    const Lanes3 across1 = cross(v2, v3), across2 = cross(v3, v1), across3 = cross(v1, v2);
    strain.J = dot(across3, v3) / 6.0 / volume;
    [[maybe_unused]] Lanes3 u;
    strain.f = 0.0;
    if constexpr (HasFibres<Law>) {
        const auto& all = fibres->u;
        u = {Lanes::load(all[0] + first), Lanes::load(all[1] + first), Lanes::load(all[2] + first)};
        strain.f = u.x * u.x * E.d1 + u.y * u.y * E.d2 + u.z * u.z * E.d3 +
                   2.0 * (u.x * u.y * E.s12 + u.y * u.z * E.s23 + u.z * u.x * E.s31);
    }

    const LawResponse<Lanes> r = response_of_lanes(law, strain, J0);
    // T = 2 Vol (w_a G + 2 w_b G E' G + w_f u u^T), and f_i = -(sum of T_ij v_j + w_J dvol/dx_i).
    const Lanes a = 2.0 * volume * r.w_a;
    Symmetric T{a * G.d1, a * G.d2, a * G.d3, a * G.s12, a * G.s23, a * G.s31};
    if constexpr (NeedsB<Law>) {
        const Lanes b = 4.0 * volume * r.w_b;
        T.d1 += b * (p11 * G.d1 + p12 * G.s12 + p13 * G.s31);
        T.d2 += b * (p21 * G.s12 + p22 * G.d2 + p23 * G.s23);
        T.d3 += b * (p31 * G.s31 + p32 * G.s23 + p33 * G.d3);
        T.s12 += b * (p11 * G.s12 + p12 * G.d2 + p13 * G.s23);
        T.s23 += b * (p21 * G.s31 + p22 * G.s23 + p23 * G.d3);
        T.s31 += b * (p31 * G.d1 + p32 * G.s12 + p33 * G.s31);
    }
    if constexpr (HasFibres<Law>) {
        const Lanes f = 2.0 * volume * r.w_f;
        T.d1 += f * u.x * u.x;
        T.d2 += f * u.y * u.y;
        T.d3 += f * u.z * u.z;
        T.s12 += f * u.x * u.y;
        T.s23 += f * u.y * u.z;
        T.s31 += f * u.z * u.x;
    }
    Lanes3 g1 = T.d1 * v1 + T.s12 * v2 + T.s31 * v3, g2 = T.s12 * v1 + T.d2 * v2 + T.s23 * v3,
           g3 = T.s31 * v1 + T.s23 * v2 + T.d3 * v3;  // the gradient
    if constexpr (NeedsJ<Law>) {
        const Lanes p = r.w_J / 6.0;
        g1 = g1 + p * across1;
        g2 = g2 + p * across2;
        g3 = g3 + p * across3;
    }
    scatter_add<4>({g1 + g2 + g3, -1.0 * g1, -1.0 * g2, -1.0 * g3}, forces, group.nodes, first);
}

}  // namespace

void add_heml_forces(const Law& law, double J0, std::span<const LinkGroup> groups,
                     std::span<const FibreGroup> fibres, const LocalVector* positions,
                     LocalVector* forces) {
    std::visit(
        [&](const auto& l) {
            for (std::size_t g = 0; g < groups.size(); ++g)
                for (std::size_t first = 0; first < LinkGroup::size; first += num_lanes)
                    add_forces_of(l, J0, groups[g], fibres.empty() ? nullptr : &fibres[g], first,
                                  positions, forces);
        },
        law);
}

}  // namespace incise::physics::INCISE_PROCESSOR
