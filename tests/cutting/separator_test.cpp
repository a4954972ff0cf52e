// What a blade opens in tissue that is still, against plain geometry.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/separator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/topology/box_mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "swept_body.h"

namespace incise::cutting {
namespace {

using test::Random;

TEST(Separator, ASweepRightThroughPartsAlongThePlane) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < test::num_cases(12); ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            Body body(family.data);
            const auto box = body.box();
            const double size = box.diagonal().norm();
            const BladePlane plane(box.center() + random.vector(0.1 * size), random.vector(1));
            std::vector<bool> above;
            for (std::size_t e = 0; e < body.mesh.element_capacity(); ++e)
                above.push_back(plane.height(body.centre(CellId(e))) > 0.0);
            const auto side = [&](CellId e) -> bool { return above[e.index()]; };
            const auto faces = body.inner_faces();
            body.step(plane.edge(2 * size, -2 * size), plane.edge(2 * size, 2 * size));

            // Only faces between the sides, and all of them, but for those that single elements of
            // the one side hang on the other by.
            for (const auto& pair : faces) {
                const bool is_between = side(pair.a.cell) != side(pair.b.cell);
                if (body.opened.contains(pair)) {
                    EXPECT_TRUE(is_between);
                } else if (is_between) {
                    EXPECT_TRUE(has_leaf(body.mesh, pair));
                }
            }
            if (is_convex(family.name)) {
                EXPECT_EQ(num_pieces_above(body.mesh, 2), 2);
            }
            expect_parted_cleanly(body);
            const auto once = body.opened;
            body.step(plane.edge(2 * size, 2 * size), plane.edge(2 * size, -2 * size));
            EXPECT_EQ(body.opened, once);  // the way back opens nothing
        }
    }
}

// Its faces have any number of corners.
TEST(Separator, ASweepPartsWhatWasSplitBefore) {
    using test::Bricks;
    int most_corners = 0;
    for (const auto bricks :
         {Bricks::hexahedra, Bricks::wedges, Bricks::pyramids, Bricks::mixed, Bricks::joined})
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(testing::Message()
                         << "bricks " << static_cast<int>(bricks) << ", seed " << seed);
            Random random(seed);
            Body body(test::brick_cube(bricks, 3, 0.1, seed));
            std::vector<RestTool> planes(2);
            for (RestTool& plane : planes)
                plane.kind = PlaneCut{Vec3::Constant(0.5) + random.vector(0.2), random.vector(1.0)};
            cut_at_rest(body.mesh, planes, CutMode::split);
            body.positions.assign(body.mesh.rest_positions().begin(),
                                  body.mesh.rest_positions().end());
            const BladePlane plane(Vec3::Constant(0.5) + random.vector(0.2), random.vector(1));
            const auto side = [&](CellId e) { return plane.height(body.centre(e)) > 0.0; };
            const auto faces = body.inner_faces();
            for (const auto& pair : faces)
                most_corners = std::max(most_corners, body.mesh.face_size(pair.a));
            std::vector<bool> is_between;
            for (const auto& pair : faces)
                is_between.push_back(side(pair.a.cell) != side(pair.b.cell));
            body.step(plane.edge(4.0, -4.0), plane.edge(4.0, 4.0));
            for (std::size_t i = 0; i < faces.size(); ++i) {
                const bool is_open = body.opened.contains(faces[i]);
                EXPECT_TRUE(is_open == is_between[i] ||
                            (!is_open && has_leaf(body.mesh, faces[i])));
            }
        }
    EXPECT_GT(most_corners, 4);
}

TEST(Separator, PlanesThroughNodesAndCentresPartAsWell) {
    // On the grid of a regular mesh, where everything touches everything: what lies on the plane
    // counts as shifted by a hair along x, then y, then z.
    constexpr int n = 4;
    const std::array<Vec3, 8> normals{{{2, 1, -1},
                                       {1, 0, 0},
                                       {0, 1, 0},
                                       {0, 0, -1},
                                       {1, 1, 0},
                                       {1, -1, 0},
                                       {0, 1, -1},
                                       {1, 1, 1}}};
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron})
        for (const Vec3& normal : test::some_of(normals))
            for (const double offset : {0.0, 0.25, 0.5, 1.0})
                for (const int num_steps : {1, test::num_cases(8)}) {
                    SCOPED_TRACE(testing::Message() << normal.transpose() << ", " << offset << ", "
                                                    << num_steps << " steps");
                    Body body(topology::box_mesh(kind, {0, 0, 0}, {n, n, n}, {n, n, n}));
                    // All numbers are small fractions of two: nothing is rounded.
                    const Vec3 u = normal.cross(normal.x() != 0 ? Vec3(0, 0, 1) : Vec3(1, 0, 0));
                    const Vec3 v = normal.cross(u);
                    const Vec3 point = Vec3::Constant(n / 2) + Vec3(offset, 0, 0) +
                                       (normal.x() == 0.0 ? offset : 0.0) * Vec3(0, 1, -1);
                    const auto edge = [&](double along) -> Polyline {
                        return {point - 32 * u + along * v, point + 32 * u + along * v};
                    };
                    std::vector<bool> above;
                    for (std::size_t e = 0; e < body.mesh.element_capacity(); ++e) {
                        double height = (body.centre(CellId(e)) - point).dot(normal);
                        for (const double shifted : {normal.x(), normal.y(), normal.z()})
                            if (height == 0.0) height = shifted;
                        above.push_back(height > 0.0);
                    }
                    body.sweep(edge(-32), edge(32), num_steps);

                    const auto pieces = topology::components(body.mesh);
                    std::array<std::set<int>, 2> of_side;
                    for (std::size_t e = 0; e < above.size(); ++e)
                        of_side[above[e]].insert(pieces.of_element[e]);
                    EXPECT_EQ(of_side[0].size(), 1u);
                    EXPECT_EQ(of_side[1].size(), 1u);
                    EXPECT_NE(of_side[0], of_side[1]);
                }
}

/// Where the path of a face passes it: on the straight line between the centres if that pierces
/// the triangle, else at its centre.
Vec3 intersection(const Body& body, const topology::FacePair& pair) {
    const Mesh& mesh = body.mesh;
    if (mesh.face_size(pair.a) != 3) return body.centre(pair.a);
    const auto at = [&](int p) -> Vec3 { return mesh.rest_position(mesh.face_corner(pair.a, p)); };
    const Vec3 from = body.centre(pair.a.cell), to = body.centre(pair.b.cell);
    Eigen::Matrix3d system;
    system << at(1) - at(0), at(2) - at(0), from - to;
    const Vec3 solution = system.inverse() * (from - at(0));  // not finite if it is in the plane
    const double s = solution[0], t = solution[1];
    if (!(s > 0.0 && t > 0.0 && s + t < 1.0)) return body.centre(pair.a);
    return at(0) + s * (at(1) - at(0)) + t * (at(2) - at(0));
}

/// How often the path of a face, from centre to centre, passes through the rectangle of `plane`
/// over |along u| < reach, from < along v < to; by rounded arithmetic, in tissue at rest.
int crossings(const Body& body, const topology::FacePair& pair, const BladePlane& plane,
              double reach, double from, double to) {
    const Vec3 middle = intersection(body, pair);
    int count = 0;
    for (const Vec3& end : {body.centre(pair.a.cell), body.centre(pair.b.cell)}) {
        const double h0 = plane.height(end), h1 = plane.height(middle);
        if ((h0 > 0.0) == (h1 > 0.0)) continue;
        const Vec3 x = end + h0 / (h0 - h1) * (middle - end) - plane.point;
        count += std::abs(x.dot(plane.u)) < reach && x.dot(plane.v) > from && x.dot(plane.v) < to;
    }
    return count;
}

/// The piece with the most elements.
int largest_piece(const topology::Components& pieces) {
    std::vector<int> sizes(static_cast<std::size_t>(pieces.count), 0);
    for (const int piece : pieces.of_element) ++sizes[static_cast<std::size_t>(piece)];
    return static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
}

/// Elements that are not in the largest piece.
long num_apart(const Body& body) {
    const auto pieces = topology::components(body.mesh);
    return static_cast<long>(pieces.of_element.size()) -
           std::count(pieces.of_element.begin(), pieces.of_element.end(), largest_piece(pieces));
}

TEST(Separator, APartialSweepOpensButPartsNothing) {
    for (const auto& family : test::mesh_families()) {
        if (!is_convex(family.name)) continue;
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            Body body(family.data);
            const auto box = body.box();
            const double size = box.diagonal().norm();
            const BladePlane plane(box.center() + random.vector(0.05 * size), random.vector(1));
            // Half through, over the whole width; or a stab that is narrower than the body.
            const double reach = seed % 2 == 0 ? 2 * size : 0.2 * size;
            std::set<topology::FacePair> expected;
            for (const auto& pair : body.inner_faces())
                if (crossings(body, pair, plane, reach, -size, 0.0) == 1) expected.insert(pair);
            body.step(plane.edge(reach, -size), plane.edge(reach, 0.0));
            EXPECT_TRUE(std::includes(expected.begin(), expected.end(), body.opened.begin(),
                                      body.opened.end()));
            for (const auto& pair : expected)
                EXPECT_TRUE(body.opened.contains(pair) || has_leaf(body.mesh, pair));
            EXPECT_GT(body.opened.size(), 3u);
            EXPECT_EQ(num_apart(body), 0);
            for (const auto& pair : body.opened) {
                const Vec3 x = body.centre(pair.a);
                const double element = body.largest_element();
                EXPECT_LT(std::abs(plane.height(x)), element);
                EXPECT_LT((x - plane.point).dot(plane.v), element);
                EXPECT_LT(std::abs((x - plane.point).dot(plane.u)), reach + element);
            }
        }
    }
}

/// Edges of a face as pairs of nodes.
std::vector<std::pair<VertexId, VertexId>> edges_of(const Mesh& mesh, FaceId f) {
    std::vector<std::pair<VertexId, VertexId>> edges;
    for (int p = 0; p < mesh.face_size(f); ++p)
        edges.push_back(
            std::minmax(mesh.face_corner(f, p), mesh.face_corner(f, (p + 1) % mesh.face_size(f))));
    return edges;
}

TEST(Separator, OpensASheetThatEndsAtTheBlade) {
    int num_branches = 0;
    for (const auto& family : test::mesh_families()) {
        if (!is_convex(family.name)) continue;
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            Body body(family.data);
            const Mesh uncut = Mesh::build(family.data).mesh;
            std::set<std::pair<VertexId, VertexId>> on_surface;
            for (const FaceId f : topology::boundary_faces(uncut))
                for (const auto& edge : edges_of(uncut, f)) on_surface.insert(edge);
            const auto box = body.box();
            const double size = box.diagonal().norm();
            const BladePlane plane(box.center() + random.vector(0.05 * size), random.vector(1));
            const Polyline last = plane.edge(2 * size, 0.0);
            body.step(plane.edge(2 * size, -size), last);

            std::map<std::pair<VertexId, VertexId>, std::vector<topology::FacePair>> at_edge;
            for (const auto& pair : body.opened)
                for (const auto& edge : edges_of(uncut, pair.a)) at_edge[edge].push_back(pair);
            int num_ends = 0;
            for (const auto& [edge, faces] : at_edge) {
                if (on_surface.contains(edge) || faces.size() % 2 == 0) continue;
                ++num_ends;
                const Vec3 x =
                    0.5 * (uncut.rest_position(edge.first) + uncut.rest_position(edge.second)) -
                    plane.point;
                EXPECT_LT(std::hypot(plane.normal.dot(x), plane.v.dot(x)), body.largest_element());
            }
            EXPECT_GT(num_ends, 0);
            // All in one, over edges from face to face, but for what is within an element of the
            // blade, where the sheet frays, and for slivers.
            const auto pieces = topology::components(body.mesh);
            const int main_piece = largest_piece(pieces);
            std::set<topology::FacePair> behind, reached;
            for (const auto& pair : body.opened) {
                const Vec3 x = body.centre(pair.a) - plane.point;
                if (pieces.of_element[pair.a.cell.index()] == main_piece &&
                    pieces.of_element[pair.b.cell.index()] == main_piece &&
                    std::hypot(plane.normal.dot(x), plane.v.dot(x)) > body.largest_element())
                    behind.insert(pair);
            }
            if (behind.empty()) continue;
            ++num_branches;
            std::vector<topology::FacePair> pending{*behind.begin()};
            while (!pending.empty()) {
                const auto pair = pending.back();
                pending.pop_back();
                if (!reached.insert(pair).second) continue;
                for (const auto& edge : edges_of(uncut, pair.a))
                    for (const auto& next : at_edge[edge]) pending.push_back(next);
            }
            EXPECT_TRUE(
                std::includes(reached.begin(), reached.end(), behind.begin(), behind.end()));
        }
    }
    EXPECT_GE(num_branches, test::num_cases(21));
}

TEST(Separator, SmallStepsOpenWhatALargeOneOpens) {
    // But for which of its faces an element at the boundary is left hanging by, and for faces
    // beside the line between their elements' centres: the blade may pass their path twice, which a
    // large step cancels and small steps do not.
    std::size_t num_opened = 0, num_other = 0;
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            Body large(family.data), small(family.data);
            const auto box = large.box();
            const double size = box.diagonal().norm();
            const BladePlane plane(box.center() + random.vector(0.05 * size), random.vector(1));
            const double end = seed % 2 == 0 ? size : 0.1 * size;
            large.sweep(plane.edge(2 * size, -size), plane.edge(2 * size, end), 1);
            small.sweep(plane.edge(2 * size, -size), plane.edge(2 * size, end), 97);
            std::vector<topology::FacePair> other;
            std::set_symmetric_difference(large.opened.begin(), large.opened.end(),
                                          small.opened.begin(), small.opened.end(),
                                          std::back_inserter(other));
            for (const auto& pair : other)
                EXPECT_TRUE(crossings(large, pair, plane, 2 * size, -size, end) == 2 ||
                            has_leaf(large.mesh, pair) || has_leaf(small.mesh, pair));
            if (is_convex(family.name) && end == size) {
                EXPECT_EQ(topology::components(large.mesh).count, 2);
                EXPECT_EQ(topology::components(small.mesh).count, 2);
            }
            num_opened += large.opened.size();
            num_other += other.size();
        }
    }
    EXPECT_LT(50 * num_other, num_opened);  // they are few
}

TEST(Separator, PartsAChainOfElementsAtEveryJoint) {
    // The end of a chain is no sliver: it has one neighbour from the start.
    for (int joint = 1; joint < 5; ++joint) {
        Body body(
            topology::box_mesh(topology::CellKind::hexahedron, {0, 0, 0}, {5, 1, 1}, {5, 1, 1}));
        const double x = joint;
        body.step({{x, -1, 9}, {x, 2, 9}}, {{x, -1, -9}, {x, 2, -9}});
        EXPECT_EQ(body.opened.size(), 1u);
        EXPECT_EQ(topology::components(body.mesh).count, 2);
    }
}

TEST(Separator, ABentEdgePartsAlongItsShape) {
    // A roof: the edge rises along x to a ridge and falls again; swept along y.
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron}) {
        Body body(topology::box_mesh(kind, {0, 0, 0}, {1, 1, 1}, {8, 3, 8}));
        const auto roof = [](double x) { return 0.61 - 0.73 * std::abs(x - 0.47); };
        const auto edge = [&](double y) -> Polyline {
            Polyline points;
            for (const double x : {-2.0, 0.47, 3.0}) points.push_back({x, y, roof(x)});
            return points;
        };
        std::vector<bool> above;
        for (std::size_t e = 0; e < body.mesh.element_capacity(); ++e) {
            const Vec3 c = body.centre(CellId(e));
            above.push_back(c.z() > roof(c.x()));
        }
        body.step(edge(-1), edge(2));
        for (const auto& pair : body.opened)
            EXPECT_NE(above[pair.a.cell.index()], above[pair.b.cell.index()]);
        for (const auto& pair : body.inner_faces())
            EXPECT_EQ(above[pair.a.cell.index()], above[pair.b.cell.index()]);
        EXPECT_EQ(topology::components(body.mesh).count, 2);
        expect_parted_cleanly(body);
    }
}

TEST(Separator, AnEdgeFoldedOntoItselfOpensNothing) {
    // It passes everything twice at once: an even number of times.
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Body body(family.data);
        const auto box = body.box();
        const double size = box.diagonal().norm();
        const BladePlane plane(box.center(), {3, 1, 2});
        const auto folded = [&](double along) {
            Polyline edge = plane.edge(2 * size, along);
            edge.push_back(edge.front());
            return edge;
        };
        body.step(folded(-2 * size), folded(2 * size));
        EXPECT_TRUE(body.opened.empty());
    }
}

TEST(Separator, ABladeOutsideOpensNothing) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Body body(family.data);
        const auto box = body.box();
        const double size = box.diagonal().norm();
        // All round it, just off its box; and the same in tissue that does not stay for it.
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                Vec3 normal = Vec3::Zero();
                normal[axis] = side;
                Vec3 point = box.center();
                point[axis] += side * (0.5 * box.sizes()[axis] + 1e-9 * size);
                const BladePlane plane(point, normal);
                body.step(plane.edge(2 * size, -2 * size), plane.edge(2 * size, 2 * size));
                // Into the body's box, but short of it.
                body.step(plane.edge(2 * size, -2 * size), plane.edge(2 * size, -size));
            }
        EXPECT_TRUE(body.opened.empty());
        EXPECT_EQ(body.mesh.epoch(), 0u);
    }
    // The hole of the ring is outside.
    for (const auto& family : test::mesh_families())
        if (family.name == "ring") {
            Body body(family.data);
            const double z = body.box().center().z();
            body.step({{-0.4, 0, z + 9}, {0.4, 0, z + 9}}, {{-0.4, 0, z - 9}, {0.4, 0, z - 9}});
            EXPECT_TRUE(body.opened.empty());
        }
}

TEST(Separator, AHalfCutRingStaysOneComponent) {
    for (const auto& family : test::mesh_families())
        if (family.name == "ring") {
            Body body(family.data);
            // Through one side of the ring: a radial blade.
            body.step({{0.2, 0.01, 9}, {9, 0.02, 9}}, {{0.2, 0.01, -9}, {9, 0.02, -9}});
            EXPECT_GT(body.opened.size(), 3u);
            EXPECT_EQ(topology::components(body.mesh).count, 1);
            body.step({{-0.2, 0.01, 9}, {-9, 0.02, 9}}, {{-0.2, 0.01, -9}, {-9, 0.02, -9}});
            EXPECT_EQ(topology::components(body.mesh).count, 2);
            expect_parted_cleanly(body);
        }
}

}  // namespace
}  // namespace incise::cutting
