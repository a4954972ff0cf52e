// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_centre_elements.h"

#include <algorithm>
#include <cassert>

namespace incise::physics {

using topology::CellKind;

namespace plain {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
CentreStiffening<CellKind::hexahedron> centre_stiffening;
AddCentreForces<CellKind::wedge> add_centre_forces;
CentreStiffening<CellKind::wedge> centre_stiffening;
AddCentreForces<CellKind::pyramid> add_centre_forces;
CentreStiffening<CellKind::pyramid> centre_stiffening;
}  // namespace plain
namespace avx2 {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
CentreStiffening<CellKind::hexahedron> centre_stiffening;
AddCentreForces<CellKind::wedge> add_centre_forces;
CentreStiffening<CellKind::wedge> centre_stiffening;
AddCentreForces<CellKind::pyramid> add_centre_forces;
CentreStiffening<CellKind::pyramid> centre_stiffening;
}  // namespace avx2
namespace avx512 {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
CentreStiffening<CellKind::hexahedron> centre_stiffening;
AddCentreForces<CellKind::wedge> add_centre_forces;
CentreStiffening<CellKind::wedge> centre_stiffening;
AddCentreForces<CellKind::pyramid> add_centre_forces;
CentreStiffening<CellKind::pyramid> centre_stiffening;
}  // namespace avx512

template <CellKind kind>
AddCentreForces<kind>* centre_forces_for(Processor processor) {
    return INCISE_CHOOSE(processor, AddCentreForces<kind>, add_centre_forces);
}

template <CellKind kind>
CentreStiffening<kind>* centre_stiffening_for(Processor processor) {
    return INCISE_CHOOSE(processor, CentreStiffening<kind>, centre_stiffening);
}
template AddCentreForces<CellKind::hexahedron>* centre_forces_for(Processor processor);
template CentreStiffening<CellKind::hexahedron>* centre_stiffening_for(Processor processor);
template AddCentreForces<CellKind::wedge>* centre_forces_for(Processor processor);
template CentreStiffening<CellKind::wedge>* centre_stiffening_for(Processor processor);
template AddCentreForces<CellKind::pyramid>* centre_forces_for(Processor processor);
template CentreStiffening<CellKind::pyramid>* centre_stiffening_for(Processor processor);

template <CellKind kind>
void SimdCentreElements<kind>::assign_groups(std::size_t num_elements, bool with_fibres) {
    constexpr std::size_t size = CentreGroup<kind>::size;
    CentreGroup<kind> unused{};
    for (MetricGroup<double>& part : unused.parts) {
        std::fill(part.volume, part.volume + size, 1.0);
        std::fill(part.per_six_volumes, part.per_six_volumes + size, 1.0);
    }
    std::fill(unused.per_volume, unused.per_volume + size, 1.0);
    groups_.assign((num_elements + size - 1) / size, unused);
    fibres_.assign(with_fibres ? groups_.size() : 0, CentreFibres<kind>{});
    shares_.clear();
    weights_.clear();
}

template <CellKind kind>
void SimdCentreElements<kind>::set_cell(std::size_t i, const Cell& cell, double share) {
    const std::size_t g = i % groups_.size(), lane = i / groups_.size();
    if (shares_.empty() && !(cell.is_whole && share == 1.0)) {
        shares_.resize(groups_.size());
        for (CentreShares<kind>& of_group : shares_)
            for (auto& of_part : of_group.parts) std::ranges::fill(of_part, 1.0);
    }
    set_weights(g, lane, cell.diagonals);
    groups_[g].per_volume[lane] = 1.0 / (share * cell.volume);
    for (std::size_t t = 0; t < num_parts; ++t) {
        const double per_volume = 6.0 * cell.inverse_edges[t].determinant();
        const double volume = cell.is_whole ? cell.volumes[t] : 1.0 / per_volume;
        set_metric(groups_[g].parts[t], lane, cell.inverse_edges[t], volume);
        if (!shares_.empty())
            shares_[g].parts[t][lane] =
                share * (cell.is_whole ? 1.0 : cell.volumes[t] * per_volume);
        if (fibres_.empty()) continue;
        const Vec3 u = cell.inverse_edges[t] * cell.fibre;
        for (int k = 0; k < 3; ++k) fibres_[g].parts[t].u[k][lane] = u[k];
    }
}

template <CellKind kind>
void SimdCentreElements<kind>::set_weights(std::size_t group, std::size_t lane,
                                           topology::Diagonals diagonals) {
    using fragments::QuadWeights;
    if (weights_.empty() && diagonals.is_none()) return;
    const auto set = [](auto& of_face, std::size_t of_lane, const QuadWeights& weights) {
        of_face.even[of_lane] = weights.even;
        of_face.odd[of_lane] = weights.odd;
    };
    if (weights_.empty()) {
        weights_.resize(groups_.size());
        for (CentreWeights<kind>& of_group : weights_)
            for (auto& of_face : of_group.faces)
                for (std::size_t l = 0; l < CentreWeights<kind>::size; ++l) set(of_face, l, {});
    }
    std::size_t quad = 0;
    const auto& traits = CentreDivision<kind>::traits;
    for (int f = 0; f < traits.num_faces; ++f)
        if (traits.face(f).size() == 4)
            set(weights_[group].faces[quad++], lane, fragments::quad_weights(diagonals, f));
}

template <CellKind kind>
void SimdCentreElements<kind>::add_forces_of(const Law& law, double J0,
                                             const LocalVector* positions,
                                             LocalVector* forces) const {
    static AddCentreForces<kind>* const add = centre_forces_for<kind>(processor());
    add(law, J0, groups_, extras(), positions, forces);
}

template <CellKind kind>
void SimdCentreElements<kind>::set_stiffening_of(const Law& law, double J0,
                                                 const LocalVector* positions,
                                                 std::span<double> factors) const {
    static CentreStiffening<kind>* const compute = centre_stiffening_for<kind>(processor());
    const auto of_groups = room_for<ElementFactors<double>>(groups_.size());
    compute(law, J0, groups_, extras(), positions, of_groups.data());
    std::size_t i = 0;
    for (std::size_t lane = 0; i < factors.size(); ++lane)
        for (std::size_t g = 0; g < of_groups.size() && i < factors.size(); ++g)
            factors[i++] = of_groups[g].factor[lane];
}

template class SimdCentreElements<CellKind::hexahedron>;
template class SimdCentreElements<CellKind::wedge>;
template class SimdCentreElements<CellKind::pyramid>;

}  // namespace incise::physics
