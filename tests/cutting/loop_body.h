// Bodies of all kinds of cells that are cut, and the exact arrangement of planes to judge them by.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/cutting/cutter.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {

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

inline const Kind kinds[] = {
    {"hexahedra", plain<Bricks::hexahedra>},
    {"wedges", plain<Bricks::wedges>},
    {"pyramids", plain<Bricks::pyramids>},
    {"mixed", plain<Bricks::mixed>},
    {"jittered hexahedra", jittered<Bricks::hexahedra>},
    {"jittered mixed", jittered<Bricks::mixed>},
    {"joined",
     [](int n, std::uint64_t seed) { return test::brick_cube(Bricks::joined, n, 0.0, seed); }},
    {"jittered joined", jittered<Bricks::joined>},
    {"tetrahedra",
     [](int n, std::uint64_t) {
         return topology::box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {n, n, n});
     }},
    {"jittered tetrahedra",
     [](int n, std::uint64_t seed) { return test::jittered_cube(n, 0.2, seed); }},
};

struct Divider {
    Vec3 point, normal;
    double height(const Vec3& x) const { return (x - point).dot(normal); }
};

/// A convex body as its faces.
using Polygon = std::vector<Vec3>;
using Polyhedron = std::vector<Polygon>;

inline Polyhedron unit_cube() {
    Polyhedron cube;
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
inline Polyhedron clipped(const Polyhedron& solid, const Divider& plane) {
    Polyhedron result;
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

inline double volume(const Polyhedron& solid) {
    if (solid.empty()) return 0.0;
    const Vec3 o = solid[0][0];
    double sum = 0.0;
    for (const Polygon& face : solid)
        for (std::size_t i = 2; i < face.size(); ++i)
            sum += std::abs((face[0] - o).dot((face[i - 1] - o).cross(face[i] - o))) / 6.0;
    return sum;
}

/// The volumes of the parts into which planes divide the unit cube, in ascending order.
inline std::vector<double> exact_volumes(const std::vector<Divider>& planes) {
    std::vector<Polyhedron> parts{unit_cube()};
    for (const Divider& plane : planes) {
        std::vector<Polyhedron> next;
        for (const Polyhedron& part : parts)
            for (const double side : {1.0, -1.0})
                if (Polyhedron half = clipped(part, {plane.point, side * plane.normal});
                    !half.empty())
                    next.push_back(std::move(half));
        parts = std::move(next);
    }
    std::vector<double> volumes;
    for (const Polyhedron& part : parts) volumes.push_back(volume(part));
    std::ranges::sort(volumes);
    return volumes;
}

/// A mesh that is cut, with what is asked of it after each edit.
class Body {
  public:
    explicit Body(const topology::MeshData& from)
        : data(from),
          mesh(Mesh::build(from).mesh),
          positions(mesh.rest_positions().begin(), mesh.rest_positions().end()),
          volume_before(sum(rest_volumes())) {}

    Split cut(const CutSurface& surface, LoopFront& front, std::span<SuspendedLoops> resting = {}) {
        Split done = split_cells(mesh, {mesh, positions, positions}, surface, front, {}, resting);
        positions = followed(std::move(positions), done.changes);
        for (SuspendedLoops& blade : resting) blade.front.apply(mesh, done.changes);
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
        if (!done.changes.is_empty()) edits.push_back(done.changes);
        area += done.report.cut_area;
        return done;
    }

    void sweep(const Divider& plane, int num_steps, double from = -2.0, double to = 2.0) {
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

    topology::MeshData data;
    Mesh mesh;
    std::vector<Vec3> positions;
    double volume_before;
    double area = 0.0;
    std::vector<ChangeSet> edits;
};

inline void expect_parts(const Body& body, const std::vector<Divider>& planes, double tolerance) {
    const auto volumes = body.rest_volumes(), expected = exact_volumes(planes);
    EXPECT_NEAR(Body::sum(volumes), body.volume_before, 1e-13);
    ASSERT_EQ(volumes.size(), expected.size());
    for (std::size_t i = 0; i < volumes.size(); ++i)
        EXPECT_NEAR(volumes[i], expected[i], tolerance);
}

/// Planes through the cube, none of which cuts off a corner that is smaller than a cell.
inline std::vector<Divider> random_planes(Random& random, int count) {
    for (;;) {
        std::vector<Divider> planes;
        for (int i = 0; i < count; ++i)
            planes.push_back(
                {Vec3::Constant(0.5) + random.vector(0.25), random.vector(1.0).normalized()});
        if (exact_volumes(planes).front() > 2e-3) return planes;
    }
}

/// Planes through nodes of a cube of four cells a side, in directions of the lattice.
inline std::vector<Divider> lattice_planes(Random& random, std::size_t count) {
    for (;;) {
        std::vector<Divider> planes;
        while (planes.size() < count) {
            const Vec3 normal = random.grid_point(3) - Vec3::Ones(),
                       point = 0.25 * (random.grid_point(3) + Vec3::Ones());
            if (normal.norm() > 0.0) planes.push_back({point, normal.normalized()});
        }
        if (exact_volumes(planes).front() >= 2e-3) return planes;
    }
}

/// All but those of tetrahedra only, which a cutter divides otherwise.
inline constexpr std::size_t num_kinds_of_loops = std::size(kinds) - 2;

/// @param num_kinds  the first of the kinds
template <class Check>
void for_bodies(int num_seeds, int n, Check check, std::size_t num_kinds = std::size(kinds)) {
    for (const Kind& kind : std::span(kinds).first(num_kinds))
        for (int seed = 0; seed < test::num_cases(num_seeds); ++seed) {
            SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(seed));
            Random random(static_cast<std::uint64_t>(seed));
            Body body(kind.make(n, static_cast<std::uint64_t>(seed)));
            check(body, random);
        }
}

/// An edge that moves in a plane: its middle goes along v, its ends are at +-u.
struct StraightPath {
    Divider plane;
    Vec3 u, v;
    explicit StraightPath(const Divider& p, double turn = 0.0) : plane(p) {
        const Vec3 a = p.normal.unitOrthogonal(), b = p.normal.normalized().cross(a);
        u = std::cos(turn) * a + std::sin(turn) * b;
        v = -std::sin(turn) * a + std::cos(turn) * b;
    }
    std::vector<Vec3> edge(double along, double reach = 3.0) const {
        const Vec3 middle = plane.point + along * v;
        return {middle - reach * u, middle + reach * u};
    }
};

/// A body at rest that a cutter cuts.
class CutBody : public Body {
  public:
    explicit CutBody(const topology::MeshData& from) : Body(from), cutter(mesh, positions, true) {}

    Split follow(Split done) {
        positions = followed(std::move(positions), done.changes);
        cutter.apply(mesh, done.changes);
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>{});
        if (!done.changes.is_empty()) edits.push_back(done.changes);
        return done;
    }
    Split move(CutId cut, const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
        cutter.follow_motion(mesh, positions);
        return follow(cutter.split(cut, mesh, from, to));
    }
    void lead(CutId cut, const StraightPath& path, double from, double to, int num_steps) {
        for (int i = 0; i < num_steps; ++i)
            move(cut, path.edge(from + (to - from) * i / num_steps),
                 path.edge(from + (to - from) * (i + 1) / num_steps));
    }
    /// One blade for each plane; they go by turns.
    void lead_by_turns(const std::vector<Divider>& planes, int num_steps, double turn = 0.0) {
        std::vector<CutId> cuts;
        for (std::size_t k = 0; k < planes.size(); ++k)
            cuts.push_back(cutter.begin_cut(default_snap));
        for (int i = 0; i < num_steps; ++i) {
            cutter.follow_motion(mesh, positions);
            for (std::size_t k = 0; k < planes.size(); ++k) {
                const StraightPath path(planes[k], turn);
                follow(cutter.split(cuts[k], mesh, path.edge(-2.0 + 4.0 * i / num_steps),
                                    path.edge(-2.0 + 4.0 * (i + 1) / num_steps)));
            }
        }
        for (const CutId cut : cuts) cutter.remove_cut(cut);
    }
    Split cut_along(const CutSurface& surface) {
        cutter.follow_motion(mesh, positions);
        return follow(cutter.split(mesh, surface, default_snap));
    }

    Cutter cutter;
};

}  // namespace incise::cutting
