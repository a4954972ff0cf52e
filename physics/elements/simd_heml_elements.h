// The fast forces and energies of HEML: elements side by side, one a lane. Equal to those of
// HemlKernel, the reference, but for rounding: to doubles, or to floats where the kernel has single
// precision.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "incise/base/sum.h"
#include "incise/physics/elements/element_states.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/processor.h"
#include "incise/physics/laws/law.h"

namespace incise::physics {

struct HemlKernel;
struct LinkElement;

/// Eight elements, or sixteen in floats, as the force loop reads them. Where the vtr and Mtr of the
/// paper have 27 numbers these have the six of G = (V^T V)^-1, V the rest edges, from which all of
/// those follow: docs/theory.md, Lanes.
template <class Number>
struct alignas(64) LinkGroup {
    static constexpr std::size_t size = 64 / sizeof(Number);
    Number rest_links[6][size];           ///< m2, in the order of squared_links
    Number G[6][size];                    ///< 11, 22, 33, 12, 23, 31: 1/m2
    Number volume[size];                  ///< m3
    Number per_six_volumes[size];         ///< 1/m3: a product is sooner there than a quotient
    std::uint16_t offsets[4][size] = {};  ///< of the corners: offset_of
};

/// u = V^-1 a0 of as many elements with fibres, 1/m.
template <class Number>
struct alignas(64) FibreGroup {
    Number u[3][LinkGroup<Number>::size];
};

template <class Number>
struct LinkGroups {
    std::vector<LinkGroup<Number>> links;
    std::vector<FibreGroup<Number>> fibres;  ///< empty without
};

/// The elements of a block.
class SimdHemlElements {
  public:
    /// Makes room for so many elements, of the kernel given and in its precision, in place of what
    /// there was.
    void assign(std::size_t num_elements, const HemlKernel& kernel);
    /// Sets what the element of the given number, from 0, has but its nodes.
    void set(std::size_t i, const LinkElement& element);
    /// See set_offsets_of_lanes.
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds each element's forces, N, to those of its nodes. The same bits on every processor.
    /// @param positions m; both by local number
    void add_forces(const HemlKernel& kernel, const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// What add_forces reads of the elements.
    std::span<const std::byte> bytes() const;

    /// From the elements' energies by the law of the kernel, which are those of HemlKernel::energy
    /// within rounding, zero at rest; and volume ratios, to the bit as HemlKernel::volume_ratio.
    /// The same bits on every processor. In double precision only, as floats at rest have strains.
    /// @param positions m, by local number
    BlockState state(const HemlKernel& kernel, const LocalVector* positions) const;
    /// Sets all of the elements' results, in the order of their numbers, but volumes at rest, which
    /// are read: as the reference within rounding. In double precision only, the same bits on every
    /// processor.
    void set_results(const HemlKernel& kernel, const LocalVector* positions,
                     std::span<ElementResult> results) const;
    /// Those in the numbers that the kernel's precision asks for.
    template <class Number>
    const LinkGroups<Number>& groups() const {
        return std::get<LinkGroups<Number>>(groups_);
    }

  private:
    std::size_t num_elements_ = 0;
    std::variant<LinkGroups<double>, LinkGroups<float>> groups_;
};

template <class Number>
using AddHemlForces = void(const Law& law, double inversion_threshold,
                           const LinkGroups<Number>& groups, const LocalVector* positions,
                           LocalVector* forces, std::span<const std::byte> next);
/// What SimdHemlElements calls, by processor; for double and float.
template <class Number>
AddHemlForces<Number>* heml_forces_for(Processor processor);

/// Both set what lanes have of each group.
using HemlEnergies = void(const Law& law, double inversion_threshold,
                          const LinkGroups<double>& groups, const LocalVector* positions,
                          ElementEnergies* energies);
using HemlStates = void(const Law& law, double inversion_threshold,
                        const LinkGroups<double>& groups, const LocalVector* positions,
                        ElementStates* states);
HemlEnergies* heml_energies_for(Processor processor);
HemlStates* heml_states_for(Processor processor);

}  // namespace incise::physics
