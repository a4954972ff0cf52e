// Surfaces that have cut the body, and the nodes that lie on their faces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/loop_front.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Knows a surface that comes again, and the nodes that lay on it when it cut the body.
///
/// The tissue moves after a cut, and its cut faces leave the surface. The same surface would cut
/// slices off there. So a node that was on the surface counts as on the side of its part of the
/// body until it has moved across the surface by three tenths of the size of a cell. The faces
/// between the nodes are chords of a surface that bends: their edges are not cut again either.
class KnownSurfaces {
  public:
    using Number = std::uint32_t;

    /// Returns the number of a surface that has cut the body; nothing if it has not.
    /// @param size  of cells, m
    std::optional<Number> find(const CutSurface& surface, double size) const;

    /// Notes the nodes of a cut that a surface has made.
    /// @param mesh     after the edit of the cut
    /// @param front    the nodes of the cut
    /// @param changes  the edit of the cut
    /// @param x        where nodes were before the edit, m
    /// @param size     of cells, m
    void note(const topology::Mesh& mesh, const CutSurface& surface, const LoopFront& front,
              const topology::ChangeSet& changes, const topology::NodeField<VertexId, Vec3>& x,
              double size);

    /// How a surface that comes again sees nodes.
    struct Seen {
        std::unordered_set<VertexId> on_surface;  ///< those that were on it, and those beside them
        /// Those that have moved across it, and those beside them, and where they are to be, m.
        std::vector<std::pair<VertexId, Vec3>> displaced;
    };
    /// Returns how a surface that comes again sees the nodes that were on it.
    /// @param x     where they are, m
    /// @param size  of cells, m
    Seen seen(const topology::Mesh& mesh, const CutSurface& surface, Number number,
              const topology::NodeField<VertexId, Vec3>& x, double size) const;

    /// Follows an edit. Copies of a node are on the surfaces that it is on; so is a node between
    /// others that all are.
    void apply(const topology::ChangeSet& changes);

    /// True if the mesh has all nodes that it names.
    bool is_on(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.known_, self.surfaces_of_); }

  private:
    /// A surface, by a point of it.
    struct Known {
        SurfaceIdentity identity = no_identity;
        Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  // m; of unit length
        static void archive(auto& ar, auto& self) { ar(self.identity, self.point, self.normal); }
    };

    std::vector<Known> known_;
    std::unordered_map<VertexId, std::vector<Number>> surfaces_of_;  // in ascending order
};

}  // namespace incise::cutting
