// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/sides.h"

#include <algorithm>
#include <iterator>
#include <queue>
#include <unordered_set>

namespace incise::cutting {

using topology::CellKind;
using topology::Mesh;

Sides::Sides(const Mesh& mesh, const CutFront& front, const std::vector<CellId>& touched,
             const PlaceOnCut& place_on_cut)
    : mesh_(mesh), front_(front), place_on_cut_(place_on_cut) {
    collect_faces(touched);
    place_elements_on_cut();
}

std::vector<FaceId> Sides::separated_faces() const {
    std::vector<FaceId> parted;
    std::ranges::copy_if(faces_, std::back_inserter(parted),
                         [&](FaceId f) { return is_separated(f); });
    return parted;
}

/// Collects the faces on the cut of the touched elements, and of neighbours with all corners on the
/// cut.
void Sides::collect_faces(const std::vector<CellId>& touched) {
    std::vector<CellId> pending = touched;
    std::unordered_set<CellId> followed;
    while (!pending.empty()) {
        const CellId e = pending.back();
        pending.pop_back();
        if (mesh_.kind(e) != CellKind::tetrahedron) continue;
        for (int f = 0; f < 4; ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (!other.is_valid() || !is_on_cut(face)) continue;
            faces_.push_back(std::min(face, other));
            if (!far_corner(other.cell).is_valid() && followed.insert(other.cell).second)
                pending.push_back(other.cell);
        }
    }
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
}

void Sides::place_elements_on_cut() {
    struct Bond {
        double area;
        FaceId placed;  // the one with the element whose side is known
        bool operator<(const Bond& other) const {
            return area != other.area ? area < other.area : other.placed < placed;
        }
    };
    std::priority_queue<Bond> bonds;
    const auto add = [&](FaceId from, FaceId to) {
        if (is_placed(from.cell) && !is_placed(to.cell))
            bonds.push({topology::rest_area(mesh_, from), from});
    };
    for (const FaceId face : faces_)
        for (const CellId e : {face.cell, mesh_.neighbor(face).cell})
            if (!far_corner(e).is_valid())
                if (const auto known = place(e)) places_.emplace(e, *known);
    for (const FaceId face : faces_) {
        add(face, mesh_.neighbor(face));
        add(mesh_.neighbor(face), face);
    }
    while (!bonds.empty()) {
        const FaceId from = bonds.top().placed;
        bonds.pop();
        const CellId e = mesh_.neighbor(from).cell;
        if (is_placed(e)) continue;
        const VertexId corner = mesh_.face_corner(from, 0);
        places_.emplace(e, Place{corner, is_crossed_to(from.cell, corner)});
        for (int f = 0; f < 4; ++f)
            if (const FaceId next = mesh_.neighbor({e, f}); next.is_valid()) add({e, f}, next);
    }
}

bool Sides::is_on_cut(FaceId f) const {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        if (!front_.is_on(mesh_.face_corner(f, p))) return false;
    return true;
}

/// Returns a corner that is not on the cut, or an invalid id if all corners are on it.
VertexId Sides::far_corner(CellId e) const {
    for (const VertexId n : mesh_.corners(e))
        if (!front_.is_on(n)) return n;
    return {};
}

std::optional<CutFront::Place> Sides::place(CellId e) const {
    if (const VertexId far = far_corner(e); far.is_valid()) return Place{far};
    if (const auto known = places_.find(e); known != places_.end()) return known->second;
    if (mesh_.kind(e) != CellKind::tetrahedron) return std::nullopt;
    if (place_on_cut_)
        if (const std::optional<Place> place = place_on_cut_(e)) return place;
    return front_.place_of(e, mesh_.corners(e).first<4>());
}

bool Sides::is_crossed_to(CellId e, VertexId n) const {
    const Place from = *place(e);
    return from.is_crossed != (from.corner != n && front_.is_crossed(from.corner, n));
}

bool Sides::is_separated(FaceId f) const {
    const CellId here = f.cell, there = mesh_.neighbor(f).cell;
    if (!is_placed(here) || !is_placed(there)) return false;
    for (int p = 0; p < 3; ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        if (is_crossed_to(here, n) == is_crossed_to(there, n)) return false;
    }
    return true;
}

}  // namespace incise::cutting
