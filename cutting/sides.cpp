// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/sides.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <ranges>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

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

/// Of a step: what is nearer than that to each other happens at the same time, but for rounding.
constexpr double at_once = 1e-9;

class Sides {
  public:
    Sides(const Mesh& mesh, const CutFront& front, const Scars& scars,
          const std::vector<ElementId>& touched, const std::optional<Course>& course)
        : mesh_(mesh), front_(front), scars_(scars), touched_(touched), course_(course) {}

    Parting parting() {
        collect_faces();
        place_elements_on_cut();
        for (const FaceId f : faces_)
            if (is_parted(f)) parted_.push_back(f);
        if (course_) keep_crumbs();
        std::erase_if(parted_, [&](FaceId f) { return is_settled(f) || kept_.contains(f); });
        return {std::move(parted_), std::move(crumbs_), std::move(waiting_)};
    }

  private:
    using Place = CutFront::Place;
    static constexpr double at_last = std::numeric_limits<double>::infinity();

    void collect_faces();
    void place_elements_on_cut();
    void keep_crumbs();
    double time(FaceId f);
    bool collect_piece(ElementId start, double time, std::vector<ElementId>& piece);
    bool is_known_crumb(ElementId e) const;
    void star_of(NodeId n, std::vector<ElementId>& star) const;
    template <class Condition>
    bool any_twin(NodeId n, Condition condition) const;
    bool is_crumb(const std::vector<ElementId>& piece) const;
    bool may_hang(const std::vector<ElementId>& piece) const;
    bool is_on_cut(FaceId f) const;
    NodeId far_corner(ElementId e) const;
    std::optional<Place> place(ElementId e) const;
    bool is_placed(ElementId e) const { return place(e).has_value(); }
    bool is_crossed_to(ElementId e, NodeId n) const;
    bool is_parted(FaceId f) const;
    bool is_settled(FaceId f) const;

    const Mesh& mesh_;
    const CutFront& front_;
    const Scars& scars_;
    const std::vector<ElementId>& touched_;  // each that the edit has changed, and some besides
    const std::optional<Course>& course_;
    std::vector<FaceId> faces_;                       // joined, on the cut, from their lower side
    std::unordered_map<std::int32_t, Place> places_;  // of elements all of whose corners are on it
    std::unordered_set<std::int32_t> large_;          // elements of large pieces
    std::vector<FaceId> parted_;                      // in ascending order
    std::map<FaceId, double> times_;                  // of those asked for
    std::set<FaceId> kept_;                           // joined, of those
    std::vector<ElementId> crumbs_, waiting_;
};

/// Of the touched elements, and of those next to them that have no corner off the cut.
void Sides::collect_faces() {
    std::vector<ElementId> pending = touched_;
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
            if (!far_corner(e).is_valid())
                if (const auto known = place(e)) places_.emplace(e.value, *known);
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

// In the order in which the surface comes to the faces, each opens unless that leaves a crumb.
void Sides::keep_crumbs() {
    std::vector<ElementId> piece;
    std::vector<std::pair<double, FaceId>> doubtful;
    for (const FaceId f : parted_)
        if (!is_settled(f) && (collect_piece(f.element, at_last, piece) ||
                               collect_piece(mesh_.neighbor(f).element, at_last, piece)))
            doubtful.emplace_back(time(f), f);
    std::sort(doubtful.begin(), doubtful.end());
    for (auto begin = doubtful.begin(); begin != doubtful.end();) {
        const double now = begin->first + at_once;
        const auto end = std::find_if(begin, doubtful.end(),
                                      [&](const auto& entry) { return entry.first > now; });
        std::vector<ElementId> coming_off;
        const auto comes_off = [&](ElementId e) {
            return std::find(coming_off.begin(), coming_off.end(), e) != coming_off.end();
        };
        for (const auto& [t, f] : std::ranges::subrange(begin, end))
            for (const ElementId e : {f.element, mesh_.neighbor(f).element}) {
                if (comes_off(e) || !collect_piece(e, now, piece)) continue;
                const bool is_decided = !may_hang(piece);
                if (is_decided && !is_crumb(piece)) continue;
                coming_off.insert(coming_off.end(), piece.begin(), piece.end());
                auto& kind = is_decided ? crumbs_ : waiting_;
                kind.insert(kind.end(), piece.begin(), piece.end());
            }
        for (const auto& [t, f] : std::ranges::subrange(begin, end))
            if (comes_off(f.element) != comes_off(mesh_.neighbor(f).element)) kept_.insert(f);
        begin = end;
    }
}

double Sides::time(FaceId f) {
    const auto [place, is_new] = times_.try_emplace(f);
    if (is_new) place->second = course_->time_of_parting(f);
    return place->second;
}

bool Sides::is_known_crumb(ElementId e) const { return scars_.is_crumb(e, front_.number()); }

/// What hangs together with `start` once the faces are open that are so by then; false if that is
/// much.
bool Sides::collect_piece(ElementId start, double by, std::vector<ElementId>& piece) {
    const auto is_open = [&](FaceId f) {
        return std::binary_search(parted_.begin(), parted_.end(), f) && !kept_.contains(f) &&
               (by == at_last || time(f) <= by);
    };
    piece.assign(1, start);
    double volume = 0.0, edge = 0.0;
    for (std::size_t next = 0; next < piece.size(); ++next) {
        const ElementId e = piece[next];
        if (!is_known_crumb(e)) volume += rest_volume(mesh_, e);
        for (const NodeId n : mesh_.corners(e)) edge = std::max(edge, front_.reach(n));
        if (large_.contains(e.value) || volume > largest_crumb * edge * edge * edge) {
            if (by == at_last)  // and before it was no less
                for (const ElementId member : piece) large_.insert(member.value);
            return false;
        }
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (!other.is_valid() || is_open(std::min(face, other)) ||
                std::find(piece.begin(), piece.end(), other.element) != piece.end())
                continue;
            piece.push_back(other.element);
        }
    }
    return true;
}

/// The mesh knows an element of each node from before the edit, which may have lost it since; one
/// that has it then is among the touched.
void Sides::star_of(NodeId n, std::vector<ElementId>& star) const {
    const auto has_it = [&](ElementId e) { return mesh_.corner_of(e, n) >= 0; };
    ElementId start = mesh_.anchor(n);
    if (!start.is_valid() || !has_it(start)) start = *std::ranges::find_if(touched_, has_it);
    star.clear();
    topology::collect_star(mesh_, n, start, star);
}

/// Whether the condition holds for one of the nodes that a node on the cut has become.
template <class Condition>
bool Sides::any_twin(NodeId n, Condition condition) const {
    for (NodeId twin = n;;) {
        // Nodes that the edit has made do not count as alive before it ends.
        if ((twin == n || mesh_.is_alive(twin)) && condition(twin)) return true;
        twin = front_.next_twin(twin);
        if (twin == n) return false;
    }
}

/// Whether it hangs on the rest of its side by nodes.
bool Sides::is_crumb(const std::vector<ElementId>& piece) const {
    const auto is_in_piece = [&](ElementId e) {
        return std::find(piece.begin(), piece.end(), e) != piece.end();
    };
    if (std::any_of(piece.begin(), piece.end(), [&](ElementId e) { return is_known_crumb(e); }))
        return true;  // along an earlier cut
    std::vector<ElementId> star;
    for (const ElementId e : piece) {
        if (mesh_.kind(e) != CellKind::tetrahedron || !is_placed(e)) return false;
        for (const NodeId n : mesh_.corners(e)) {
            if (!front_.is_on(n)) continue;
            const bool is_crossed = is_crossed_to(e, n);
            const auto has_rest = [&](NodeId twin) {
                star_of(twin, star);
                return std::ranges::any_of(star, [&](ElementId other) {
                    return !is_in_piece(other) && is_placed(other) &&
                           is_crossed_to(other, twin) == is_crossed;
                });
            };
            if (any_twin(n, has_rest)) return true;
        }
    }
    return false;
}

/// Whether the cut is not finished round one of its nodes.
bool Sides::may_hang(const std::vector<ElementId>& piece) const {
    std::vector<ElementId> star;
    const auto is_at_border = [&](ElementId e) {
        if (mesh_.kind(e) != CellKind::tetrahedron) return false;
        for (int f = 0; f < 4; ++f) {
            int count = 0;
            for (int p = 0; p < 3; ++p)
                count += front_.is_crossed(mesh_.face_corner({e, f}, p),
                                           mesh_.face_corner({e, f}, (p + 1) % 3));
            if (count % 2 == 1 && course_->ends_in({e, f})) return true;
        }
        return false;
    };
    const auto is_unfinished = [&](NodeId twin) {
        star_of(twin, star);
        return std::ranges::any_of(star, is_at_border);
    };
    for (const ElementId e : piece)
        for (const NodeId n : mesh_.corners(e))
            if (front_.is_on(n) && any_twin(n, is_unfinished)) return true;
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

std::optional<CutFront::Place> Sides::place(ElementId e) const {
    if (const NodeId far = far_corner(e); far.is_valid()) return Place{far};
    if (const auto known = places_.find(e.value); known != places_.end()) return known->second;
    if (mesh_.kind(e) != CellKind::tetrahedron) return std::nullopt;
    return front_.place_of(e, mesh_.corners(e).first<4>());
}

/// Whether the way from where the placed element lies to its corner `n`, on the cut, crosses it.
bool Sides::is_crossed_to(ElementId e, NodeId n) const {
    const Place from = *place(e);
    return from.is_crossed != (from.corner != n && front_.is_crossed(from.corner, n));
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
                     const std::vector<ElementId>& touched, const std::optional<Course>& course) {
    return Sides(mesh, front, scars, touched, course).parting();
}

}  // namespace incise::cutting
