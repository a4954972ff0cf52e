// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/sides.h"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <unordered_set>

namespace incise::cutting {

using topology::CellKind;
using topology::ElementId;
using topology::FaceId;
using topology::Mesh;
using topology::NodeId;

namespace {

/// Groups of more volume than this share of the cube of the edges there are pieces, not crumbs:
/// less than two elements have before they are divided.
constexpr double largest_crumb = 0.1;

double rest_volume(const Mesh& mesh, ElementId e) {
    const auto corners = mesh.corners(e);
    const auto edge = [&](std::size_t k) -> Vec3 {
        return mesh.rest_position(corners[k]) - mesh.rest_position(corners[0]);
    };
    return std::abs(edge(1).dot(edge(2).cross(edge(3)))) / 6.0;
}

class Sides {
  public:
    Sides(const Mesh& mesh, const CutFront& front, const Scars& scars)
        : mesh_(mesh), front_(front), scars_(scars) {}

    Parting parting(const std::vector<ElementId>& touched, bool has_crumbs) {
        collect_faces(touched);
        place_elements_on_cut();
        Parting result;
        for (const FaceId f : faces_)
            if (is_parted(f)) result.faces.push_back(f);
        if (has_crumbs) keep_crumbs(result);
        std::erase_if(result.faces, [&](FaceId f) { return is_settled(f); });
        return result;
    }

  private:
    using Place = CutFront::Place;

    void collect_faces(const std::vector<ElementId>& touched);
    void place_elements_on_cut();
    void keep_crumbs(Parting& parting);
    bool collect_piece(ElementId start, std::vector<ElementId>& piece);
    bool is_crumb(const std::vector<ElementId>& piece) const;
    bool is_on_cut(FaceId f) const;
    NodeId far_corner(ElementId e) const;
    bool is_placed(ElementId e) const;
    bool is_crossed_to(ElementId e, NodeId n) const;
    bool is_parted(FaceId f) const;
    bool is_settled(FaceId f) const;

    const Mesh& mesh_;
    const CutFront& front_;
    const Scars& scars_;
    std::vector<FaceId> faces_;                       // joined, on the cut, from their lower side
    std::unordered_map<std::int32_t, Place> places_;  // of elements all of whose corners are on it
    std::unordered_set<std::int32_t> large_;          // elements of large pieces
    const std::vector<FaceId>* parted_ = nullptr;
};

/// Of the touched elements, and of those next to them that have no corner off the cut.
void Sides::collect_faces(const std::vector<ElementId>& touched) {
    std::vector<ElementId> pending = touched;
    std::unordered_set<std::int32_t> followed;
    while (!pending.empty()) {
        const ElementId e = pending.back();
        pending.pop_back();
        if (mesh_.kind(e) != CellKind::tetrahedron) continue;
        for (int f = 0; f < 4; ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (!other.is_valid() || !is_on_cut(face)) continue;
            faces_.push_back(std::min(face, other));
            if (!far_corner(other.element).is_valid() &&
                followed.insert(other.element.value).second)
                pending.push_back(other.element);
        }
    }
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
}

void Sides::place_elements_on_cut() {
    struct Bond {
        double area;
        FaceId placed;  // the side that is placed
        bool operator<(const Bond& other) const {
            return area != other.area ? area < other.area : other.placed < placed;
        }
    };
    std::priority_queue<Bond> bonds;
    const auto add = [&](FaceId from, FaceId to) {
        if (is_placed(from.element) && !is_placed(to.element))
            bonds.push({topology::rest_area(mesh_, from), from});
    };
    for (const FaceId face : faces_)
        for (const ElementId e : {face.element, mesh_.neighbor(face).element})
            if (!is_placed(e))
                if (const auto place = front_.place_of(e, mesh_.corners(e).first<4>()))
                    places_.emplace(e.value, *place);
    for (const FaceId face : faces_) {
        add(face, mesh_.neighbor(face));
        add(mesh_.neighbor(face), face);
    }
    while (!bonds.empty()) {
        const FaceId from = bonds.top().placed;
        bonds.pop();
        const ElementId e = mesh_.neighbor(from).element;
        if (is_placed(e)) continue;
        const NodeId corner = mesh_.face_corner(from, 0);
        places_.emplace(e.value, Place{corner, is_crossed_to(from.element, corner)});
        for (int f = 0; f < 4; ++f)
            if (const FaceId next = mesh_.neighbor({e, f}); next.is_valid()) add({e, f}, next);
    }
}

void Sides::keep_crumbs(Parting& parting) {
    std::vector<FaceId>& parted = parting.faces;
    parted_ = &parted;
    std::unordered_set<std::int32_t> crumbs;
    std::vector<ElementId> piece;
    for (const FaceId f : parted) {
        if (is_settled(f)) continue;
        for (const ElementId e : {f.element, mesh_.neighbor(f).element}) {
            if (crumbs.contains(e.value) || !collect_piece(e, piece) || !is_crumb(piece)) continue;
            for (const ElementId member : piece) crumbs.insert(member.value);
            parting.crumbs.insert(parting.crumbs.end(), piece.begin(), piece.end());
        }
    }
    std::erase_if(parted, [&](FaceId f) {
        return crumbs.contains(f.element.value) != crumbs.contains(mesh_.neighbor(f).element.value);
    });
}

/// What hangs together with `start` once the faces are open; false if that is much.
bool Sides::collect_piece(ElementId start, std::vector<ElementId>& piece) {
    piece.assign(1, start);
    double volume = 0.0, edge = 0.0;
    for (std::size_t next = 0; next < piece.size(); ++next) {
        const ElementId e = piece[next];
        if (!scars_.is_crumb(e)) volume += rest_volume(mesh_, e);
        for (const NodeId n : mesh_.corners(e)) edge = std::max(edge, front_.reach(n));
        if (large_.contains(e.value) || volume > largest_crumb * edge * edge * edge) {
            for (const ElementId member : piece) large_.insert(member.value);
            return false;
        }
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (!other.is_valid() ||
                std::binary_search(parted_->begin(), parted_->end(), std::min(face, other)) ||
                std::find(piece.begin(), piece.end(), other.element) != piece.end())
                continue;
            piece.push_back(other.element);
        }
    }
    return true;
}

bool Sides::is_crumb(const std::vector<ElementId>& piece) const {
    if (std::any_of(piece.begin(), piece.end(), [&](ElementId e) { return scars_.is_crumb(e); }))
        return true;  // along an earlier cut
    std::vector<ElementId> star;
    for (const ElementId e : piece) {
        if (mesh_.kind(e) != CellKind::tetrahedron || !is_placed(e)) return false;
        for (const NodeId n : mesh_.corners(e)) {
            if (!front_.is_on(n)) continue;
            star.clear();
            topology::collect_star(mesh_, n, e, star);
            for (const ElementId other : star)
                if (std::find(piece.begin(), piece.end(), other) == piece.end() &&
                    is_placed(other) && is_crossed_to(other, n) == is_crossed_to(e, n))
                    return true;
        }
    }
    return false;
}

bool Sides::is_on_cut(FaceId f) const {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        if (!front_.is_on(mesh_.face_corner(f, p))) return false;
    return true;
}

/// The corner that tells where the element is: one that is not on the cut; invalid if all are.
NodeId Sides::far_corner(ElementId e) const {
    for (const NodeId n : mesh_.corners(e))
        if (!front_.is_on(n)) return n;
    return {};
}

bool Sides::is_placed(ElementId e) const {
    return far_corner(e).is_valid() || places_.contains(e.value);
}

/// Whether the way from where the placed element lies to its corner `n`, on the cut, crosses it.
bool Sides::is_crossed_to(ElementId e, NodeId n) const {
    if (const NodeId far = far_corner(e); far.is_valid()) return front_.is_crossed(far, n);
    const Place& place = places_.at(e.value);
    return place.is_crossed != (place.corner != n && front_.is_crossed(place.corner, n));
}

bool Sides::is_parted(FaceId f) const {
    const ElementId here = f.element, there = mesh_.neighbor(f).element;
    if (!is_placed(here) || !is_placed(there)) return false;
    for (int p = 0; p < 3; ++p) {
        const NodeId n = mesh_.face_corner(f, p);
        if (is_crossed_to(here, n) == is_crossed_to(there, n)) return false;
    }
    return true;
}

/// Whether an earlier cut along the same surface has left the face joined.
bool Sides::is_settled(FaceId f) const {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        if (!front_.is_settled(mesh_.face_corner(f, p))) return false;
    return true;
}

}  // namespace

Parting parted_faces(const Mesh& mesh, const CutFront& front, const Scars& scars,
                     const std::vector<ElementId>& touched, bool keep_crumbs) {
    return Sides(mesh, front, scars).parting(touched, keep_crumbs);
}

}  // namespace incise::cutting
