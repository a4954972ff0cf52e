// Elements of one kind and one material, a few hundred at a time: what the force loop walks.
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

/// What one element brings to its corners for good; a pure function of its rest shape.
struct NodalContributions {
    double mass = 0.0;                  ///< kg, to each corner alike
    std::array<double, 8> stiffness{};  ///< N/m, by corner: part of the nodal bound
};

/// The state at the end of a step that implicit integration looks for.
struct EndOfStep {
    std::span<const Vec3> positions;  ///< m, by node id
    const ViscousHistory& history;    ///< of the beginning of the step
    double dt;                        ///< s; infinite: all relaxed, as in statics
};

/// Takes the tangents of elements, one after the other.
class TangentSink {
  public:
    virtual ~TangentSink() = default;
    /// @param tangent symmetric, N/m, of three rows for each of the nodes, column by column
    virtual void add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) = 0;
};
enum class TangentKind { exact, positive };  ///< see positive_part

/// Interface of a block; one virtual call serves a whole block. Elements stand in ascending
/// order of their ids, so that a block's sums do not depend on how it came about. Its nodes have
/// local numbers, which order them as their ids do.
///
/// An edit touches many blocks, but few elements of each. What it costs a block follows these, but
/// for local numbers, and for elements that come or go: then all stand in other slots.
class ElementBlock {
  public:
    static constexpr std::uint16_t unnumbered = 0xffff;
    static constexpr std::size_t max_elements = 512;
    static_assert(4 * (max_elements * topology::max_corners + 1) <= 0xffff);  // offset_of

    virtual ~ElementBlock() = default;
    virtual std::shared_ptr<ElementBlock> clone() const = 0;

    std::span<const ElementId> elements() const { return elements_; }

    /// Ids of the nodes of its elements, by local number, in ascending order.
    std::span<const std::uint32_t> nodes() const { return nodes_; }

    /// Brings nodes(), and what goes by local numbers, up to the elements as they are: after
    /// insert, replace and erase, before forces, energy or volumes are asked for or the history
    /// advances.
    /// @param local_numbers scratch, by node id; `unnumbered` before and after
    void number_nodes(std::span<std::uint16_t> local_numbers);

    /// Those of its nodes by local number, and a place more, in `offsets`: the caller's thread
    /// keeps that from block to block, so that it takes memory once and never again.
    std::span<const LocalVector> local_positions(std::span<const Vec3> positions,
                                                 std::vector<LocalVector>& offsets) const;
    /// The same in the thread's own place for them, until the next call.
    std::span<const LocalVector> local_positions(std::span<const Vec3> positions) const;

    /// Sets `forces` to the sums of the elements' elastic forces, N, at `positions`, m, with those
    /// of viscosity as far as the history goes. Both by local number; each has one place more than
    /// there are nodes, for the block's own use.
    /// @param next  of the block that the thread most likely takes then
    virtual void compute_forces(std::span<const LocalVector> positions,
                                const ViscousHistory& history, std::span<LocalVector> forces,
                                std::span<const std::byte> next) const = 0;
    /// What compute_forces reads first of its elements.
    virtual std::span<const std::byte> bytes_of_elements() const = 0;
    /// Adds the forces (N) at the end of a step, viscous ones by the exact rule of advance().
    virtual void add_forces(const EndOfStep& end, std::span<Vec3> forces) const = 0;
    /// Whose gradient by the positions are minus these forces, J; without viscosity the energy.
    virtual double potential(const EndOfStep& end) const = 0;
    /// Hands over the derivatives of minus these forces, in the order of elements.
    virtual void visit_tangents(const EndOfStep& end, TangentKind kind,
                                TangentSink& sink) const = 0;
    /// Whether its elements remember anything.
    virtual bool has_history() const = 0;
    /// Brings the history of the elements from the positions `before` to `positions`, dt later
    /// (s); these as for compute_forces. Returns the energy that viscosity took, J; 0 if the
    /// material has none.
    virtual double advance(std::span<const LocalVector> before,
                           std::span<const LocalVector> positions, double dt,
                           ViscousHistory& history) = 0;
    /// What the elements come to at `positions`.
    virtual BlockState state(std::span<const Vec3> positions) const = 0;
    /// Sum of their rest volumes, m3.
    virtual Sum rest_volume() const = 0;
    /// Sum over the elements of modulus times rest volume, J.
    virtual double stiffness_energy() const = 0;
    virtual ElementResult result(ElementId e, std::span<const Vec3> positions,
                                 const ViscousHistory& history) const = 0;
    /// Those of all, in the order of elements(); within rounding of those one by one.
    virtual void results(std::span<const Vec3> positions, const ViscousHistory& history,
                         std::span<ElementResult> results) const = 0;
    virtual const NodalContributions& contributions(ElementId e) const = 0;
    virtual double rest_volume(ElementId e) const = 0;

    /// Takes the element in and precomputes it from the rest positions (by node id).
    /// @param fibre  direction of its fibres at rest; of no account without fibres
    virtual void insert(ElementId e, std::span<const NodeId> corners,
                        std::span<const Vec3> rest_positions, const Vec3& fibre) = 0;
    /// Recomputes an element that it has, with other corners.
    virtual void replace(ElementId e, std::span<const NodeId> corners,
                         std::span<const Vec3> rest_positions, const Vec3& fibre) = 0;
    virtual void erase(ElementId e) = 0;

  protected:
    explicit ElementBlock(std::size_t num_corners) : num_corners_(num_corners) {}

    /// Node ids of the element in the given slot.
    virtual std::span<const std::uint32_t> corners_of(std::size_t s) const = 0;
    /// Brings what follows elements and their local numbers up to them.
    /// @param changed  slots whose elements are not what they were when this was last called; if
    ///                 have_moved_, all may stand in other slots than then
    virtual void use_numbers(std::span<const std::size_t> changed) = 0;

    /// Local numbers of the nodes of the element in slot s.
    std::span<std::uint16_t> local_corners(std::size_t s) {
        return std::span(local_corners_).subspan(s * num_corners_, num_corners_);
    }
    std::span<const std::uint16_t> local_corners(std::size_t s) const {
        return std::span(local_corners_).subspan(s * num_corners_, num_corners_);
    }

    /// Returns where the new element stands.
    std::size_t add_slot(ElementId e);
    void change_slot(std::size_t s);
    void remove_slot(std::size_t s);
    std::size_t slot_of(ElementId e) const {
        // Ids ascend: it stands no farther from the first than its id does, and seldom nearer.
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
    // Local numbers, by slot; unnumbered those of elements that changed.
    std::vector<std::uint16_t> local_corners_;
    bool is_numbered_ = true, have_moved_ = false;
};

}  // namespace incise::physics
