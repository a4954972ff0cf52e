// SPDX-License-Identifier: LGPL-3.0-or-later
#include "topology/change_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "topology/error.h"

namespace incise::topology {

namespace {

[[noreturn]] void refuse(const std::string& why) { throw InputError("an edit in it " + why); }
void require(bool holds, const std::string& why) {
    if (!holds) refuse(why);
}

std::string name_of(ElementId e) { return "element " + std::to_string(e.value); }
std::string name_of(NodeId n) { return "node " + std::to_string(n.value); }

class ChangeCheck {
  public:
    ChangeCheck(const ChangeSet& changes, const Mesh& mesh) : changes_(changes), mesh_(mesh) {}

    void run() {
        check_capacities();
        for (std::size_t i = 0; i < changes_.nodes_added.size(); ++i) check_added_node(i);
        for (const NodeRecord& record : changes_.nodes_removed) check_removed(record);
        for (const ElementRecord& record : changes_.elements_removed) check_removed(record);
        for (const FacePair& pair : changes_.faces_opened) check_opened(pair);
        for (const ElementRecord& record : changes_.elements_removed) check_freed(record.id);
        for (std::size_t i = 0; i < changes_.elements_added.size(); ++i) check_added_element(i);
        for (const Rewiring& rewiring : changes_.rewired) check_rewired(rewiring);
        for (const FacePair& pair : changes_.faces_closed) check_closed(pair);
        for (const auto& [e, corners] : rewired_) check_joins_kept(e);
    }

  private:
    void check_capacities() const {
        require(changes_.epoch_before == mesh_.epoch() &&
                    changes_.epoch_after == changes_.epoch_before + 1,
                "is out of turn");
        require(changes_.node_capacity_before == mesh_.node_capacity() &&
                    changes_.element_capacity_before == mesh_.element_capacity() &&
                    changes_.node_capacity_after ==
                        mesh_.node_capacity() + changes_.nodes_added.size() &&
                    changes_.element_capacity_after ==
                        mesh_.element_capacity() + changes_.elements_added.size(),
                "has other numbers of nodes or elements than the body");
    }

    void require_node(NodeId n) const {
        require(n.is_valid() && n.index() < changes_.node_capacity_after,
                "names " + name_of(n) + ", which is not there");
    }
    bool is_old(ElementId e) const { return e.is_valid() && e.index() < mesh_.element_capacity(); }
    void require_old(ElementId e) const {
        require(is_old(e) && mesh_.is_alive(e) && !removed_.contains(e),
                "names " + name_of(e) + ", which is not there");
    }

    void check_sources(const NodeRecord& record, int most) const {
        require(record.num_sources >= 0 && record.num_sources <= most,
                "has " + name_of(record.id) + " with " + std::to_string(record.num_sources) +
                    " sources");
        for (int s = 0; s < record.num_sources; ++s) {
            const NodeSource& source = record.sources[static_cast<std::size_t>(s)];
            require_node(source.node);
            require(std::isfinite(source.weight), "has a weight that is not finite");
        }
    }

    void check_added_node(std::size_t i) const {
        const NodeRecord& record = changes_.nodes_added[i];
        require(record.id == NodeId(changes_.node_capacity_before + i),
                "adds " + name_of(record.id) + " out of turn");
        require(record.rest_position.allFinite(),
                "adds " + name_of(record.id) + " at a place that is not finite");
        check_sources(record, static_cast<int>(record.sources.size()));
        require(record.num_sources > 0, "adds " + name_of(record.id) + " without a source");
        for (int s = 0; s < record.num_sources; ++s)
            require(record.sources[static_cast<std::size_t>(s)].node < record.id,
                    "adds " + name_of(record.id) + " before its source");
    }

    void check_removed(const NodeRecord& record) const {
        require_node(record.id);
        check_sources(record, 1);
    }

    void check_removed(const ElementRecord& record) {
        require_old(record.id);
        const auto corners = mesh_.corners(record.id);
        require(record.region == mesh_.region(record.id) && record.kind == mesh_.kind(record.id) &&
                    std::ranges::equal(record.corners, corners) && !record.parent.is_valid(),
                "removes " + name_of(record.id) + " as another one");
        removed_.insert(record.id);
    }

    void check_opened(const FacePair& pair) {
        const bool is_there = is_old(pair.a.element) && mesh_.is_alive(pair.a.element) &&
                              pair.a.face >= 0 && pair.a.face < mesh_.num_faces(pair.a.element) &&
                              pair.b.is_valid() && mesh_.neighbor(pair.a) == pair.b;
        require(is_there, "opens a face of " + name_of(pair.a.element) + " that is not joined so");
        const bool is_new =
            opened_.insert(key(pair.a)).second && opened_.insert(key(pair.b)).second;
        require(is_new, "opens a face of " + name_of(pair.a.element) + " twice");
    }

    void check_freed(ElementId e) const {
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            require(!mesh_.neighbor({e, f}).is_valid() || opened_.contains(key({e, f})),
                    "removes " + name_of(e) + " while it is joined");
    }

    void check_added_element(std::size_t i) const {
        const ElementRecord& record = changes_.elements_added[i];
        const ElementId e = record.id, parent = record.parent;
        require(
            e == ElementId(changes_.element_capacity_before + i) && parent.is_valid() && parent < e,
            "adds " + name_of(e) + " out of turn");
        const auto [kind, region] = [&]() -> std::pair<CellKind, int> {
            if (is_old(parent)) return {mesh_.kind(parent), mesh_.region(parent)};
            const ElementRecord& of = added(parent);
            return {of.kind, of.region};
        }();
        require(record.kind == kind && record.region == region &&
                    record.corners.size() == static_cast<std::size_t>(traits(kind).num_corners),
                "adds " + name_of(e) + " unlike the one that it is a part of");
        for (const NodeId n : record.corners) require_node(n);
    }

    void check_rewired(const Rewiring& rewiring) {
        const ElementId e = rewiring.element;
        require_old(e);
        auto place = rewired_.find(e);
        if (place == rewired_.end()) {
            const auto corners = mesh_.corners(e);
            place = rewired_.emplace(e, std::vector(corners.begin(), corners.end())).first;
        }
        auto& corners = place->second;
        const auto corner = static_cast<std::size_t>(rewiring.corner);
        require(rewiring.corner >= 0 && corner < corners.size() && corners[corner] == rewiring.from,
                "moves a corner of " + name_of(e) + " that it has not");
        require_node(rewiring.to);
        corners[corner] = rewiring.to;
    }

    void check_closed(const FacePair& pair) {
        for (const FaceId f : {pair.a, pair.b}) {
            const bool is_added = f.element.is_valid() && !is_old(f.element) &&
                                  f.element.index() < changes_.element_capacity_after;
            if (!is_added) require_old(f.element);
            require(f.face >= 0 && f.face < traits(kind_of(f.element)).num_faces,
                    "joins a face that " + name_of(f.element) + " has not");
            const bool is_free =
                is_added || !mesh_.neighbor(f).is_valid() || opened_.contains(key(f));
            require(is_free && closed_.insert(key(f)).second,
                    "joins a face of " + name_of(f.element) + " that is joined already");
        }
        require_same_nodes(pair.a, pair.b);
    }

    /// Faces of an element with other corners that stay joined.
    void check_joins_kept(ElementId e) const {
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (other.is_valid() && !opened_.contains(key(face))) require_same_nodes(face, other);
        }
    }

    void require_same_nodes(FaceId a, FaceId b) const {
        const auto at = [&](FaceId f) {
            std::vector<NodeId> nodes;
            const auto corners = corners_after(f.element);
            for (const int corner : traits(kind_of(f.element)).face(f.face))
                nodes.push_back(corners[static_cast<std::size_t>(corner)]);
            return nodes;
        };
        auto one = at(a);
        const auto other = at(b);
        std::reverse(one.begin(), one.end());  // as seen from the other side
        bool fits = false;
        for (std::size_t i = 0; i < one.size() && !fits; ++i) {
            fits = one == other;
            std::rotate(one.begin(), one.begin() + 1, one.end());
        }
        require(fits, "joins " + name_of(a.element) + " and " + name_of(b.element) +
                          " by faces with different nodes");
    }

    const ElementRecord& added(ElementId e) const {
        return changes_.elements_added[e.index() - mesh_.element_capacity()];
    }
    CellKind kind_of(ElementId e) const { return is_old(e) ? mesh_.kind(e) : added(e).kind; }
    std::span<const NodeId> corners_after(ElementId e) const {
        if (!is_old(e)) return added(e).corners;
        const auto place = rewired_.find(e);
        return place == rewired_.end() ? mesh_.corners(e) : std::span<const NodeId>(place->second);
    }
    static std::int64_t key(FaceId f) { return std::int64_t{f.element.value} * max_faces + f.face; }

    const ChangeSet& changes_;
    const Mesh& mesh_;
    std::unordered_set<ElementId> removed_;                       // elements
    std::unordered_set<std::int64_t> opened_, closed_;            // faces, both sides of each
    std::unordered_map<ElementId, std::vector<NodeId>> rewired_;  // their corners afterwards
};

}  // namespace

void require_fit(const ChangeSet& changes, const Mesh& mesh) { ChangeCheck(changes, mesh).run(); }

}  // namespace incise::topology
