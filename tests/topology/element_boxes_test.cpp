// Boxes of elements find all elements near a box, also after edits and motions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/spatial/element_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

Box box_of(const Mesh& mesh, CellId e, std::span<const Vec3> positions) {
    Box box;
    for (const VertexId n : mesh.corners(e)) box.extend(positions[n.index()]);
    return box;
}

/// Expects that a search finds all elements that meet small boxes at their nodes.
void expect_complete(const ElementBoxes& boxes, const Mesh& mesh, std::span<const Vec3> positions,
                     test::Random& random) {
    for (int i = 0; i < 10; ++i) {
        const Vec3& x = positions[random.below(positions.size())];
        const Box near(x - Vec3::Constant(0.05), x + Vec3::Constant(0.05));
        std::vector<CellId> found;
        boxes.for_each_near(
            mesh, [&](const Box& box) { return box.intersects(near); },
            [&](CellId e) { found.push_back(e); });
        EXPECT_TRUE(std::ranges::is_sorted(found));
        for (const CellId e : mesh.elements())
            if (box_of(mesh, e, positions).intersects(near)) {
                EXPECT_TRUE(std::ranges::binary_search(found, e));
                EXPECT_TRUE(boxes.may_meet(near));
            }
    }
}

TEST(ElementBoxes, FindAllAfterEditsAndMotions) {
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh mesh = Mesh::build(family.data).mesh;
            ElementBoxes boxes(mesh, mesh.rest_positions());
            Vec3 shift = Vec3::Zero();
            std::vector<Vec3> positions;
            for (int i = 0; i < 12; ++i) {
                boxes.apply(mesh, test::random_edit(mesh, random));
                const Vec3 step = random.vector(0.05);
                const bool moves = i % 3 != 0;
                if (moves) shift += step;
                positions.assign(mesh.rest_positions().begin(), mesh.rest_positions().end());
                for (Vec3& x : positions) x += shift;
                if (moves)
                    boxes.move(mesh, positions, step.norm());
                else
                    boxes.refresh(mesh, positions);
                EXPECT_TRUE(boxes.cover(mesh));
                expect_complete(boxes, mesh, positions, random);
            }
        }
}

}  // namespace
}  // namespace incise::topology
