// The changes that one edit of the material made to the fragments, as a value.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"

namespace incise::fragments {

using NodeRecord = topology::NodeRecordOf<NodeId>;
using ElementRecord = topology::ElementRecordOf<NodeId, ElementId>;
using ElementRewiring = topology::RewiringOf<NodeId, ElementId>;
using FragmentMeshChanges = topology::MeshChanges<NodeId, ElementId>;

/// A change of the share of a fragment that existed before and after the edit. The share is the
/// same before and after where only shares of its tetrahedra change: FragmentMesh::part_shares().
struct ShareChange {
    ElementId fragment;
    double from = 0.0, to = 0.0;
    bool operator==(const ShareChange&) const = default;
};

/// A cell that an edit gave to another fragment, or that hangs on the same one in another way; see
/// FragmentMesh::is_carried_around(). Invalid: the cell did not exist, or was removed.
struct CarriedCell {
    CellId cell;
    CarrierId carrier;
    ElementId from, to;
    /// True if the edit took the cell out of a fragment that carried it with a light part, or gave
    /// it to such a one. A new cell comes out of the fragment that carried its parent.
    bool is_released = false, is_joined = false;
    /// Whether it was carried around a cut before the edit, and is now. Where only this changes,
    /// `from` and `to` are the same.
    bool was_around = false, is_around = false;
    bool operator==(const CarriedCell&) const = default;
};

/// The record of an edit of a fragment mesh.
struct FragmentChanges {
    /// Fragments and their nodes. The parent of an added fragment is the one that carried its first
    /// cell before. No faces: fragments have none.
    FragmentMeshChanges mesh;
    std::vector<ShareChange> shares;  ///< in ascending order of fragments
    std::vector<CarriedCell> cells;   ///< in ascending order of cells
    /// True if parts of a cell reach into each other: a cut bends within the cell. Then they share
    /// what all of them have of each tetrahedron of the carrier.
    bool has_overlaps = false;
    /// True if a light fragment joined another one or parted from it, or if parts overlap. Then
    /// other nodes carry a part of the mass.
    bool has_joins() const {
        return has_overlaps || std::ranges::any_of(cells, [](const CarriedCell& cell) {
                   return cell.is_released || cell.is_joined;
               });
    }
    bool operator==(const FragmentChanges&) const = default;
};

/// Returns the changes that take `changes` back.
FragmentChanges inverse(FragmentChanges changes);

}  // namespace incise::fragments
