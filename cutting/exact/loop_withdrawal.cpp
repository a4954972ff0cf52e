// How a blade leaves a cut that ends inside the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "incise/cutting/exact/loop_front.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// Which of some things are on the same side of a surface.
class EdgeSides {
  public:
    void add() {
        parents_.push_back(parents_.size());
        is_other_.push_back(false);
    }
    /// Notes that two of them are on the same side, or not. What contradicts it is passed over.
    void relate(std::size_t i, std::size_t j, bool is_other_side) {
        const auto [a, other_a] = find(i);
        const auto [b, other_b] = find(j);
        if (a == b) return;
        parents_[std::max(a, b)] = std::min(a, b);
        is_other_[std::max(a, b)] = is_other_side != (other_a != other_b);
    }
    /// True if it is not on the side of the first one that it is related to.
    bool is_other(std::size_t i) const { return find(i).second; }

  private:
    std::pair<std::size_t, bool> find(std::size_t i) const {
        bool is_other = false;
        for (; parents_[i] != i; i = parents_[i]) is_other ^= is_other_[i];
        return {i, is_other};
    }

    std::vector<std::size_t> parents_;
    std::vector<bool> is_other_;  // than that of the parent
};

}  // namespace

/// The rest of the cut is pushed off its nodes, to one side. So the edges there are passed that are
/// on this side. Two edges at a node are on different sides where the cut goes through the corner
/// between them: where the node waits in the face. It may go along edges of the face, too.
void LoopFront::draw_back(const Mesh& mesh) {
    std::vector<VertexId> nodes;
    for (const auto& entry : nodes_)
        if (mesh.is_alive(entry.first)) nodes.push_back(entry.first);
    std::ranges::sort(nodes);
    std::map<std::pair<VertexId, VertexId>, std::size_t> numbers;  // of edges at nodes on the cut
    EdgeSides sides;
    const auto number = [&](VertexId n, VertexId end) {
        const auto [it, is_new] = numbers.try_emplace({n, end}, numbers.size());
        if (is_new) sides.add();
        return it->second;
    };
    // In a face, from an edge to the first node, along the cut, to the edge that leaves it again.
    const auto relate_in = [&](FaceId f, int p) {
        const int size = mesh.face_size(f);
        const auto at = [&](int q) { return mesh.face_corner(f, (q + size) % size); };
        const auto is_on_cut = [&](VertexId n, VertexId next) {
            return is_on(n) && is_on(next) && is_marked(n, next);
        };
        if (is_on_cut(at(p - 1), at(p))) return;
        bool is_other_side = passed_at(at(p - 1), at(p)).is_valid();
        for (int q = p; q < p + size; ++q) {
            is_other_side ^= waits(mesh, f, at(q));
            is_other_side ^= passed_at(at(q), at(q + 1)).is_valid();
            if (is_on_cut(at(q), at(q + 1))) continue;
            sides.relate(number(at(p), at(p - 1)), number(at(q), at(q + 1)), is_other_side);
            return;
        }
    };
    std::vector<CellId> star;
    for (const VertexId n : nodes) {
        mesh.star(n, star);
        for (const CellId e : star)
            for (int k = 0; k < mesh.num_faces(e); ++k) {
                const FaceId f{e, k}, other = mesh.neighbor(f);
                if (other.is_valid() && other < f) continue;
                for (int p = 0; p < mesh.face_size(f); ++p)
                    if (mesh.face_corner(f, p) == n) relate_in(f, p);
            }
    }
    is_drawn_back_ = has_moved_ = false;
    for (auto& [n, node] : nodes_) node.place = Node().place;
    for (const auto& [edge, i] : numbers) {
        if (!sides.is_other(i)) continue;
        is_drawn_back_ = true;
        const auto [n, end] = edge;
        toggle_passed(passed_at(n, end) == end ? PassedEdge{end, n} : PassedEdge{n, end});
    }
}

void LoopFront::follow_motion(std::span<const Vec3> positions) {
    constexpr double share = 1e-3;
    if (!is_drawn_back_ || has_moved_) return;
    for (auto& [n, node] : nodes_) {
        const Vec3& x = positions[n.index()];
        if (!node.place.allFinite()) node.place = x;
        has_moved_ |= (x - node.place).norm() > share * node.local_edge_length;
    }
}

}  // namespace incise::cutting
