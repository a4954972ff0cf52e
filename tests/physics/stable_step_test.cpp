// The bound on the step against the true one, 2 / omega_max, from a dense eigensolution.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/stable_step.h"

#include <gtest/gtest.h>

#include <limits>

#include "incise/base/error.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::Mesh;
using topology::MeshData;

/// 2 / omega_max of the linearised motion about rest, or about a body that is a little larger.
double true_stable_step(const Mesh& mesh, const MaterialTable& table, double dilation = 0.0) {
    Model model(mesh, table);
    const auto n = static_cast<Eigen::Index>(3 * mesh.node_capacity());
    double size = 0.0;
    for (const Vec3& x : mesh.rest_positions()) size = std::max(size, x.norm());
    const double h = 1e-6 * size;
    Eigen::MatrixXd A(n, n);
    BodyState state = rest_state(mesh);
    for (Vec3& x : state.positions) x *= 1.0 + dilation;
    const auto column = [&](Eigen::Index i, double shift) {
        double& x = state.positions[static_cast<std::size_t>(i / 3)][i % 3];
        const double rest = x;
        x += shift;
        set_state(model, state);
        x = rest;
        Eigen::VectorXd force(n);
        for (Eigen::Index k = 0; k < n; ++k)
            force[k] = model.elastic_forces()[static_cast<std::size_t>(k / 3)][k % 3];
        return force;
    };
    for (Eigen::Index i = 0; i < n; ++i) A.col(i) = (column(i, -h) - column(i, h)) / (2.0 * h);
    // Symmetric like M^-1/2 K M^-1/2, which has the eigenvalues of M^-1 K.
    Eigen::VectorXd root(n);
    for (Eigen::Index k = 0; k < n; ++k)
        root[k] = std::sqrt(model.masses()[static_cast<std::size_t>(k / 3)]);
    A = (root.cwiseInverse().asDiagonal() * A * root.cwiseInverse().asDiagonal()).eval();
    A = (0.5 * (A + A.transpose())).eval();
    return 2.0 / std::sqrt(spectrum(A).values.maxCoeff());
}

struct SmallBody {
    std::string name;
    MeshData data;
};

std::vector<SmallBody> small_bodies() {
    std::vector<SmallBody> bodies;
    for (const char* name : {"one tetrahedron", "two by a face", "ring", "ball"})
        for (const auto& family : test::mesh_families())
            if (family.name == name) bodies.push_back({family.name, family.data});
    bodies.push_back({"cube", test::jittered_cube(3, 0.1, 1)});
    MeshData flat = test::jittered_cube(3, 0.0, 1);
    for (Vec3& x : flat.points) x.z() *= 0.1;
    bodies.push_back({"flat cube", flat});
    // One inner node moved to a hundredth of an edge above the opposite face of an element.
    MeshData slivers = test::jittered_cube(2, 0.0, 1);
    for (Vec3& x : slivers.points)
        if (x == Vec3(0.5, 0.5, 0.5)) x = Vec3(0.5, 0.495, 0.01);
    bodies.push_back({"slivers", slivers});
    return bodies;
}

TEST(StableStep, IsBelowTheTrueOneButNotFar) {
    for (const SmallBody& body : small_bodies()) {
        SCOPED_TRACE(body.name);
        const Mesh mesh = Mesh::build(body.data).mesh;
        const auto check = [&](const std::string& name, const auto& method) {
            SCOPED_TRACE(name);
            const auto table = table_of_one_material(method);
            const double bound = Model(mesh, table).stable_step();
            const double exact = true_stable_step(mesh, table);
            EXPECT_LE(bound, exact * (1.0 + 1e-6));  // the differences are good to 1e-8
            if (!table.materials[0].has_fibres()) {  // of which half are slack
                EXPECT_GE(bound, 0.4 * exact);
            }
        };
        for (const NamedLaw& named : test_laws())
            if (mesh.num_nodes() < 30 || named.name == "neo-Hookean, nu 0.3")  // else it takes long
                check(named.name, HyperElasticLinks{named.law});
        check("springs", MassSprings{1e4});
    }
}

// Fibres add stiffness where they are stretched, at rest in every other direction of motion: all of
// them are in a body that is a little larger. Its strain changes what else there is by as much.
TEST(StableStep, HoldsWithAllFibresTaut) {
    constexpr double dilation = 1e-4;
    for (const char* name : {"one tetrahedron", "two by a face", "ring", "ball", "cube"})
        for (const SmallBody& body : small_bodies()) {
            if (body.name != name || body.data.num_cells() > 60) continue;
            SCOPED_TRACE(body.name);
            const Mesh mesh = Mesh::build(body.data).mesh;
            for (const double kappa : {0.0, 0.1, 1.0 / 3.0})
                for (const double k1 : {1e2, 1e4, 1e6}) {
                    SCOPED_TRACE(testing::Message() << "kappa " << kappa << ", k1 " << k1);
                    const HolzapfelGasserOgden law{2e3, 1e4, k1, 1.0, kappa};
                    const auto table = table_of_one_law(law);
                    const double bound = Model(mesh, table).stable_step();
                    const double exact = true_stable_step(mesh, table, dilation);
                    EXPECT_LE(bound, exact * (1.0 + 10.0 * dilation));
                    EXPECT_GE(bound, 0.35 * exact);
                }
        }
}

TEST(StableStep, HoldsForABodyOfAllMaterials) {
    const auto table = table_of_all_materials();
    const Mesh mesh =
        Mesh::build(with_regions(test::jittered_cube(3, 0.2, 5), table.materials.size())).mesh;
    const double bound = Model(mesh, table).stable_step(), exact = true_stable_step(mesh, table);
    EXPECT_LE(bound, exact * (1.0 + 1e-6));
    EXPECT_GE(bound, 0.4 * exact);
}

TEST(StableStep, HoldsForHybridSprings) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    struct Grid {
        Vec3 size;
        std::array<int, 3> cells;
        double least;  // of the true step
    };
    for (const Grid& grid : {Grid{{1, 1, 1}, {1, 1, 1}, 0.99}, Grid{{3, 2, 2}, {3, 2, 2}, 0.65},
                             Grid{{3, 2, 2}, {4, 2, 2}, 0.4}})
        for (const double ratio : {0.5, 1.0, infinite})
            for (const double kappa : {-3e3, 0.0, 1e4, 1e6}) {
                SCOPED_TRACE(testing::Message() << grid.cells[0] << " cells along x, A " << ratio
                                                << ", kappa " << kappa);
                const Mesh mesh =
                    Mesh::build(topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                                   grid.size, grid.cells))
                        .mesh;
                const auto table = table_of_one_material(HybridSprings{5e3, kappa, ratio});
                const double bound = Model(mesh, table).stable_step();
                const double exact = true_stable_step(mesh, table);
                EXPECT_LE(bound, exact * (1.0 + 1e-6));
                EXPECT_GE(bound, (kappa < 0.0 ? 0.6 : 1.0) * grid.least * exact);
            }
}

TEST(StableStep, FollowsDensityStiffnessAndSize) {
    const auto step_of = [](double size, double density, double factor) {
        MeshData data = test::jittered_cube(2, 0.1, 1);
        for (Vec3& x : data.points) x *= size;
        const Mesh mesh = Mesh::build(data).mesh;
        return Model(mesh, table_of_one_law(NeoHookean{factor * 1e3, factor * 3e3}, density))
            .stable_step();
    };
    const double one = step_of(1.0, 1000.0, 1.0);
    EXPECT_NEAR(step_of(0.1, 1000.0, 1.0), 0.1 * one, 1e-14 * one);
    EXPECT_NEAR(step_of(1.0, 4000.0, 1.0), 2.0 * one, 1e-13 * one);
    EXPECT_NEAR(step_of(1.0, 1000.0, 4.0), 0.5 * one, 1e-14 * one);
}

TEST(StableStep, DecidesBetweenBoundedAndExplodingMotion) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    const auto table = table_of_one_law(NeoHookean{1923.0, 5769.0});
    const double exact = true_stable_step(mesh, table);
    const auto start = [&] {
        test::Random random(2);
        BodyState state = rest_state(mesh);
        for (Vec3& x : state.positions) x += random.vector(1e-5);
        return state;
    };
    {
        Model model(mesh, table);
        set_state(model, start());
        double time = 0.0, largest = 0.0;
        for (int i = 0; i < 20'000; ++i) {
            step(model, time, 0.98 * exact);
            for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
                largest =
                    std::max(largest, (model.positions()[n] - mesh.rest_positions()[n]).norm());
        }
        EXPECT_LT(largest, 1e-3);
    }
    Model model(mesh, table);
    set_state(model, start());
    double time = 0.0;
    try {
        for (int i = 0; i < 2000; ++i) step(model, time, 1.05 * exact);
        FAIL() << "did not blow up";
    } catch (const PhysicsError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("element "), std::string::npos) << text;
        EXPECT_NE(text.find("above the stable step"), std::string::npos) << text;
        std::ostringstream bound;
        bound << model.structure().rest_stable_step();
        EXPECT_NE(text.find(bound.str()), std::string::npos) << text;
    }
}

TEST(StableStep, IsTheMaximumOverNodesWhateverTheHistory) {
    StableStep step;
    EXPECT_EQ(step.value(), std::numeric_limits<double>::infinity());
    test::Random random(1);
    std::vector<double> quotients(1000, 0.0);
    for (int i = 0; i < 5000; ++i) {
        const std::size_t n = random.below(quotients.size());
        const double mass = random.below(4) == 0 ? 0.0 : random.uniform(0.5, 2.0);
        const double stiffness = random.uniform(0.0, 10.0);
        quotients[n] = mass > 0.0 ? stiffness / mass : 0.0;
        step.set(n, stiffness, mass);
        if (random.below(200) == 0) {
            const std::size_t left = 1 + random.below(quotients.size());
            std::fill(quotients.begin() + static_cast<std::ptrdiff_t>(left), quotients.end(), 0.0);
            step.truncate(left);
        }
        const double highest = *std::max_element(quotients.begin(), quotients.end());
        EXPECT_EQ(step.value(), highest > 0.0 ? 2.0 / std::sqrt(highest)
                                              : std::numeric_limits<double>::infinity());
    }
}

}  // namespace
}  // namespace incise::physics
