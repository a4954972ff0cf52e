// Forces and energies of HybMSS by SIMD, with one cell in each lane. They equal those of the
// reference, HybmssKernel, within the rounding of doubles, or of floats in single precision.
// Source: docs/theory.md, Lanes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "incise/physics/elements/element_states.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/processor.h"

namespace incise::physics {

struct HybmssKernel;
struct HybmssElement;

/// A group of eight cells, or of sixteen in floats, as the force loop reads it.
template <class Number>
struct alignas(64) CellGroup {
    static constexpr std::size_t size = 64 / sizeof(Number);
    Number stiffnesses[7][size];          ///< of springs by group, as in SpringContributions, N/m
    Number rest_pulls[7][size];           ///< stiffness times rest length, N
    Number volume[size];                  ///< at rest, m3
    std::uint16_t offsets[8][size] = {};  ///< of the corners; see offset_of()
};

/// The cells of a block in the layout for SIMD. Cells are numbered from 0 in the order of the
/// block. All results are the same bit for bit on every processor.
class SimdHybmssElements {
  public:
    /// Replaces the contents by `num_elements` cells without values, in the precision of the
    /// kernel.
    void assign(std::size_t num_elements, const HybmssKernel& kernel);
    /// Sets the values of cell `i`, except for its nodes.
    void set(std::size_t i, const HybmssElement& element, double share = 1.0);
    /// Sets the nodes of all cells; see set_offsets_of_lanes().
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds the forces of the cells to those of their nodes.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @param forces     N, by local number
    /// @param next       memory to prefetch; see ElementBlock::compute_forces
    void add_forces(const HybmssKernel& kernel, const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// Returns the memory of the cells that add_forces() reads first.
    std::span<const std::byte> bytes() const;

    /// Returns the totals of the elastic energies and volume ratios. Energies equal those of
    /// HybmssKernel::energy within rounding, and are zero where these are zero because all springs
    /// have their rest lengths. Volume ratios equal those of HybmssKernel bit for bit.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @pre  double precision
    BlockState state(const HybmssKernel& kernel, const LocalVector* positions) const;
    /// Sets the results of all cells, in their order. They equal those of the reference within
    /// rounding.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @param results    their rest volumes are inputs
    /// @pre  double precision
    void set_results(const HybmssKernel& kernel, const LocalVector* positions,
                     std::span<ElementResult> results) const;

    /// Returns the groups.
    /// @pre  `Number` is that of the precision of the kernel: double or float
    template <class Number>
    std::span<const CellGroup<Number>> groups() const {
        return std::get<std::vector<CellGroup<Number>>>(groups_);
    }

  private:
    std::size_t num_elements_ = 0;
    std::variant<std::vector<CellGroup<double>>, std::vector<CellGroup<float>>> groups_;
};

template <class Number>
using AddHybmssForces = void(double volume_modulus, std::span<const CellGroup<Number>> groups,
                             const LocalVector* positions, LocalVector* forces,
                             std::span<const std::byte> next);
/// Returns the function that SimdHybmssElements::add_forces calls on a processor, for double or
/// float.
template <class Number>
AddHybmssForces<Number>* hybmss_forces_for(Processor processor);

/// Functions that set the results of each group.
using HybmssEnergies = void(double volume_modulus, std::span<const CellGroup<double>> groups,
                            const LocalVector* positions, ElementEnergies* energies);
using HybmssStates = void(double volume_modulus, std::span<const CellGroup<double>> groups,
                          const LocalVector* positions, ElementStates* states);
HybmssEnergies* hybmss_energies_for(Processor processor);
HybmssStates* hybmss_states_for(Processor processor);

}  // namespace incise::physics
