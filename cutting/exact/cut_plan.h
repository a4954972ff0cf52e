// A plan of what to cut, decided before the mesh changes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// The elements and faces that a carver or a separating blade changes.
struct CutPlan {
    std::vector<CellId> elements_to_remove;
    std::vector<FaceId> faces_to_open;

    bool is_empty() const { return elements_to_remove.empty() && faces_to_open.empty(); }
};

/// Carries out a plan in one transaction. Elements that have died and faces that are open already
/// are skipped.
topology::ChangeSet execute(const CutPlan& plan, topology::Mesh& mesh);

}  // namespace incise::cutting
