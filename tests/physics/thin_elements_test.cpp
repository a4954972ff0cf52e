// How much of energies, forces and tangents is left in thin tetrahedra, beside a reference in
// higher precision. The bounds are those that docs/theory.md states under Accuracy: errors of the
// reference kernels grow with 1/r, those of lanes with 1/r^2, where r is the least altitude over
// the longest edge. Energies on lanes alone have a term of 1/r^3. SPDX-License-Identifier:
// LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "incise/physics/body/model.h"
#include "incise/physics/elements/element_tangent.h"
#include "incise/physics/solve/solved_step.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/thin_tetrahedra.h"

namespace incise::physics {
namespace {

using Long = long double;
using LongMat3 = Eigen::Matrix<Long, 3, 3>;

LongMat3 long_edges(const Tetrahedron& x) {
    LongMat3 v;
    for (std::size_t k = 1; k < 4; ++k)
        v.col(static_cast<int>(k) - 1) = x[k].cast<Long>() - x[0].cast<Long>();
    return v;
}

/// What an element of these corners should come to; per volume at rest what grows with it.
struct Expected {
    double volume, energy_density;
    Tetrahedron force_densities;  // N/m3
    Mat3 cauchy_stress;
};

Expected expected(const Law& law, const Tetrahedron& X, const Tetrahedron& x) {
    const LongMat3 V = long_edges(X), W = V.fullPivLu().inverse(), F = long_edges(x) * W;
    const LongMat3 H = (long_edges(x) - V) * W, C = H + H.transpose() + H.transpose() * H;
    const Eigen::Matrix<Long, 3, 1> a0 = fibre_direction().cast<Long>();
    const Long J = F.determinant();
    const bool has_fibre = has_fibres(law);
    const LinkStrain<double> strain{static_cast<double>(C.trace()),
                                    static_cast<double>((C * C).trace()), static_cast<double>(J),
                                    has_fibre ? static_cast<double>(a0.dot(C * a0)) : 0.0};
    const LawResponse<double> r = response(law, strain, 0.4);
    const LongMat3 I = LongMat3::Identity();
    const LongMat3 P =
        F * (2.0L * r.w_a * I + 4.0L * r.w_b * C + 2.0L * r.w_f * a0 * a0.transpose()) +
        static_cast<Long>(r.w_J) * J * F.inverse().transpose();
    const LongMat3 f = -P * W.transpose();
    Expected e;
    e.volume = static_cast<double>(V.fullPivLu().determinant() / 6.0L);
    e.energy_density = r.w;
    e.force_densities[0] = -f.rowwise().sum().cast<double>();
    for (int k = 0; k < 3; ++k)
        e.force_densities[static_cast<std::size_t>(k) + 1] = f.col(k).cast<double>();
    e.cauchy_stress = (P * F.transpose() / J).cast<double>();
    return e;
}

/// Strained by up to some 10 %, and by a thousandth of that.
Tetrahedron strained(const Tetrahedron& X, double amount, test::Random& random) {
    Mat3 F = Mat3::Identity();
    for (int c = 0; c < 3; ++c) F.col(c) += random.vector(amount);
    return deformed(X, random_rotation(random) * F);
}

double modulus_of(const Law& law) {
    const RestFibres fibres = rest_fibres(law);
    return rest_lambda(law) + 2.0 * rest_mu(law) + fibres.modulus;
}

double least_altitude(const Tetrahedron& X) {
    double least = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 &a = X[(k + 1) % 4], &b = X[(k + 2) % 4], &c = X[(k + 3) % 4];
        const Vec3 normal = (b - a).cross(c - a);
        least = std::min(least, std::abs(normal.dot(X[k] - a)) / normal.norm());
    }
    return least;
}

template <class Visit>
void for_each_thin_state(Visit visit) {
    test::Random random(1);
    for_each_thin_tetrahedron([&](const Tetrahedron& X, double r) {
        for (const double amount : {0.1, 1e-4}) {
            SCOPED_TRACE(amount);
            visit(X, strained(X, amount, random), r);
        }
    });
}

// The strain of an element is off by some eps/r, as its positions are rounded.
TEST(ThinElements, HaveTheEnergyAndForcesOfTheReference) {
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        const WithFibre<HemlKernel> kernel(HemlKernel{named.law, 0.4});
        for_each_thin_state([&](const Tetrahedron& X, const Tetrahedron& x, double r) {
            const auto element = kernel.precompute(X);
            const Expected should = expected(named.law, X, x);
            const double error = 2e-13 / r * modulus_of(named.law);
            EXPECT_NEAR(element.volume, should.volume, 1e-15 / (r * r) * should.volume);
            EXPECT_NEAR(kernel.energy(element, x) / element.volume, should.energy_density, error);
            const Tetrahedron f = kernel.forces(element, x);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE((f[k] / element.volume - should.force_densities[k]).norm(),
                          error / least_altitude(X));
        });
    }
}

// A body of one element: forces, energies and stresses from lanes, in both precisions.
void expect_accuracy_of_body(Precision precision, double rounding, double least_ratio) {
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        MaterialTable table = table_of_one_law(named.law);
        if (!table.fibres.empty()) table.fibres.assign(1, fibre_direction());
        table.precision = precision;
        for_each_thin_state([&](const Tetrahedron& X, const Tetrahedron& x, double r) {
            if (r < least_ratio) return;
            const topology::Mesh mesh = mesh_of(X);
            Model model(mesh, table);
            model.set_state(x, std::vector<Vec3>(4, Vec3::Zero()), 0.0);
            const Expected should = expected(named.law, X, x);
            const double modulus = modulus_of(named.law), doubles = 2e-14 / (r * r) * modulus,
                         error = rounding / (r * r) * modulus;
            EXPECT_NEAR(model.energetics().totals().elastic_energy / should.volume,
                        should.energy_density, doubles + 1e-17 / (r * r * r) * modulus);
            EXPECT_LE(
                (model.element_result(ElementId(0)).cauchy_stress - should.cauchy_stress).norm(),
                doubles);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE(
                    (model.elastic_forces()[k] / should.volume - should.force_densities[k]).norm(),
                    error / least_altitude(X));
        });
    }
}

TEST(ThinElements, HaveTheirAccuracyInABody) {
    expect_accuracy_of_body(Precision::double_precision, 2e-14, 0.0);
}

TEST(ThinElements, HaveTheirAccuracyInSinglePrecision) {
    expect_accuracy_of_body(Precision::single_precision, 1e-5, 1e-2);
}

// Of an affine motion, in which the large entries of the tangent cancel.
TEST(ThinElements, HaveTangentsOfAffineMotions) {
    test::Random random(2);
    for (const NamedLaw& named : test_laws()) {
        if (has_fibres(named.law)) continue;  // with a tangent that jumps at rest
        SCOPED_TRACE(named.name);
        const HemlKernel kernel{named.law, 0.4};
        for_each_thin_tetrahedron([&](const Tetrahedron& X, double r) {
            const auto element = kernel.precompute(X);
            Mat3 A;
            for (int c = 0; c < 3; ++c) A.col(c) = random.vector(1.0);
            Eigen::Matrix<double, 12, 1> way;
            for (std::size_t k = 0; k < 4; ++k)
                way.segment<3>(static_cast<Eigen::Index>(3 * k)) = A * (X[k] - X[0]);
            const Mat3 strain = 0.5 * (A + A.transpose());
            const double should = rest_lambda(named.law) * strain.trace() * strain.trace() +
                                  2.0 * rest_mu(named.law) * strain.squaredNorm();
            EXPECT_NEAR(way.dot(element_tangent(kernel, element, X) * way) / element.volume, should,
                        2e-14 / (r * r) * modulus_of(named.law));
        });
    }
}

// The stress that viscous elements remember, and what is left of it in their forces.
TEST(ThinElements, HaveTheirAccuracyWithViscosity) {
    const std::vector<PronyTerm> prony{{0.3, 0.05}, {0.2, 0.2}};
    for (const PronyRule rule : {PronyRule::stress, PronyRule::nodal})
        for_each_thin_state([&](const Tetrahedron& X, const Tetrahedron& x, double r) {
            const topology::Mesh mesh = mesh_of(X);
            Model model(mesh, table_of_one_material(HyperElasticLinks{soft_law, 0.4, prony, rule}));
            const Expected should = expected(soft_law, X, x);
            // Held for a step without length: all moduli act; for ever: those of the long time.
            for (const auto& [dt, share] : {std::pair(1e-12, 1.0), std::pair(1e6, 0.5)}) {
                model.set_state(mesh.rest_positions(), std::vector<Vec3>(4, Vec3::Zero()), 0.0);
                begin_solved_step(model);
                const std::vector<Vec3> none(4, Vec3::Zero());
                take_solved_step(model, x, none, none, dt);
                model.compute_forces(dt);
                for (std::size_t k = 0; k < 4; ++k)
                    EXPECT_LE((model.elastic_forces()[k] / should.volume -
                               share * should.force_densities[k])
                                  .norm(),
                              (1e-5 * should.force_densities[k].norm() +
                               2e-14 / (r * r) * modulus_of(soft_law) / least_altitude(X)));
            }
        });
}

}  // namespace
}  // namespace incise::physics
