// The fast forces and energies against the reference, on each kind of processor at hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_heml_elements.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "tests/physics/processors_at_hand.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

/// In both precisions.
template <class Number>
class SimdHemlElementsOf : public testing::Test {
  protected:
    static constexpr bool is_single = sizeof(Number) == sizeof(float);
    /// Of the forces at rest: by stiffness times area of a side.
    static constexpr double rounding_at_rest = is_single ? 2e-7 : 1e-14;

    /// Of forces, where the strain of an element is of the order of one. In floats more of laws
    /// that raise stretches to powers of up to 19, or to those of e.
    static double rounding(const Law& law) {
        if (!is_single) return 1e-12;
        const bool is_steep =
            std::holds_alternative<Ogden>(law) || std::holds_alternative<IsochoricFungDemiray>(law);
        return is_steep ? 1e-4 : 2e-6;
    }

    template <class Visit>
    static void for_each_kernel_of_it(Visit visit) {
        for_each_heml_kernel([&](const std::string& name, auto kernel) {
            SCOPED_TRACE(name);
            if (is_single) kernel.precision = Precision::single_precision;
            visit(kernel);
        });
    }
};
using Numbers = testing::Types<double, float>;
TYPED_TEST_SUITE(SimdHemlElementsOf, Numbers, );

/// Tetrahedra that share no node, as lanes have them.
template <class Number>
struct Elements {
    SimdHemlElements lanes;
    LinkGroups<Number> groups;
    std::vector<LocalVector> positions;
    std::vector<Tetrahedron> expected;                     // forces by the reference
    std::vector<double> volumes, energies, volume_ratios;  // these, too

    Elements(const HemlKernel& kernel, const std::vector<Tetrahedron>& rest,
             const std::vector<Tetrahedron>& now) {
        const auto spare = static_cast<std::uint16_t>(4 * rest.size());
        lanes.assign(rest.size(), kernel);
        std::vector<std::uint16_t> corners(4 * rest.size());
        std::iota(corners.begin(), corners.end(), std::uint16_t{0});
        lanes.set_nodes(corners, spare);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const auto element = kernel.precompute(rest[i], fibre_direction());
            for (const Vec3& x : now[i]) positions.emplace_back(x);
            lanes.set(i, element);
            expected.push_back(kernel.forces(element, now[i]));
            volumes.push_back(element.volume);
            energies.push_back(kernel.energy(element, now[i]));
            volume_ratios.push_back(kernel.volume_ratio(element, now[i]));
        }
        positions.emplace_back();
        groups = lanes.groups<Number>();
    }

    std::vector<LocalVector> forces(const HemlKernel& kernel, Processor processor) const {
        std::vector<LocalVector> f(positions.size());
        heml_forces_for<Number>(processor)(kernel.law, kernel.inversion_threshold, groups,
                                           positions.data(), f.data(), {});
        return f;
    }

    /// By number of the element.
    std::vector<double> lane_energies(const HemlKernel& kernel, Processor processor) const {
        std::vector<ElementEnergies> of_groups(groups.links.size());
        heml_energies_for(processor)(kernel.law, kernel.inversion_threshold, groups,
                                     positions.data(), of_groups.data());
        std::vector<double> result;
        for (std::size_t i = 0; i < energies.size(); ++i) {
            const ElementEnergies& group = of_groups[i % of_groups.size()];
            result.push_back(group.energy[i / of_groups.size()]);
            const double ratio = group.volume_ratio[i / of_groups.size()];
            if (positions[4 * i + 2].vector().allFinite()) {
                EXPECT_EQ(ratio, volume_ratios[i]);
            }
        }
        return result;
    }
};

template <class Number>
Elements<Number> random_elements(const HemlKernel& kernel, std::size_t n, test::Random& random) {
    std::vector<Tetrahedron> rest, now;
    for (std::size_t i = 0; i < n; ++i) {
        rest.push_back(random_tetrahedron(random, 0.01));
        const double last = i % 3 == 0 ? random.uniform(-1.5, 0.5) : random.uniform(0.6, 1.6);
        now.push_back(deformed(
            rest.back(), random_deformation(
                             random, {random.uniform(0.6, 1.6), random.uniform(0.6, 1.6), last})));
    }
    return {kernel, rest, now};
}

double stiffness(const HemlKernel& kernel) { return rest_lambda(kernel.law) + rest_mu(kernel.law); }

// Over strained, flattened and inverted states.
TYPED_TEST(SimdHemlElementsOf, HaveTheForcesOfTheReference) {
    test::Random random(1);
    this->for_each_kernel_of_it([&](const HemlKernel& kernel) {
        for (const std::size_t n : {std::size_t{1}, std::size_t{7}, std::size_t{203}}) {
            const auto elements = random_elements<TypeParam>(kernel, n, random);
            const auto f = elements.forces(kernel, Processor::plain);
            for (std::size_t i = 0; i < n; ++i) {
                double scale = 1e-4 * stiffness(kernel);
                for (const Vec3& g : elements.expected[i]) scale = std::max(scale, g.norm());
                for (std::size_t k = 0; k < 4; ++k)
                    EXPECT_LE((f[4 * i + k].vector() - elements.expected[i][k]).norm(),
                              this->rounding(kernel.law) * scale);
            }
        }
    });
}

/// Ogden's law of one to three terms, and stretches to find from its invariants: alike or nearly
/// so, also with the third of them apart, in elements small and large, crushed and turned inside
/// out.
template <class Visit>
void for_each_case_of_ogden(Visit visit) {
    const Ogden laws[] = {{{{{3846.0, 4.0}}}, 1, 8333.0},
                          {{{{670.0, -19.0}}}, 1, 6000.0},
                          {{{{10.0, 40.0}}}, 1, 1e5},
                          {{{{2500.0, 4.0}, {500.0, -2.0}}}, 2, 8000.0},
                          {{{{2000.0, 1.3}, {900.0, 5.0}, {700.0, -3.0}}}, 3, 20000.0}};
    test::Random random(7);
    for (const Ogden& law : laws)
        for (const double spread : {0.0, 1e-9, 1e-7, 1e-5, 1e-3, 1e-1})
            for (const double size : {0.1, 0.6, 1.0, 1.6, 20.0}) {
                const Vec3 alike = Vec3::Constant(size * random.uniform(1.0, 1.2)) +
                                   spread * size * (random.vector(1.0) + Vec3::Ones());
                for (const double third : {1.0, 1.7, -1.0})
                    visit(law, Vec3(alike[0], alike[1], third * alike[2]));
            }
}

TYPED_TEST(SimdHemlElementsOf, HaveReferenceForcesWhereStretchesAreAlike) {
    test::Random random(8);
    for_each_case_of_ogden([&](const Ogden& law, const Vec3& stretches) {
        HemlKernel kernel{law, 0.4};
        if (this->is_single) kernel.precision = Precision::single_precision;
        std::vector<Tetrahedron> rest, now;
        for (int i = 0; i < 8; ++i) {
            rest.push_back(random_tetrahedron(random, 0.01));
            now.push_back(deformed(rest.back(), random_deformation(random, stretches)));
        }
        const Elements<TypeParam> elements(kernel, rest, now);
        // A high power has as many times the rounding of its base.
        const double tolerance =
            this->rounding(law) * std::max(1.0, 0.25 * std::abs(law.terms[0].alpha));
        const auto f = elements.forces(kernel, Processor::plain);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            double scale = 1e-4 * stiffness(kernel);
            for (const Vec3& g : elements.expected[i]) scale = std::max(scale, g.norm());
            if (this->is_single && scale > 1e30) continue;  // more than floats hold
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE((f[4 * i + k].vector() - elements.expected[i][k]).norm(),
                          tolerance * scale)
                    << "alpha " << law.terms[0].alpha << ", stretches " << stretches.transpose();
        }
    });
}

TYPED_TEST(SimdHemlElementsOf, HaveTheSameBitsOnEachProcessor) {
    test::Random random(2);
    this->for_each_kernel_of_it([&](const HemlKernel& kernel) {
        auto elements = random_elements<TypeParam>(kernel, 100, random);
        // Few nodes, which lanes share: the order of sums tells.
        for (auto& group : elements.groups.links)
            for (auto& corner : group.offsets)
                for (std::uint16_t& place : corner)
                    place = static_cast<std::uint16_t>(place % offset_of(12));
        const auto expected = elements.forces(kernel, Processor::plain);
        for (const Processor processor : processors_at_hand()) {
            const auto f = elements.forces(kernel, processor);
            EXPECT_EQ(std::memcmp(f.data(), expected.data(), f.size() * sizeof(LocalVector)), 0)
                << static_cast<int>(processor);
        }
    });
}

TYPED_TEST(SimdHemlElementsOf, AreFreeOfForcesAtRest) {
    test::Random random(3);
    this->for_each_kernel_of_it([&](const HemlKernel& kernel) {
        // Far off, positions are rounded themselves: by 1e-13 m.
        for (const double far : {0.0, 1e3}) {
            std::vector<Tetrahedron> rest;
            for (int i = 0; i < 50; ++i) {
                rest.push_back(random_tetrahedron(random, 0.01));
                for (Vec3& x : rest.back()) x += Vec3(far, -far, 2.0 * far);
            }
            const Elements<TypeParam> elements(kernel, rest, rest);
            const double tolerance =
                far > 0.0 ? std::max(this->rounding_at_rest, 1e-9) : this->rounding_at_rest;
            for (const LocalVector& f : elements.forces(kernel, processor()))
                EXPECT_LE(f.vector().norm(), tolerance * 1e-4 * stiffness(kernel));
        }
    });
}

TYPED_TEST(SimdHemlElementsOf, AddUpToNothingAndHaveNoMoment) {
    test::Random random(6);
    this->for_each_kernel_of_it([&](const HemlKernel& kernel) {
        const auto elements = random_elements<TypeParam>(kernel, 100, random);
        const auto f = elements.forces(kernel, processor());
        for (std::size_t i = 0; i < 100; ++i) {
            Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
            double scale = 0.0, moment_scale = 1e-6 * stiffness(kernel);
            for (std::size_t k = 0; k < 4; ++k) {
                const Vec3 force = f[4 * i + k].vector(),
                           arm = elements.positions[4 * i + k].vector() -
                                 elements.positions[4 * i].vector();
                sum += force;
                moment += arm.cross(force);
                scale += force.norm();
                moment_scale += arm.norm() * force.norm();
            }
            EXPECT_LE(sum.norm(), 1e-15 * scale);
            EXPECT_LE(moment.norm(), (this->is_single ? 5e-7 : 1e-14) * moment_scale);
        }
    });
}

TYPED_TEST(SimdHemlElementsOf, PassOnWhatIsNotANumber) {
    test::Random random(4);
    this->for_each_kernel_of_it([&](const HemlKernel& kernel) {
        auto elements = random_elements<TypeParam>(kernel, 9, random);
        elements.positions[14].data()[1] = std::nan("");
        const auto f = elements.forces(kernel, processor());
        for (std::size_t i = 0; i < 9; ++i)
            EXPECT_EQ(f[4 * i].vector().allFinite(), i != 3) << "element " << i;
    });
}

/// A relative error of a power's base is as many times that of the power.
double steepness(const Law& law) {
    const auto* ogden = std::get_if<Ogden>(&law);
    return ogden ? std::max(1.0, 0.25 * std::abs(ogden->terms[0].alpha)) : 1.0;
}

void expect_energies_of_reference(const HemlKernel& kernel, const Elements<double>& elements,
                                  double strain) {
    const auto energies = elements.lane_energies(kernel, Processor::plain);
    for (std::size_t i = 0; i < energies.size(); ++i) {
        const double scale = std::max(std::abs(elements.energies[i]),
                                      strain * stiffness(kernel) * elements.volumes[i]);
        EXPECT_NEAR(energies[i], elements.energies[i], 1e-12 * steepness(kernel.law) * scale);
    }
}

template <class Number>
std::vector<ElementResult> results_of(const HemlKernel& kernel, const Elements<Number>& elements) {
    std::vector<ElementResult> results(elements.volumes.size());
    for (std::size_t i = 0; i < results.size(); ++i) results[i].volume = elements.volumes[i];
    elements.lanes.set_results(kernel, elements.positions.data(), results);
    return results;
}

// Over strained, flattened and inverted states.
TEST(SimdHemlElements, HaveTheResultsOfTheReference) {
    test::Random random(15);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        for (const std::size_t n : {std::size_t{1}, std::size_t{7}, std::size_t{203}}) {
            const auto elements = random_elements<double>(kernel, n, random);
            const auto results = results_of(kernel, elements);
            const auto energies = elements.lane_energies(kernel, Processor::plain);
            for (std::size_t i = 0; i < n; ++i) {
                EXPECT_EQ(results[i].energy, energies[i]);
                EXPECT_EQ(results[i].volume_ratio, elements.volume_ratios[i]);
                Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();
                double size = 1e-2 * stiffness(kernel) * elements.volumes[i];
                for (std::size_t k = 1; k < 4; ++k) {
                    const Vec3 edge =
                        elements.positions[4 * i + k].vector() - elements.positions[4 * i].vector();
                    virial += elements.expected[i][k] * edge.transpose();
                    size += elements.expected[i][k].norm() * edge.norm();
                }
                const double present = elements.volumes[i] * elements.volume_ratios[i];
                EXPECT_LE((results[i].cauchy_stress * present + virial).norm(),
                          1e-12 * steepness(kernel.law) * size);
            }
        }
    });
}

// As the forces: but for laws of which the reference has a rest of rounding there.
TEST(SimdHemlElements, HaveNoStressAtRestButRounding) {
    test::Random random(16);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        std::vector<Tetrahedron> rest;
        for (int i = 0; i < 50; ++i) rest.push_back(random_tetrahedron(random, 0.01));
        const Elements<double> elements(kernel, rest, rest);
        for (const ElementResult& result : results_of(kernel, elements))
            EXPECT_LE(result.cauchy_stress.norm(), 1e-12 * stiffness(kernel));
    });
}

TEST(SimdHemlElements, HaveTheSameResultBitsOnEachProcessor) {
    test::Random random(17);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        const auto elements = random_elements<double>(kernel, 100, random);
        const auto states_on = [&](Processor processor) {
            std::vector<ElementStates> states(elements.groups.links.size());
            heml_states_for(processor)(kernel.law, kernel.inversion_threshold, elements.groups,
                                       elements.positions.data(), states.data());
            return states;
        };
        const auto expected = states_on(Processor::plain);
        for (const Processor processor : processors_at_hand()) {
            const auto states = states_on(processor);
            EXPECT_EQ(
                std::memcmp(states.data(), expected.data(), states.size() * sizeof(ElementStates)),
                0)
                << static_cast<int>(processor);
        }
    });
}

// Over strained, flattened and inverted states.
TEST(SimdHemlElements, HaveTheEnergiesAndVolumesOfTheReference) {
    test::Random random(11);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        for (const std::size_t n : {std::size_t{1}, std::size_t{7}, std::size_t{203}}) {
            const auto elements = random_elements<double>(kernel, n, random);
            expect_energies_of_reference(kernel, elements, 1e-2);
            Sum sum;
            double size = 0.0;
            for (const double energy : elements.energies) sum += energy, size += std::abs(energy);
            const auto* x = elements.positions.data();
            const BlockState state = elements.lanes.state(kernel, x);
            EXPECT_NEAR(state.elastic_energy.value(), sum.value(),
                        1e-12 * steepness(kernel.law) * size);
            EXPECT_EQ(state.min_volume_ratio, *std::min_element(elements.volume_ratios.begin(),
                                                                elements.volume_ratios.end()));
        }
    });
    for_each_case_of_ogden([&](const Ogden& law, const Vec3& stretches) {
        const HemlKernel kernel{law, 0.4};
        std::vector<Tetrahedron> rest, now;
        for (int i = 0; i < 8; ++i) {
            rest.push_back(random_tetrahedron(random, 0.01));
            now.push_back(deformed(rest.back(), random_deformation(random, stretches)));
        }
        expect_energies_of_reference(kernel, Elements<double>(kernel, rest, now), 1e-2);
    });
}

// Where parts of shape and of volume cancel, no more is lost than in the reference: by the first
// power of strain, or what one has for rounding where a law subtracts that.
TEST(SimdHemlElements, HaveTheEnergiesOfTheReferenceNearRest) {
    test::Random random(12);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        for (const double strain : {1e-2, 1e-4, 1e-6, 1e-9}) {
            std::vector<Tetrahedron> rest, now;
            for (int i = 0; i < 40; ++i) {
                rest.push_back(random_tetrahedron(random, 0.01));
                now.push_back(deformed(
                    rest.back(), random_deformation(random, Vec3::Ones() + random.vector(strain))));
            }
            expect_energies_of_reference(kernel, Elements<double>(kernel, rest, now),
                                         std::max(strain, 1e-2));
        }
    });
}

TEST(SimdHemlElements, HaveNoEnergyAtRest) {
    test::Random random(13);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        for (const double far : {0.0, 1e3}) {
            std::vector<Tetrahedron> rest;
            for (int i = 0; i < 50; ++i) {
                rest.push_back(random_tetrahedron(random, 0.01));
                for (Vec3& x : rest.back()) x += Vec3(far, -far, 2.0 * far);
            }
            const Elements<double> elements(kernel, rest, rest);
            for (const double energy : elements.lane_energies(kernel, processor()))
                EXPECT_EQ(energy, 0.0);
            const BlockState state = elements.lanes.state(kernel, elements.positions.data());
            EXPECT_EQ(state.elastic_energy.value(), 0.0);
            EXPECT_EQ(state.min_volume_ratio, 1.0);
        }
    });
}

TEST(SimdHemlElements, HaveTheSameEnergyBitsOnEachProcessor) {
    test::Random random(14);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        const auto elements = random_elements<double>(kernel, 100, random);
        const auto expected = elements.lane_energies(kernel, Processor::plain);
        for (const Processor processor : processors_at_hand())
            EXPECT_EQ(elements.lane_energies(kernel, processor), expected)
                << static_cast<int>(processor);
    });
}

TEST(SimdHemlElements, PassOnEnergiesThatAreNotNumbers) {
    test::Random random(15);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        auto elements = random_elements<double>(kernel, 9, random);
        elements.positions[14].data()[1] = std::nan("");
        const auto energies = elements.lane_energies(kernel, processor());
        for (std::size_t i = 0; i < energies.size(); ++i)
            EXPECT_EQ(std::isfinite(energies[i]), i != 3) << "element " << i;
    });
}

// What a law says of itself spares the fast forces the terms.
TEST(SimdHemlElements, SpareTermsThatAreZero) {
    test::Random random(5);
    for (const NamedLaw& named : test_laws())
        std::visit(
            [&]<class L>(const L& law) {
                for (int i = 0; i < 100; ++i) {
                    const LinkStrain<double> s{random.uniform(-1, 2), random.uniform(0, 3),
                                               random.uniform(-1, 2), random.uniform(-1, 2)};
                    const auto r = law.response(s, 0.4);
                    if (!NeedsB<L>) {
                        EXPECT_EQ(r.w_b, 0.0) << named.name;
                    }
                    if (!NeedsJ<L>) {
                        EXPECT_EQ(r.w_J, 0.0) << named.name;
                    }
                }
            },
            named.law);
}

TYPED_TEST(SimdHemlElementsOf, StiffeningEqualsThatOfTheReference) {
    this->for_each_kernel_of_it([](const auto& kernel) {
        test::Random random(7);
        std::vector<Tetrahedron> rest, now;
        for (int i = 0; i < 37; ++i) {
            rest.push_back(random_tetrahedron(random));
            const auto stretch = [&] { return random.uniform(i % 5 == 0 ? -0.5 : 0.7, 1.6); };
            const Mat3 F = random_deformation(random, {stretch(), stretch(), stretch()});
            now.push_back(deformed(rest.back(), F));
        }
        const Elements<TypeParam> elements(kernel, rest, now);
        std::vector<double> factors(rest.size());
        elements.lanes.set_stiffening(kernel, elements.positions.data(), factors);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const double expected = kernel.stiffening(kernel.precompute(rest[i]), now[i]);
            // Floats keep stretches apart that are nearer than 3e-4.
            EXPECT_NEAR(factors[i], expected,
                        (sizeof(TypeParam) == sizeof(float) ? 2e-3 : 1e-7) * expected);
        }
    });
}

}  // namespace
}  // namespace incise::physics
