// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/selection.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "incise/base/error.h"

namespace incise::sim {

using topology::Mesh;

namespace {

bool is_in_regions(const Mesh& mesh, const Selection& where, CellId e) {
    return !where.regions ||
           std::binary_search(where.regions->begin(), where.regions->end(), mesh.region(e));
}

/// Returns `where` without its regions. Elements and faces belong to one region each and are tested
/// for it themselves; nodes may belong to several.
Selection without_regions(Selection where) {
    where.regions.reset();
    return where;
}

/// Throws InputError for a box, ball or half space that is not finite, with which nothing would be
/// selected.
void require_finite(const Selection& where) {
    const auto require = [](bool is_finite, const char* what) {
        if (!is_finite)
            throw InputError(std::string("the ") + what + " of the selection is not finite");
    };
    if (where.box) require(where.box->min.allFinite() && where.box->max.allFinite(), "box");
    if (where.sphere)
        require(where.sphere->center.allFinite() && std::isfinite(where.sphere->radius), "ball");
    if (where.half_space)
        require(where.half_space->point.allFinite() && where.half_space->normal.allFinite(),
                "half space");
}

/// Returns, by node id, whether the node is alive and selected.
std::vector<char> selected(const Mesh& mesh, const Selection& where) {
    require_finite(where);
    std::vector<char> in_regions(mesh.node_capacity(), !where.regions.has_value());
    if (where.regions)
        for (const CellId e : mesh.elements())
            if (is_in_regions(mesh, where, e))
                for (const VertexId n : mesh.corners(e)) in_regions[n.index()] = 1;
    std::vector<char> on_surface(mesh.node_capacity(), !where.surface);
    if (where.surface)
        for (const FaceId f : topology::boundary_faces(mesh))
            for (int p = 0; p < mesh.face_size(f); ++p)
                on_surface[mesh.face_corner(f, p).index()] = 1;

    // A pinched point has several nodes. All of them have the number of the point.
    std::vector<char> is_named(mesh.node_capacity(), !where.nodes);
    if (where.nodes)
        for (const std::int64_t label : *where.nodes) {
            const auto named = mesh.nodes_with_label(label);
            if (std::none_of(named.begin(), named.end(),
                             [&](VertexId n) { return mesh.is_alive(n); }))
                throw InputError(
                    "the selection names node " + std::to_string(label) +
                    ", which no element has; the nodes of the mesh are numbered from 0 to " +
                    std::to_string(mesh.num_source_points() - 1));
            for (const VertexId n : named) is_named[n.index()] = 1;
        }

    std::vector<char> result(mesh.node_capacity(), 0);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const VertexId n(i);
        if (!mesh.is_alive(n)) continue;
        const Vec3& x = mesh.rest_position(n);
        bool is_in = in_regions[i] && on_surface[i] && is_named[i];
        if (where.box)
            is_in = is_in && (x.array() >= where.box->min.array()).all() &&
                    (x.array() <= where.box->max.array()).all();
        if (where.sphere)
            is_in = is_in && (x - where.sphere->center).norm() <= where.sphere->radius;
        if (where.half_space)
            is_in = is_in && (x - where.half_space->point).dot(where.half_space->normal) >= 0.0;
        result[i] = is_in;
    }
    return result;
}

}  // namespace

std::vector<VertexId> select_nodes(const Mesh& mesh, const Selection& where) {
    const auto is_in = selected(mesh, where);
    std::vector<VertexId> nodes;
    for (std::size_t i = 0; i < is_in.size(); ++i)
        if (is_in[i]) nodes.emplace_back(i);
    return nodes;
}

std::vector<FaceId> select_faces(const Mesh& mesh, const Selection& where) {
    const auto is_in = selected(mesh, without_regions(where));
    std::vector<FaceId> faces = topology::boundary_faces(mesh);
    std::erase_if(faces, [&](FaceId f) {
        if (!is_in_regions(mesh, where, f.cell)) return true;
        for (int p = 0; p < mesh.face_size(f); ++p)
            if (!is_in[mesh.face_corner(f, p).index()]) return true;
        return false;
    });
    return faces;
}

std::vector<CellId> select_elements(const Mesh& mesh, const Selection& where) {
    const auto is_in = selected(mesh, without_regions(where));
    std::vector<CellId> elements;
    for (const CellId e : mesh.elements()) {
        if (!is_in_regions(mesh, where, e)) continue;
        const auto corners = mesh.corners(e);
        if (std::all_of(corners.begin(), corners.end(),
                        [&](VertexId n) { return is_in[n.index()]; }))
            elements.push_back(e);
    }
    return elements;
}

void require_selected(std::size_t count, const Mesh& mesh, const std::string& what,
                      const std::string& things) {
    if (count > 0) return;
    Eigen::AlignedBox3d box;
    for (const VertexId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    const Eigen::IOFormat list(6, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
    std::ostringstream text;
    text << what << " selects no " << things << "; the mesh lies between "
         << box.min().transpose().format(list) << " and " << box.max().transpose().format(list);
    throw InputError(text.str());
}

}  // namespace incise::sim
