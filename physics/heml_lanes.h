// The fast forces of HEML: elements side by side, one a lane. Equal to HemlKernel::forces, the
// reference, but for rounding.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/law.h"
#include "physics/local_nodes.h"
#include "physics/processor.h"

namespace incise::physics {

struct HemlKernel;
struct LinkElement;

/// Eight elements as the force loop reads them. Where vtr and Mtr have 27 numbers these have the
/// six of G = (V^T V)^-1, V the rest edges, from which all of those follow: docs/theory.md, Lanes.
struct alignas(64) LinkGroup {
    static constexpr std::size_t size = 8;
    double rest_links[6][size];         ///< m2, in the order of squared_links
    double G[6][size];                  ///< 11, 22, 33, 12, 23, 31: 1/m2
    double volume[size];                ///< m3
    std::uint16_t nodes[4][size] = {};  ///< by local number
};

/// u = V^-1 a0 of eight elements with fibres, 1/m.
struct alignas(64) FibreGroup {
    double u[3][LinkGroup::size];
};

/// The elements of a block. Neighbours in a block lie in different groups, as far as may be, so
/// that the lanes of a group seldom add to the same node.
class HemlLanes {
  public:
    /// Makes room for so many elements, of the kernel given, in place of what there was.
    /// @param spare  local number of a node that spare lanes work on
    void assign(std::size_t num_elements, std::uint16_t spare, const HemlKernel& kernel);
    /// Sets the element of the given number, from 0.
    /// @param nodes its corners by local number
    void set(std::size_t i, const LinkElement& element, std::span<const std::uint16_t, 4> nodes);

    /// Adds each element's forces, N, to those of its nodes. The same bits on every processor.
    /// @param positions m; both by local number
    void add_forces(const HemlKernel& kernel, const LocalVector* positions,
                    LocalVector* forces) const;

    std::span<const LinkGroup> groups() const { return groups_; }
    std::span<const FibreGroup> fibres() const { return fibres_; }

  private:
    std::vector<LinkGroup> groups_;
    std::vector<FibreGroup> fibres_;  // empty without
};

using AddHemlForces = void(const Law& law, double inversion_threshold,
                           std::span<const LinkGroup> groups, std::span<const FibreGroup> fibres,
                           const LocalVector* positions, LocalVector* forces);
/// What HemlLanes calls, by processor.
AddHemlForces* heml_forces_for(Processor processor);

}  // namespace incise::physics
