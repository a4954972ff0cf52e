// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/exact_plane.h"

#include <cmath>
#include <unordered_map>
#include <vector>

#include "incise/topology/mesh_edit.h"

namespace incise::test {

using topology::Mesh;

topology::ChangeSet cut_along_plane(Mesh& mesh, const Vec3& point, const Vec3& normal,
                                    const std::function<bool(const Vec3&)>& open) {
    topology::MeshEdit edit(mesh);
    // Nodes made on the plane are at distance 0, whatever rounding says.
    std::unordered_map<VertexId, double> on_plane;
    const auto distance = [&](VertexId n) {
        if (const auto it = on_plane.find(n); it != on_plane.end()) return it->second;
        return (mesh.rest_position(n) - point).dot(normal.normalized());
    };
    for (std::size_t i = 0; i < mesh.element_capacity();) {
        const CellId e(i);
        bool is_divided = false;
        if (mesh.is_alive(e) && mesh.kind(e) == topology::CellKind::tetrahedron) {
            const auto corners = mesh.corners(e);
            const std::vector<VertexId> nodes(corners.begin(), corners.end());
            for (std::size_t a = 0; a < nodes.size() && !is_divided; ++a)
                for (std::size_t b = 0; b < a && !is_divided; ++b) {
                    const double da = distance(nodes[a]), db = distance(nodes[b]);
                    if (!(da * db < 0.0)) continue;
                    on_plane[edit.bisect(e, nodes[a], nodes[b], da / (da - db)).node] = 0.0;
                    is_divided = true;
                }
        }
        if (!is_divided) ++i;  // else the kept half may have further crossed edges
    }
    const auto side = [&](CellId e) {
        double sum = 0.0;
        for (const VertexId n : mesh.corners(e)) sum += distance(n);
        return sum > 0.0;
    };
    std::vector<FaceId> faces;
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh.neighbor(face);
            if (!other.is_valid() || !(face < other) || side(e) == side(other.cell)) continue;
            Vec3 centre = Vec3::Zero();
            bool is_on = true;
            for (int p = 0; p < mesh.face_size(face); ++p) {
                is_on = is_on && distance(mesh.face_corner(face, p)) == 0.0;
                centre += mesh.rest_position(mesh.face_corner(face, p));
            }
            if (is_on && open(centre / mesh.face_size(face))) faces.push_back(face);
        }
    for (const FaceId face : faces) edit.open(face);
    return edit.commit();
}

}  // namespace incise::test
