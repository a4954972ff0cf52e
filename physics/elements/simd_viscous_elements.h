// Viscous history and viscous forces by SIMD, with one element in each lane. Results equal those of
// the reference, ViscousKernel, within rounding. All numbers are doubles, whatever the precision of
// the elastic forces. Source: docs/theory.md, Lanes and Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/function_ref.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/processor.h"
#include "incise/physics/elements/simd_heml_elements.h"
#include "incise/physics/elements/viscous_history.h"
#include "incise/physics/laws/law.h"

namespace incise::physics {

struct LinkMetric;
struct ViscousKernel;

/// One step of a term of a Prony series: H' = decay H + gain (S' - S).
struct PronyStep {
    double decay, gain;
};

/// A group of eight elements, as the viscous kernels read it.
struct alignas(64) ViscousGroup {
    static constexpr std::size_t size = 8;
    double rest_links[6][size];           ///< m2, in the order of squared_links()
    double inverse_edges[9][size];        ///< V^-1 by rows, 1/m
    double volume[size];                  ///< at rest, m3
    std::uint32_t elements[size];         ///< ids; spare lanes have the id of the first lane
    std::uint16_t offsets[4][size] = {};  ///< of the corners; see offset_of()
    std::uint32_t num_used = 0;           ///< lanes with an element; later lanes are spare
};

/// The directions of fibres at rest, of unit length, of a group.
struct alignas(64) FibreDirections {
    double a0[3][ViscousGroup::size];
};

/// The groups of a block.
struct ViscousGroups {
    std::vector<ViscousGroup> elements;
    std::vector<FibreDirections> fibres;     ///< empty for a law without fibres
    std::vector<ShareGroup<double>> shares;  ///< empty if all elements are whole
};

/// The common values of all elements of a block.
struct ViscousRule {
    const Law& law;
    double inversion_threshold;
    double relaxing_share;             ///< sum of alpha_i
    std::span<const PronyStep> steps;  ///< by term
};

/// The values of a ViscousHistory: those of the element with id e begin at first + e * length.
template <class Number>
struct MemoryRows {
    Number* first;
    std::size_t length;
};

/// The elements of a block in the layout for SIMD. Elements are numbered from 0 in the order of the
/// block. All results are the same bit for bit on every processor.
class SimdViscousElements {
  public:
    /// Replaces the contents by `num_elements` elements without values.
    void assign(std::size_t num_elements, const ViscousKernel& kernel);
    /// Sets the values of element `i`, except for its nodes.
    /// @pre  after assign(), the elements are first set in ascending order
    void set(std::size_t i, ElementId id, const LinkMetric& element, double share = 1.0);
    /// Sets the nodes of all elements; see set_offsets_of_lanes().
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds ViscousKernel::forces_of_memory of the elements to the forces of their nodes.
    /// @param kernel     the kernel of assign()
    /// @param history    of all elements of the body
    /// @param positions  m, by local number
    /// @param forces     N, by local number
    /// @param next       memory to prefetch; see ElementBlock::compute_forces
    void add_forces(const ViscousKernel& kernel, const ViscousHistory& history,
                    const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// Returns the memory of the elements that add_forces() reads, without the history.
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(groups_.elements)); }

    /// Advances the history of all elements as ViscousKernel::advance does. Returns the sum of the
    /// energies that ViscousKernel::advance returns, J.
    /// @param kernel       the kernel of assign(), after begin_step()
    /// @param before       positions before the step, m, by local number
    /// @param positions    positions after the step, m, by local number
    /// @param history      of all elements of the body
    /// @param advance_one  advances element `i` by the reference; called for the elements below the
    ///                     inversion threshold, which are rare and follow another formula
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
/// The functions that SimdViscousElements calls.
struct ViscousFunctions {
    AddForcesOfMemory* add_forces;
    AdvanceMemory* advance;
};
/// Returns the functions for a processor.
ViscousFunctions viscous_functions_for(Processor processor);

}  // namespace incise::physics
