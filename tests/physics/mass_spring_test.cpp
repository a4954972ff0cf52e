// Springs: what they have beyond tests/physics/heml_forces_test.cpp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/physics/body/model.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

constexpr double springs_young = 1e4;
const MassSpringKernel mass_springs{springs_young};

TEST(MassSprings, PullAlongEdgesInProportionToElongation) {
    test::Random random(1);
    const Tetrahedron X = random_tetrahedron(random);
    const auto element = mass_springs.precompute(X);
    const Tetrahedron x = deformed(X, random_deformation(random, {0.7, 1.2, 1.5}));
    std::array<Vec3, 4> expected{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    double energy = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            if (i == j) continue;
            const double rest = (X[j] - X[i]).norm(), length = (x[j] - x[i]).norm();
            const double stiffness = springs_young * element.volume / (rest * rest);
            expected[i] += stiffness * (length - rest) * (x[j] - x[i]) / length;
            energy += 0.25 * stiffness * (length - rest) * (length - rest);  // each edge twice
        }
    const Tetrahedron f = mass_springs.forces(element, x);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LE((f[i] - expected[i]).norm(), 1e-14 * springs_young);
    EXPECT_NEAR(mass_springs.energy(element, x), energy, 1e-14 * springs_young);
}

TEST(MassSprings, DoNotDistinguishMirrorImages) {
    test::Random random(2);
    const Tetrahedron X = random_tetrahedron(random);
    const auto element = mass_springs.precompute(X);
    const Mat3 mirror = Vec3(1, 1, -1).asDiagonal();
    EXPECT_LE(mass_springs.energy(element, deformed(X, mirror)), 1e-28 * springs_young);
    EXPECT_NEAR(mass_springs.volume_ratio(element, deformed(X, mirror)), -1.0, 1e-14);
}

TEST(MassSprings, OfNoLengthPushNowhere) {
    test::Random random(3);
    const Tetrahedron X = random_tetrahedron(random);
    const auto element = mass_springs.precompute(X);
    Tetrahedron x = X;
    x[1] = x[0];
    for (const Vec3& f : mass_springs.forces(element, x)) EXPECT_TRUE(f.allFinite());
}

// The shares of the elements round an edge add up: an edge of a body of two materials has a
// stiffness between the two.
TEST(MassSprings, ShareAnEdgeBetweenElements) {
    topology::MeshData data =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {1, 1, 1});
    const auto pull = [&](std::vector<double> youngs) {
        for (std::size_t c = 0; c < data.num_cells(); ++c)
            data.regions[c] = static_cast<int>(c % youngs.size());
        MaterialTable table;
        for (std::size_t m = 0; m < youngs.size(); ++m) {
            table.materials.push_back({1000.0, MassSprings{youngs[m]}});
            table.of_region[static_cast<int>(m)] = m;
        }
        const topology::Mesh mesh = topology::Mesh::build(data).mesh;
        Model model(mesh, table);
        std::vector<Vec3> x(mesh.rest_positions().begin(), mesh.rest_positions().end());
        for (Vec3& p : x) p *= 1.1;
        model.set_state(x, std::vector<Vec3>(x.size(), Vec3::Zero()), 0.0);
        return model.energetics().totals().elastic_energy;
    };
    EXPECT_NEAR(pull({1.0, 3.0}), 0.5 * (pull({1.0}) + pull({3.0})), 1e-14);
    EXPECT_NEAR(pull({2.0}), 2.0 * pull({1.0}), 1e-15);
}

}  // namespace
}  // namespace incise::physics
