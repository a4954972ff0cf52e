// Viscosity fast: what elements remember is followed, and its forces added, side by side, one
// element a lane. Equal to ViscousKernel, the reference, but for rounding. In doubles, whatever the
// precision of the elastic forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/function_ref.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/processor.h"
#include "incise/physics/elements/viscous_history.h"
#include "incise/physics/laws/law.h"

namespace incise::physics {

struct LinkElement;
struct ViscousKernel;

/// What a term of a Prony series does in one step: H' = decay H + gain (S' - S).
struct PronyStep {
    double decay, gain;
};

/// Eight elements as viscosity reads them.
struct alignas(64) ViscousGroup {
    static constexpr std::size_t size = 8;
    double rest_links[6][size];           ///< m2, in the order of squared_links
    double inverse_edges[9][size];        ///< V^-1 by rows, 1/m
    double volume[size];                  ///< m3
    std::uint32_t elements[size];         ///< their ids; spare lanes have that of the first
    std::uint16_t offsets[4][size] = {};  ///< of the corners: offset_of
    std::uint32_t num_used = 0;  ///< lanes that have an element; those after them are spare
};

/// The direction of fibres at rest of as many.
struct alignas(64) FibreDirections {
    double a0[3][ViscousGroup::size];
};

struct ViscousGroups {
    std::vector<ViscousGroup> elements;
    std::vector<FibreDirections> fibres;  ///< empty without
};

/// What all elements of a block have in common.
struct ViscousRule {
    const Law& law;
    double inversion_threshold;
    double relaxing_share;             ///< sum of alpha_i
    std::span<const PronyStep> steps;  ///< of the terms
};

/// Where elements remember: that of id e has its numbers at first + e * length.
template <class Number>
struct MemoryRows {
    Number* first;
    std::size_t length;
};

/// The elements of a block.
class SimdViscousElements {
  public:
    /// Makes room for so many elements, in place of what there was.
    void assign(std::size_t num_elements, const ViscousKernel& kernel);
    /// Sets what the element of the given number, from 0, has but its nodes; the first time in
    /// ascending order.
    void set(std::size_t i, ElementId id, const LinkElement& element);
    /// See set_offsets_of_lanes.
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds each element's ViscousKernel::forces_of_memory, N, to those of its nodes. The same bits
    /// on every processor.
    /// @param positions m; both by local number
    void add_forces(const ViscousKernel& kernel, const ViscousHistory& history,
                    const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// What add_forces reads of the elements, but what they remember.
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(groups_.elements)); }

    /// ViscousKernel::advance of all elements; returns the sum of what that does, J. The same bits
    /// on every processor.
    /// @param advance_one  does it for the element of the given number: called for those below the
    ///                     inversion threshold, which are rare and take another way
    double advance(const ViscousKernel& kernel, const LocalVector* before,
                   const LocalVector* positions, ViscousHistory& history,
                   FunctionRef<double(std::size_t)> advance_one) const;

    const ViscousGroups& groups() const { return groups_; }

  private:
    ViscousGroups groups_;
};

using AddForcesOfMemory = void(const ViscousRule& rule, const ViscousGroups& groups,
                               MemoryRows<const double> memory, const LocalVector* positions,
                               LocalVector* forces, std::span<const std::byte> next);
using AdvanceMemory = double(const ViscousRule& rule, const ViscousGroups& groups,
                             MemoryRows<double> memory, const LocalVector* before,
                             const LocalVector* positions,
                             FunctionRef<double(std::size_t)> advance_one);
/// What SimdViscousElements calls, by processor.
struct ViscousFunctions {
    AddForcesOfMemory* add_forces;
    AdvanceMemory* advance;
};
ViscousFunctions viscous_functions_for(Processor processor);

}  // namespace incise::physics
