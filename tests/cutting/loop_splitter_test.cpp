// Exact cuts through cells of any shape: against the exact arrangement of planes, in one step and
// in many, from any side, with edits that are taken back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/loop_splitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Bricks;
using test::Random;
using topology::CellKind;
using topology::ChangeSet;
using topology::Mesh;

struct Kind {
    const char* name;
    topology::MeshData (*make)(int n, std::uint64_t seed);
};

template <Bricks bricks>
topology::MeshData plain(int n, std::uint64_t) {
    return test::brick_cube(bricks, n, 0.0, 1);
}
template <Bricks bricks>
topology::MeshData jittered(int n, std::uint64_t seed) {
    return test::brick_cube(bricks, n, 0.2, seed);
}

const Kind kinds[] = {
    {"hexahedra", plain<Bricks::hexahedra>},
    {"wedges", plain<Bricks::wedges>},
    {"pyramids", plain<Bricks::pyramids>},
    {"mixed", plain<Bricks::mixed>},
    {"jittered hexahedra", jittered<Bricks::hexahedra>},
    {"jittered mixed", jittered<Bricks::mixed>},
    {"tetrahedra",
     [](int n, std::uint64_t) {
         return topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {n, n, n});
     }},
    {"jittered tetrahedra",
     [](int n, std::uint64_t seed) { return test::jittered_cube(n, 0.2, seed); }},
};

struct PlaneOfCut {
    Vec3 point, normal;
    double height(const Vec3& x) const { return (x - point).dot(normal); }
};

/// A convex body as its faces.
using Polygon = std::vector<Vec3>;
using Solid = std::vector<Polygon>;

Solid unit_cube() {
    Solid cube;
    for (int c = 0; c < 3; ++c)
        for (const double side : {0.0, 1.0}) {
            Polygon face;
            for (const auto& [s, t] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
                Vec3 x;
                x[c] = side;
                x[(c + 1) % 3] = s;
                x[(c + 2) % 3] = t;
                face.push_back(x);
            }
            cube.push_back(face);
        }
    return cube;
}

/// The part of a convex body above a plane.
Solid clipped(const Solid& solid, const PlaneOfCut& plane) {
    Solid result;
    Polygon cap;
    for (const Polygon& face : solid) {
        Polygon part;
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3 &a = face[i], &b = face[(i + 1) % face.size()];
            const double from = plane.height(a), to = plane.height(b);
            if (from >= 0.0) part.push_back(a);
            if ((from < 0.0) == (to < 0.0)) continue;
            part.push_back(a + from / (from - to) * (b - a));
            cap.push_back(part.back());
        }
        if (part.size() > 2) result.push_back(part);
    }
    if (cap.size() < 3) return result;
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : cap) centre += x / static_cast<double>(cap.size());
    const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.normalized().cross(u);
    std::ranges::sort(cap, {}, [&](const Vec3& x) {
        return std::atan2((x - centre).dot(v), (x - centre).dot(u));
    });
    result.push_back(cap);
    return result;
}

double volume(const Solid& solid) {
    if (solid.empty()) return 0.0;
    const Vec3 o = solid[0][0];
    double sum = 0.0;
    for (const Polygon& face : solid)
        for (std::size_t i = 2; i < face.size(); ++i)
            sum += std::abs((face[0] - o).dot((face[i - 1] - o).cross(face[i] - o))) / 6.0;
    return sum;
}

/// The volumes of the parts into which planes divide the unit cube, in ascending order.
std::vector<double> exact_volumes(const std::vector<PlaneOfCut>& planes) {
    std::vector<Solid> parts{unit_cube()};
    for (const PlaneOfCut& plane : planes) {
        std::vector<Solid> next;
        for (const Solid& part : parts)
            for (const double side : {1.0, -1.0})
                if (Solid half = clipped(part, {plane.point, side * plane.normal}); !half.empty())
                    next.push_back(std::move(half));
        parts = std::move(next);
    }
    std::vector<double> volumes;
    for (const Solid& part : parts) volumes.push_back(volume(part));
    std::ranges::sort(volumes);
    return volumes;
}

/// A mesh that is cut, with what is asked of it after each edit.
class Body {
  public:
    explicit Body(const topology::MeshData& data)
        : mesh(Mesh::build(data).mesh),
          positions(mesh.rest_positions().begin(), mesh.rest_positions().end()),
          volume_before(sum(rest_volumes())) {}

    Split cut(const CutSurface& surface, LoopFront& front, std::span<SuspendedLoops> resting = {}) {
        Split done = split_cells(mesh, {mesh, positions, positions}, surface, front, {}, resting);
        for (const auto& record : done.changes.nodes_added) {
            Vec3 x = Vec3::Zero();
            for (int k = 0; k < record.num_sources; ++k)
                x += record.sources[static_cast<std::size_t>(k)].weight *
                     positions[record.sources[static_cast<std::size_t>(k)].node.index()];
            positions.push_back(x);
        }
        for (SuspendedLoops& blade : resting) blade.front.apply(mesh, done.changes);
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
        if (!done.changes.is_empty()) edits.push_back(done.changes);
        area += done.report.cut_area;
        return done;
    }

    void sweep(const PlaneOfCut& plane, int num_steps, double from = -2.0, double to = 2.0) {
        LoopFront front;
        const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.normalized().cross(u);
        const auto edge = [&](int i) {
            const Vec3 middle = plane.point + (from + (to - from) * i / num_steps) * v;
            return std::vector<Vec3>{middle - 3.0 * u, middle + 3.0 * u};
        };
        for (int i = 0; i < num_steps && !testing::Test::HasFailure(); ++i)
            cut(SweptEdge(edge(i), edge(i + 1)), front);
    }

    std::vector<double> rest_volumes() const {
        const auto pieces = topology::components(mesh);
        std::vector<double> volumes(static_cast<std::size_t>(pieces.count));
        for (const CellId e : mesh.elements())
            volumes[static_cast<std::size_t>(pieces.of_element[e.index()])] +=
                topology::rest_volume(mesh, e);
        std::ranges::sort(volumes);
        return volumes;
    }
    static double sum(const std::vector<double>& values) {
        double sum = 0.0;
        for (const double value : values) sum += value;
        return sum;
    }

    /// All edits are taken back, and made again.
    void expect_replay() {
        const test::MeshSnapshot after(mesh);
        for (std::size_t i = edits.size(); i-- > 0;) topology::replay(mesh, inverse(edits[i]));
        for (const ChangeSet& edit : edits) topology::replay(mesh, edit);
        EXPECT_TRUE(test::MeshSnapshot(mesh) == after);
    }

    Mesh mesh;
    std::vector<Vec3> positions;
    double volume_before;
    double area = 0.0;
    std::vector<ChangeSet> edits;
};

void expect_parts(const Body& body, const std::vector<PlaneOfCut>& planes, double tolerance) {
    const auto volumes = body.rest_volumes(), expected = exact_volumes(planes);
    EXPECT_NEAR(Body::sum(volumes), body.volume_before, 1e-13);
    ASSERT_EQ(volumes.size(), expected.size());
    for (std::size_t i = 0; i < volumes.size(); ++i)
        EXPECT_NEAR(volumes[i], expected[i], tolerance);
}

/// Planes through the cube, none of which cuts off a corner that is smaller than a cell.
std::vector<PlaneOfCut> random_planes(Random& random, int count) {
    for (;;) {
        std::vector<PlaneOfCut> planes;
        for (int i = 0; i < count; ++i)
            planes.push_back(
                {Vec3::Constant(0.5) + random.vector(0.25), random.vector(1.0).normalized()});
        if (exact_volumes(planes).front() > 2e-3) return planes;
    }
}

template <class Check>
void for_bodies(int num_seeds, int n, Check check) {
    for (const Kind& kind : kinds)
        for (int seed = 0; seed < test::num_cases(num_seeds); ++seed) {
            SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(seed));
            Random random(static_cast<std::uint64_t>(seed));
            Body body(kind.make(n, static_cast<std::uint64_t>(seed)));
            check(body, random);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(LoopSplitter, PartsABodyAlongAPlane) {
    for_bodies(4, 4, [](Body& body, Random& random) {
        const auto planes = random_planes(random, 1);
        LoopFront front;
        body.cut(Plane(planes[0].point, planes[0].normal), front);
        EXPECT_TRUE(front.is_empty());
        expect_parts(body, planes, 2e-3);
        body.expect_replay();
    });
}

TEST(LoopSplitter, PartsABodyAlongThePathOfABlade) {
    for (const int num_steps : {1, 7, 100})
        for_bodies(3, 3, [&](Body& body, Random& random) {
            const auto planes = random_planes(random, 1);
            body.sweep(planes[0], num_steps);
            expect_parts(body, planes, 3e-3);
            body.expect_replay();
        });
}

TEST(LoopSplitter, PartsABodyAlongThreePlanes) {
    for (const int num_steps : {1, 25})
        for_bodies(4, 4, [&](Body& body, Random& random) {
            const auto planes = random_planes(random, 3);
            for (const PlaneOfCut& plane : planes) {
                body.sweep(plane, num_steps);
                if (testing::Test::HasFailure()) return;
            }
            expect_parts(body, planes, 5e-3);
            body.expect_replay();
        });
}

}  // namespace
}  // namespace incise::cutting
