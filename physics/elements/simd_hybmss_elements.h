// The fast forces and energies of HybMSS: cells side by side, one a lane. Equal to those of
// HybmssKernel, the reference, but for rounding: to doubles, or to floats where the kernel has
// single precision.
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

/// Eight cells, or sixteen in floats, as the force loop reads them.
template <class Number>
struct alignas(64) CellGroup {
    static constexpr std::size_t size = 64 / sizeof(Number);
    Number stiffnesses[7][size];          ///< of springs by group, as in SpringContributions: N/m
    Number rest_pulls[7][size];           ///< stiffness times rest length: N
    Number volume[size];                  ///< m3
    std::uint16_t offsets[8][size] = {};  ///< of the corners: offset_of
};

/// The cells of a block.
class SimdHybmssElements {
  public:
    /// Makes room for so many cells, in the kernel's precision, in place of what there was.
    void assign(std::size_t num_elements, const HybmssKernel& kernel);
    /// Sets what the cell of the given number, from 0, has but its nodes.
    void set(std::size_t i, const HybmssElement& element);
    /// See set_offsets_of_lanes.
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds each cell's forces, N, to those of its nodes. The same bits on every processor.
    /// @param positions m; both by local number
    void add_forces(const HybmssKernel& kernel, const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// What add_forces reads of the cells.
    std::span<const std::byte> bytes() const;

    /// In double precision only, as what follows; that of the reference within rounding, but volume
    /// ratios to the bit, and without energy where that has none for springs of their rest lengths.
    /// The same bits on every processor.
    /// @param positions m, by local number
    BlockState state(const HybmssKernel& kernel, const LocalVector* positions) const;
    /// Sets all of the cells' results, in the order of their numbers, but volumes at rest, which
    /// are read.
    void set_results(const HybmssKernel& kernel, const LocalVector* positions,
                     std::span<ElementResult> results) const;

    /// Those in the numbers that the kernel's precision asks for.
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
/// What SimdHybmssElements calls, by processor; for double and float.
template <class Number>
AddHybmssForces<Number>* hybmss_forces_for(Processor processor);

/// Both set what lanes have of each group.
using HybmssEnergies = void(double volume_modulus, std::span<const CellGroup<double>> groups,
                            const LocalVector* positions, ElementEnergies* energies);
using HybmssStates = void(double volume_modulus, std::span<const CellGroup<double>> groups,
                          const LocalVector* positions, ElementStates* states);
HybmssEnergies* hybmss_energies_for(Processor processor);
HybmssStates* hybmss_states_for(Processor processor);

}  // namespace incise::physics
