// Basic types shared by every folder: points and strongly typed ids.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace incise {

/// A point or vector in three dimensions.
using Vec3 = Eigen::Vector3d;

/// A box whose sides are parallel to the axes; a default-constructed box is empty.
using Box = Eigen::AlignedBox3d;

/// Index into arrays of one kind, as a type of its own. Ids are assigned in ascending order and
/// stay with their node or element through all edits. An id is not used again for another node or
/// element, with one exception: undoing an edit releases the ids that the edit assigned.
template <class Tag>
struct Id {
    std::int32_t value = -1;

    constexpr Id() = default;
    constexpr explicit Id(std::size_t index) : value(static_cast<std::int32_t>(index)) {}

    constexpr bool is_valid() const { return value >= 0; }
    constexpr std::size_t index() const { return static_cast<std::size_t>(value); }
    constexpr auto operator<=>(const Id&) const = default;
};

/// A vertex and a cell of the material: the mesh that is cut.
using VertexId = Id<struct VertexTag>;
using CellId = Id<struct CellTag>;
/// A carrier: a cell as it was before any cut.
using CarrierId = Id<struct CarrierTag>;
/// A node and an element of the physics: the mesh that moves.
using NodeId = Id<struct NodeTag>;
using ElementId = Id<struct ElementTag>;

/// Returns the id of another kind with the same number, where both are numbered alike.
template <class To, class Tag>
constexpr To with_number_of(Id<Tag> id) {
    To same;
    same.value = id.value;
    return same;
}

/// One face of a cell. Local face numbers are those of cell_kind.h.
struct FaceId {
    CellId cell;
    std::int32_t face = -1;

    constexpr bool is_valid() const { return cell.is_valid(); }
    constexpr auto operator<=>(const FaceId&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.cell, self.face); }
};

}  // namespace incise

/// @cond
template <class Tag>
struct std::hash<incise::Id<Tag>> {
    std::size_t operator()(incise::Id<Tag> id) const noexcept {
        return std::hash<std::int32_t>()(id.value);
    }
};
/// @endcond
