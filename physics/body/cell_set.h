// Selections of elements and of faces that follow the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A set of elements. The parts of a divided member become members. Dead members stay in the set,
/// so that an edit can be undone: Mesh::is_alive tells which members are alive.
class CellSet {
  public:
    CellSet(std::vector<CellId> elements = {});

    /// Returns the members in ascending order.
    const std::vector<CellId>& members() const { return members_; }

    /// Follows an edit; `mesh` is the mesh after the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if an id is invalid or if the members are not in ascending order.
    void require_fit() const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<CellId> members_;
};

/// A set of faces. If an edit divides the element of a member, the faces of its parts that lie in
/// that face become members. Faces of dead elements and faces inside the body stay in the set:
/// the mesh tells which members are on the boundary.
class FaceSet {
  public:
    struct Member {
        FaceId face;
        /// Valid if a division moved the whole face to other elements: the first new part. The face
        /// that now has the number of the member lies inside the former element.
        CellId left_to;
        static void archive(auto& ar, auto& self) { ar(self.face, self.left_to); }
    };

    FaceSet(std::vector<FaceId> faces = {});

    /// Returns the members in ascending order of faces.
    const std::vector<Member>& members() const { return members_; }

    /// Follows an edit; `mesh` is the mesh after the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member cannot be a face of the mesh.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<int> take_faces(CellId e);
    void follow_shapes(const topology::Mesh& mesh, const topology::ChangeSet& changes,
                       std::vector<FaceId>& born);
    /// Takes back what follow_shapes() did for `changes`. `mesh` is the mesh before them.
    void go_back(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    std::vector<Member> members_;
};

}  // namespace incise::physics
