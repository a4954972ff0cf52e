// The law with fibres: their strain, stresses of homogeneous bodies solved apart, what they carry
// and what they do not, and how their directions follow edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::Mesh;

const HolzapfelGasserOgden parallel{3846.0, 8333.0, 5000.0, 0.8, 0.0};
const HolzapfelGasserOgden dispersed{3846.0, 8333.0, 5000.0, 0.8, 0.15};

Vec3 random_direction(test::Random& random) { return random_rotation(random).col(0); }

Mat3 structure_tensor(const HolzapfelGasserOgden& law, const Vec3& a0) {
    return law.dispersion * Mat3::Identity() + (1.0 - 3.0 * law.dispersion) * a0 * a0.transpose();
}

TEST(Fibres, AreMeasuredByTheirSquaredStretch) {
    test::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Tetrahedron X = random_tetrahedron(random, random.uniform(0.01, 2.0));
        const Vec3 a0 = random_direction(random);
        const auto e = HemlKernel{parallel, 0.4}.precompute(X, a0);
        const Mat3 F = random_deformation(random, random.vector(2.0));
        EXPECT_NEAR(deformation(e, deformed(X, F)).strain.f, (F * a0).squaredNorm() - 1.0,
                    1e-11 * (1.0 + F.squaredNorm()));
    }
}

TEST(Fibres, DeriveForcesFromEnergyWhateverTheirDirection) {
    test::Random random(2);
    for (const auto& law : {parallel, dispersed})
        for (int i = 0; i < 100; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const HemlKernel kernel{law, 0.4};
            const auto e = kernel.precompute(X, random_direction(random));
            const Tetrahedron x = deformed(
                X, random_deformation(random, {random.uniform(0.6, 1.6), random.uniform(0.6, 1.6),
                                               random.uniform(0.6, 1.6)}));
            const Tetrahedron f = kernel.forces(e, x);
            double scale = 0.0;
            for (const Vec3& v : f) scale = std::max(scale, v.norm());
            const double h = 1e-4;
            for (std::size_t k = 0; k < 4; ++k)
                for (int c = 0; c < 3; ++c) {
                    const auto energy = [&](double d) {
                        Tetrahedron moved = x;
                        moved[k][c] += d;
                        return kernel.energy(e, moved);
                    };
                    const double slope =
                        (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) /
                        (12.0 * h);
                    EXPECT_NEAR(f[k][c], -slope, 1e-8 * scale);
                }
        }
}

// A body that is turned before it is strained, and its fibres with it, has the same forces.
TEST(Fibres, TurnWithTheBodyAtRest) {
    test::Random random(3);
    int num_changed = 0;
    for (const auto& law : {parallel, dispersed})
        for (int i = 0; i < 100; ++i) {
            const HemlKernel kernel{law, 0.4};
            const Tetrahedron X = random_tetrahedron(random);
            const Vec3 a0 = random_direction(random);
            const Tetrahedron x = deformed(X, random_deformation(random, {0.8, 1.2, 1.4}));
            const Mat3 R = random_rotation(random);
            const auto f = kernel.forces(kernel.precompute(X, a0), x);
            const auto g = kernel.forces(kernel.precompute(deformed(X, R), R * a0), x);
            const auto other = kernel.forces(kernel.precompute(deformed(X, R), a0), x);
            double difference = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_LE((f[k] - g[k]).norm(), 1e-11 * law.k1);
                difference = std::max(difference, (f[k] - other[k]).norm());
            }
            num_changed += difference > 1e-6 * law.k1 ? 1 : 0;  // fibres left behind: unless slack
            const auto opposite = kernel.forces(kernel.precompute(X, -a0), x);
            EXPECT_EQ(f, opposite);
        }
    EXPECT_GT(num_changed, 150);
}

TEST(Fibres, CarryNoCompression) {
    const HemlKernel ground{IsochoricMooneyRivlin{0.5 * parallel.mu, 0.0, parallel.bulk_modulus},
                            0.4};
    const HemlKernel kernel{parallel, 0.4};
    test::Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Tetrahedron X = random_tetrahedron(random);
        const Vec3 a0 = random_direction(random);
        const Mat3 R = random_rotation(random);
        const auto response = [&](double along) {
            const Mat3 F = R * (Mat3::Identity() + (along - 1.0) * a0 * a0.transpose());
            const Tetrahedron x = deformed(X, F);
            const auto f = kernel.forces(kernel.precompute(X, a0), x);
            const auto g = ground.forces(ground.precompute(X), x);
            double difference = 0.0;
            for (std::size_t k = 0; k < 4; ++k)
                difference = std::max(difference, (f[k] - g[k]).norm());
            return difference;
        };
        EXPECT_LE(response(0.7), 1e-12 * parallel.mu);
        EXPECT_GT(response(1.3), 1e-2 * parallel.k1);
    }
}

TEST(Fibres, AddTheirModulusAtRestInTensionOnly) {
    test::Random random(5);
    for (const auto& law : {parallel, dispersed})
        for (int i = 0; i < 50; ++i) {
            const HemlKernel kernel{law, 0.4};
            const Tetrahedron X = random_tetrahedron(random);
            const Vec3 a0 = random_direction(random);
            const auto e = kernel.precompute(X, a0);
            Mat3 D = random_deformation(random, random.vector(1.0));
            D = (0.5 * (D + D.transpose())).eval();
            const Mat3 H = structure_tensor(law, a0);
            const auto stress = [&](double s) {
                const Tetrahedron x = deformed(X, Mat3::Identity() + s * D);
                const Tetrahedron f = kernel.forces(e, x);
                Mat3 sum = Mat3::Zero();
                for (std::size_t k = 0; k < 4; ++k) sum -= f[k] * x[k].transpose();
                return Mat3(sum / (e.volume * (Mat3::Identity() + s * D).determinant()));
            };
            const double h = 1e-4, sign = H.cwiseProduct(D).sum() > 0.0 ? 1.0 : -1.0;
            // One-sided to the second order.
            const auto tangent = [&](double s) {
                return Mat3((4.0 * stress(s) - stress(2.0 * s)) / (2.0 * s));
            };
            const Mat3 hooke =
                law.rest_lambda() * D.trace() * Mat3::Identity() + 2.0 * law.rest_mu() * D;
            const Mat3 fibres = law.rest_fibre_modulus() * H.cwiseProduct(D).sum() * H;
            EXPECT_LE((tangent(-sign * h) - hooke).norm(), 1e-5 * law.bulk_modulus);
            EXPECT_LE((tangent(sign * h) - hooke - fibres).norm(), 1e-5 * law.bulk_modulus);
        }
}

/// A homogeneous body whose principal stretches lie along the axes and whose fibres lie along one.
struct PrincipalState {
    HolzapfelGasserOgden law;
    int fibre_axis;

    /// Principal first Piola-Kirchhoff stresses dw/dl_i, from the law as its paper writes it.
    Vec3 stress(const Vec3& l) const {
        const double J = l.prod(), I1 = l.squaredNorm(), g = std::pow(J, -2.0 / 3.0);
        const double kappa = law.dispersion, along = l[fibre_axis] * l[fibre_axis];
        const double E = kappa * (I1 - 3.0) + (1.0 - 3.0 * kappa) * (along - 1.0);
        Vec3 P;
        for (int i = 0; i < 3; ++i) {
            P[i] =
                law.mu * g * (l[i] - I1 / (3.0 * l[i])) + law.bulk_modulus * (J - 1.0) * J / l[i];
            const double dE = 2.0 * l[i] * (kappa + (i == fibre_axis ? 1.0 - 3.0 * kappa : 0.0));
            if (E > 0.0) P[i] += law.k1 * E * std::exp(law.k2 * E * E) * dE;
        }
        return P;
    }

    /// The stretches at which the sides of a bar along z are free, by Newton's method.
    Vec3 bar(double axial) const {
        Vec3 l(1.0 / std::sqrt(axial), 1.0 / std::sqrt(axial), axial);
        for (int i = 0; i < 50; ++i) {
            const Vec3 P = stress(l);
            Eigen::Matrix2d tangent;
            for (int k = 0; k < 2; ++k) {
                const double h = 1e-6;
                const Vec3 d = h * Vec3::Unit(k);
                tangent.col(k) = ((stress(l + d) - stress(l - d)) / (2.0 * h)).head<2>();
            }
            l.head<2>() -= tangent.inverse() * P.head<2>();
        }
        EXPECT_LE(stress(l).head<2>().norm(), 1e-10 * law.mu);
        return l;
    }
};

TEST(Fibres, GiveBarsTheStressOfTheLaw) {
    const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                     {0.1, 0.1, 0.2}, {2, 2, 3}))
                          .mesh;
    for (const auto& law : {parallel, dispersed})
        for (const int axis : {0, 1, 2}) {
            const PrincipalState state{law, axis};
            MaterialTable table = table_of_one_law(law);
            table.fibres.assign(mesh.element_capacity(), Vec3::Unit(axis));
            Model model(mesh, table);
            double stiffest = 0.0;
            for (const double axial : {0.7, 0.9, 1.0, 1.1, 1.3, 1.5}) {
                SCOPED_TRACE(testing::Message() << "fibres along " << axis << ", stretch " << axial
                                                << ", kappa " << law.dispersion);
                const Vec3 l = state.bar(axial), P = state.stress(l);
                BodyState body = rest_state(mesh);
                for (Vec3& x : body.positions) x = x.cwiseProduct(l);
                set_state(model, body);
                const Mat3 expected = Vec3(P.cwiseProduct(l) / l.prod()).asDiagonal();
                for (const ElementId e : living_elements(model.fragments()))
                    EXPECT_LE((model.element_result(e).cauchy_stress - expected).norm(),
                              1e-9 * law.mu);
                double end_force = 0.0;
                for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
                    if (mesh.rest_positions()[n].z() > 0.19)
                        end_force -= model.elastic_forces()[n].z();
                EXPECT_NEAR(end_force, P.z() * 0.01, 1e-9 * law.mu * 0.01);
                stiffest = std::max(stiffest, P.z());
            }
            // Fibres along the bar carry most of it, parallel ones across it nothing.
            if (law.dispersion == 0.0) {
                const double without =
                    PrincipalState{{law.mu, law.bulk_modulus, 1e-9, 1.0, 0.0}, axis}
                        .stress(
                            PrincipalState{{law.mu, law.bulk_modulus, 1e-9, 1.0, 0.0}, axis}.bar(
                                1.5))
                        .z();
                if (axis == 2)
                    EXPECT_GT(stiffest, 3.0 * without);
                else
                    EXPECT_NEAR(stiffest, without, 1e-6 * without);
            }
        }
}

// Full invariants: a pressure from within makes a ball an ellipsoid, short along the fibres.
TEST(Fibres, ResistADilationAlongThem) {
    const PrincipalState state{parallel, 2};
    const Vec3 P = state.stress(Vec3::Constant(1.1));
    EXPECT_GT(P.z(), P.x() + 0.1 * parallel.k1);
}

TEST(Fibres, DirectionsAreInheritedAndComeBack) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Model model(mesh, table_of_one_law(dispersed));
    test::Random random(6);
    set_state(model, random_state(mesh, random, 0.02, 0.0));
    const std::vector<Vec3> first(model.structure().fibres().begin(),
                                  model.structure().fibres().end());
    ASSERT_EQ(first.size(), mesh.element_capacity());
    std::vector<BodyEdit> edits;
    std::size_t num_parts = 0;
    for (int i = 0; i < 60; ++i) {
        edits.push_back(follow(model, test::random_edit(mesh, random)));
        ASSERT_EQ(model.structure().fibres().size(), model.fragments().element_capacity());
        for (const auto& record : edits.back().physics.mesh.elements_added)
            if (record.parent.is_valid()) {
                ++num_parts;
                EXPECT_EQ(model.structure().fibres()[record.id.index()],
                          model.structure().fibres()[record.parent.index()]);
            }
        if (mesh.num_elements() == 0) break;
    }
    EXPECT_GT(num_parts, 20u);
    for (; !edits.empty(); edits.pop_back()) take_back(mesh, model, edits.back());
    EXPECT_EQ(
        std::vector<Vec3>(model.structure().fibres().begin(), model.structure().fibres().end()),
        first);
}

TEST(Fibres, AreNeededByTheirLaw) {
    const Mesh mesh = Mesh::build(test::jittered_cube(1, 0.1, 3)).mesh;
    MaterialTable table = table_of_one_law(parallel);
    const auto refusal = [&] {
        try {
            Model(mesh, table);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_EQ(refusal(), "accepted");
    table.fibres[1] = Vec3::Zero();
    EXPECT_EQ(refusal(), "element " + std::to_string(mesh.label(CellId(1))) +
                             ", of region 0, has no direction of fibres of unit length, which its "
                             "material needs");
    table.fibres[1] = Vec3(1.0, 1.0, 0.0);
    EXPECT_NE(refusal(), "accepted");
    table.fibres.clear();
    EXPECT_NE(refusal(), "accepted");
}

}  // namespace
}  // namespace incise::physics
