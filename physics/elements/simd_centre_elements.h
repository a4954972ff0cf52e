// The cells of VirtualCentreKernel side by side, in the layout for SIMD. Compiled for each kind of
// processor: physics/simd.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/fragments/centre_division.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/processor.h"
#include "incise/physics/elements/simd_heml_elements.h"

namespace incise::physics {

using fragments::CentreDivision;

/// A group of eight cells, as the force loop reads it.
template <topology::CellKind kind>
struct alignas(64) CentreGroup {
    static constexpr std::size_t size = MetricGroup<double>::size;
    MetricGroup<double> parts[CentreDivision<kind>::num_parts];
    double per_volume[size];  ///< 1/volume of the cell, 1/m3
    std::uint16_t offsets[CentreDivision<kind>::num_corners][size] = {};  ///< see offset_of()
};

/// The vectors V^-1 a0 of the tetrahedra of a group of cells with fibres, 1/m.
template <topology::CellKind kind>
struct CentreFibres {
    FibreGroup<double> parts[CentreDivision<kind>::num_parts];
};

/// How much of each tetrahedron of a group of cells is material.
template <topology::CellKind kind>
struct CentreShares {
    static constexpr std::size_t size = CentreGroup<kind>::size;
    alignas(64) double parts[CentreDivision<kind>::num_parts][size];
};

/// The weights of the centres of faces in a group of cells: see fragments::QuadWeights.
template <topology::CellKind kind>
struct CentreWeights {
    static constexpr std::size_t size = CentreGroup<kind>::size;
    struct alignas(64) OfFace {
        double even[size], odd[size];
    };
    OfFace faces[CentreDivision<kind>::num_quads];
};

/// What only some groups of cells need; null where no cell of the block does.
template <topology::CellKind kind>
struct CentreExtras {
    const CentreFibres<kind>* fibres = nullptr;    ///< of a law with fibres
    const CentreShares<kind>* shares = nullptr;    ///< else all are 1
    const CentreWeights<kind>* weights = nullptr;  ///< else all are 1/4

    /// Returns those of one group.
    CentreExtras of(std::size_t group) const {
        return {fibres ? fibres + group : nullptr, shares ? shares + group : nullptr,
                weights ? weights + group : nullptr};
    }
};

/// The cells of a block. Cells are numbered from 0 in the order of the block. All results are the
/// same bit for bit on every processor.
template <topology::CellKind kind>
class SimdCentreElements {
  public:
    /// Replaces the contents by `num_elements` cells without values.
    template <class Kernel>
    void assign(std::size_t num_elements, const Kernel& kernel) {
        assign_groups(num_elements, has_fibres(kernel.law));
    }
    /// Sets the values of cell `i`, except for its nodes.
    template <class Element>
    void set(std::size_t i, const Element& e, double share) {
        set_cell(i, {e.volumes, e.inverse_edges, e.volume, e.fibre, e.is_whole, e.diagonals},
                 share);
    }
    /// Sets the nodes of all cells; see set_offsets_of_lanes().
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare) {
        set_offsets_of_lanes(groups_, corners, spare);
    }

    /// Adds the forces of the cells to those of their nodes. They equal those of the kernel within
    /// rounding.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @param forces     N, by local number
    template <class Kernel>
    void add_forces(const Kernel& kernel, const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> /*next*/) const {
        add_forces_of(kernel.law, kernel.inversion_threshold, positions, forces);
    }
    /// Sets the factors of VirtualCentreKernel::stiffening of all cells, in their order. They equal
    /// those of the reference within rounding.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    template <class Kernel>
    void set_stiffening(const Kernel& kernel, const LocalVector* positions,
                        std::span<double> factors) const {
        set_stiffening_of(kernel.law, kernel.inversion_threshold, positions, factors);
    }
    /// Returns the memory of the cells that add_forces() reads first.
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(groups_)); }

    std::span<const CentreGroup<kind>> groups() const { return groups_; }
    CentreExtras<kind> extras() const {
        const auto data = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
        return {data(fibres_), data(shares_), data(weights_)};
    }

  private:
    static constexpr std::size_t num_parts = CentreDivision<kind>::num_parts;
    struct Cell {
        const std::array<double, num_parts>& volumes;
        const std::array<Eigen::Matrix3d, num_parts>& inverse_edges;
        double volume;
        const Vec3& fibre;
        bool is_whole;
        topology::Diagonals diagonals;
    };
    void assign_groups(std::size_t num_elements, bool with_fibres);
    void set_cell(std::size_t i, const Cell& cell, double share);
    void set_weights(std::size_t group, std::size_t lane, topology::Diagonals diagonals);
    void add_forces_of(const Law& law, double J0, const LocalVector* positions,
                       LocalVector* forces) const;
    void set_stiffening_of(const Law& law, double J0, const LocalVector* positions,
                           std::span<double> factors) const;

    std::vector<CentreGroup<kind>> groups_;
    std::vector<CentreFibres<kind>> fibres_;    // empty for a law without fibres
    std::vector<CentreShares<kind>> shares_;    // empty if all are 1
    std::vector<CentreWeights<kind>> weights_;  // empty if no face is divided
};

/// Adds the forces of groups. `extras` are those of the first one.
template <topology::CellKind kind>
using AddCentreForces = void(const Law& law, double inversion_threshold,
                             std::span<const CentreGroup<kind>> groups,
                             const CentreExtras<kind>& extras, const LocalVector* positions,
                             LocalVector* forces);
/// Returns the function that SimdCentreElements::add_forces calls on a processor.
template <topology::CellKind kind>
AddCentreForces<kind>* centre_forces_for(Processor processor);

template <topology::CellKind kind>
using CentreStiffening = void(const Law& law, double inversion_threshold,
                              std::span<const CentreGroup<kind>> groups,
                              const CentreExtras<kind>& extras, const LocalVector* positions,
                              ElementFactors<double>* factors);
/// Returns the function that SimdCentreElements::set_stiffening calls on a processor.
template <topology::CellKind kind>
CentreStiffening<kind>* centre_stiffening_for(Processor processor);

extern template class SimdCentreElements<topology::CellKind::hexahedron>;
extern template class SimdCentreElements<topology::CellKind::wedge>;
extern template class SimdCentreElements<topology::CellKind::pyramid>;

}  // namespace incise::physics
