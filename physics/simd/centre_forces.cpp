// Forces of HEML on hexahedra, wedges and pyramids on lanes: VirtualCentreKernel::forces.
// Equations: docs/theory.md, Hexahedra, wedges and pyramids. Compiled for each kind of processor:
// lanes.h. SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/simd/centre_lanes.h"
#include "incise/physics/simd/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using topology::CellKind;

/// Adds what acts on the centres to the corners.
/// @param weights  of the group; null: those of faces that are not divided
template <CellKind kind>
[[gnu::always_inline]] inline void hand_on(
    std::array<CellVectors, CentreDivision<kind>::num_points>& f,
    const CentreWeights<kind>* weights, std::size_t first) {
    using Division = CentreDivision<kind>;
    const CellVectors of_centre =
        CellNumbers(1.0 / static_cast<double>(Division::num_corners)) * f[Division::num_points - 1];
    for (std::size_t k = 0; k < Division::num_corners; ++k) f[k] = f[k] + of_centre;
    std::size_t next = Division::num_corners;
    for (int i = 0; i < Division::traits.num_faces; ++i) {
        const auto face = Division::traits.face(i);
        if (face.size() != 4) continue;
        CellNumbers even = 0.25, odd = 0.25;
        if (weights) {
            const auto& of_face = weights->faces[next - Division::num_corners];
            even = CellNumbers::load(of_face.even + first);
            odd = CellNumbers::load(of_face.odd + first);
        }
        const CellVectors of_even = even * f[next], of_odd = odd * f[next];
        ++next;
        for (std::size_t p = 0; p < 4; ++p) {
            CellVectors& of_corner = f[static_cast<std::size_t>(face[p])];
            of_corner = of_corner + (p % 2 == 0 ? of_even : of_odd);
        }
    }
}

// The edges of a tetrahedron are scaled by s, so that it has the mean volume ratio. With its forces
// f on scaled edges v, the work of the scale is f . v per ln s: it acts on the two volume ratios.
template <CellKind kind, class Law>
void add_forces_of(const Law& law, double J0, const CentreGroup<kind>& group,
                   const CentreExtras<kind>& extras, std::size_t first,
                   const LocalVector* positions, LocalVector* forces) {
    using Division = CentreDivision<kind>;
    constexpr auto& parts = CellLanes<kind>::parts;
    const auto [fibres, shares, weights] = extras;
    const CellLanes<kind> cells(group, extras, first, positions);
    const Growth of_mean(cells.mean, J0);
    std::array<CellVectors, Division::num_points> f;
    f.fill({0.0, 0.0, 0.0});
    std::array<CellNumbers, Division::num_parts> works;  // of ln s, J
    CellNumbers work = 0.0;
    const auto add = [&](std::size_t t, const LinkVectors<double>& of_corners) {
        for (std::size_t k = 0; k < 3; ++k) {
            f[parts[t][k + 1]] = f[parts[t][k + 1]] + of_corners[k];
            f[parts[t][0]] = f[parts[t][0]] - of_corners[k];
        }
    };
    for (std::size_t t = 0; t < Division::num_parts; ++t) {
        const Growth growth(cells.ratios[t], J0);
        const CellNumbers s = exp((of_mean.logarithm - growth.logarithm) * (1.0 / 3.0));
        auto v = cells.edges(t);
        for (CellVectors& edge : v) edge = s * edge;
        LinkVectors<double> on_edges =
            link_forces(law, J0, group.parts[t], fibres ? &fibres->parts[t] : nullptr, first, v);
        if (shares)
            for (CellVectors& force : on_edges) force = cells.share(t) * force;
        const CellNumbers of_part =
            dot(on_edges[0], v[0]) + dot(on_edges[1], v[1]) + dot(on_edges[2], v[2]);
        work += of_part;
        works[t] = of_part * growth.rate;
        for (CellVectors& force : on_edges) force = s * force;
        add(t, on_edges);
    }
    const CellNumbers on_mean =
        work * of_mean.rate * CellNumbers::load(group.per_volume + first) * (1.0 / 18.0);
    for (std::size_t t = 0; t < Division::num_parts; ++t) {
        const auto v = cells.edges(t);
        const CellNumbers along =
            on_mean * cells.share(t) -
            works[t] * CellNumbers::load(group.parts[t].per_six_volumes + first) * (1.0 / 3.0);
        add(t, {along * cross(v[1], v[2]), along * cross(v[2], v[0]), along * cross(v[0], v[1])});
    }
    hand_on<kind>(f, weights, first);
    std::array<CellVectors, Division::num_corners - 1> others;
    std::copy(f.begin() + 1, f.begin() + Division::num_corners, others.begin());
    scatter_add<double>(others, forces, group.offsets, first);
}

template <CellKind kind>
void add_forces(const Law& law, double J0, std::span<const CentreGroup<kind>> groups,
                const CentreExtras<kind>& extras, const LocalVector* positions,
                LocalVector* forces) {
    std::visit(
        [&](const auto& l) {
            for (std::size_t g = 0; g < groups.size(); ++g)
                for (std::size_t first = 0; first < CentreGroup<kind>::size;
                     first += num_lanes<double>)
                    add_forces_of<kind>(l, J0, groups[g], extras.of(g), first, positions, forces);
        },
        law);
}

}  // namespace

void add_centre_forces(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::hexahedron>> groups,
                       const CentreExtras<CellKind::hexahedron>& extras,
                       const LocalVector* positions, LocalVector* forces) {
    add_forces(law, J0, groups, extras, positions, forces);
}

void add_centre_forces(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::wedge>> groups,
                       const CentreExtras<CellKind::wedge>& extras, const LocalVector* positions,
                       LocalVector* forces) {
    add_forces(law, J0, groups, extras, positions, forces);
}

void add_centre_forces(const Law& law, double J0,
                       std::span<const CentreGroup<CellKind::pyramid>> groups,
                       const CentreExtras<CellKind::pyramid>& extras, const LocalVector* positions,
                       LocalVector* forces) {
    add_forces(law, J0, groups, extras, positions, forces);
}

}  // namespace incise::physics::INCISE_PROCESSOR
