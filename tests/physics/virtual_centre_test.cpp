// HEML on hexahedra, wedges and pyramids: against differences of its energy, against HEML on the
// tetrahedra of an affine state, its bounds against spectra, and bending near nu = 1/2.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "incise/physics/elements/centre_viscous_kernel.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/physics/elements/virtual_centre_kernel.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "tests/fragments/random_cells.h"
#include "tests/physics/processors_at_hand.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

using topology::CellKind;

template <CellKind kind>
using Corners = typename VirtualCentreKernel<kind>::Corners;

using test::unit_cell;

template <CellKind kind>
Corners<kind> random_cell(test::Random& random) {
    Corners<kind> X = unit_cell<kind>();
    const double size = random.uniform(0.01, 0.1);
    for (Vec3& x : X) x = size * (x + random.vector(0.12));
    return X;
}

/// Shares of the tetrahedra of a cell, some of which are whole and some empty.
template <CellKind kind>
std::array<double, CentreDivision<kind>::num_parts> random_shares(test::Random& random) {
    std::array<double, CentreDivision<kind>::num_parts> shares;
    for (double& share : shares) share = std::clamp(random.uniform(-0.5, 1.5), 0.0, 1.0);
    shares[random.below(shares.size())] = 0.5;
    return shares;
}

/// A random affine deformation, and a motion of each corner on top of it, of a cell of this size.
template <CellKind kind>
Corners<kind> moved(const Corners<kind>& X, const Mat3& F, double noise, test::Random& random) {
    Corners<kind> x;
    const double size = (X[1] - X[0]).norm();
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = F * X[k] + random.vector(noise * size);
    return x;
}

/// Calls check(kernel, name) for each law and each kind of cell.
void for_each_kernel_of_cells(auto check) {
    for (const NamedLaw& named : test_laws()) {
        const auto of_kind = [&]<CellKind kind>() {
            SCOPED_TRACE(named.name + ", " + topology::traits(kind).name);
            check(VirtualCentreKernel<kind>{named.law, 0.4},
                  std::integral_constant<CellKind, kind>());
        };
        of_kind.template operator()<CellKind::hexahedron>();
        of_kind.template operator()<CellKind::wedge>();
        of_kind.template operator()<CellKind::pyramid>();
    }
}

const Vec3 fibre = Vec3(2, -1, 2) / 3.0;

Mat3 gentle_deformation(test::Random& random, double strain) {
    return random_deformation(
        random, {1.0 + random.uniform(-strain, strain), 1.0 + random.uniform(-strain, strain),
                 1.0 + random.uniform(-strain, strain)});
}

TEST(VirtualCentre, HasTheForcesOfItsEnergyAndTheTangentOfItsForces) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        test::Random random(1);
        for (int i = 0; i < 4; ++i) {
            const auto X = random_cell<kind()>(random);
            const auto diagonals = test::random_diagonals(kind(), random);
            ASSERT_FALSE(kernel.why_no_cell(X, diagonals));
            const auto e =
                i % 2 == 0 ? kernel.precompute(X, fibre, {}, diagonals)
                           : kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
            auto x = moved<kind()>(X, gentle_deformation(random, 0.15), 0.05, random);
            const auto f = kernel.forces(e, x);
            const auto K = kernel.tangent(e, x);
            EXPECT_LE((K - K.transpose()).norm(), 1e-13 * K.norm());
            double scale = 0.0;
            for (const Vec3& force : f) scale = std::max(scale, force.norm());
            const double h = 1e-4 * (X[1] - X[0]).norm();
            for (std::size_t k = 0; k < x.size(); ++k)
                for (int c = 0; c < 3; ++c) {
                    const double at = x[k][c];
                    const auto shifted = [&](double d, auto value) {
                        x[k][c] = at + d;
                        const auto result = value();
                        x[k][c] = at;
                        return result;
                    };
                    const auto energy = [&] { return kernel.energy(e, x); };
                    const auto forces = [&] {
                        Eigen::VectorXd all(3 * static_cast<Eigen::Index>(x.size()));
                        const auto of_corners = kernel.forces(e, x);
                        for (std::size_t m = 0; m < x.size(); ++m)
                            all.segment<3>(static_cast<Eigen::Index>(3 * m)) = of_corners[m];
                        return all;
                    };
                    const auto difference = [&](auto value) {
                        using Value = decltype(value());
                        const Value near = shifted(h, value) - shifted(-h, value);
                        const Value far = shifted(2 * h, value) - shifted(-2 * h, value);
                        return Value((8.0 * near - far) / (12.0 * h));
                    };
                    EXPECT_NEAR(f[k][c], -difference(energy), 1e-6 * scale);
                    const Eigen::VectorXd column = K.col(static_cast<Eigen::Index>(3 * k) + c);
                    EXPECT_LE((column + difference(forces)).norm(), 1e-6 * K.norm());
                }
        }
    });
}

TEST(VirtualCentre, IsAtRestWithoutForcesAndTurnsWithoutStrain) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        test::Random random(2);
        const auto X = random_cell<kind()>(random);
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto e = kernel.precompute(X, fibre, {}, diagonals);
        for (const Vec3& f : kernel.forces(e, X))
            EXPECT_LE(f.norm(), 1e-14 * kernel.stiffness_energy(e) / (X[1] - X[0]).norm());
        EXPECT_EQ(kernel.energy(e, X), 0.0);
        EXPECT_NEAR(kernel.stiffening(e, X), 1.0, 1e-6);
        const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2) / 3.0).toRotationMatrix();
        const auto turned = moved<kind()>(X, R, 0.0, random);
        const double scale = kernel.stiffness_energy(e);
        EXPECT_NEAR(kernel.energy(e, turned), 0.0, 1e-14 * scale);
        EXPECT_NEAR(kernel.volume_ratio(e, turned), 1.0, 1e-13);
    });
}

TEST(VirtualCentre, TellsThatACellIsFoldedInside) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        test::Random random(7);
        for (int i = 0; i < 3; ++i) {
            const auto X = random_cell<kind()>(random);
            const auto diagonals = test::random_diagonals(kind(), random);
            const auto e = kernel.precompute(X, fibre, {}, diagonals);
            const Mat3 F = gentle_deformation(random, 0.3);
            auto x = moved<kind()>(X, F, 0.0, random);
            EXPECT_NEAR(kernel.least_volume_ratio(e, x), F.determinant(), 1e-12);
            // A corner goes through the plane of those that it is joined to.
            constexpr auto corner_parts = CentreDivision<kind()>::corner_parts();
            for (const auto& c : corner_parts) {
                auto folded = x;
                folded[c[0]] += 1.2 * ((x[c[1]] + x[c[2]] + x[c[3]]) / 3.0 - x[c[0]]);
                const bool is_apex = kind() == CellKind::pyramid && c[0] == 4;
                if (!is_apex) {  // the whole of a pyramid is inverted then
                    EXPECT_GT(kernel.volume_ratio(e, folded), 0.05) << c[0];
                }
                EXPECT_LT(kernel.least_volume_ratio(e, folded), 0.0) << c[0];
            }
        }
    });
}

TEST(VirtualCentre, HasTheEnergyOfHemlInAnAffineState) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        test::Random random(3);
        const HemlKernel of_tetrahedra{kernel.law, 0.4};
        for (const double last : {1.1, 0.3, -0.4}) {  // also below the threshold, and inverted
            const auto X = random_cell<kind()>(random);
            const auto diagonals = test::random_diagonals(kind(), random);
            const auto e = kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
            const Mat3 F = random_deformation(
                random, {random.uniform(0.8, 1.2), random.uniform(0.8, 1.2), last});
            const Tetrahedron Y = random_tetrahedron(random);
            const auto t = of_tetrahedra.precompute(Y, fibre);
            const double density = of_tetrahedra.energy(t, deformed(Y, F)) / t.volume;
            const auto x = moved<kind()>(X, F, 0.0, random);
            EXPECT_NEAR(kernel.energy(e, x), e.volume * density,
                        1e-9 * e.volume * (std::abs(density) + 1e3));
            EXPECT_NEAR(kernel.volume_ratio(e, x), F.determinant(), 1e-12);
        }
    });
}

TEST(VirtualCentre, KnowsItsTangentAtRest) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        test::Random random(5);
        const auto X = random_cell<kind()>(random);
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto e = kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
        // At rest fibres are on the verge of being slack, where the tangent has two values.
        auto x = X;
        for (Vec3& corner : x) corner += 1e-9 * fibre.dot(corner) * fibre;
        const auto K = kernel.rest_tangent(e);
        EXPECT_LE((K - kernel.tangent(e, x)).norm(), 1e-6 * K.norm());
    });
}

TEST(VirtualCentre, KeepsMomentaAndBoundsItsStiffness) {
    double highest = 0.0;  // share of the bound that a cell reaches
    for_each_kernel_of_cells([&](const auto& kernel, auto kind) {
        test::Random random(4);
        for (int i = 0; i < 60; ++i) {
            const double strain = 0.05 * (i % 6);
            const auto X = random_cell<kind()>(random);
            const auto diagonals = test::random_diagonals(kind(), random);
            const auto e =
                i % 12 < 6 ? kernel.precompute(X, fibre, {}, diagonals)
                           : kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
            const auto x =
                moved<kind()>(X, gentle_deformation(random, strain), 0.3 * strain, random);
            Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
            double size = 0.0;
            const auto f = kernel.forces(e, x);
            for (std::size_t k = 0; k < x.size(); ++k) {
                force += f[k];
                torque += x[k].cross(f[k]);
                size += f[k].norm();
            }
            EXPECT_LE(force.norm(), 1e-12 * size + 1e-20);
            if (i % 6 != 0) {  // else there are no forces but by rounding
                EXPECT_LE(torque.norm(), 1e-11 * size * (X[1] - X[0]).norm());
            }
            // Of the tangent over the masses.
            const auto bounds = kernel.stiffness_bounds(e, X);
            const auto masses = kernel.mass_fractions(e);
            auto K = kernel.tangent(e, x);
            double bound = 0.0;
            for (std::size_t k = 0; k < masses.size(); ++k) {
                K.template middleRows<3>(static_cast<Eigen::Index>(3 * k)) /= std::sqrt(masses[k]);
                K.template middleCols<3>(static_cast<Eigen::Index>(3 * k)) /= std::sqrt(masses[k]);
                bound = std::max(bound, bounds[k] / masses[k] * kernel.stiffening(e, x));
            }
            const double stiffness = spectrum(K).values.maxCoeff();
            EXPECT_LE(stiffness, bound * (1.0 + 1e-12)) << "at a strain of " << strain;
            highest = std::max(highest, stiffness / bound);
        }
    });
    EXPECT_GT(highest, 0.85);
}

TEST(VirtualCentre, HasTheForcesOfTheReferenceOnLanesWithTheSameBitsOnEachProcessor) {
    for_each_kernel_of_cells([](const auto& kernel, auto kind) {
        constexpr std::size_t n = 19, num_corners = CentreDivision<kind()>::num_corners;
        test::Random random(6);
        SimdCentreElements<kind()> lanes;
        lanes.assign(n, kernel);
        std::vector<std::uint16_t> corners(num_corners * n);
        std::iota(corners.begin(), corners.end(), std::uint16_t{0});
        lanes.set_nodes(corners, static_cast<std::uint16_t>(num_corners * n));
        std::vector<LocalVector> positions(num_corners * n + 1), expected(positions.size());
        std::vector<double> stiffening;
        double scale = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const auto X = random_cell<kind()>(random);
            const auto diagonals = test::random_diagonals(kind(), random);
            const auto e =
                i % 3 == 0 ? kernel.precompute(X, fibre, {}, diagonals)
                           : kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
            const double share = i % 3 == 2 ? 0.7 : 1.0;
            lanes.set(i, e, share);
            // Gentle, at rest, crushed below the threshold, and inverted.
            const double last = i % 4 == 0 ? 1.1 : i % 4 == 1 ? 1.0 : i % 4 == 2 ? 0.2 : -0.3;
            const Mat3 F = random_deformation(
                random, {random.uniform(0.8, 1.2), random.uniform(0.8, 1.2), last});
            const auto x = i % 4 == 1 ? X : moved<kind()>(X, F, 0.05, random);
            const auto f = kernel.forces(e, x);
            stiffening.push_back(kernel.stiffening(e, x));
            for (std::size_t k = 0; k < num_corners; ++k) {
                positions[num_corners * i + k] = x[k];
                expected[num_corners * i + k] = Vec3(share * f[k]);
                scale = std::max(scale, f[k].norm());
            }
        }
        std::vector<double> factors(n);
        lanes.set_stiffening(kernel, positions.data(), factors);
        for (std::size_t i = 0; i < n; ++i)
            EXPECT_NEAR(factors[i], stiffening[i], 1e-6 * stiffening[i]);
        std::vector<LocalVector> first;
        for (const Processor processor : processors_at_hand()) {
            std::vector<LocalVector> forces(positions.size());
            centre_forces_for<kind()>(processor)(kernel.law, 0.4, lanes.groups(), lanes.extras(),
                                                 positions.data(), forces.data());
            for (std::size_t k = 0; k < num_corners * n; ++k)
                EXPECT_LE((forces[k].vector() - expected[k].vector()).norm(), 1e-11 * scale);
            if (first.empty()) first = forces;
            EXPECT_EQ(std::memcmp(forces.data(), first.data(), sizeof(LocalVector) * forces.size()),
                      0);
        }
    });
}

// In an affine state each tetrahedron of a cell is that of ViscousKernel; else the forces at the
// end of a step are the gradient of their potential, and the tangent is their difference.
TEST(CentreViscous, IsTheViscosityOfHemlInEachTetrahedron) {
    const std::vector<PronyTerm> prony{{0.3, 0.05}, {0.2, 0.5}};
    for_each_kernel_of_cells([&](const auto& elastic, auto kind) {
        test::Random random(8);
        CentreViscousKernel<kind()> kernel(elastic, prony);
        ViscousKernel of_tetrahedra(HemlKernel{elastic.law, 0.4}, prony);
        const auto X = random_cell<kind()>(random);
        const auto diagonals = test::random_diagonals(kind(), random);
        const auto e = kernel.precompute(X, fibre, random_shares<kind()>(random), diagonals);
        const Tetrahedron Y = random_tetrahedron(random);
        const auto t = of_tetrahedra.precompute(Y, fibre);
        std::vector<double> memory(kernel.history_size(2)),
            memory_of_t(of_tetrahedra.history_size(2));
        auto last = X;
        Tetrahedron last_of_t = Y;
        for (const double dt : {0.01, 0.03, 0.2}) {
            const Mat3 F = gentle_deformation(random, 0.15);
            const auto x = moved<kind()>(X, F, 0.0, random);
            kernel.begin_step(dt);
            of_tetrahedra.begin_step(dt);
            const double taken = kernel.advance(e, last, x, memory);
            const double expected =
                of_tetrahedra.advance(t, last_of_t, deformed(Y, F), memory_of_t) / t.volume;
            EXPECT_NEAR(taken, e.volume * expected, 1e-9 * e.volume * (std::abs(expected) + 1e2));
            for (std::size_t k = 0; k < 6; ++k)
                EXPECT_NEAR(memory[6 * CentreDivision<kind()>::num_parts + k], memory_of_t[6 + k],
                            1e-8 * (std::abs(memory_of_t[6 + k]) + 1e2));
            last = x;
            last_of_t = deformed(Y, F);
        }
        auto x = moved<kind()>(X, gentle_deformation(random, 0.1), 0.05, random);
        const auto end = kernel.end_of_step(memory, 0.02);
        const auto f = kernel.forces(e, x, end);
        const auto K = element_tangent(kernel, e, x, end);
        double scale = 0.0;
        for (const Vec3& force : f) scale = std::max(scale, force.norm());
        const double h = 1e-4 * (X[1] - X[0]).norm();
        for (std::size_t k = 0; k < x.size(); ++k)
            for (int c = 0; c < 3; ++c) {
                const double at = x[k][c];
                const auto shifted = [&](double d, auto value) {
                    x[k][c] = at + d;
                    const auto result = value();
                    x[k][c] = at;
                    return result;
                };
                const auto potential = [&] { return kernel.potential(e, x, end); };
                EXPECT_NEAR(f[k][c],
                            -(8.0 * (shifted(h, potential) - shifted(-h, potential)) -
                              (shifted(2 * h, potential) - shifted(-2 * h, potential))) /
                                (12.0 * h),
                            1e-6 * scale);
                const auto first = [&] { return kernel.forces(e, x, end)[0]; };
                const Vec3 change = (8.0 * (shifted(h, first) - shifted(-h, first)) -
                                     (shifted(2 * h, first) - shifted(-2 * h, first))) /
                                    (12.0 * h);
                EXPECT_LE((K.template block<3, 1>(0, static_cast<Eigen::Index>(3 * k) + c) + change)
                              .norm(),
                          1e-6 * K.norm());
            }
    });
}

TEST(VirtualCentre, RefusesWhatHasNoVolumeSomewhere) {
    auto X = unit_cell<CellKind::hexahedron>();
    EXPECT_FALSE(VirtualCentreKernel<CellKind::hexahedron>::why_no_cell(X));
    X[6] = Vec3(0.1, 0.1, 0.2);
    EXPECT_TRUE(VirtualCentreKernel<CellKind::hexahedron>::why_no_cell(X));
}

/// The deflection of a cantilever of square section, six times as long as high, by a force at its
/// end, over that of Timoshenko's beam.
double deflection(CellKind kind, int n, double nu) {
    const double length = 0.6, height = 0.1, young = 1e4, force = 1e-4;
    const topology::Mesh mesh =
        topology::Mesh::build(
            topology::box_mesh(kind, Vec3::Zero(), {length, height, height}, {6 * n, n, n}))
            .mesh;
    BoundaryConditions s;
    s.constraints.push_back(
        holding("wall", nodes_where(mesh, [](const Vec3& X) { return X[0] < 1e-9; })));
    Load load;
    load.name = "end";
    const auto end = nodes_where(mesh, [&](const Vec3& X) { return X[0] > length - 1e-9; });
    load.kind = NodalLoad{VertexSet(end), Vec3(0, 0, -force / static_cast<double>(end.size()))};
    load.factor = TimeCurve<double>({{0.0, 0.0}, {1.0, 1.0}});
    s.loads.push_back(load);
    const double lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), mu = young / (2 * (1 + nu));
    Model model(mesh, table_of_one_law(NeoHookean{0.5 * mu, lambda}), s);
    Statics().step(model, 0.0, 1.0);
    double sum = 0.0;
    for (const VertexId v : end)
        sum += mesh.rest_position(v).z() - model.mesh_positions()[v.index()].z();
    const double inertia = std::pow(height, 4) / 12.0, shear = mu * height * height * 5.0 / 6.0;
    const double beam =
        force * std::pow(length, 3) / (3.0 * young * inertia) + force * length / shear;
    return sum / static_cast<double>(end.size()) / beam;
}

TEST(VirtualCentre, DoesNotLockInBending) {
    for (const double nu : {0.3, 0.499}) {
        const double of_hexahedra = deflection(CellKind::hexahedron, 4, nu);
        EXPECT_GT(of_hexahedra, 0.88) << nu;
        EXPECT_LT(of_hexahedra, 1.0) << nu;
    }
    // Tetrahedra lock: the comparison holds that the load and the beam are what they should be.
    EXPECT_LT(deflection(CellKind::tetrahedron, 4, 0.499), 0.2);
}

}  // namespace
}  // namespace incise::physics
