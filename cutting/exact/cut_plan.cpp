// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/cut_plan.h"

#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

topology::ChangeSet execute(const CutPlan& plan, topology::Mesh& mesh) {
    topology::MeshEdit edit(mesh);
    for (const CellId e : plan.elements_to_remove)
        if (mesh.is_alive(e)) edit.remove(e);
    for (const FaceId f : plan.faces_to_open)
        if (mesh.is_alive(f.cell) && mesh.neighbor(f).is_valid()) edit.open(f);
    return edit.commit();
}

}  // namespace incise::cutting
