// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/boundary_surface.h"

#include <algorithm>
#include <utility>

#include "incise/topology/face_triangles.h"

namespace incise::topology {

namespace {

template <class T>
void sort_and_make_unique(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

BoundarySurface::BoundarySurface(const Mesh& mesh) : epoch_(mesh) {
    for (const CellId e : mesh.elements()) add_faces(mesh, e);
}

void BoundarySurface::add_faces(const Mesh& mesh, CellId e) {
    for (int f = 0; f < mesh.num_faces(e); ++f) {
        const FaceId face{e, f};
        if (mesh.neighbor(face).is_valid()) continue;
        for_each_triangle(mesh, face, [&](VertexId a, VertexId b, VertexId c) {
            slots_[e].push_back(triangles_.size());
            changed_.push_back(triangles_.size());
            triangles_.push_back({a, b, c});
            faces_.push_back(face);
            is_cut_.push_back(mesh.is_on_cut(face) ? 1 : 0);
        });
    }
}

/// Fills the slot of each removed triangle with the last triangle of the list.
void BoundarySurface::remove_faces(CellId e) {
    const auto row = slots_.find(e);
    if (row == slots_.end()) return;
    std::vector<std::size_t> slots = std::move(row->second);
    slots_.erase(row);
    std::sort(slots.rbegin(), slots.rend());
    for (const std::size_t slot : slots) {
        const std::size_t last = triangles_.size() - 1;
        if (slot != last) {
            triangles_[slot] = triangles_[last];
            faces_[slot] = faces_[last];
            is_cut_[slot] = is_cut_[last];
            std::ranges::replace(slots_.at(faces_[slot].cell), last, slot);
        }
        changed_.push_back(slot);
        changed_.push_back(last);
        triangles_.pop_back();
        faces_.pop_back();
        is_cut_.pop_back();
    }
}

void BoundarySurface::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return;
    epoch_.advance(mesh, changes, "surface");
    const auto touched = touched_cells(changes);
    for (const CellId e : touched) remove_faces(e);
    for (const CellId e : touched)
        if (e.index() < mesh.element_capacity() && mesh.is_alive(e)) add_faces(mesh, e);
    // Without calls of take_changes() the list would grow with each edit.
    if (changed_.size() > 2 * triangles_.size() + 1024) sort_and_make_unique(changed_);
}

std::vector<std::size_t> BoundarySurface::take_changes() {
    std::vector<std::size_t> changes = std::exchange(changed_, {});
    sort_and_make_unique(changes);
    return changes;
}

}  // namespace incise::topology
