// What is to be cut, decided before anything is touched.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

struct CutPlan {
    std::vector<ElementId> elements_to_remove;
    std::vector<FaceId> faces_to_open;

    bool is_empty() const { return elements_to_remove.empty() && faces_to_open.empty(); }
};

/// Carries the plan out in one transaction. What another edit has done meanwhile, elements gone
/// and faces open already, is passed over.
topology::ChangeSet execute(const CutPlan& plan, topology::Mesh& mesh);

}  // namespace incise::cutting
