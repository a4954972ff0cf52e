// The number of pieces that follows edits is the one that a look at the whole mesh finds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/component_count.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

TEST(ComponentCount, FollowsAnyEditsAndTheirUndoing) {
    int num_changed = 0;
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(30); ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh mesh = Mesh::build(family.data).mesh;
            ComponentCount pieces(mesh);
            std::vector<ChangeSet> done;
            const auto follow = [&](const ChangeSet& changes) {
                const int before = pieces.value();
                pieces.apply(mesh, changes);
                ASSERT_EQ(pieces.value(), components(mesh).count);
                num_changed += pieces.value() != before;
            };
            for (int i = 0; i < 8; ++i) {
                done.push_back(test::random_edit(mesh, random));
                follow(done.back());
            }
            for (; !done.empty(); done.pop_back()) {
                const ChangeSet back = inverse(done.back());
                replay(mesh, back);
                follow(back);
            }
        }
    EXPECT_GT(num_changed, 100);
}

/// Opens the faces between layers of bricks, one after the other, from one side to the other.
TEST(ComponentCount, RisesWithTheLastStepOfACut) {
    constexpr int n = 6;
    Mesh mesh = Mesh::build(test::jittered_cube(n, 0.0, 0)).mesh;
    ComponentCount pieces(mesh);
    const auto layer_of = [&](const FaceId& f) {
        double lowest = 1.0;
        for (int p = 0; p < 3; ++p) {
            const Vec3& x = mesh.rest_position(mesh.face_corner(f, p));
            if (std::abs(x.z() - 0.5) > 1e-9) return -1;
            lowest = std::min(lowest, x.x());
        }
        return static_cast<int>(std::lround(lowest * n));
    };
    for (int layer = 0; layer < n; ++layer) {
        MeshEdit edit(mesh);
        for (const FaceId f : test::inner_faces(mesh))
            if (layer_of(f) == layer) edit.open(f);
        pieces.apply(mesh, edit.commit());
        EXPECT_EQ(pieces.value(), layer + 1 < n ? 1 : 2);
    }
}

}  // namespace
}  // namespace incise::topology
