// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_centre_elements.h"

#include <algorithm>
#include <cassert>

namespace incise::physics {

using topology::CellKind;

namespace plain {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
AddCentreForces<CellKind::wedge> add_centre_forces;
AddCentreForces<CellKind::pyramid> add_centre_forces;
}  // namespace plain
namespace avx2 {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
AddCentreForces<CellKind::wedge> add_centre_forces;
AddCentreForces<CellKind::pyramid> add_centre_forces;
}  // namespace avx2
namespace avx512 {
AddCentreForces<CellKind::hexahedron> add_centre_forces;
AddCentreForces<CellKind::wedge> add_centre_forces;
AddCentreForces<CellKind::pyramid> add_centre_forces;
}  // namespace avx512

template <CellKind kind>
AddCentreForces<kind>* centre_forces_for(Processor processor) {
    return INCISE_CHOOSE(processor, AddCentreForces<kind>, add_centre_forces);
}
template AddCentreForces<CellKind::hexahedron>* centre_forces_for(Processor processor);
template AddCentreForces<CellKind::wedge>* centre_forces_for(Processor processor);
template AddCentreForces<CellKind::pyramid>* centre_forces_for(Processor processor);

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
}

template <CellKind kind>
void SimdCentreElements<kind>::set_cell(std::size_t i, const Cell& cell,
                                        [[maybe_unused]] double share) {
    assert(share == 1.0);  // these cells are not divided
    const std::size_t g = i % groups_.size(), lane = i / groups_.size();
    groups_[g].per_volume[lane] = 1.0 / cell.volume;
    for (std::size_t t = 0; t < num_parts; ++t) {
        set_metric(groups_[g].parts[t], lane, cell.inverse_edges[t], cell.volumes[t]);
        if (fibres_.empty()) continue;
        const Vec3 u = cell.inverse_edges[t] * cell.fibre;
        for (int k = 0; k < 3; ++k) fibres_[g].parts[t].u[k][lane] = u[k];
    }
}

template <CellKind kind>
void SimdCentreElements<kind>::add_forces_of(const Law& law, double J0,
                                             const LocalVector* positions, LocalVector* forces,
                                             std::span<const std::byte> next) const {
    static AddCentreForces<kind>* const add = centre_forces_for<kind>(processor());
    add(law, J0, groups_, fibres_.empty() ? nullptr : fibres_.data(), positions, forces, next);
}

template class SimdCentreElements<CellKind::hexahedron>;
template class SimdCentreElements<CellKind::wedge>;
template class SimdCentreElements<CellKind::pyramid>;

}  // namespace incise::physics
