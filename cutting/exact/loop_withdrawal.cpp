// How a blade leaves a cut that ends inside the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "incise/cutting/exact/loop_front.h"
#include "incise/cutting/exact/side_sets.h"

namespace incise::cutting {

using topology::Mesh;

/// The rest of the cut is pushed off its nodes, to one side. So the edges there are passed that are
/// on this side. Two edges at a node are on different sides where the cut goes through the corner
/// between them: where the node waits in the face. It may go along edges of the face, too.
void LoopFront::draw_back(const Mesh& mesh) {
    std::vector<VertexId> nodes;
    for (const auto& entry : nodes_)
        if (mesh.is_alive(entry.first)) nodes.push_back(entry.first);
    std::ranges::sort(nodes);
    std::map<std::pair<VertexId, VertexId>, std::size_t> numbers;  // of edges at nodes on the cut
    SideSets sides;
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
            return is_on(n) && is_on(next) && lies_on(n, next);
        };
        if (is_on_cut(at(p - 1), at(p))) return;
        // An edge that is not on the cut may be passed at its other end, too: that is not here.
        bool is_other_side = passed_at(at(p - 1), at(p)) == at(p);
        for (int q = p; q < p + size; ++q) {
            is_other_side ^= waits(f, at(q));
            const VertexId passed = passed_at(at(q), at(q + 1));
            if (is_on_cut(at(q), at(q + 1))) {
                is_other_side ^= passed.is_valid();
                continue;
            }
            is_other_side ^= passed == at(q);
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
    for (const auto& [edge, i] : numbers) {
        if (!sides.is_other(i)) continue;
        const auto [n, end] = edge;
        toggle_passed({n, end});
    }
}

}  // namespace incise::cutting
