// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/separation.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <map>
#include <ranges>
#include <set>
#include <unordered_set>
#include <utility>

#include "incise/cutting/surfaces/space_time.h"

namespace incise::cutting {

using topology::CellKind;
using topology::Mesh;

namespace {

/// Largest volume of a sliver fragment, as a share of the cube of the longest edge there. For
/// comparison, a regular tetrahedron has 0.118.
constexpr double largest_sliver = 0.1;

/// True if the face is between frozen nodes: an earlier cut along the same surface has left it
/// joined.
bool is_frozen(const Mesh& mesh, const CutFront& front, FaceId f) {
    for (int p = 0; p < mesh.face_size(f); ++p)
        if (!front.is_frozen(mesh.face_corner(f, p))) return false;
    return true;
}

/// Holds the sliver fragments of an edit that is not committed yet.
class SliverFragments {
  public:
    /// `parted` has the faces between the sides in ascending order, each with its lower id. All
    /// arguments must outlive the object.
    SliverFragments(const Mesh& mesh, const CutFront& front, const SnapHistory& snap_history,
                    const Sides& sides, const std::vector<ElementId>& touched,
                    const std::vector<FaceId>& parted, const Course& course)
        : mesh_(mesh),
          front_(front),
          snap_history_(snap_history),
          sides_(sides),
          touched_(touched),
          parted_(parted),
          course_(course) {}

    /// Finds the fragments. To be called once.
    void keep();

    bool is_kept(FaceId f) const { return kept_.contains(f); }
    const std::vector<ElementId>& elements() const { return elements_; }
    const std::vector<ElementId>& waiting() const { return waiting_; }

  private:
    static constexpr double at_last = std::numeric_limits<double>::infinity();

    double time(FaceId f);
    bool collect_piece(ElementId start, double by, std::vector<ElementId>& piece);
    bool is_known(ElementId e) const { return snap_history_.is_earlier_sliver(e, front_.number()); }
    void star_of(NodeId n, std::vector<ElementId>& star) const;
    template <class Condition>
    bool any_twin(NodeId n, Condition condition) const;
    bool hangs(const std::vector<ElementId>& piece) const;
    bool may_hang(const std::vector<ElementId>& piece) const;

    const Mesh& mesh_;
    const CutFront& front_;
    const SnapHistory& snap_history_;
    const Sides& sides_;
    const std::vector<ElementId>& touched_;
    const std::vector<FaceId>& parted_;
    const Course& course_;
    std::unordered_set<ElementId> large_;  // elements of large components
    std::map<FaceId, double> times_;       // of the faces for which time() was called
    std::set<FaceId> kept_;                // faces between the sides that stay joined
    std::vector<ElementId> elements_, waiting_;
};

// In the order in which the surface comes to the faces, each opens unless that leaves a fragment.
void SliverFragments::keep() {
    std::vector<ElementId> piece;
    std::vector<std::pair<double, FaceId>> doubtful;
    for (const FaceId f : parted_)
        if (!is_frozen(mesh_, front_, f) &&
            (collect_piece(f.element, at_last, piece) ||
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
        for (auto entry = begin; entry != end; ++entry)
            for (const ElementId e :
                 {entry->second.element, mesh_.neighbor(entry->second).element}) {
                if (comes_off(e) || !collect_piece(e, now, piece)) continue;
                const bool is_decided = !may_hang(piece);
                if (is_decided && !hangs(piece)) continue;
                coming_off.insert(coming_off.end(), piece.begin(), piece.end());
                auto& kind = is_decided ? elements_ : waiting_;
                kind.insert(kind.end(), piece.begin(), piece.end());
            }
        for (auto entry = begin; entry != end; ++entry) {
            const FaceId f = entry->second;
            if (comes_off(f.element) != comes_off(mesh_.neighbor(f).element)) kept_.insert(f);
        }
        begin = end;
    }
}

double SliverFragments::time(FaceId f) {
    const auto [place, is_new] = times_.try_emplace(f);
    if (is_new) place->second = course_.time_of_separation(f);
    return place->second;
}

/// Collects the component of `start` when those faces are open that open by the time `by`. Returns
/// false if the component is too large for a sliver fragment.
bool SliverFragments::collect_piece(ElementId start, double by, std::vector<ElementId>& piece) {
    const auto is_open = [&](FaceId f) {
        return std::binary_search(parted_.begin(), parted_.end(), f) && !kept_.contains(f) &&
               (by == at_last || time(f) <= by);
    };
    piece.assign(1, start);
    double volume = 0.0, edge = 0.0;
    for (std::size_t next = 0; next < piece.size(); ++next) {
        const ElementId e = piece[next];
        if (!is_known(e)) volume += rest_volume(mesh_, e);
        for (const NodeId n : mesh_.corners(e)) edge = std::max(edge, front_.local_edge_length(n));
        if (large_.contains(e) || volume > largest_sliver * edge * edge * edge) {
            if (by == at_last)  // at earlier times it is at least as large
                for (const ElementId member : piece) large_.insert(member);
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

/// Collects the elements at a node. The element that the mesh keeps for the node is from before the
/// edit, and may no longer have the node. One of the touched elements then has it.
void SliverFragments::star_of(NodeId n, std::vector<ElementId>& star) const {
    const auto has_it = [&](ElementId e) { return mesh_.corner_of(e, n) >= 0; };
    ElementId start = mesh_.incident_element(n);
    if (!start.is_valid() || !has_it(start)) {
        const auto place = std::ranges::find_if(touched_, has_it);
        assert(place != touched_.end());
        start = *place;
    }
    star.clear();
    topology::collect_star(mesh_, n, start, star);
}

/// True if the condition holds for the node or for one of its twins.
template <class Condition>
bool SliverFragments::any_twin(NodeId n, Condition condition) const {
    for (NodeId twin = n;;) {
        // Nodes that the edit has made are not alive before it is committed.
        if ((twin == n || mesh_.is_alive(twin)) && condition(twin)) return true;
        twin = front_.next_twin(twin);
        if (twin == n) return false;
    }
}

/// True if the component is connected to the rest of its side by nodes, or was kept by an earlier
/// cut.
bool SliverFragments::hangs(const std::vector<ElementId>& piece) const {
    const auto is_in_piece = [&](ElementId e) {
        return std::find(piece.begin(), piece.end(), e) != piece.end();
    };
    if (std::any_of(piece.begin(), piece.end(), [&](ElementId e) { return is_known(e); }))
        return true;
    std::vector<ElementId> star;
    for (const ElementId e : piece) {
        if (mesh_.kind(e) != CellKind::tetrahedron || !sides_.is_placed(e)) return false;
        for (const NodeId n : mesh_.corners(e)) {
            if (!front_.is_on(n)) continue;
            const bool is_crossed = sides_.is_crossed_to(e, n);
            const auto has_rest = [&](NodeId twin) {
                star_of(twin, star);
                return std::ranges::any_of(star, [&](ElementId other) {
                    return !is_in_piece(other) && sides_.is_placed(other) &&
                           sides_.is_crossed_to(other, twin) == is_crossed;
                });
            };
            if (any_twin(n, has_rest)) return true;
        }
    }
    return false;
}

/// True if the cut is not finished round one of the nodes of the component.
bool SliverFragments::may_hang(const std::vector<ElementId>& piece) const {
    std::vector<ElementId> star;
    const auto is_at_boundary = [&](ElementId e) {
        if (mesh_.kind(e) != CellKind::tetrahedron) return false;
        for (int f = 0; f < 4; ++f) {
            int count = 0;
            for (int p = 0; p < 3; ++p)
                count += front_.is_crossed(mesh_.face_corner({e, f}, p),
                                           mesh_.face_corner({e, f}, (p + 1) % 3));
            if (count % 2 == 1 && course_.ends_in({e, f})) return true;
        }
        return false;
    };
    const auto is_unfinished = [&](NodeId twin) {
        star_of(twin, star);
        return std::ranges::any_of(star, is_at_boundary);
    };
    for (const ElementId e : piece)
        for (const NodeId n : mesh_.corners(e))
            if (front_.is_on(n) && any_twin(n, is_unfinished)) return true;
    return false;
}

}  // namespace

Separation separation(const Mesh& mesh, const CutFront& front, const SnapHistory& snap_history,
                      const std::vector<ElementId>& touched, const PlaceOnCut& place_on_cut,
                      const std::function<bool(FaceId)>& is_reached,
                      const std::optional<Course>& course) {
    const Sides sides(mesh, front, touched, place_on_cut);
    Separation result{sides.separated_faces(), {}, {}};
    if (is_reached) std::erase_if(result.faces, [&](FaceId f) { return !is_reached(f); });
    const auto is_frozen_face = [&](FaceId f) { return is_frozen(mesh, front, f); };
    if (!course) {
        std::erase_if(result.faces, is_frozen_face);
        return result;
    }
    SliverFragments slivers(mesh, front, snap_history, sides, touched, result.faces, *course);
    slivers.keep();
    std::erase_if(result.faces, [&](FaceId f) { return is_frozen_face(f) || slivers.is_kept(f); });
    result.slivers = slivers.elements();
    result.waiting = slivers.waiting();
    return result;
}

}  // namespace incise::cutting
