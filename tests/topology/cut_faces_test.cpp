// Faces on cuts, against the planes of the cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cut_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/exact_plane.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

double area_of(const Mesh& mesh, FaceId f) {
    const auto x = [&](int k) { return mesh.rest_position(mesh.face_corner(f, k)); };
    return 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
}

// Two planes one after the other; fragments of others carry the lighter parts. A face of the skin
// is never on a cut. One on a plane is, but for those that are as near to a face of their carrier
// as cuts move nodes: these have little area.
TEST(CutFaces, AreThoseOnThePlanesOfTheCuts) {
    double area = 0.0, found = 0.0;
    for (const test::MeshFamily* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(testing::Message() << family->name << ", seed " << seed);
            test::Random random(seed);
            Mesh mesh = Mesh::build(family->data).mesh;
            FragmentMesh fragments(mesh);
            Box box;
            for (const Vec3& x : mesh.rest_positions()) box.extend(x);
            std::vector<std::pair<Vec3, Vec3>> planes;
            for (int i = 0; i < 2; ++i) {
                planes.emplace_back(
                    box.center() + 0.1 * random.vector(1.0).cwiseProduct(box.sizes()),
                    random.vector(1.0).normalized());
                const ChangeSet changes =
                    test::cut_along_plane(mesh, planes.back().first, planes.back().second);
                fragments.apply(mesh, changes);
            }
            const double rounding = 1e-9 * box.sizes().norm();
            for (const ElementId e : mesh.elements())
                for (int f = 0; f < mesh.num_faces(e); ++f) {
                    const FaceId face{e, f};
                    const bool is_on_plane = std::ranges::any_of(planes, [&](const auto& plane) {
                        for (int k = 0; k < 3; ++k) {
                            const Vec3& x = mesh.rest_position(mesh.face_corner(face, k));
                            if (std::abs(plane.second.dot(x - plane.first)) > rounding)
                                return false;
                        }
                        return true;
                    });
                    const bool is_cut = is_on_cut(mesh, fragments, face);
                    if (mesh.neighbor(face).is_valid() || !is_on_plane) {
                        EXPECT_FALSE(is_cut);
                        continue;
                    }
                    area += area_of(mesh, face);
                    found += is_cut ? area_of(mesh, face) : 0.0;
                }
        }
    EXPECT_GT(area, 0.0);
    EXPECT_GT(found, 0.99 * area);
}

}  // namespace
}  // namespace incise::topology
