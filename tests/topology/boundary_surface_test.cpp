// The surface that follows edits is the surface of the edited mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/boundary_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "incise/base/error.h"
#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

struct Triangle {
    FaceId face;
    std::array<VertexId, 3> nodes;
    bool is_cut;
    auto operator<=>(const Triangle&) const = default;
};

std::vector<Triangle> triangles_of(const BoundarySurface& surface) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < surface.triangles().size(); ++i)
        triangles.push_back({surface.faces()[i], surface.triangles()[i], surface.is_cut()[i] != 0});
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

TEST(BoundarySurface, EqualsAFreshOneAfterEditsAndInverses) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < 5; ++seed) {
            Mesh mesh = Mesh::build(family.data).mesh;
            test::Random random(seed);
            BoundarySurface surface(mesh);
            std::vector<std::array<VertexId, 3>> copy;  // as a renderer has it
            const auto upload = [&] {
                const auto changes = surface.take_changes();
                copy.resize(surface.triangles().size());
                for (const std::size_t place : changes)
                    if (place < copy.size()) copy[place] = surface.triangles()[place];
                EXPECT_TRUE(std::ranges::equal(copy, surface.triangles()));
            };
            upload();
            for (int i = 0; i < test::num_cases(20) && mesh.num_elements() > 4; ++i) {
                const ChangeSet changes = test::random_edit(mesh, random);
                surface.apply(mesh, changes);
                ASSERT_EQ(triangles_of(surface), triangles_of(BoundarySurface(mesh)));
                ASSERT_EQ(surface.version(), mesh.epoch());
                upload();
                if (changes.is_empty() || random.below(3) > 0) continue;
                const ChangeSet back = inverse(changes);
                replay(mesh, back);
                surface.apply(mesh, back);
                ASSERT_EQ(triangles_of(surface), triangles_of(BoundarySurface(mesh)));
                upload();
            }
        }
    }
}

TEST(BoundarySurface, EnclosesTheVolumeWithOutwardTriangles) {
    for (const auto& family : test::mesh_families()) {
        if (family.name == std::string("hexahedra")) continue;  // whose faces may be warped
        SCOPED_TRACE(family.name);
        const Mesh mesh = Mesh::build(family.data).mesh;
        const BoundarySurface surface(mesh);
        double volume = 0.0;
        for (const auto& [a, b, c] : surface.triangles())
            volume +=
                mesh.rest_position(a).dot(mesh.rest_position(b).cross(mesh.rest_position(c))) / 6.0;
        EXPECT_GT(volume, 0.0);
    }
}

TEST(BoundarySurface, RefusesAnEditOutOfTurn) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    BoundarySurface surface(mesh);
    MeshEdit first(mesh);
    first.remove(CellId(3));
    first.commit();
    MeshEdit second(mesh);
    second.remove(CellId(5));
    const ChangeSet changes = second.commit();
    EXPECT_THROW(surface.apply(mesh, changes), InputError);
}

}  // namespace
}  // namespace incise::topology
