// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/polyhedron_check.h"

#include <algorithm>
#include <compare>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/base/disjoint_set.h"

namespace incise::topology {

namespace {

constexpr std::int64_t least_faces = 4, least_corners = 3;

/// An edge as one face passes it.
struct FaceEdge {
    std::int64_t from, to;
    int face;
    auto operator<=>(const FaceEdge&) const = default;
};

}  // namespace

std::string fault_of_face_lists(const MeshData& data) {
    const auto& faces = data.faces;
    std::size_t at = 0;
    std::vector<std::int64_t> named, corners;
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        if (data.kinds[c] != CellKind::polyhedron) continue;
        const auto fault = [&](const auto&... parts) {
            std::ostringstream text;
            ((text << data.cell_name(c) << ' ') << ... << parts) << "; " << data.words.mend_faces;
            return text.str();
        };
        if (at == faces.size()) return fault("has no list of faces");
        const std::int64_t num_faces = faces[at++];
        if (num_faces < least_faces)
            return fault("has ", num_faces, " faces, and a polyhedron has ", least_faces,
                         " or more");
        named.clear();
        for (std::int64_t f = 0; f < num_faces; ++f) {
            if (at == faces.size()) return fault("lacks its face ", f, " of ", num_faces);
            const std::int64_t size = faces[at++];
            if (size < least_corners)
                return fault("has a face ", f, " of ", size, " corners, and a face has ",
                             least_corners, " or more");
            if (size > std::ssize(faces) - static_cast<std::int64_t>(at))
                return fault("has a face ", f, " of ", size,
                             " corners, of which the list of faces ends too early");
            const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(at);
            named.insert(named.end(), begin, begin + size);
            at += static_cast<std::size_t>(size);
        }
        corners.assign(data.cell(c).begin(), data.cell(c).end());
        for (auto* list : {&named, &corners}) {
            std::ranges::sort(*list);
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
        if (named != corners) return fault("has other corners than its faces");
    }
    if (at != faces.size())
        return "the faces of polyhedra are " + std::to_string(faces.size()) +
               " numbers, and the polyhedra use " + std::to_string(at) + "; " +
               data.words.mend_faces;
    return "";
}

std::string fault_of_polyhedron(const MeshData& data, const SourceFaces& faces, std::size_t c) {
    const auto fault = [&](const auto&... parts) {
        std::ostringstream text;
        ((text << data.cell_name(c) << ' ') << ... << parts) << "; " << data.words.mend_polyhedron;
        return text.str();
    };
    const auto name = [&](std::int64_t p) { return data.point_name(static_cast<std::size_t>(p)); };
    const int num_faces = faces.num_faces(c);
    std::vector<FaceEdge> edges;
    std::vector<std::int64_t> corners;
    for (int f = 0; f < num_faces; ++f) {
        const int size = faces.size({c, f});
        for (int p = 0; p < size; ++p) {
            edges.push_back({faces.point({c, f}, p), faces.point({c, f}, (p + 1) % size), f});
            corners.push_back(edges.back().from);
        }
        std::ranges::sort(corners);
        if (const auto twice = std::ranges::adjacent_find(corners); twice != corners.end())
            return fault("has a face ", f, " that meets ", name(*twice), " twice");
        corners.clear();
    }
    std::ranges::sort(edges);
    const auto passing = [&](std::int64_t from, std::int64_t to) {
        return std::ranges::equal_range(edges, std::pair(from, to), {}, [](const FaceEdge& edge) {
            return std::pair(edge.from, edge.to);
        });
    };
    DisjointSet joined(static_cast<std::size_t>(num_faces));
    int count = num_faces;
    for (const FaceEdge& edge : edges) {
        const auto along = passing(edge.from, edge.to), back = passing(edge.to, edge.from);
        if (along.size() > 1)
            return fault("has the faces ", along[0].face, " and ", along[1].face,
                         " that pass the edge from ", name(edge.from), " to ", name(edge.to),
                         " in the same direction");
        if (back.empty())
            return fault("is not closed: only its face ", edge.face, " has the edge from ",
                         name(edge.from), " to ", name(edge.to));
        if (joined.find(edge.face) != joined.find(back[0].face)) --count;
        joined.join(edge.face, back[0].face);
    }
    if (count > 1) return fault("has ", count, " sets of faces that do not hang together");
    // The faces at a corner follow each other round it. A corner with several rounds is where the
    // cell touches itself.
    for (auto first = edges.begin(); first != edges.end();) {
        auto end = first;
        while (end != edges.end() && end->from == first->from) ++end;
        const FaceEdge* at = &*first;
        std::ptrdiff_t round = 0;
        do {
            // The face on the other side of the edge leaves the point by its next edge.
            const FaceEdge& back = passing(at->to, at->from)[0];
            const int size = faces.size({c, back.face});
            int p = 0;
            while (faces.point({c, back.face}, p) != at->from) ++p;
            at = &passing(at->from, faces.point({c, back.face}, (p + 1) % size))[0];
            ++round;
        } while (at != &*first);
        if (round != end - first) return fault("touches itself at ", name(first->from));
        first = end;
        corners.push_back(at->from);
    }
    if (std::ssize(corners) - std::ssize(edges) / 2 + num_faces != 2)
        return fault("is no ball: it has ", corners.size(), " corners, ", edges.size() / 2,
                     " edges and ", num_faces,
                     " faces, and corners less edges plus faces must be 2");
    return "";
}

}  // namespace incise::topology
