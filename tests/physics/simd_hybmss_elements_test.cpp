// Hybrid mass-spring cells side by side: forces, energies and stresses as of the reference, and the
// same bits on each processor.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "tests/physics/hybmss_cells.h"
#include "tests/physics/processors_at_hand.h"

namespace incise::physics {
namespace {

/// Cells side by side, each with nodes of its own, deformed.
template <class Number>
struct CellsInLanes {
    static constexpr std::size_t n = 19;  // no multiple of the lanes
    HybmssKernel kernel;
    HybmssKernel::Element element;
    SimdHybmssElements lanes;
    std::vector<LocalVector> positions{8 * n + 1};
    std::vector<Cell> cells;

    CellsInLanes(const HybmssKernel& of, const Cell& X, const HybmssKernel::Element& e,
                 test::Random& random)
        : kernel(of), element(e) {
        if (sizeof(Number) == sizeof(float)) kernel.precision = Precision::single_precision;
        lanes.assign(n, kernel);
        std::vector<std::uint16_t> corners(8 * n);
        std::iota(corners.begin(), corners.end(), std::uint16_t{0});
        lanes.set_nodes(corners, 8 * n);
        for (std::size_t i = 0; i < n; ++i) {
            const Mat3 F = random_deformation(random, {1.1, 0.9, random.uniform(-1.0, 1.5)});
            Cell x = shaken(deformed(X, F), random, 0.1);
            if (i == 3) x[1] = x[0];  // a spring without length
            if (i == 4) x = X;
            for (std::size_t k = 0; k < 8; ++k) positions[8 * i + k] = x[k];
            lanes.set(i, e);
            cells.push_back(x);
        }
    }
};

/// Of the fast forces, on each kind of processor at hand.
/// @param rounding  of them
template <class Number>
void expect_forces_of_the_reference(const CellsInLanes<Number>& all, double rounding) {
    // With few nodes, which lanes share, the order of sums tells.
    const auto groups = all.lanes.template groups<Number>();
    std::vector<CellGroup<Number>> sharing(groups.begin(), groups.end());
    for (auto& group : sharing)
        for (auto& corner : group.offsets)
            for (std::uint16_t& place : corner)
                place = static_cast<std::uint16_t>(place % offset_of(13));
    const auto forces_on = [&](Processor processor, std::span<const CellGroup<Number>> cells) {
        std::vector<LocalVector> f(all.positions.size());
        hybmss_forces_for<Number>(processor)(all.kernel.material.volume_modulus, cells,
                                             all.positions.data(), f.data(), {});
        return f;
    };
    const auto plain = forces_on(Processor::plain, groups),
               shared = forces_on(Processor::plain, sharing);
    for (std::size_t i = 0; i < all.cells.size(); ++i) {
        const Cell expected = all.kernel.forces(all.element, all.cells[i]);
        const double scale = force_scale(all.kernel, all.element) + sum_of_norms(expected);
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < 8; ++k) {
            const Vec3 f = plain[8 * i + k].vector();
            sum += f;
            EXPECT_LE((f - expected[k]).norm(), rounding * scale);
        }
        EXPECT_LE(sum.norm(), 1e-15 * scale);
    }
    for (const Processor p : processors_at_hand()) {
        const auto f = forces_on(p, groups), g = forces_on(p, sharing);
        EXPECT_EQ(std::memcmp(f.data(), plain.data(), f.size() * sizeof(LocalVector)), 0);
        EXPECT_EQ(std::memcmp(g.data(), shared.data(), g.size() * sizeof(LocalVector)), 0);
    }
}

TEST(SimdHybmssElements, HaveReferenceForcesAlikeOnEachProcessor) {
    test::Random random(12);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        expect_forces_of_the_reference(CellsInLanes<double>(kernel, X, e, random), 1e-12);
        expect_forces_of_the_reference(CellsInLanes<float>(kernel, X, e, random), 2e-6);
    });
}

TEST(SimdHybmssElements, HaveTheEnergiesAndStressesOfTheReference) {
    test::Random random(13);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        const CellsInLanes<double> all(kernel, X, e, random);
        std::vector<ElementResult> results(all.cells.size());
        for (ElementResult& result : results) result.volume = e.volume;
        all.lanes.set_results(kernel, all.positions.data(), results);
        Sum sum;
        double least = infinity, size = 0.0;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const Cell &x = all.cells[i], f = kernel.forces(e, x);
            const double energy = kernel.energy(e, x), ratio = kernel.volume_ratio(e, x);
            const double scale = kernel.stiffness_energy(e) + std::abs(energy);
            EXPECT_NEAR(results[i].energy, energy, 1e-14 * scale);
            EXPECT_EQ(results[i].volume_ratio, ratio);
            Mat3 virial = Mat3::Zero();
            for (std::size_t k = 1; k < 8; ++k) virial += f[k] * (x[k] - x[0]).transpose();
            const double present = e.volume * results[i].volume_ratio;
            EXPECT_LE((results[i].cauchy_stress * present + virial).norm(),
                      1e-13 * (scale + virial.norm()));
            sum += energy, size += scale;
            least = std::min(least, ratio);
        }
        const LocalVector* x = all.positions.data();
        const BlockState state = all.lanes.state(kernel, x);
        EXPECT_NEAR(state.elastic_energy.value(), sum.value(), 1e-14 * size);
        EXPECT_EQ(state.min_volume_ratio, least);
    });
}

// As the reference, where springs have their rest lengths to the bit.
TEST(SimdHybmssElements, HaveNoEnergyAndStressAtRest) {
    for (const double edge : {1.0, 0.125}) {
        const Cell X = box(Vec3::Constant(edge), Mat3::Identity(), Vec3(2.0, -1.0, 0.5));
        for (const double ratio : {0.0, 1.0, infinity}) {
            const HybmssKernel kernel{hybrid_springs(0.4, ratio)};
            const auto e = kernel.precompute(X);
            ASSERT_EQ(kernel.energy(e, X), 0.0);
            test::Random random(15);
            const CellsInLanes<double> all(kernel, X, e, random);  // number 4 is at rest
            std::vector<ElementResult> results(all.cells.size());
            for (ElementResult& result : results) result.volume = e.volume;
            all.lanes.set_results(kernel, all.positions.data(), results);
            EXPECT_EQ(results[4].energy, 0.0);
            EXPECT_EQ(results[4].volume_ratio, 1.0);
            EXPECT_TRUE(results[4].cauchy_stress.isZero(0.0));
        }
    }
}

// Boxes that are cubes but for rounding may have a few, and stiff cells push hard.
TEST(SimdHybmssElements, HaveResultsOfPushingSpringsAndStiffCells) {
    test::Random random(16);
    const Cell X = box({1.0, 1.0, 1.000005});
    const HybmssKernel soft{hybrid_springs(0.3, 1e-6)};
    HybmssKernel stiff{hybrid_springs(0.3, 1.0)};
    stiff.material.shear_modulus = stiff.material.volume_modulus = 1e12;
    for (const HybmssKernel& kernel : {soft, stiff}) {
        const auto e = kernel.precompute(X);
        const auto& k = e.springs.stiffnesses;
        EXPECT_EQ(*std::min_element(k.begin(), k.end()) < 0.0,
                  kernel.material.stiffness_ratio < 1.0);
        const CellsInLanes<double> all(kernel, X, e, random);
        std::vector<ElementResult> results(all.cells.size());
        for (ElementResult& result : results) result.volume = e.volume;
        all.lanes.set_results(kernel, all.positions.data(), results);
        for (std::size_t i = 0; i < results.size(); ++i) {
            const double energy = kernel.energy(e, all.cells[i]);
            EXPECT_NEAR(results[i].energy, energy,
                        1e-12 * (kernel.stiffness_energy(e) + std::abs(energy)));
            EXPECT_TRUE(results[i].cauchy_stress.allFinite());
        }
    }
}

TEST(SimdHybmssElements, HaveTheSameResultBitsOnEachProcessor) {
    test::Random random(14);
    for_each_cell([&](const HybmssKernel& kernel, const Cell& X, const auto& e) {
        const CellsInLanes<double> all(kernel, X, e, random);
        const auto groups = all.lanes.groups<double>();
        const double modulus = kernel.material.volume_modulus;
        const LocalVector* x = all.positions.data();
        std::vector<ElementStates> expected(groups.size()), states(groups.size());
        hybmss_states_for(Processor::plain)(modulus, groups, x, expected.data());
        std::vector<ElementEnergies> energies(groups.size());
        for (const Processor p : processors_at_hand()) {
            SCOPED_TRACE(static_cast<int>(p));
            hybmss_states_for(p)(modulus, groups, x, states.data());
            hybmss_energies_for(p)(modulus, groups, x, energies.data());
            for (std::size_t g = 0; g < groups.size(); ++g) {
                const ElementEnergies& alone = expected[g];
                EXPECT_EQ(std::memcmp(&states[g], &expected[g], sizeof states[g]), 0);
                EXPECT_EQ(std::memcmp(&energies[g], &alone, sizeof alone), 0);
            }
        }
    });
}

}  // namespace
}  // namespace incise::physics
