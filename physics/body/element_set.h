// Selections of elements and of faces that follow the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The parts of a divided member are members. Members that die stay listed, so that an undone edit
/// finds them again: ask the mesh who is alive.
class ElementSet {
  public:
    ElementSet(std::vector<ElementId> elements = {});

    /// In ascending order.
    const std::vector<ElementId>& members() const { return members_; }

    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member cannot be an element.
    void require_fit() const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<ElementId> members_;
};

/// Where an edit divides the element of a face, the set goes on to just the faces of the parts that
/// lie in that face. Members that are gone or inside stay listed: ask the mesh.
class FaceSet {
  public:
    struct Member {
        FaceId face;
        /// Valid when a division took the face to other elements as a whole: the first part that
        /// the edit made. What now has the member's number lies inside the former element.
        ElementId left_to;
        static void archive(auto& ar, auto& self) { ar(self.face, self.left_to); }
    };

    FaceSet(std::vector<FaceId> faces = {});

    /// In ascending order of faces.
    const std::vector<Member>& members() const { return members_; }

    /// @param mesh after the edit
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member cannot be a face of the mesh.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<Member> members_;
};

}  // namespace incise::physics
