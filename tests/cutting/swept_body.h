// A body that is moved and swept by a blade, and what is asked of it afterwards.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "incise/cutting/exact/cut_plan.h"
#include "incise/cutting/tools/separator.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"

namespace incise::cutting {

using topology::ChangeSet;
using topology::Mesh;

using Polyline = std::vector<Vec3>;

/// A mesh whose nodes are moved about, and cut.
class Body {
  public:
    explicit Body(const topology::MeshData& data)
        : mesh(Mesh::build(data).mesh),
          positions(mesh.rest_positions().begin(), mesh.rest_positions().end()) {}

    /// The blade goes from `before` to `after` while the nodes go to `moved`.
    ChangeSet step(const Polyline& before, const Polyline& after, const std::vector<Vec3>& moved) {
        CutPlan plan;
        plan.faces_to_open = faces_to_open({mesh, positions, moved}, before, after);
        positions = moved;
        const ChangeSet changes = execute(plan, mesh);
        // Each face once, from its lower side, and all of them.
        EXPECT_EQ(plan.faces_to_open.size(), changes.faces_opened.size());
        for (std::size_t i = 0; i < changes.faces_opened.size(); ++i)
            EXPECT_EQ(plan.faces_to_open[i], changes.faces_opened[i].a);
        for (const auto& record : changes.nodes_added) {
            EXPECT_EQ(record.num_sources, 1);
            positions.push_back(positions[record.sources[0].node.index()]);
        }
        if (!changes.is_empty()) {
            EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
            // Nodes are divided only where faces opened at them.
            std::set<VertexId> at_opened;
            for (const auto& pair : changes.faces_opened)
                for (const FaceId f : {pair.a, pair.b})
                    for (int p = 0; p < mesh.face_size(f); ++p)
                        at_opened.insert(mesh.face_corner(f, p));
            for (const auto& record : changes.nodes_added)
                EXPECT_TRUE(at_opened.contains(record.id));
        }
        opened.insert(changes.faces_opened.begin(), changes.faces_opened.end());
        return changes;
    }
    ChangeSet step(const Polyline& before, const Polyline& after) {
        return step(before, after, positions);
    }

    /// In `num_steps` equal steps, the tissue still.
    void sweep(const Polyline& from, const Polyline& to, int num_steps) {
        const auto at = [&](int i) {
            Polyline edge;
            for (std::size_t k = 0; k < from.size(); ++k)
                edge.push_back(from[k] + i * (to[k] - from[k]) / num_steps);
            return edge;
        };
        for (int i = 0; i < num_steps; ++i) step(at(i), at(i + 1));
    }

    Vec3 centre(CellId e) const { return TissueMotion::centre(mesh, e, positions); }
    Vec3 centre(FaceId f) const {
        Vec3 sum = Vec3::Zero();
        for (int p = 0; p < mesh.face_size(f); ++p)
            sum += positions[mesh.face_corner(f, p).index()];
        return sum / mesh.face_size(f);
    }
    Eigen::AlignedBox3d box() const {
        Eigen::AlignedBox3d b;
        for (const Vec3& x : positions) b.extend(x);
        return b;
    }
    double largest_element() const {
        double size = 0.0;
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e)
            for (const VertexId a : mesh.corners(CellId(e)))
                for (const VertexId b : mesh.corners(CellId(e)))
                    size = std::max(size, (positions[a.index()] - positions[b.index()]).norm());
        return size;
    }
    std::vector<topology::FacePair> inner_faces() const {
        std::vector<topology::FacePair> faces;
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e)
            for (int f = 0; f < mesh.num_faces(CellId(e)); ++f) {
                const FaceId face{CellId(e), f}, other = mesh.neighbor(face);
                if (face < other) faces.push_back({face, other});
            }
        return faces;
    }

    Mesh mesh;
    std::vector<Vec3> positions;
    std::set<topology::FacePair> opened;
};

/// A plane, and in it a rectangle about `point` that reaches by `reach` to all sides.
struct BladePlane {
    Vec3 point, normal, u, v;

    BladePlane(const Vec3& p, const Vec3& n) : point(p), normal(n.normalized()) {
        u = normal.unitOrthogonal();
        v = normal.cross(u);
    }
    double height(const Vec3& x) const { return (x - point).dot(normal); }
    Polyline edge(double reach, double along) const {
        return {point - reach * u + along * v, point + reach * u + along * v};
    }
};

/// Whether the element hangs on the body by one face only.
inline bool is_leaf(const Mesh& mesh, CellId e) {
    int num_joined = 0;
    for (int f = 0; f < mesh.num_faces(e); ++f) num_joined += mesh.neighbor({e, f}).is_valid();
    return num_joined == 1;
}
inline bool has_leaf(const Mesh& mesh, const topology::FacePair& pair) {
    return is_leaf(mesh, pair.a.cell) || is_leaf(mesh, pair.b.cell);
}

/// Pieces of more than `size` elements. Two elements at the boundary that have only each other on
/// their side of the cut come off together.
inline long num_pieces_above(const Mesh& mesh, long size) {
    const auto pieces = topology::components(mesh);
    long count = 0;
    for (int piece = 0; piece < pieces.count; ++piece)
        count += std::count(pieces.of_element.begin(), pieces.of_element.end(), piece) > size;
    return count;
}

/// Every opened face lies between two pieces, or beside an element that hangs by one face: the body
/// is parted wherever it was opened.
inline void expect_parted_cleanly(const Body& body) {
    const auto pieces = topology::components(body.mesh);
    for (const auto& pair : body.opened)
        EXPECT_TRUE(pieces.of_element[pair.a.cell.index()] !=
                        pieces.of_element[pair.b.cell.index()] ||
                    has_leaf(body.mesh, pair));
}

inline bool is_convex(const std::string& family) {
    return family == "cube" || family == "ball" || family == "hexahedra" || family == "organ";
}

}  // namespace incise::cutting
