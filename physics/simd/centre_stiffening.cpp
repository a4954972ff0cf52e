// The stiffening of HEML on hexahedra, wedges and pyramids on lanes. Compiled for each kind of
// processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <limits>

#include "incise/physics/laws/stiffening.h"
#include "incise/physics/simd/centre_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using topology::CellKind;

/// Returns the strain of tetrahedra with these edges, with all invariants, from B - 1.
[[gnu::always_inline]] inline LinkStrain<CellNumbers> strain_of_part(
    const MetricGroup<double>& part, const FibreGroup<double>* fibres, std::size_t first,
    const LinkVectors<double>& edges) {
    const CellVectors &v1 = edges[0], &v2 = edges[1], &v3 = edges[2];
    const Symmetric<CellNumbers> G = load_metric(part, first);
    const LinkVectors<double> w{G.d1 * v1 + G.s12 * v2 + G.s31 * v3,
                                G.s12 * v1 + G.d2 * v2 + G.s23 * v3,
                                G.s31 * v1 + G.s23 * v2 + G.d3 * v3};
    const auto product = [&](auto row, auto column) -> CellNumbers {
        return v1.*row * w[0].*column + v2.*row * w[1].*column + v3.*row * w[2].*column;
    };
    constexpr auto x = &CellVectors::x, y = &CellVectors::y, z = &CellVectors::z;
    const CellNumbers e1 = product(x, x) - 1.0, e2 = product(y, y) - 1.0, e3 = product(z, z) - 1.0,
                      s12 = product(x, y), s23 = product(y, z), s31 = product(z, x);
    LinkStrain<CellNumbers> strain;
    strain.a = e1 + e2 + e3;
    strain.b = e1 * e1 + e2 * e2 + e3 * e3 + 2.0 * (s12 * s12 + s23 * s23 + s31 * s31);
    strain.J = dot(cross(v1, v2), v3) * CellNumbers::load(part.per_six_volumes + first);
    strain.f = 0.0;
    if (fibres) {
        const CellVectors u = load_fibres(*fibres, first);
        const CellVectors fibre = u.x * v1 + u.y * v2 + u.z * v3;  // F a0
        strain.f = dot(fibre, fibre) - 1.0;
    }
    return strain;
}

template <CellKind kind, class Law>
void set_stiffening(const Law& law, double J0, std::span<const CentreGroup<kind>> groups,
                    const CentreExtras<kind>& extras, const LocalVector* positions,
                    ElementFactors<double>* factors) {
    constexpr double rounding = std::numeric_limits<double>::epsilon();
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (std::size_t first = 0; first < CentreGroup<kind>::size; first += num_lanes<double>) {
            const CentreExtras<kind> of_group = extras.of(g);
            const CellLanes<kind> cells(groups[g], of_group, first, positions);
            const Growth of_mean(cells.mean, J0);
            CellNumbers largest = 0.0;
            for (std::size_t t = 0; t < CentreDivision<kind>::num_parts; ++t) {
                const CellNumbers s =
                    exp((of_mean.logarithm - Growth(cells.ratios[t], J0).logarithm) * (1.0 / 3.0));
                const auto has_material = is_less(CellNumbers(0.0), cells.share(t));
                auto v = cells.edges(t);
                const auto* const of_part = of_group.fibres ? &of_group.fibres->parts[t] : nullptr;
                for (const bool is_scaled : {false, true}) {
                    if (is_scaled)
                        for (CellVectors& edge : v) edge = s * edge;
                    const CellNumbers of_strain = stiffening(
                        law, strain_of_part(groups[g].parts[t], of_part, first, v), J0, rounding);
                    largest = max(largest, choose(has_material, of_strain, CellNumbers(0.0)));
                }
            }
            largest.store(factors[g].factor + first);
        }
}

}  // namespace

void centre_stiffening(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::hexahedron>> groups,
                       const CentreExtras<CellKind::hexahedron>& extras,
                       const LocalVector* positions, ElementFactors<double>* factors) {
    std::visit([&](const auto& l) { set_stiffening(l, J0, groups, extras, positions, factors); },
               law);
}

void centre_stiffening(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::wedge>> groups,
                       const CentreExtras<CellKind::wedge>& extras, const LocalVector* positions,
                       ElementFactors<double>* factors) {
    std::visit([&](const auto& l) { set_stiffening(l, J0, groups, extras, positions, factors); },
               law);
}

void centre_stiffening(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::pyramid>> groups,
                       const CentreExtras<CellKind::pyramid>& extras, const LocalVector* positions,
                       ElementFactors<double>* factors) {
    std::visit([&](const auto& l) { set_stiffening(l, J0, groups, extras, positions, factors); },
               law);
}

}  // namespace incise::physics::INCISE_PROCESSOR
