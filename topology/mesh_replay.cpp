// Replay of a recorded edit. The replay of its inverse undoes an edit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/base/error.h"
#include "incise/topology/mesh_edit.h"

namespace incise::topology {

/// Execution of a record. All decisions are in the record.
class MeshReplay {
  public:
    MeshReplay(Mesh& mesh, const ChangeSet& changes) : mesh_(mesh), changes_(changes) {}

    void run() {
        for (const FacePair& pair : changes_.faces_opened) mesh_.unglue(pair.a);
        for (const CellRecord& record : changes_.elements_removed) {
            mesh_.alive_[record.id.index()] = 0;
            --mesh_.num_elements_;
        }
        for (const VertexRecord& record : changes_.nodes_added) {
            if (record.id.index() == mesh_.node_capacity()) {
                mesh_.rest_positions_.push_back(record.rest_position);
                mesh_.incident_elements_.emplace_back();
            }
            mesh_.rest_positions_[record.id.index()] = record.rest_position;
            ++mesh_.num_nodes_;
        }
        for (const CellRecord& record : changes_.elements_added) add(record);
        for (const ShapeChange& change : changes_.shape_changes)
            if (change.cell.index() < changes_.element_capacity_after)
                mesh_.set_shape(change.cell, change.kind_to, change.to);
        for (const CellRewiring& rewiring : changes_.rewired)
            corner(rewiring.element, rewiring.corner) = rewiring.to;
        for (const FacePair& pair : changes_.faces_closed) mesh_.glue(pair.a, pair.b);
        // They do not follow from the faces that were joined: a face can have been made and opened
        // in the same edit, and the inverse of an edit takes marks away.
        for (const InsideChange& change : changes_.inside_changes)
            mesh_.inside_faces_[change.cell.index()] = change.to;
        for (const VertexRecord& record : changes_.nodes_removed) {
            mesh_.incident_elements_[record.id.index()] = {};
            --mesh_.num_nodes_;
        }
        set_incident_elements();
        mesh_.truncate(changes_.node_capacity_after, changes_.element_capacity_after);
        mesh_.epoch_ = changes_.epoch_after;
    }

  private:
    VertexId& corner(CellId e, int k) {
        return mesh_.corners_[mesh_.corner_begin_[e.index()] + static_cast<std::size_t>(k)];
    }

    void add(const CellRecord& record) {
        const CellId e = record.id;
        if (e.index() == mesh_.element_capacity()) {
            mesh_.append_element_row(
                record.kind, record.region,
                record.kind == CellKind::polyhedron ? std::span<const VertexId>() : record.corners);
        } else {
            mesh_.alive_[e.index()] = 1;
            ++mesh_.num_elements_;
            if (record.kind == CellKind::polyhedron) return;
            for (std::size_t k = 0; k < record.corners.size(); ++k)
                corner(e, static_cast<int>(k)) = record.corners[k];
        }
    }

    void set_incident_elements() {
        std::vector<std::pair<VertexId, CellId>> touched;
        const auto touch = [&](CellId e) {
            if (mesh_.is_alive(e))
                for (const VertexId n : mesh_.corners(e)) touched.emplace_back(n, e);
        };
        for (const CellRecord& record : changes_.elements_added) touch(record.id);
        for (const CellRewiring& rewiring : changes_.rewired) touch(rewiring.element);
        for (const ShapeChange& change : changes_.shape_changes)
            if (change.cell.index() < changes_.element_capacity_after) touch(change.cell);
        for (const auto* pairs : {&changes_.faces_opened, &changes_.faces_closed})
            for (const FacePair& pair : *pairs) {
                touch(pair.a.cell);
                touch(pair.b.cell);
            }
        std::sort(touched.begin(), touched.end());
        std::vector<CellId> star;
        for (std::size_t i = 0; i < touched.size(); ++i) {
            const auto [n, lowest_touched] = touched[i];
            if (i > 0 && touched[i - 1].first == n) continue;
            // A cell that has come to the star is a touched one. So the lowest cell is the former
            // one or a touched one, or else, where the former one has gone, the star tells.
            CellId& lowest = mesh_.incident_elements_[n.index()];
            if (!lowest.is_valid() || lowest_touched < lowest) {
                lowest = lowest_touched;
            } else if (!mesh_.is_alive(lowest) || mesh_.corner_of(lowest, n) < 0) {
                star.clear();
                collect_star(mesh_, n, lowest_touched, star);
                lowest = star.front();
            }
        }
    }

    Mesh& mesh_;
    const ChangeSet& changes_;
};

void replay(Mesh& mesh, const ChangeSet& changes) {
    if (changes.epoch_before != mesh.epoch())
        throw InputError("edit out of turn: it belongs to epoch " +
                         std::to_string(changes.epoch_before) + ", the mesh is at epoch " +
                         std::to_string(mesh.epoch()));
    MeshReplay(mesh, changes).run();
}

}  // namespace incise::topology
