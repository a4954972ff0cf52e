// Blocks of elements: up to 512 elements of one kind and one material, over which the force loop
// runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "incise/base/sum.h"
#include "incise/base/types.h"
#include "incise/physics/elements/element_result.h"
#include "incise/physics/elements/element_states.h"
#include "incise/physics/elements/local_nodes.h"
#include "incise/physics/elements/viscous_history.h"

namespace incise::physics {

/// The constant contributions of one element to its corners. They depend only on the rest shape,
/// the share and the material.
struct NodalContributions {
    std::array<double, 8> mass{};       ///< kg, by corner
    std::array<double, 8> stiffness{};  ///< N/m, by corner, to the bound of stable_step.h
};

/// What a block needs to know of an element.
struct ElementInput {
    std::span<const NodeId> corners;
    std::span<const Vec3> rest_positions;  ///< m, by node id
    Vec3 fibre = Vec3::Zero();  ///< direction of the fibres at rest, of unit length; ignored by a
                                ///< law without fibres
    double share = 1.0;  ///< scales mass, stiffness and energy; see FragmentMesh::volume_share
    /// How much of each tetrahedron of a cell is material, see FragmentMesh::part_shares. Empty: as
    /// much of each. Ignored by kernels that do not take it.
    std::span<const double> part_shares = {};
    topology::Diagonals diagonals = {};  ///< of a cell; ignored likewise
};

/// A trial state at the end of a step of an implicit solver or of statics.
struct EndOfStep {
    std::span<const Vec3> positions;  ///< m, by node id
    const ViscousHistory& history;    ///< at the beginning of the step
    double dt;                        ///< s; infinite: all terms are relaxed, as in statics
};

/// Interface of a receiver of tangents, one call for each element or face.
class TangentSink {
  public:
    virtual ~TangentSink() = default;
    /// Takes one tangent.
    /// @param nodes    ids of its nodes
    /// @param tangent  symmetric, N/m; three rows for each node, column by column
    virtual void add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) = 0;
};
enum class TangentKind { exact, positive };  ///< for `positive` see positive_part()

/// Interface of a block of elements. One virtual call works on a whole block.
///
/// The elements are in slots in ascending order of ids, so that sums over a block do not depend on
/// the edits that led to it. The nodes of a block have local numbers, in ascending order of ids.
///
/// An edit touches many blocks, but only a few elements of each. Its cost in a block is
/// proportional to these elements, with two exceptions. Local numbers cost O(block). Insertion and
/// removal of elements shift the slots of all later ones.
class ElementBlock {
  public:
    static constexpr std::uint16_t unnumbered = 0xffff;
    static constexpr std::size_t max_elements = most_elements_of_block;
    static_assert(4 * (max_elements * topology::max_corners + 1) <= 0xffff);  // offset_of

    virtual ~ElementBlock() = default;
    virtual std::shared_ptr<ElementBlock> clone() const = 0;

    /// Returns the ids of the elements, by slot, in ascending order.
    std::span<const ElementId> elements() const { return elements_; }
    /// True if the block has the element.
    bool has(ElementId e) const { return std::ranges::binary_search(elements_, e); }

    /// Returns the ids of the nodes of the elements, by local number, in ascending order.
    std::span<const std::uint32_t> nodes() const { return nodes_; }

    /// Updates nodes(), and everything that depends on local numbers, after insert(), replace() and
    /// erase(). Without it, forces, energies and volumes must not be read, and the history must not
    /// be advanced.
    /// @param local_numbers   scratch, by node id; it holds `unnumbered` before and after the call
    /// @param rest_positions  m, by node id
    void number_nodes(std::span<std::uint16_t> local_numbers, std::span<const Vec3> rest_positions);

    /// Returns the positions of the nodes of the block, m, by local number, and one spare entry.
    /// @param positions  by node id, m
    /// @param offsets    buffer for the result; a thread that uses the same buffer for all blocks
    ///                   allocates memory only once
    std::span<const LocalVector> local_positions(std::span<const Vec3> positions,
                                                 std::vector<LocalVector>& offsets) const;
    /// Returns the same, in a buffer of the calling thread.
    /// @lifetime Until the next call on this thread.
    std::span<const LocalVector> local_positions(std::span<const Vec3> positions) const;

    /// Sets `forces` to the sums of the forces of the elements, N: the elastic forces, and the
    /// viscous forces that follow from the history.
    /// @param positions  m, by local number, with one spare entry
    /// @param history    of all elements of the body
    /// @param forces     N, by local number, with one spare entry
    /// @param next       bytes_of_elements() of the block that the thread probably computes next,
    ///                   for prefetching; may be empty
    virtual void compute_forces(std::span<const LocalVector> positions,
                                const ViscousHistory& history, std::span<LocalVector> forces,
                                std::span<const std::byte> next) const = 0;
    /// Returns the memory of the elements that compute_forces() reads first.
    virtual std::span<const std::byte> bytes_of_elements() const = 0;
    /// Adds the forces at the end of a step, N, by node id. Viscous forces follow the rule of
    /// advance().
    virtual void add_forces(const EndOfStep& end, std::span<Vec3> forces) const = 0;
    /// Returns the potential whose negative gradient are the forces of add_forces(), J. Without
    /// viscosity it is the elastic energy.
    virtual double potential(const EndOfStep& end) const = 0;
    /// Passes the tangents of the forces of add_forces() to the sink, in the order of elements().
    virtual void visit_tangents(const EndOfStep& end, TangentKind kind,
                                TangentSink& sink) const = 0;
    /// True if the elements have a viscous history.
    virtual bool has_history() const = 0;
    /// Advances the history of the elements from the positions `before` to `positions`, `dt` (s)
    /// later; both are as for compute_forces(). Returns the energy that viscosity dissipated, J, or
    /// 0 for a material without viscosity.
    virtual double advance(std::span<const LocalVector> before,
                           std::span<const LocalVector> positions, double dt,
                           ViscousHistory& history) = 0;
    /// Sets `excess`, by local number, to what the bounds on the stiffness of the nodes are above
    /// those at rest, N/m. They are positive only where elements are stiffer than at rest. Returns
    /// false, and may leave `excess` as it is, if no element is.
    /// @param positions  m, by local number, with one spare entry
    virtual bool set_excess_stiffness(std::span<const LocalVector> positions,
                                      std::span<double> excess) const = 0;
    /// Returns the factor by which the bounds of one element are above those at rest, 1 or more.
    /// @param positions  m, by node id
    virtual double stiffening(ElementId e, std::span<const Vec3> positions) const = 0;
    /// Returns the totals of the elements at `positions`, m, by node id.
    virtual BlockState state(std::span<const Vec3> positions) const = 0;
    /// Returns the sum of the rest volumes, m3.
    virtual Sum rest_volume() const = 0;
    /// Returns the sum of modulus times rest volume over the elements, J.
    virtual double stiffness_energy() const = 0;
    /// Returns the result of one element at `positions`, m, by node id.
    virtual ElementResult result(ElementId e, std::span<const Vec3> positions,
                                 const ViscousHistory& history) const = 0;
    /// Returns the least ratio of current over rest volume in one element at `positions`, m, by
    /// node id. In a tetrahedron it is that of ElementResult.
    virtual double least_volume_ratio(ElementId e, std::span<const Vec3> positions) const = 0;
    /// Sets the results of all elements, in the order of elements(). They equal those of result()
    /// within rounding.
    virtual void results(std::span<const Vec3> positions, const ViscousHistory& history,
                         std::span<ElementResult> results) const = 0;
    virtual NodalContributions contributions(ElementId e) const = 0;
    /// Returns the rest volume of one element, m3: its share of the volume between its corners.
    virtual double rest_volume(ElementId e) const = 0;

    /// Inserts an element and precomputes its values.
    virtual void insert(ElementId e, const ElementInput& input) = 0;
    /// Precomputes an element of the block again, with other corners or another share.
    virtual void replace(ElementId e, const ElementInput& input) = 0;
    virtual void erase(ElementId e) = 0;

  protected:
    explicit ElementBlock(std::size_t num_corners) : num_corners_(num_corners) {}

    /// Updates everything in the derived class that depends on the elements and their local
    /// numbers. `changed` has the slots whose elements have changed since the last call. If
    /// have_moved_ is true, other elements may also be in other slots than before.
    /// @param rest_positions  m, by node id
    virtual void use_numbers(std::span<const std::size_t> changed,
                             std::span<const Vec3> rest_positions) = 0;

    /// Returns the local numbers of the nodes of the element in slot s.
    std::span<std::uint16_t> local_corners(std::size_t s) {
        return std::span(local_corners_).subspan(s * num_corners_, num_corners_);
    }
    std::span<const std::uint16_t> local_corners(std::size_t s) const {
        return std::span(local_corners_).subspan(s * num_corners_, num_corners_);
    }

    /// Adds a slot for a new element and returns its index.
    std::size_t add_slot(ElementId e, std::span<const NodeId> corners);
    /// Gives an element other corners, or the same ones anew.
    void change_slot(std::size_t s, std::span<const NodeId> corners);
    void remove_slot(std::size_t s);
    std::size_t slot_of(ElementId e) const {
        // Ids ascend and have few gaps. The slot is therefore at most, and mostly exactly, the
        // difference between this id and the first one.
        const auto from_first = static_cast<std::size_t>(e.value - elements_.front().value);
        const auto last = elements_.begin() +
                          static_cast<std::ptrdiff_t>(std::min(from_first, elements_.size() - 1));
        const auto it = *last == e ? last : std::lower_bound(elements_.begin(), last, e);
        assert(*it == e);
        return static_cast<std::size_t>(it - elements_.begin());
    }

    std::size_t num_corners_;
    std::vector<ElementId> elements_;  // by slot
    std::vector<std::uint32_t> nodes_;
    // By slot, local numbers of the nodes; `unnumbered` for an element that has changed.
    std::vector<std::uint16_t> local_corners_;
    bool is_numbered_ = true, have_moved_ = false;

  private:
    /// The node ids of an element that has changed since the nodes were numbered.
    struct Changed {
        ElementId element;
        std::array<std::uint32_t, topology::max_corners> nodes;
    };
    bool is_changed(std::size_t s) const { return local_corners(s).front() == unnumbered; }
    void forget_change(ElementId e) {
        std::erase_if(changed_, [&](const Changed& changed) { return changed.element == e; });
    }
    void note_change(ElementId e, std::span<const NodeId> corners);

    std::vector<Changed> changed_;
};

}  // namespace incise::physics
