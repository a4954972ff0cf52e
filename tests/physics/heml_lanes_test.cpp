// The fast forces against the reference, on each kind of processor at hand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/heml_lanes.h"

#include <gtest/gtest.h>

#include <cstring>

#include "physics/test_materials.h"

namespace incise::physics {
namespace {

std::vector<Processor> processors_at_hand() {
    std::vector<Processor> all{Processor::plain, Processor::avx2, Processor::avx512};
    while (all.back() > processor()) all.pop_back();
    return all;
}

/// Tetrahedra that share no node, as lanes have them.
struct Elements {
    std::vector<LinkGroup> groups;
    std::vector<FibreGroup> fibres;
    std::vector<LocalVector> positions;
    std::vector<Tetrahedron> expected;  // by the reference

    Elements(const HemlKernel& kernel, const std::vector<Tetrahedron>& rest,
             const std::vector<Tetrahedron>& now) {
        HemlLanes lanes;
        const auto spare = static_cast<std::uint16_t>(4 * rest.size());
        lanes.assign(rest.size(), spare, kernel);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const auto element = kernel.precompute(rest[i], fibre_direction());
            std::array<std::uint16_t, 4> nodes;
            for (std::size_t k = 0; k < 4; ++k) {
                nodes[k] = static_cast<std::uint16_t>(4 * i + k);
                positions.emplace_back(now[i][k]);
            }
            lanes.set(i, element, nodes);
            expected.push_back(kernel.forces(element, now[i]));
        }
        positions.emplace_back();
        groups.assign(lanes.groups().begin(), lanes.groups().end());
        fibres.assign(lanes.fibres().begin(), lanes.fibres().end());
    }

    std::vector<LocalVector> forces(const HemlKernel& kernel, Processor processor) const {
        std::vector<LocalVector> f(positions.size());
        heml_forces_for(processor)(kernel.law, kernel.inversion_threshold, groups, fibres,
                                   positions.data(), f.data());
        return f;
    }
};

Elements random_elements(const HemlKernel& kernel, std::size_t n, test::Random& random) {
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

TEST(HemlLanes, HaveTheForcesOfTheReference) {
    test::Random random(1);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        for (const std::size_t n : {std::size_t{1}, std::size_t{7}, std::size_t{203}}) {
            const Elements elements = random_elements(kernel, n, random);
            const auto f = elements.forces(kernel, Processor::plain);
            for (std::size_t i = 0; i < n; ++i) {
                double scale = 1e-4 * (rest_lambda(kernel.law) + rest_mu(kernel.law));
                for (const Vec3& g : elements.expected[i]) scale = std::max(scale, g.norm());
                for (std::size_t k = 0; k < 4; ++k)
                    EXPECT_LE((f[4 * i + k].vector() - elements.expected[i][k]).norm(),
                              1e-12 * scale);
            }
        }
    });
}

TEST(HemlLanes, HaveTheSameBitsOnEachProcessor) {
    test::Random random(2);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        Elements elements = random_elements(kernel, 100, random);
        // Few nodes, which lanes share: the order of sums tells.
        for (LinkGroup& group : elements.groups)
            for (auto& corner : group.nodes)
                for (std::uint16_t& node : corner) node = static_cast<std::uint16_t>(node % 12);
        const auto expected = elements.forces(kernel, Processor::plain);
        for (const Processor processor : processors_at_hand()) {
            const auto f = elements.forces(kernel, processor);
            EXPECT_EQ(std::memcmp(f.data(), expected.data(), f.size() * sizeof(LocalVector)), 0)
                << static_cast<int>(processor);
        }
    });
}

TEST(HemlLanes, AreFreeOfForcesAtRest) {
    test::Random random(3);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        std::vector<Tetrahedron> rest;
        for (int i = 0; i < 50; ++i) rest.push_back(random_tetrahedron(random, 0.01));
        const Elements elements(kernel, rest, rest);
        for (const LocalVector& f : elements.forces(kernel, processor()))
            EXPECT_LE(f.vector().norm(), 1e-18 * (rest_lambda(kernel.law) + rest_mu(kernel.law)));
    });
}

TEST(HemlLanes, PassOnWhatIsNotANumber) {
    test::Random random(4);
    for_each_heml_kernel([&](const std::string& name, const HemlKernel& kernel) {
        SCOPED_TRACE(name);
        Elements elements = random_elements(kernel, 9, random);
        elements.positions[14].data()[1] = std::nan("");
        const auto f = elements.forces(kernel, processor());
        for (std::size_t i = 0; i < 9; ++i)
            EXPECT_EQ(f[4 * i].vector().allFinite(), i != 3) << "element " << i;
    });
}

// What a law says of itself spares the fast forces the terms.
TEST(HemlLanes, SpareTermsThatAreZero) {
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

}  // namespace
}  // namespace incise::physics
