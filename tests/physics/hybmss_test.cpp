// Hybrid mass-spring cells one by one: energy and forces, moduli, shape, and what they refuse.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "incise/base/error.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/physics/elements/virtual_centre_kernel.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/hybmss_cells.h"

namespace incise::physics {
namespace {

using Matrix24 = Eigen::Matrix<double, 24, 24>;

/// Young's modulus E and Poisson's ratio, as the references have them.
HybridSprings springs_of(double young, double poisson, double ratio) {
    const double G = young / (2.0 * (1.0 + poisson));
    return {G, G * (4.0 * poisson - 1.0) / (1.0 - 2.0 * poisson), ratio};
}

TEST(HybMss, ForcesAreMinusTheDerivativesOfTheEnergy) {
    test::Random random(11);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        // Also flat and turned inside out.
        for (const double stretch : {1.0, 0.7, 1.3, 1e-3, -0.8}) {
            const Cell x =
                shaken(deformed(X, random_deformation(random, {1.1, 0.9, stretch})), random, 0.1);
            const Cell f = kernel.forces(e, x);
            const double h = 1e-6;
            for (std::size_t k = 0; k < 8; ++k)
                for (int c = 0; c < 3; ++c) {
                    Cell up = x, down = x;
                    up[k][c] += h;
                    down[k][c] -= h;
                    const double slope = (kernel.energy(e, up) - kernel.energy(e, down)) / (2 * h);
                    EXPECT_NEAR(f[k][c], -slope, 1e-8 * force_scale(kernel, e));
                }
        }
    });
}

TEST(HybMss, AtRestAndTurnedThereIsNoForce) {
    test::Random random(12);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        EXPECT_LE(sum_of_norms(kernel.forces(e, X)), 1e-13 * force_scale(kernel, e));
        EXPECT_LE(kernel.energy(e, X), 1e-25 * kernel.stiffness_energy(e));
        EXPECT_NEAR(kernel.volume_ratio(e, X), 1.0, 1e-14);
        const Cell turned = deformed(X, random_rotation(random));
        EXPECT_LE(sum_of_norms(kernel.forces(e, turned)), 1e-13 * force_scale(kernel, e));
    });
}

TEST(HybMss, ForcesTurnWithTheCellAndBalance) {
    test::Random random(13);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        const Cell x = shaken(X, random, 0.2);
        const Mat3 R = random_rotation(random);
        const Cell f = kernel.forces(e, x), turned = kernel.forces(e, deformed(x, R));
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        for (std::size_t k = 0; k < 8; ++k) {
            EXPECT_LE((turned[k] - R * f[k]).norm(), 1e-12 * force_scale(kernel, e));
            sum += f[k];
            moment += x[k].cross(f[k]);
        }
        EXPECT_LE(sum.norm(), 1e-13 * force_scale(kernel, e));
        EXPECT_LE(moment.norm(), 1e-13 * force_scale(kernel, e));
    });
}

/// Stress in a cell under a homogeneous deformation, from the forces on its corners, Pa.
Mat3 first_piola_kirchhoff(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                           const Cell& X, const Mat3& F) {
    const Cell f = kernel.forces(e, deformed(X, F));
    Mat3 P = Mat3::Zero();
    for (std::size_t k = 0; k < 8; ++k) P -= f[k] * X[k].transpose() / e.volume;
    return P;
}

// For boxes too, with any ratio of springs: Hooke's law at small strain.
TEST(HybMss, IsIsotropicWithTheModuliGiven) {
    test::Random random(14);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        const double G = kernel.material.shear_modulus;
        const double lambda = G + kernel.material.volume_modulus;
        for (int i = 0; i < 5; ++i) {
            Mat3 H;
            for (int c = 0; c < 3; ++c) H.col(c) = random.vector(1.0);
            const Mat3 strain = 0.5 * (H + H.transpose());
            const Mat3 expected = lambda * strain.trace() * Mat3::Identity() + 2.0 * G * strain;
            const double h = 1e-4;
            const Mat3 I = Mat3::Identity();
            const Mat3 slope = (first_piola_kirchhoff(kernel, e, X, I + h * H) -
                                first_piola_kirchhoff(kernel, e, X, I - h * H)) /
                               (2.0 * h);
            EXPECT_LE((slope - expected).norm(), 1e-6 * (lambda + 2.0 * G) * H.norm());
        }
    });
}

/// Of the forces at rest, by central differences.
Matrix24 stiffness_at_rest(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                           const Cell& X) {
    Matrix24 K;
    const double h = 1e-5;
    for (int i = 0; i < 24; ++i) {
        Cell up = X, down = X;
        up[static_cast<std::size_t>(i / 3)][i % 3] += h;
        down[static_cast<std::size_t>(i / 3)][i % 3] -= h;
        const Cell a = kernel.forces(e, up), b = kernel.forces(e, down);
        for (int j = 0; j < 24; ++j) {
            const auto k = static_cast<std::size_t>(j / 3);
            K(j, i) = -(a[k][j % 3] - b[k][j % 3]) / (2.0 * h);
        }
    }
    return 0.5 * (K + K.transpose());
}

// What moves a cell without strain costs nothing, and only that does, unless it has no face
// diagonals: then three more motions do.
TEST(HybMss, HasSixFreeMotionsNineWithoutDiagonals) {
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        if (kernel.material.volume_modulus < 0.0) return;  // lowers other frequencies too
        const Eigen::VectorXd modes = spectrum(stiffness_at_rest(kernel, e, X)).values;
        const double highest = modes[23];
        int free = 0;
        while (modes[free] < 1e-6 * highest) ++free;
        EXPECT_EQ(free, kernel.material.stiffness_ratio == 0.0 ? 9 : 6);
        EXPECT_GE(modes[0], -1e-6 * highest);
    });
}

TEST(HybMss, BoundsItsStiffnessSharplyForCubes) {
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        const Eigen::VectorXd modes = spectrum(stiffness_at_rest(kernel, e, X)).values;
        const auto bounds = kernel.stiffness_bounds(e, X);
        const double bound = *std::min_element(bounds.begin(), bounds.end());
        EXPECT_EQ(bound, *std::max_element(bounds.begin(), bounds.end()));
        const double highest = modes[23];
        EXPECT_LE(highest, bound * (1.0 + 1e-8));
        const Vec3 edges(BoxFrame(X).a.norm(), BoxFrame(X).b.norm(), BoxFrame(X).c.norm());
        const bool is_cube = edges.maxCoeff() - edges.minCoeff() < 1e-9;
        EXPECT_GE(highest,
                  (is_cube && kernel.material.volume_modulus >= 0.0 ? 0.999 : 0.35) * bound);
    });
}

TEST(HybMss, SpringsOfCubesAreThoseOfThePaper) {
    for (const double A : {0.5, 1.0, 3.0}) {
        const auto shares = spring_contributions(Vec3::Constant(0.2), shear_modulus, A);
        ASSERT_TRUE(shares);
        const double k_c = 3.0 * shear_modulus * 0.2 / (4.0 + 3.0 * A);
        const double k_e = shear_modulus * 0.2 * (8.0 + 3.0 * A) / (4.0 + 3.0 * A);
        for (const std::size_t g : {0u, 1u, 2u}) {
            EXPECT_NEAR(shares->stiffnesses[g], k_e / 4.0, 1e-12 * k_e);
            EXPECT_NEAR(shares->stiffnesses[3 + g], A * k_c / 2.0, 1e-12 * k_e);
            EXPECT_NEAR(shares->lengths[g], 0.2, 1e-15);
            EXPECT_NEAR(shares->lengths[3 + g], 0.2 * std::sqrt(2.0), 1e-15);
        }
        EXPECT_NEAR(shares->stiffnesses[6], k_c, 1e-12 * k_e);
        EXPECT_NEAR(shares->lengths[6], 0.2 * std::sqrt(3.0), 1e-15);
    }
    const auto outer = spring_contributions(Vec3::Constant(0.2), shear_modulus, infinity);
    ASSERT_TRUE(outer);
    EXPECT_EQ(outer->stiffnesses[6], 0.0);
    EXPECT_NEAR(outer->stiffnesses[0], shear_modulus * 0.2 / 4.0, 1e-10);
    EXPECT_NEAR(outer->stiffnesses[3], shear_modulus * 0.2 / 2.0, 1e-10);
}

TEST(HybMss, NoSpringIsMissingOrPushesWhenPulled) {
    test::Random random(15);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 edges(1.0, random.uniform(1.0, 2.0), random.uniform(1.0, 2.0));
        const auto shares = spring_contributions(edges, shear_modulus, random.uniform(0.1, 5.0));
        EXPECT_EQ(shares.has_value(), edges.maxCoeff() <= 1.42 * edges.minCoeff());
        if (!shares) {
            ++refused;
            continue;
        }
        // Inner ones may be missing, as for cubes.
        for (std::size_t g = 0; g < 6; ++g) EXPECT_GT(shares->stiffnesses[g], 1e-3 * shear_modulus);
        EXPECT_GE(shares->stiffnesses[6], 0.0);
    }
    EXPECT_GT(refused, 100);
}

// A lattice is strained as its cells are: one row of the table a stretch, for any grid.
TEST(HybMss, UniaxialTensionAndCompressionMatchTheReference) {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/hybmss_uniaxial.json");
    const auto json = nlohmann::json::parse(file);
    int rows = 0;
    for (const auto& row : json.at("rows")) {
        if (row.at("PK1").is_null()) continue;  // has no equilibrium there
        ++rows;
        const double stretch = row.at("stretch"), lateral = row.at("lateral");
        const HybmssKernel kernel{springs_of(row.at("E"), row.at("nu"), row.at("A"))};
        SCOPED_TRACE(row.dump());
        for (const double l : {1.0, 0.3}) {
            const Cell X = box(Vec3::Constant(l));
            const auto e = kernel.precompute(X);
            const Mat3 F = Vec3(lateral, lateral, stretch).asDiagonal();
            const Mat3 P = first_piola_kirchhoff(kernel, e, X, F);
            const double young = row.at("E");
            EXPECT_NEAR(P(2, 2), row.at("PK1"), 1e-9 * young);
            EXPECT_NEAR(P(0, 0), 0.0, 1e-9 * young);
            EXPECT_NEAR(P(1, 1), 0.0, 1e-9 * young);
            EXPECT_NEAR(kernel.volume_ratio(e, deformed(X, F)), row.at("J"), 1e-9);
        }
    }
    EXPECT_GE(rows, 20);
}

std::string refusal(const topology::MeshData& data, const HybridSprings& material) {
    const auto mesh = topology::Mesh::build(data).mesh;
    try {
        const Model model(mesh, table_of_one_material(material));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

topology::MeshData one_cell(const Cell& X) {
    topology::MeshData data;
    data.points.assign(X.begin(), X.end());
    data.add_cell(topology::CellKind::hexahedron,
                  std::array<std::int64_t, 8>{0, 1, 2, 3, 4, 5, 6, 7});
    return data;
}

// A cell of HEML takes the place of a box that a cut divides: docs/theory.md, Fragments.
TEST(HybMss, HasTheEnergyOfItsHemlMaterialToFirstOrderOfStrain) {
    constexpr auto hexahedron = topology::CellKind::hexahedron;
    test::Random random(8);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const HybmssKernel::Element& e) {
        const HyperElasticLinks links = links_of_divided_box(kernel.material);
        const VirtualCentreKernel<hexahedron> heml{links.law, links.inversion_threshold};
        const auto of_heml = heml.precompute(X);
        EXPECT_NEAR(of_heml.volume, e.volume, 1e-12 * e.volume);
        for (const double fraction : heml.mass_fractions(of_heml))
            EXPECT_NEAR(fraction, 1.0 / 8.0, 1e-14);
        EXPECT_LE(sum_of_norms(heml.forces(of_heml, X)), 1e-12 * force_scale(kernel, e));
        for (const double strain : {1e-4, 1e-3, 1e-2}) {
            const Vec3 stretches = Vec3::Ones() + random.vector(strain);
            const Cell x = deformed(X, random_deformation(random, stretches));
            const double springs = kernel.energy(e, x);
            // All round, where the volume terms differ most, it is 2.3 times the strain.
            EXPECT_NEAR(heml.energy(of_heml, x), springs,
                        4.0 * strain * heml.stiffness_energy(of_heml) * strain * strain);
        }
    });
}

TEST(HybMss, RefusesCellsThatAreNoBoxesByName) {
    const HybridSprings usual = hybrid_springs(0.3, 1.0);
    test::Random random(16);
    EXPECT_EQ(refusal(one_cell(box({1, 1, 1}, random_rotation(random))), usual), "accepted");
    // As single precision has it.
    EXPECT_EQ(refusal(one_cell(shaken(box({1, 1, 1}), random, 1e-7)), usual), "accepted");
    Cell far = box({1, 1, 1}, random_rotation(random), {-128, -302, 420});
    for (Vec3& x : far) x = x.cast<float>().cast<double>();
    EXPECT_EQ(refusal(one_cell(far), usual), "accepted");

    Cell skew = box({1, 1, 1});
    for (const std::size_t k : {4u, 5u, 6u, 7u}) skew[k].x() += 0.1;
    EXPECT_NE(refusal(one_cell(skew), usual).find("element 0 is no box: a corner is "),
              std::string::npos)
        << refusal(one_cell(skew), usual);
    Cell bent = box({1, 1, 1});
    bent[6] += Vec3(0.01, 0, 0);
    EXPECT_NE(refusal(one_cell(bent), usual).find("element 0 is no box"), std::string::npos);

    EXPECT_EQ(refusal(one_cell(box({1, 1.4, 1})), usual), "accepted");
    EXPECT_EQ(refusal(one_cell(box({1, 2, 1})), usual),
              "element 0 is a box of 1 x 2 x 1 m; the method hybmss needs cubes, or boxes whose "
              "longest edge is at most 1.4 times the shortest");
    EXPECT_EQ(refusal(one_cell(box({1, 1.2, 1})), hybrid_springs(0.3, 0.0)),
              "element 0 is a box of 1 x 1.2 x 1 m; without face diagonals the method hybmss "
              "needs cubes");
}

TEST(HybMss, RefusesCellsThatAreNoHexahedra) {
    const auto tetrahedra = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                               Vec3::Constant(1.0), {1, 1, 1});
    EXPECT_NE(refusal(tetrahedra, hybrid_springs(0.3, 1.0))
                  .find(", of region 0, is a tetrahedron; the method hybmss needs hexahedra"),
              std::string::npos);
    topology::MeshData wedge;
    wedge.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    wedge.add_cell(topology::CellKind::wedge, std::array<std::int64_t, 6>{0, 2, 1, 3, 5, 4});
    EXPECT_EQ(refusal(wedge, hybrid_springs(0.3, 1.0)),
              "element 0, of region 0, is a wedge; the method hybmss needs hexahedra");
}

// A block of tetrahedra beside one of hexahedra, of one mesh: each moves as it would alone.
TEST(HybMss, AndHemlBodiesMoveSideBySide) {
    const auto hexahedra =
        topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), {1, 1, 1}, {3, 3, 3});
    const auto tetrahedra =
        topology::box_mesh(topology::CellKind::tetrahedron, {2, 0, 0}, {1, 1, 1}, {2, 2, 2});
    topology::MeshData both = hexahedra;
    const auto offset = static_cast<std::int64_t>(both.points.size());
    both.points.insert(both.points.end(), tetrahedra.points.begin(), tetrahedra.points.end());
    for (std::size_t c = 0; c < tetrahedra.num_cells(); ++c) {
        std::vector<std::int64_t> corners(tetrahedra.cell(c).begin(), tetrahedra.cell(c).end());
        for (auto& corner : corners) corner += offset;
        both.add_cell(topology::CellKind::tetrahedron, corners);
    }
    for (std::size_t c = 0; c < both.num_cells(); ++c)
        both.regions[c] = c < hexahedra.num_cells() ? 0 : 1;
    MaterialTable table = table_of_one_material(hybrid_springs(0.4, infinity));
    table.of_region[1] = 1;
    table.materials.push_back({1100.0, HyperElasticLinks{NeoHookean{1e3, 4e3}}});

    const auto mesh = topology::Mesh::build(both).mesh;
    const auto alone = topology::Mesh::build(hexahedra).mesh;
    Model model(mesh, table), reference(alone, table);
    const auto velocity = [](const Vec3& X) { return Vec3(0.3 * X.y(), -0.2 * X.x(), X.z()); };
    BodyState state = rest_state(mesh), state_alone = rest_state(alone);
    for (std::size_t n = 0; n < state.velocities.size(); ++n)
        state.velocities[n] = velocity(mesh.rest_positions()[n]);
    for (std::size_t n = 0; n < state_alone.velocities.size(); ++n)
        state_alone.velocities[n] = velocity(alone.rest_positions()[n]);
    set_state(model, state);
    set_state(reference, state_alone);
    const double dt = 0.8 * std::min(model.stable_step(), reference.stable_step());
    double time = 0.0, time_alone = 0.0;
    const double energy = model.energetics().totals().kinetic_energy;
    for (int i = 0; i < 100; ++i) {
        step(model, time, dt);
        step(reference, time_alone, dt);
    }
    for (std::size_t n = 0; n < alone.node_capacity(); ++n)
        for (std::size_t m = 0; m < mesh.node_capacity(); ++m)
            if (mesh.rest_positions()[m] == alone.rest_positions()[n]) {
                EXPECT_LE((model.positions()[m] - reference.positions()[n]).norm(), 1e-12);
            }
    const Totals totals = model.energetics().totals();
    EXPECT_NEAR(totals.kinetic_energy + totals.elastic_energy, energy, 0.05 * energy);
    EXPECT_GT(totals.elastic_energy, 0.01 * energy);
}

}  // namespace
}  // namespace incise::physics
