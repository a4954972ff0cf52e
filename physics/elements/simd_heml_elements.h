// Forces and energies of HEML by SIMD, with one element in each lane. They equal those of the
// reference, HemlKernel, within the rounding of doubles, or of floats in single precision.
// Source: docs/theory.md, Lanes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
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
struct LinkMetric;

/// What the forces of eight tetrahedra need, or of sixteen in floats: the six numbers of
/// G = (V^T V)^-1, with the rest edges V. The 27 numbers of vtr and Mtr of the paper follow from G:
/// docs/theory.md, Lanes.
template <class Number>
struct alignas(64) MetricGroup {
    static constexpr std::size_t size = 64 / sizeof(Number);
    Number G[6][size];             ///< components 11, 22, 33, 12, 23, 31, 1/m2
    Number volume[size];           ///< at rest, m3
    Number per_six_volumes[size];  ///< 1/(6 volume), 1/m3; it saves a slow division
};

/// A group of elements, as the force loop reads it.
template <class Number>
struct alignas(64) LinkGroup : MetricGroup<Number> {
    using MetricGroup<Number>::size;
    Number rest_links[6][size];           ///< m2, in the order of squared_links()
    std::uint16_t offsets[4][size] = {};  ///< of the corners; see offset_of()
};

/// Sets the values of a tetrahedron in one lane of a group.
/// @param inverse_edges  V^-1, 1/m
/// @param volume         at rest, m3
template <class Number>
void set_metric(MetricGroup<Number>& group, std::size_t lane, const Eigen::Matrix3d& inverse_edges,
                double volume);

/// The vectors u = V^-1 a0 of a group of elements with fibres, 1/m.
template <class Number>
struct alignas(64) FibreGroup {
    Number u[3][LinkGroup<Number>::size];
};

/// The shares of a group of elements; see fragments::FragmentMesh::share.
template <class Number>
struct alignas(64) ShareGroup {
    Number share[LinkGroup<Number>::size];
};

/// Sets the share of the element in one lane of a group. Shares are stored only once one of them is
/// not 1.
template <class Number>
void set_share(std::vector<ShareGroup<Number>>& shares, std::size_t num_groups, std::size_t group,
               std::size_t lane, double share) {
    if (shares.empty()) {
        if (share == 1.0) return;
        ShareGroup<Number> whole;
        std::ranges::fill(whole.share, Number{1});
        shares.assign(num_groups, whole);
    }
    shares[group].share[lane] = static_cast<Number>(share);
}

/// The factors of a group of elements, by which their stiffness grows with strain.
template <class Number>
struct alignas(64) ElementFactors {
    Number factor[LinkGroup<Number>::size];
};

/// The groups of a block.
template <class Number>
struct LinkGroups {
    std::vector<LinkGroup<Number>> links;
    std::vector<FibreGroup<Number>> fibres;  ///< empty for a law without fibres
    std::vector<ShareGroup<Number>> shares;  ///< empty if all elements are whole
};

/// The elements of a block in the layout for SIMD. Elements are numbered from 0 in the order of the
/// block. All results are the same bit for bit on every processor.
class SimdHemlElements {
  public:
    /// Replaces the contents by `num_elements` elements without values, in the precision of the
    /// kernel.
    void assign(std::size_t num_elements, const HemlKernel& kernel);
    /// Sets the values of element `i`, except for its nodes.
    void set(std::size_t i, const LinkMetric& element, double share = 1.0);
    /// Sets the nodes of all elements; see set_offsets_of_lanes().
    void set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare);

    /// Adds the forces of the elements to those of their nodes.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @param forces     N, by local number
    /// @param next       memory to prefetch; see ElementBlock::compute_forces
    void add_forces(const HemlKernel& kernel, const LocalVector* positions, LocalVector* forces,
                    std::span<const std::byte> next) const;
    /// Returns the memory of the elements that add_forces() reads first.
    std::span<const std::byte> bytes() const;

    /// Returns the totals of the elastic energies and volume ratios. Energies equal those of
    /// HemlKernel::energy within rounding, and are zero at rest. Volume ratios equal those of
    /// HemlKernel::volume_ratio bit for bit.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @pre  double precision, since floats would have strains at rest
    BlockState state(const HemlKernel& kernel, const LocalVector* positions) const;
    /// Sets the results of all elements, in their order, as if they were whole. They equal those of
    /// the reference within rounding.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    /// @param results    their rest volumes are inputs
    /// @pre  double precision
    void set_results(const HemlKernel& kernel, const LocalVector* positions,
                     std::span<ElementResult> results) const;
    /// Sets the factors of HemlKernel::stiffening of all elements, in their order. They equal those
    /// of the reference within rounding.
    /// @param kernel     the kernel of assign()
    /// @param positions  m, by local number
    void set_stiffening(const HemlKernel& kernel, const LocalVector* positions,
                        std::span<double> factors) const;
    /// Returns the groups.
    /// @pre  `Number` is that of the precision of the kernel: double or float
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
/// Returns the function that SimdHemlElements::add_forces calls on a processor, for double or
/// float.
template <class Number>
AddHemlForces<Number>* heml_forces_for(Processor processor);

template <class Number>
using HemlStiffening = void(const Law& law, double inversion_threshold,
                            const LinkGroups<Number>& groups, const LocalVector* positions,
                            ElementFactors<Number>* factors);
/// Returns the function that SimdHemlElements::set_stiffening calls on a processor.
template <class Number>
HemlStiffening<Number>* heml_stiffening_for(Processor processor);

/// Functions that set the results of each group.
using HemlEnergies = void(const Law& law, double inversion_threshold,
                          const LinkGroups<double>& groups, const LocalVector* positions,
                          ElementEnergies* energies);
using HemlStates = void(const Law& law, double inversion_threshold,
                        const LinkGroups<double>& groups, const LocalVector* positions,
                        ElementStates* states);
HemlEnergies* heml_energies_for(Processor processor);
HemlStates* heml_states_for(Processor processor);

}  // namespace incise::physics
