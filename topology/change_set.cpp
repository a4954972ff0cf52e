// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/change_set.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

bool ChangeSet::is_empty() const {
    return MeshChanges::is_empty() && shape_changes.empty() && inside_changes.empty() &&
           faces_opened.empty() && faces_closed.empty();
}

ChangeSet inverse(const ChangeSet& changes) {
    ChangeSet back = changes;
    invert(back);
    std::swap(back.faces_opened, back.faces_closed);
    for (ShapeChange& change : back.shape_changes) {
        std::swap(change.kind_from, change.kind_to);
        std::swap(change.from, change.to);
    }
    for (InsideChange& change : back.inside_changes) std::swap(change.from, change.to);
    return back;
}

double rest_volume(const Mesh& mesh, const ChangeSet& changes, const CellRecord& record) {
    if (record.kind != CellKind::polyhedron) {
        std::array<Vec3, max_corners> x;
        for (std::size_t k = 0; k < record.corners.size(); ++k)
            x[k] = mesh.rest_position(record.corners[k]);
        return signed_volume(record.kind, std::span(x).first(record.corners.size()));
    }
    const auto change =
        std::ranges::lower_bound(changes.shape_changes, record.id, {}, &ShapeChange::cell);
    const bool is_changed = change != changes.shape_changes.end() && change->cell == record.id;
    const CellShape& shape = !is_changed                    ? mesh.shape(record.id)
                             : change->from.num_faces() > 0 ? change->from
                                                            : change->to;
    return volume_of(shape, mesh.rest_positions());
}

std::vector<CellId> touched_cells(const ChangeSet& changes) {
    std::vector<CellId> touched;
    for (const auto* records : {&changes.elements_added, &changes.elements_removed})
        for (const CellRecord& record : *records) {
            touched.push_back(record.id);
            if (record.parent.is_valid()) touched.push_back(record.parent);
        }
    for (const CellRewiring& rewiring : changes.rewired) touched.push_back(rewiring.element);
    for (const ShapeChange& change : changes.shape_changes) touched.push_back(change.cell);
    for (const auto* pairs : {&changes.faces_opened, &changes.faces_closed})
        for (const FacePair& pair : *pairs) {
            touched.push_back(pair.a.cell);
            touched.push_back(pair.b.cell);
        }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    return touched;
}

}  // namespace incise::topology
