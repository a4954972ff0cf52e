// What must hold of a mesh before anything is built on it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// A side of a cell of the source.
struct SourceFace {
    std::size_t cell = 0;
    int face = 0;
    auto operator<=>(const SourceFace&) const = default;
};

/// Two cells that share a face. `shift` is the position in b's face of the point at position 0 of
/// a's face.
struct SharedFace {
    SourceFace a, b;
    int shift = 0;
};

struct MeshCheck {
    /// What makes the mesh unusable, in the order found. Many alike are counted, not listed.
    std::vector<std::string> errors;
    /// What was found odd and will be left out.
    std::vector<std::string> warnings;
    /// The pairs of faces, in ascending order of a; complete only without errors.
    std::vector<SharedFace> shared_faces;
};

/// Finds: lists whose lengths do not fit each other; nothing volumetric; indices out of range;
/// coordinates not finite; repeated corners; zero or negative volume, or a corner of a hexahedron,
/// wedge or pyramid that is turned inside out; duplicate cells; faces shared by three; neighbours
/// on the same side of their face, or twisted against each other. Warns of points that no cell
/// uses, and of points at one position that are not joined (see mesh_repair.h). Cells and points
/// are named by their numbers from 0, and as the source calls them. Cost: O(n), some 0.3 us a cell.
MeshCheck check(const MeshData& data);

}  // namespace incise::topology
