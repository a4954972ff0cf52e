// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/validate.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "incise/base/disjoint_set.h"

namespace incise::topology {

namespace {

/// Returns what is wrong with a polyhedron; null if nothing is. A cut can leave one that is flat.
const char* fault_of_polyhedron(const Mesh& mesh, CellId e) {
    const CellShape shape = mesh.shape(e);
    std::vector<std::pair<VertexId, VertexId>> edges;
    for (int f = 0; f < shape.num_faces(); ++f) {
        const auto face = shape.face(f);
        for (std::size_t p = 0; p < face.size(); ++p)
            edges.emplace_back(face[p], face[(p + 1) % face.size()]);
    }
    std::ranges::sort(edges);
    if (std::ranges::adjacent_find(edges) != edges.end()) return "has two edges between two nodes";
    for (const auto& [a, b] : edges)
        if (!std::ranges::binary_search(edges, std::pair(b, a)))
            return "has an edge with one face only";
    if (std::ssize(mesh.corners(e)) - std::ssize(edges) / 2 + shape.num_faces() != 2)
        return "is no ball";
    Box box;
    for (const VertexId n : mesh.corners(e)) box.extend(mesh.rest_position(n));
    constexpr double flatness = 1e-4;  // of cells that a cut leaves beside nodes and faces
    if (!(rest_volume(mesh, e) >= -flatness * std::pow(box.diagonal().norm(), 3)))
        return "has a negative volume at rest";
    return nullptr;
}

}  // namespace

std::vector<std::string> validate(const Mesh& mesh) {
    std::vector<std::string> found;
    const auto report = [&](auto&&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        found.push_back(text.str());
    };

    std::size_t num_elements = 0;
    std::vector<std::vector<CellId>> holders(mesh.node_capacity());
    for (const CellId e : mesh.elements()) {
        ++num_elements;
        const auto corners = mesh.corners(e);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            if (!mesh.is_alive(corners[k]))
                report("element ", e.value, " has the dead node ", corners[k].value);
            if (std::count(corners.begin(), corners.end(), corners[k]) != 1)
                report("element ", e.value, " has node ", corners[k].value, " twice");
            holders[corners[k].index()].push_back(e);
        }
        if (mesh.is_polyhedron(e)) {
            if (const char* fault = fault_of_polyhedron(mesh, e))
                report("polyhedron ", e.value, " ", fault);
        } else if (!(rest_volume(mesh, e) > 0.0)) {
            report("element ", e.value, " has no positive volume at rest");
        }
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh.neighbor(face);
            if (!other.is_valid()) continue;
            if (!mesh.was_inside(face))
                report("element ", e.value, " has a joined face that was never inside");
            if (!mesh.is_alive(other.cell))
                report("element ", e.value, " has the dead neighbour ", other.cell.value);
            else if (mesh.neighbor(other) != face)
                report("element ", e.value, " is unknown to its neighbour ", other.cell.value);
            else if (matching_shift(mesh, face, other) < 0)
                report("elements ", e.value, " and ", other.cell.value, " disagree on their face");
        }
    }
    if (num_elements != mesh.num_elements())
        report("there are ", num_elements, " elements, counted as ", mesh.num_elements());

    std::size_t num_nodes = 0;
    std::vector<CellId> star;
    for (std::size_t i = 0; i < mesh.node_capacity(); ++i) {
        const VertexId n(i);
        if (!mesh.is_alive(n)) {
            if (!holders[i].empty()) report("the dead node ", i, " has elements");
            continue;
        }
        ++num_nodes;
        mesh.star(n, star);
        if (star != holders[i])
            report("the elements of node ", i, " do not hang together through faces at it");
        else if (star.front() != mesh.incident_element(n))
            report("the incident element of node ", i, " is not its lowest one");
    }
    if (num_nodes != mesh.num_nodes())
        report("there are ", num_nodes, " nodes, counted as ", mesh.num_nodes());
    return found;
}

}  // namespace incise::topology
