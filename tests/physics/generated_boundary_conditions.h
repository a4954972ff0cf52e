// Constraints and loads of generated bodies, and which of them an edited body is to have: by
// offsets at rest, where physics keeps to ids. SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <span>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"
#include "support/properties.h"

namespace incise::physics {

/// Numbers that choose among what the body has at the start, counted on past the last.
struct GeneratedBoundaryConditions {
    std::vector<std::size_t> held_elements;   ///< their nodes stay at rest
    std::vector<std::size_t> moved_elements;  ///< other nodes of these are moved and turned
    std::vector<std::size_t> loaded_nodes;
    std::vector<std::size_t> loaded_faces;    ///< of the boundary: traction on all, pressure
    std::vector<std::size_t> loaded_regions;  ///< with a body force
};
std::ostream& operator<<(std::ostream& out, const GeneratedBoundaryConditions& boundary_conditions);

/// Shrinks to none.
rc::Gen<GeneratedBoundaryConditions> generated_boundary_conditions();

/// Follows a mesh through its edits. A node is what its place is: copies share the place, and one
/// born between two offsets belongs to what both belong to. A face is loaded as the one of the
/// start in which all its corners lie, if it looks the same way.
class Acting {
  public:
    /// @param mesh as it is at the start
    Acting(const topology::Mesh& mesh, const GeneratedBoundaryConditions& chosen);

    /// What a body has at the start.
    const BoundaryConditions& at_start() const { return at_start_; }

    /// @param mesh after the edit
    void follow(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// What a body built on the mesh as it is now has to have to be the same: the force on a place
    /// is shared by its nodes by mass. @param masses by node id
    BoundaryConditions now(const topology::Mesh& mesh, std::span<const double> masses) const;

  private:
    using Place = std::array<double, 3>;
    struct Membership {
        bool is_held = false, is_moved = false, is_loaded = false;
        std::uint32_t faces = 0;  // bits: in which of the loaded faces it lies
    };

    BoundaryConditions select(const topology::Mesh& mesh) const;

    std::map<Place, Membership> places_;
    std::vector<Vec3> face_areas_;  // area vectors of the loaded faces at the start
    std::vector<int> regions_;
    BoundaryConditions at_start_;
};

}  // namespace incise::physics
