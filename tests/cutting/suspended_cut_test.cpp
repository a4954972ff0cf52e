// Blades that are in the body at the same time, on ways that cross.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "incise/cutting/surfaces/plane.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;

/// A straight edge that goes right through the body in a plane.
struct BladeOnItsWay {
    Vec3 point, normal, along, way;
    std::optional<CutId> cut;

    BladeOnItsWay(const Box& box, Random& random)
        : point(box.center() + random.vector(0.05 * box.diagonal().norm())),
          normal(random.vector(1.0).normalized()),
          along(1.5 * box.diagonal().norm() * normal.unitOrthogonal()),
          way(normal.cross(along)) {}

    /// After that share of the way.
    Polyline edge(double share) const {
        const Vec3 middle = point + (2.0 * share - 1.0) * way;
        return {middle - along, middle + along};
    }
};

/// Bodies of 384 tetrahedra, and two blades whose planes cross.
struct CrossingBlades {
    SplitBody body;
    BladeOnItsWay a, b;
    SplitOptions options;

    CrossingBlades(std::uint64_t seed, Random& random, double snap)
        : body(test::jittered_cube(4, 0.2, seed)),
          a(body.box(), random),
          b(body.box(), random),
          options(SplitOptions{snap}) {}
    bool are_parallel() const { return std::abs(a.normal.dot(b.normal)) > 0.9; }

    /// One of them goes on, the other one rests.
    void move(BladeOnItsWay& blade, double from, double to) {
        body.cut({blade.edge(from), blade.edge(to)}, blade.cut, options);
    }
};

/// How far the piece that reaches farthest to both sides of the blade's plane does so.
double reach_across(const topology::Mesh& mesh, const BladeOnItsWay& blade) {
    const topology::Components components = topology::components(mesh);
    std::vector<double> above(static_cast<std::size_t>(components.count)), below(above.size());
    for (const CellId e : mesh.elements()) {
        const auto piece = static_cast<std::size_t>(components.of_element[e.index()]);
        for (const VertexId n : mesh.corners(e)) {
            const double height = (mesh.rest_position(n) - blade.point).dot(blade.normal);
            above[piece] = std::max(above[piece], height);
            below[piece] = std::max(below[piece], -height);
        }
    }
    double farthest = 0.0;
    for (std::size_t p = 0; p < above.size(); ++p)
        farthest = std::max(farthest, std::min(above[p], below[p]));
    return farthest;
}

void expect_parted_by_both(const CrossingBlades& blades, double longest) {
    EXPECT_GE(topology::components(blades.body.mesh).count, 4);
    EXPECT_LT(reach_across(blades.body.mesh, blades.a), longest);
    EXPECT_LT(reach_across(blades.body.mesh, blades.b), longest);
    EXPECT_NEAR(rest_volume(blades.body.mesh), 1.0, 1e-12);
}

template <class Cut>
void for_crossing_blades(Cut cut) {
    for (const double snap : {0.0, 0.3, default_snap})
        for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::num_cases(24));
             ++seed) {
            SCOPED_TRACE(testing::Message() << "snap " << snap << ", seed " << seed);
            Random random(seed);
            CrossingBlades blades(seed, random, snap);
            if (blades.are_parallel()) continue;
            const double longest = longest_edge(blades.body.mesh, blades.body.positions);
            cut(blades, 3 + static_cast<int>(seed % 5) * 7);
            expect_parted_by_both(blades, longest);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(SuspendedCut, GoesOnThroughWhatAnotherCutsInTurns) {
    for_crossing_blades([](CrossingBlades& blades, int num_steps) {
        for (int i = 0; i < num_steps; ++i) {
            const double from = 1.0 * i / num_steps, to = (i + 1.0) / num_steps;
            blades.move(blades.a, from, to);
            blades.move(blades.b, from, to);
        }
    });
}

TEST(SuspendedCut, GoesOnThroughWhatAnotherHasCutMeanwhile) {
    for_crossing_blades([](CrossingBlades& blades, int num_steps) {
        const double half = 0.5;
        for (int i = 0; i < num_steps; ++i)
            blades.move(blades.a, half * i / num_steps, half * (i + 1) / num_steps);
        for (int i = 0; i < num_steps; ++i)
            blades.move(blades.b, 1.0 * i / num_steps, (i + 1.0) / num_steps);
        for (int i = 0; i < num_steps; ++i)
            blades.move(blades.a, half + half * i / num_steps, half + half * (i + 1) / num_steps);
    });
}

TEST(SuspendedCut, GoesOnThroughWhatAPlaneHasCut) {
    for_crossing_blades([](CrossingBlades& blades, int num_steps) {
        const double part = 0.47;
        for (int i = 0; i < num_steps; ++i)
            blades.move(blades.a, part * i / num_steps, part * (i + 1) / num_steps);
        blades.body.cut(Plane(blades.b.point, blades.b.normal), blades.options);
        blades.move(blades.a, part, 1.0);
    });
}

}  // namespace
}  // namespace incise::cutting
