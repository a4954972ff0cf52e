// The memory of viscous elements on lanes against the reference, on each kind of processor at hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_viscous_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "incise/physics/elements/viscous_kernel.h"
#include "tests/physics/processors_at_hand.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using Memory = std::vector<double>;

const std::vector<PronyTerm> three_terms{{0.3, 0.2}, {0.4, 5.0}, {0.1, 0.01}};

/// Calls visit(kernel) for each law with one, two and three terms.
template <class Visit>
void for_each_series_and_law(Visit visit) {
    for_each_heml_kernel([&](const std::string& name, const auto& elastic) {
        for (std::vector<PronyTerm> series; series.size() < three_terms.size();) {
            series.push_back(three_terms[series.size()]);
            SCOPED_TRACE(name + ", terms: " + std::to_string(series.size()));
            visit(ViscousKernel(elastic, series));
        }
    });
}

/// What stresses are like, and their rounding: that of the links in these, the law's otherwise. A
/// high power has as many times the rounding of its base.
double rounding(const Law& law) {
    const auto* ogden = std::get_if<Ogden>(&law);
    return 1e-12 * (ogden ? std::max(1.0, 0.25 * std::abs(ogden->terms[0].alpha)) : 1.0);
}
double stiffness(const Law& law) { return rest_lambda(law) + 2.0 * std::abs(rest_mu(law)); }

/// Tetrahedra that share no node, with a past; ids are not those of their order.
struct ViscousElements {
    ViscousKernel kernel;
    std::vector<LinkElement> elements;
    std::vector<Tetrahedron> before, now;
    std::vector<std::size_t> ids;
    std::size_t length;  // of what an element remembers: more than it needs
    Memory memory;
    SimdViscousElements lanes;

    ViscousElements(const ViscousKernel& of, std::size_t n, test::Random& random, double strain,
                    bool is_crushed)
        : kernel(of), length(ViscousKernel::history_size(kernel.terms.size()) + 5) {
        kernel.begin_step(0.05);
        lanes.assign(n, kernel);
        std::vector<std::uint16_t> corners(4 * n);
        std::iota(corners.begin(), corners.end(), std::uint16_t{0});
        lanes.set_nodes(corners, static_cast<std::uint16_t>(4 * n));
        memory.resize((2 * n + 3) * length);
        for (double& x : memory) x = random.uniform(-1.0, 1.0) * strain * stiffness(kernel.law);
        const auto stretches = [&]() -> Vec3 { return Vec3::Ones() + random.vector(strain); };
        for (std::size_t i = 0; i < n; ++i) {
            const Tetrahedron X = random_tetrahedron(random, 0.01);
            elements.push_back(kernel.precompute(X, fibre_direction()));
            Vec3 s = stretches();
            before.push_back(deformed(X, random_deformation(random, s)));
            s = stretches();
            if (is_crushed && i % 3 == 0) s[2] = random.uniform(-1.5, 0.3);
            now.push_back(deformed(X, random_deformation(random, s)));
            if (is_crushed && i % 5 == 0) std::swap(before.back(), now.back());
            ids.push_back(2 * i + 3);
            lanes.set(i, ElementId(ids[i]), elements[i]);
        }
    }
    static std::vector<LocalVector> local(const std::vector<Tetrahedron>& tetrahedra) {
        std::vector<LocalVector> offsets;
        for (const Tetrahedron& x : tetrahedra) offsets.insert(offsets.end(), x.begin(), x.end());
        offsets.emplace_back();
        return offsets;
    }
    std::span<double> of(Memory& all, std::size_t i) const {
        return std::span(all).subspan(ids[i] * length, length);
    }
    ViscousRule rule() const {
        return {kernel.law, kernel.inversion_threshold, 1.0 - kernel.long_time_share, kernel.steps};
    }
    std::vector<LocalVector> forces(Processor processor) const {
        const auto offsets = local(now);
        std::vector<LocalVector> f(offsets.size());
        viscous_functions_for(processor).add_forces(rule(), lanes.groups(), {memory.data(), length},
                                                    offsets.data(), f.data(), {});
        return f;
    }
    /// Of all in turn, by the reference.
    double advance_by_reference(Memory& all) const {
        double energy = 0.0;
        for (std::size_t i = 0; i < elements.size(); ++i)
            energy += kernel.advance(elements[i], before[i], now[i], of(all, i));
        return energy;
    }
    /// @param left_out numbers of the elements that lanes left to the reference
    double advance(Processor processor, Memory& all, std::vector<std::size_t>& left_out) const {
        return viscous_functions_for(processor).advance(
            rule(), lanes.groups(), {all.data(), length}, local(before).data(), local(now).data(),
            [&](std::size_t i) {
                left_out.push_back(i);
                return kernel.advance(elements[i], before[i], now[i], of(all, i));
            });
    }
    bool is_low(std::size_t i) const {
        return std::min(kernel.volume_ratio(elements[i], before[i]),
                        kernel.volume_ratio(elements[i], now[i])) < kernel.inversion_threshold;
    }
};

constexpr std::size_t numbers_of_elements[] = {1, 7, 8, 61};

TEST(SimdViscousElements, HaveTheForcesOfTheReference) {
    test::Random random(1);
    for_each_series_and_law([&](const ViscousKernel& kernel) {
        for (const std::size_t n : numbers_of_elements) {
            const ViscousElements elements(kernel, n, random, 0.4, true);
            const auto f = elements.forces(Processor::plain);
            Memory memory = elements.memory;
            for (std::size_t i = 0; i < n; ++i) {
                const auto expected = kernel.forces_of_memory(elements.elements[i], elements.now[i],
                                                              elements.of(memory, i));
                const double scale = 1e-4 * stiffness(kernel.law);
                for (std::size_t k = 0; k < 4; ++k)
                    EXPECT_LE((f[4 * i + k].vector() - expected[k]).norm(), 1e-12 * scale);
            }
            EXPECT_EQ(f.back().vector(), Vec3::Zero());  // of spare lanes
        }
    });
}

// Deformed, near rest and crushed: stresses, what terms remember, and the energy taken.
TEST(SimdViscousElements, AdvanceAsTheReference) {
    test::Random random(2);
    for_each_series_and_law([&](const ViscousKernel& kernel) {
        for (const double strain : {0.2, 1e-5, 0.0})
            for (const bool is_crushed : {false, true})
                for (const std::size_t n : numbers_of_elements) {
                    const ViscousElements elements(kernel, n, random, strain, is_crushed);
                    Memory memory = elements.memory, expected = memory;
                    std::vector<std::size_t> left_out;
                    const double energy = elements.advance(Processor::plain, memory, left_out);
                    const double expected_energy = elements.advance_by_reference(expected);
                    double largest = stiffness(kernel.law), energy_scale = 0.0;
                    for (std::size_t i = 0; i < n; ++i) {
                        const auto after = elements.of(expected, i);
                        double scale = stiffness(kernel.law);
                        for (const double x : after) scale = std::max(scale, std::abs(x));
                        largest = std::max(largest, scale);
                        energy_scale += elements.elements[i].volume * scale;
                        const auto got = elements.of(memory, i);
                        for (std::size_t k = 0; k < after.size(); ++k)
                            EXPECT_NEAR(got[k], after[k], rounding(kernel.law) * scale)
                                << "element " << i << ", number " << k;
                    }
                    EXPECT_NEAR(energy, expected_energy, rounding(kernel.law) * energy_scale);
                }
    });
}

TEST(SimdViscousElements, LeaveElementsBelowTheThresholdToTheReference) {
    test::Random random(3);
    for_each_series_and_law([&](const ViscousKernel& kernel) {
        const ViscousElements elements(kernel, 61, random, 0.2, true);
        Memory memory = elements.memory, expected = memory;
        std::vector<std::size_t> left_out, low;
        elements.advance(processor(), memory, left_out);
        elements.advance_by_reference(expected);
        for (std::size_t i = 0; i < 61; ++i)
            if (elements.is_low(i)) {
                low.push_back(i);
                const auto got = elements.of(memory, i), after = elements.of(expected, i);
                EXPECT_TRUE(std::equal(got.begin(), got.end(), after.begin()));
            }
        std::sort(left_out.begin(), left_out.end());
        EXPECT_EQ(left_out, low);
        EXPECT_GT(low.size(), 10u);
        EXPECT_LT(low.size(), 50u);
    });
}

TEST(SimdViscousElements, TouchNoMemoryButThatOfTheirElements) {
    test::Random random(4);
    const ViscousKernel kernel({soft_law, 0.4}, three_terms);
    const ViscousElements elements(kernel, 13, random, 0.2, true);
    Memory memory = elements.memory;
    std::vector<std::size_t> left_out;
    elements.advance(processor(), memory, left_out);
    const std::size_t used = ViscousKernel::history_size(kernel.terms.size());
    for (std::size_t place = 0; place < memory.size(); ++place) {
        const std::size_t id = place / elements.length;
        const bool is_theirs = std::count(elements.ids.begin(), elements.ids.end(), id) == 1 &&
                               place % elements.length < used;
        EXPECT_EQ(memory[place] != elements.memory[place], is_theirs) << place;
    }
}

TEST(SimdViscousElements, HaveTheSameBitsOnEachProcessor) {
    test::Random random(5);
    for_each_series_and_law([&](const ViscousKernel& kernel) {
        for (const std::size_t n : numbers_of_elements) {
            const ViscousElements elements(kernel, n, random, 0.3, true);
            const auto forces = elements.forces(Processor::plain);
            Memory memory = elements.memory;
            std::vector<std::size_t> left_out;
            const double energy = elements.advance(Processor::plain, memory, left_out);
            for (const Processor processor : processors_at_hand()) {
                SCOPED_TRACE(static_cast<int>(processor));
                const auto f = elements.forces(processor);
                EXPECT_EQ(std::memcmp(f.data(), forces.data(), f.size() * sizeof(LocalVector)), 0);
                Memory same = elements.memory;
                std::vector<std::size_t> same_left_out;
                EXPECT_EQ(elements.advance(processor, same, same_left_out), energy);
                EXPECT_EQ(same, memory);
                EXPECT_EQ(same_left_out, left_out);
            }
        }
    });
}

TEST(SimdViscousElements, RememberNothingAtRest) {
    test::Random random(6);
    for_each_series_and_law([&](const ViscousKernel& kernel) {
        ViscousElements elements(kernel, 61, random, 0.0, false);
        // To the bit where they were at rest: no deformation is computed.
        for (std::size_t i = 0; i < 61; ++i) {
            const Tetrahedron X = random_tetrahedron(random, 0.01);
            elements.elements[i] = kernel.precompute(X, fibre_direction());
            elements.before[i] = elements.now[i] = X;
            elements.lanes.set(i, ElementId(elements.ids[i]), elements.elements[i]);
        }
        std::fill(elements.memory.begin(), elements.memory.end(), 0.0);
        Memory memory = elements.memory;
        std::vector<std::size_t> left_out;
        EXPECT_EQ(elements.advance(processor(), memory, left_out), 0.0);
        for (const double x : memory) EXPECT_LE(std::abs(x), 1e-13 * stiffness(kernel.law));
        for (const LocalVector& f : elements.forces(processor()))
            EXPECT_EQ(f.vector(), Vec3::Zero());
    });
}

// A whole body, by ids with gaps and of two materials: what its elements remember after a step and
// the energy that it took are the reference's, in either precision of the elastic forces.
TEST(SimdViscousElements, FollowABodyInEitherPrecision) {
    const auto mesh = topology::Mesh::build(with_regions(test::jittered_cube(3, 0.2, 3), 2)).mesh;
    MaterialTable table;
    const std::vector<PronyTerm> one_term{{0.5, 0.01}}, two{{0.3, 0.02}, {0.4, 5.0}};
    table.materials = {{1000.0, HyperElasticLinks{soft_law, 0.4, one_term}},
                       {1100.0, HyperElasticLinks{SaintVenantKirchhoff{5e3, 3e3}, 0.4, two}}};
    table.of_region = {{0, 0}, {1, 1}};
    const ViscousKernel kernels[] = {ViscousKernel({soft_law, 0.4}, one_term),
                                     ViscousKernel({SaintVenantKirchhoff{5e3, 3e3}, 0.4}, two)};
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        table.precision = precision;
        Model model(mesh, table);
        test::Random random(7);
        set_state(model, random_state(mesh, random, 0.02, 0.5));
        double time = 0.0;
        const double dt = 0.3 * model.stable_step();
        for (int i = 0; i < 5; ++i) step(model, time, dt);
        ViscousHistory expected = model.state().history();
        const BodyState before = state_of(model);
        const double taken_before = model.energetics().dissipated_energy();
        step(model, time, dt);
        double taken = 0.0;
        for (const CellId e : living_elements(mesh)) {
            ViscousKernel kernel = kernels[mesh.region(e)];
            kernel.begin_step(dt);
            Tetrahedron X, x, next;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto n = mesh.corners(e)[k];
                X[k] = mesh.rest_position(n);
                x[k] = before.positions[n.index()];
                next[k] = model.positions()[n.index()];
            }
            taken += kernel.advance(kernel.precompute(X), x, next,
                                    expected.of(with_number_of<ElementId>(e)));
        }
        double scale = 0.0;
        for (const double x : expected.values()) scale = std::max(scale, std::abs(x));
        for (std::size_t i = 0; i < expected.values().size(); ++i)
            EXPECT_NEAR(model.state().history().values()[i], expected.values()[i], 1e-12 * scale);
        EXPECT_GT(std::abs(taken), 0.0);
        EXPECT_NEAR(model.energetics().dissipated_energy() - taken_before, taken, 1e-12 * scale);
    }
}

}  // namespace
}  // namespace incise::physics
