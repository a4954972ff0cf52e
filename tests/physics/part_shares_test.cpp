// HEML on cells of which a fragment has a share of each tetrahedron: masses, sums of fragments, and
// the patch test of a block that a plane cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "incise/fragments/part_volumes.h"
#include "incise/physics/elements/kernel_block.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/physics/elements/virtual_centre_kernel.h"
#include "incise/topology/box_mesh.h"
#include "tests/fragments/polyhedra.h"
#include "tests/fragments/random_cells.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

using fragments::PartNumbers;
using topology::CellKind;

const Law law_of_parts = NeoHookean{500.0, 4000.0};

/// The shares of the tetrahedra of a cell on one side of a plane.
template <CellKind kind>
std::vector<double> shares_beside(const typename CentreDivision<kind>::Corners& X,
                                  const Vec3& point, const Vec3& normal) {
    const PartNumbers fractions = fragments::part_fractions(
        kind, X, test::half_of(test::surface_of_cell<kind>(X), point, normal));
    return {fractions.begin(), fractions.begin() + CentreDivision<kind>::num_parts};
}

/// A plane through a random point of a cell.
struct CellCut {
    Vec3 point, normal;
    CellCut(const auto& X, test::Random& random) {
        double sum = 0.0;
        point.setZero();
        for (const Vec3& x : X) {
            const double weight = random.uniform();
            point += weight * x;
            sum += weight;
        }
        point /= sum;
        normal = random.vector(1.0).normalized();
    }
};

TEST(PartShares, AddUpToTheWholeInMassAndInAffineStates) {
    test::for_each_random_cell(20, [](auto kind, const auto& X, test::Random& random) {
        const VirtualCentreKernel<kind()> kernel{law_of_parts, 0.4};
        const CellCut cut(X, random);
        const auto whole = kernel.precompute(X);
        const auto a = kernel.precompute(X, {}, shares_beside<kind()>(X, cut.point, cut.normal)),
                   b = kernel.precompute(X, {}, shares_beside<kind()>(X, cut.point, -cut.normal));
        EXPECT_NEAR(a.volume + b.volume, whole.volume, 1e-13 * whole.volume);
        const auto of_whole = kernel.mass_fractions(whole), of_a = kernel.mass_fractions(a),
                   of_b = kernel.mass_fractions(b);
        Vec3 centre = Vec3::Zero(), exact = Vec3::Zero();
        const auto at = CentreDivision<kind()>::points(X);
        std::size_t t = 0;
        for (const auto& p : CentreDivision<kind()>::parts())
            exact += whole.volumes[t++] / whole.volume *
                     (0.25 * (at[p[0]] + at[p[1]] + at[p[2]] + at[p[3]]));
        for (std::size_t k = 0; k < X.size(); ++k) {
            EXPECT_NEAR(a.volume * of_a[k] + b.volume * of_b[k], whole.volume * of_whole[k],
                        1e-13 * whole.volume);
            EXPECT_GT(of_a[k], 0.0);
            EXPECT_GT(of_b[k], 0.0);
            centre += of_whole[k] * X[k];
        }
        EXPECT_NEAR(std::accumulate(of_a.begin(), of_a.end(), 0.0), 1.0, 1e-14);
        EXPECT_LE((centre - exact).norm(), 1e-15);

        const Mat3 F = random_deformation(random, {1.2, 0.9, 0.8});
        auto x = X;
        for (Vec3& corner : x) corner = F * corner;
        const double energy = kernel.energy(whole, x);
        EXPECT_NEAR(kernel.energy(a, x) + kernel.energy(b, x), energy, 1e-12 * energy);
        const auto f = kernel.forces(whole, x), f_a = kernel.forces(a, x),
                   f_b = kernel.forces(b, x);
        double scale = 0.0;
        for (const Vec3& force : f) scale = std::max(scale, force.norm());
        for (std::size_t k = 0; k < X.size(); ++k)
            EXPECT_LE((f_a[k] + f_b[k] - f[k]).norm(), 1e-12 * scale);
    });
}

// A fragment has the six rigid motions without energy and no others, and its step has a floor.
TEST(PartShares, LeaveNoMotionWithoutEnergyAndKeepTheStep) {
    double least_step = 1.0, least_stiffness = 1.0, least_mass = 1.0;
    test::for_each_random_cell(100, [&](auto kind, const auto& X, test::Random& random) {
        const VirtualCentreKernel<kind()> kernel{law_of_parts, 0.4};
        const CellCut cut(X, random);
        const auto whole = kernel.precompute(X),
                   e = kernel.precompute(X, {}, shares_beside<kind()>(X, cut.point, cut.normal));
        if (e.volume < 0.2 * whole.volume) return;  // light
        const auto quotient = [&](const auto& of) {
            return kernel.stiffness_bounds(of, X)[0] / (of.volume * kernel.mass_fractions(of)[0]);
        };
        least_step = std::min(least_step, std::sqrt(quotient(whole) / quotient(e)));
        // By the masses, as the motions of light corners are what counts.
        const auto lowest = [&](const auto& of) {
            const auto masses = kernel.mass_fractions(of);
            auto K = kernel.rest_tangent(of);
            for (std::size_t k = 0; k < X.size(); ++k) {
                const double by = 1.0 / std::sqrt(of.volume * masses[k]);
                K.template middleRows<3>(static_cast<Eigen::Index>(3 * k)) *= by;
                K.template middleCols<3>(static_cast<Eigen::Index>(3 * k)) *= by;
            }
            auto values = spectrum(K).values;
            std::sort(values.begin(), values.end());
            return values[6];
        };
        least_stiffness = std::min(least_stiffness, lowest(e) / lowest(whole));
        const auto masses = kernel.mass_fractions(e);
        least_mass = std::min(least_mass, *std::ranges::min_element(masses));
    });
    EXPECT_GT(least_step, 0.8);
    EXPECT_GT(least_stiffness, 0.3);
    EXPECT_GT(least_mass, 0.03);
}

TEST(PartShares, ThatAreAllTheSameAreOneFactorToTheBit) {
    test::for_each_random_cell(3, [](auto kind, const auto& X, test::Random& random) {
        using Kernel = VirtualCentreKernel<kind()>;
        std::vector<NodeId> corners;
        for (std::size_t k = 0; k < X.size(); ++k) corners.emplace_back(k);
        const std::vector<Vec3> at_rest(X.begin(), X.end());
        std::vector<Vec3> now = at_rest;
        for (Vec3& x : now) x += random.vector(0.002);
        const double share = 0.37;
        const std::vector<double> shares(Kernel::num_parts, share);
        std::array<std::vector<LocalVector>, 2> forces;
        std::array<NodalContributions, 2> contributions;
        std::array<double, 2> energies;
        for (const std::size_t i : {0u, 1u}) {
            KernelBlock<Kernel> block(Kernel{law_of_parts, 0.4}, 1000.0);
            block.insert(ElementId(0), {corners, at_rest, Vec3::Zero(), share,
                                        i == 0 ? std::span<const double>() : shares});
            std::vector<std::uint16_t> numbers(corners.size(), ElementBlock::unnumbered);
            block.number_nodes(numbers, at_rest);
            forces[i].resize(corners.size() + 1);
            block.compute_forces(block.local_positions(now), ViscousHistory(0, 1), forces[i], {});
            contributions[i] = block.contributions(ElementId(0));
            energies[i] = block.state(now).elastic_energy.value();
        }
        for (std::size_t k = 0; k < corners.size(); ++k)
            EXPECT_EQ(forces[0][k].vector(), forces[1][k].vector());
        EXPECT_EQ(contributions[0].mass, contributions[1].mass);
        EXPECT_EQ(contributions[0].stiffness, contributions[1].stiffness);
        EXPECT_EQ(energies[0], energies[1]);
    });
}

/// A block of hexahedra with jittered inner nodes under uniaxial tension along x. A plane that
/// contains the x axis parts it; each hexahedron that it crosses becomes two fragments.
/// Returns the largest force on a node that should have none, over the largest of all.
double imbalance_of_cut_block(const Vec3& normal, bool with_shares, std::uint64_t seed) {
    constexpr CellKind kind = CellKind::hexahedron;
    constexpr int n = 3;
    test::Random random(seed);
    auto data = topology::box_mesh(kind, Vec3::Zero(), Vec3::Ones(), {n, n, n});
    for (Vec3& x : data.points)
        if ((x.array() > 1e-9).all() && (x.array() < 1.0 - 1e-9).all())
            x += random.vector(0.12 / n);
    const topology::Mesh mesh = topology::Mesh::build(data).mesh;

    // The lateral stretch at which the stress is uniaxial.
    const HemlKernel heml{law_of_parts, 0.4};
    const Tetrahedron unit{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    const auto t = heml.precompute(unit);
    Mat3 F = Mat3::Identity();
    F(0, 0) = 1.3;
    double low = 0.5, high = 1.0;
    for (int i = 0; i < 80; ++i) {
        F(1, 1) = F(2, 2) = 0.5 * (low + high);
        (heml.forces(t, deformed(unit, F))[2].y() > 0.0 ? low : high) = F(1, 1);
    }

    const VirtualCentreKernel<kind> kernel{law_of_parts, 0.4};
    const Vec3 point(0.5, 0.47, 0.52);
    const std::size_t num_nodes = mesh.node_capacity();
    std::vector<Vec3> forces(2 * num_nodes, Vec3::Zero());  // on the copies of both sides
    int num_cut = 0;
    for (const CellId cell : mesh.elements()) {
        CentreDivision<kind>::Corners X, x;
        for (std::size_t k = 0; k < X.size(); ++k) {
            X[k] = mesh.rest_position(mesh.corners(cell)[k]);
            x[k] = F * X[k];
        }
        const auto whole = kernel.precompute(X);
        for (const std::size_t side : {0u, 1u}) {
            const auto shares =
                shares_beside<kind>(X, point, side == 0 ? Vec3(normal) : Vec3(-normal));
            const auto part = kernel.precompute(X, {}, shares);
            const double share = part.volume / whole.volume;
            if (share < 1e-12) continue;
            num_cut += share < 1.0 - 1e-12 ? 1 : 0;
            const auto f = kernel.forces(with_shares ? part : whole, x);
            for (std::size_t k = 0; k < X.size(); ++k)
                forces[side * num_nodes + mesh.corners(cell)[k].index()] +=
                    (with_shares ? 1.0 : share) * f[k];
        }
    }
    EXPECT_GT(num_cut, 2 * n);
    double largest = 0.0, unbalanced = 0.0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const double along = mesh.rest_position(VertexId(i % num_nodes)).x();
        const bool is_loaded = along < 1e-9 || along > 1.0 - 1e-9;
        largest = std::max(largest, forces[i].norm());
        if (is_loaded) forces[i].x() = 0.0;
        unbalanced = std::max(unbalanced, forces[i].norm());
    }
    return unbalanced / largest;
}

TEST(PartShares, PassThePatchTestOfAnObliqueCutAndOneFactorDoesNot) {
    for (const Vec3& normal : {Vec3(0, 1, 1), Vec3(0, 1, -0.3), Vec3(0, 0.2, 1), Vec3(0, 3, 2)})
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            EXPECT_LE(imbalance_of_cut_block(normal.normalized(), true, seed), 1e-11);
            EXPECT_GT(imbalance_of_cut_block(normal.normalized(), false, seed), 1e-2);
        }
}

// In a state that is not affine the two parts have mean volumes of their own: the cut changes the
// energy by the second order of the size of the cell.
TEST(PartShares, ChangeTheEnergyByTheSecondOrderOfTheSize) {
    std::array<double, 2> changes{};
    constexpr CellKind kind = CellKind::hexahedron;
    const VirtualCentreKernel<kind> kernel{law_of_parts, 0.4};
    for (const std::size_t i : {0u, 1u}) {
        test::Random random(3);
        const double size = i == 0 ? 0.04 : 0.02;
        for (int trial = 0; trial < 50; ++trial) {
            auto X = test::unit_cell<kind>();
            for (Vec3& x : X) x = size * (x + random.vector(0.1));
            const CellCut cut(X, random);
            auto x = X;
            for (Vec3& p : x)
                p = Vec3(1.1 * p.x() + 0.5 * p.x() * p.z(), p.y() - 0.4 * p.y() * p.z(),
                         0.95 * p.z() + 0.3 * p.x() * p.x());
            const auto energy = [&](const auto& e) { return kernel.energy(e, x); };
            const double whole = energy(kernel.precompute(X));
            const double parts =
                energy(kernel.precompute(X, {}, shares_beside<kind>(X, cut.point, cut.normal))) +
                energy(kernel.precompute(X, {}, shares_beside<kind>(X, cut.point, -cut.normal)));
            changes[i] += std::abs(parts / whole - 1.0) / 50.0;
        }
    }
    EXPECT_GT(changes[0], 3.0 * changes[1]);
    EXPECT_LT(changes[0], 1e-3);
}

}  // namespace
}  // namespace incise::physics
