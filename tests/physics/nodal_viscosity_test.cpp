// The nodal recursion of a Prony series: the paper's formula to the letter, its order, what edits
// do to it, and its limits, which are facts to be known: it does not turn with the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/nodal_viscous_kernel.h"
#include "physics/test_bodies.h"
#include "physics/viscous_kernel.h"
#include "topology/box_mesh.h"
#include "topology/mesh_edit.h"

namespace incise::physics {
namespace {

using topology::ChangeSet;
using topology::Mesh;
using topology::MeshEdit;

using Series = std::vector<PronyTerm>;
using Memory = std::vector<double>;

const Series two_terms{{0.3, 0.2}, {0.4, 5.0}};
const NeoHookean law{1923.0, 5769.0};

HyperElasticLinks links(const Series& series, PronyRule rule = PronyRule::nodal) {
    return {law, 0.4, series, rule};
}

/// Calls visit(name, kernel) for HEML with each law and two terms.
template <class Visit>
void for_each_nodal_kernel(Visit visit) {
    for_each_heml_kernel([&](const std::string& name, const auto& elastic) {
        visit(name, with_fibre(NodalViscousKernel<std::decay_t<decltype(elastic.law)>>(elastic,
                                                                                       two_terms)));
    });
}

Memory no_memory() {
    return Memory(NodalViscousKernel<NeoHookean>::history_size(two_terms.size()), 0.0);
}

// Eq. (20) on the forces of the nodes themselves, beside a moving body.
TEST(NodalViscosity, IsTheRecursionOfThePaper) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Model model(mesh, table_of_one_material(links(two_terms)));
    Model elastic(mesh, table_of_one_law(law));
    test::Random random(41);
    set_state(model, random_state(mesh, random, 0.03, 0.5));
    std::vector<std::vector<Vec3>> gamma(two_terms.size(),
                                         std::vector<Vec3>(mesh.node_capacity(), Vec3::Zero()));
    double time = 0.0;
    for (int i = 0; i < 50; ++i) {
        const double dt = (i % 3 == 0 ? 0.3 : 0.1) * model.stable_step();
        model.integrate(time, dt);
        time += dt;
        model.compute_forces(time);
        set_state(elastic, state_of(model));
        double largest = 0.0;
        for (const Vec3& f : elastic.elastic_forces()) largest = std::max(largest, f.norm());
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
            const Vec3 f = elastic.elastic_forces()[n];
            Vec3 expected = f;
            for (std::size_t k = 0; k < two_terms.size(); ++k) {
                const auto [alpha, tau] = two_terms[k];
                gamma[k][n] = dt * alpha / (dt + tau) * f + tau / (dt + tau) * gamma[k][n];
                expected -= gamma[k][n];
            }
            EXPECT_LE((model.elastic_forces()[n] - expected).norm(), 1e-12 * largest);
        }
    }
}

// A strain that comes at once and is held: the exact fading, to first order in the step.
TEST(NodalViscosity, RelaxesToFirstOrder) {
    const Mesh mesh = Mesh::build(test::jittered_cube(1, 0.1, 3)).mesh;
    test::Random random(42);
    const BodyState state = random_state(mesh, random, 0.05, 0.0);
    const auto error = [&](int steps) {
        Model model(mesh, table_of_one_material(links(two_terms), 1e30));  // too heavy to move
        Model elastic(mesh, table_of_one_law(law, 1e30));
        set_state(elastic, state);
        set_state(model, state);
        EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), elastic.elastic_forces()));
        double largest = 0.0;
        for (int i = 1; i <= steps; ++i) {
            model.integrate(0.0, 1.0 / steps);
            model.compute_forces(0.0);
            double share = 0.3;
            for (const auto& [alpha, tau] : two_terms)
                share += alpha * std::exp(-static_cast<double>(i) / steps / tau);
            for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
                const Vec3 f = elastic.elastic_forces()[n];
                largest =
                    std::max(largest, (model.elastic_forces()[n] - share * f).norm() / f.norm());
            }
        }
        // In the end the long-time moduli, of which the elastic energy is.
        for (int i = 0; i < 400; ++i) model.integrate(0.0, 1.0);
        model.compute_forces(0.0);
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            EXPECT_LE((model.elastic_forces()[n] - 0.3 * elastic.elastic_forces()[n]).norm(),
                      1e-12 * elastic.elastic_forces()[n].norm());
        EXPECT_NEAR(model.totals().elastic_energy, 0.3 * elastic.totals().elastic_energy,
                    1e-12 * elastic.totals().elastic_energy);
        EXPECT_EQ(model.stable_step(), elastic.stable_step());
        return largest;
    };
    const double coarse = error(50), middle = error(100), fine = error(200);
    EXPECT_NEAR(coarse / middle, 2.0, 0.15);
    EXPECT_NEAR(middle / fine, 2.0, 0.1);
    EXPECT_LT(fine, 0.005);
}

// Creep under a constant force of one term: strain = load/modulus (1/g - (1/g - 1) exp(-g t/tau)),
// g = 1 - alpha. Quasi-static: each step the strain is found at which the element bears the load.
TEST(NodalViscosity, CreepsToFirstOrder) {
    const double alpha = 0.6, tau = 0.5, g = 1.0 - alpha, strain = 1e-7;
    const auto error = [&](int steps) {
        NodalViscousKernel<SaintVenantKirchhoff> kernel({{0.0, 1.0}, 0.4}, {{alpha, tau}});
        const Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
        const auto e = kernel.precompute(X);
        const auto at = [&](double s) { return deformed(X, Vec3(1 + s, 1, 1).asDiagonal()); };
        Memory memory(kernel.history_size(1), 0.0);
        double now = strain, largest = 0.0;
        const double load = kernel.forces(e, at(now), memory)[1].x();
        kernel.begin_step(1.0 / steps);
        for (int i = 1; i <= steps; ++i) {
            const auto force_after = [&](double next) {
                Memory tried = memory;
                kernel.advance(e, at(now), at(next), tried);
                return kernel.forces(e, at(next), tried)[1].x();
            };
            double low = now, high = 3.0 * strain / g;
            for (int k = 0; k < 60; ++k) {
                const double middle = 0.5 * (low + high);
                (force_after(middle) > load ? low : high) = middle;  // the force is negative
            }
            kernel.advance(e, at(now), at(low), memory);
            now = low;
            const double t = static_cast<double>(i) / steps;
            const double expected = strain * (1.0 / g - (1.0 / g - 1.0) * std::exp(-g * t / tau));
            largest = std::max(largest, std::abs(now / expected - 1.0));
        }
        return largest;
    };
    const double coarse = error(50), middle = error(100), fine = error(200);
    EXPECT_NEAR(coarse / middle, 2.0, 0.1);
    EXPECT_NEAR(middle / fine, 2.0, 0.1);
    EXPECT_LT(fine, 0.005);
}

// The limit for which the other rule is the default. Half of the stress of a stretched element has
// all but faded when the element makes a quarter turn.
TEST(NodalViscosity, DoesNotTurnWithTheBody) {
    const Series half{{0.5, 1.0}};
    const Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    const Mat3 quarter = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()).matrix();
    Mat3 shear = Mat3::Identity();
    shear(0, 1) = 0.3;
    const Tetrahedron x = deformed(X, shear), turned = deformed(x, quarter);
    struct Measure {
        double size, moment;  // over those of the elastic forces; force times length
    };
    const auto measure = [&](auto kernel) {
        const auto e = kernel.precompute(X);
        Memory memory(kernel.history_size(1), 0.0);
        kernel.begin_step(0.0);
        kernel.advance(e, X, x, memory);
        const auto sudden = kernel.forces(e, x, memory);
        kernel.begin_step(0.001);
        for (int i = 0; i < 5000; ++i) kernel.advance(e, x, x, memory);
        kernel.begin_step(0.0);
        kernel.advance(e, x, turned, memory);
        const auto f = kernel.forces(e, turned, memory);
        double square = 0.0, square_of_sudden = 0.0;
        Vec3 moment = Vec3::Zero(), sum = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) {
            square += f[k].squaredNorm();
            square_of_sudden += sudden[k].squaredNorm();
            moment += turned[k].cross(f[k]);
            sum += f[k];
        }
        EXPECT_LE(sum.norm(), 1e-13 * std::sqrt(square));
        return Measure{std::sqrt(square / square_of_sudden),
                       moment.norm() / std::sqrt(square_of_sudden)};
    };
    const HemlKernel<NeoHookean> elastic{law, 0.4};
    const Measure stress = measure(ViscousKernel<NeoHookean>(elastic, half));
    EXPECT_NEAR(stress.size, 0.5 + 0.5 * std::exp(-5.0), 1e-12);
    EXPECT_LE(stress.moment, 1e-13);
    const Measure nodal = measure(NodalViscousKernel<NeoHookean>(elastic, half));
    // With a held state the recursion is geometric.
    const double remembered = 0.5 * (1.0 - std::pow(1.0 / 1.001, 5000));
    EXPECT_NEAR(remembered, 0.5 - 0.5 * std::exp(-5.0), 1e-4);
    const auto e = HemlKernel<NeoHookean>::Element(elastic.precompute(X));
    const Tetrahedron sudden = elastic.forces(e, x);
    double square = 0.0, square_of_sudden = 0.0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 f = quarter * sudden[k] - remembered * sudden[k];
        square += f.squaredNorm();
        square_of_sudden += sudden[k].squaredNorm();
        moment += turned[k].cross(f);
    }
    EXPECT_NEAR(nodal.size, std::sqrt(square / square_of_sudden), 1e-12);
    EXPECT_NEAR(nodal.moment, moment.norm() / std::sqrt(square_of_sudden), 1e-12);
    // As docs/theory.md states it: more than twice the force, and a moment out of nothing.
    EXPECT_NEAR(nodal.size, 1.117, 1e-3);
    EXPECT_NEAR(nodal.moment, 0.074, 1e-3);
}

// What advance() returns is the work done on the element less the growth of its energy, also
// through flat states.
TEST(NodalViscosity, TakesTheWorkThatItsEnergyDoesNotShow) {
    for_each_nodal_kernel([&](const std::string& name, auto kernel) {
        SCOPED_TRACE(name);
        const auto error = [&](int num_steps) {
            test::Random random(34);
            const Tetrahedron X = random_tetrahedron(random);
            const auto e = kernel.precompute(X);
            const Mat3 shear = random_deformation(random, {0.95, 1.0, 1.05});
            kernel.begin_step(1.0 / num_steps);
            Memory memory = no_memory();
            Tetrahedron before = X;
            auto f = kernel.forces(e, before, memory);
            double missing = 0.0, way = 0.0;
            for (int i = 1; i <= num_steps; ++i) {
                const double t = static_cast<double>(i) / num_steps;
                const double flat = std::pow(std::sin(std::numbers::pi * t), 2);
                const Mat3 F = (1.0 - flat) * Mat3::Identity() +
                               flat * (shear * Vec3(1.1, 1.05, -0.3).asDiagonal());
                const Tetrahedron x = deformed(X, F);
                missing += kernel.energy(e, x) - kernel.energy(e, before);
                missing += kernel.advance(e, before, x, memory);
                const auto g = kernel.forces(e, x, memory);
                for (std::size_t k = 0; k < 4; ++k) {
                    const double work = -0.5 * (f[k] + g[k]).dot(x[k] - before[k]);
                    missing -= work;
                    way += std::abs(work);
                }
                before = x;
                f = g;
            }
            return std::abs(missing) / way;
        };
        const double coarse = error(200), fine = error(400);
        EXPECT_LE(coarse, 1e-3);
        EXPECT_LE(fine, 0.5 * coarse + 1e-12);
    });
}

/// A body of elastic material and both rules, with a past.
struct BodyWithPast {
    MaterialTable table;
    Mesh mesh;
    Model model;
    double time = 0.0;

    explicit BodyWithPast(std::uint64_t seed)
        : table(materials()),
          mesh(Mesh::build(with_regions(test::jittered_cube(2, 0.2, 3), table.materials.size()))
                   .mesh),
          model(mesh, table) {
        test::Random random(seed);
        set_state(model, random_state(mesh, random, 0.03, 0.5));
        for (int i = 0; i < 20; ++i) step(model, time, 0.3 * model.stable_step());
        model.compute_forces(time);
    }
    static MaterialTable materials() {
        MaterialTable table;
        for (const auto& method : {links({}), links({{0.5, 0.1}}), links(two_terms),
                                   links({{0.2, 0.3}}, PronyRule::stress)}) {
            table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
            table.materials.push_back({1000.0, method});
        }
        return table;
    }
    Memory history() const {
        return {model.history().values().begin(), model.history().values().end()};
    }
    std::vector<Vec3> forces() {
        model.compute_forces(time);
        return {model.elastic_forces().begin(), model.elastic_forces().end()};
    }
};

double largest(const std::vector<Vec3>& forces) {
    double size = 0.0;
    for (const Vec3& f : forces) size = std::max(size, f.norm());
    return size;
}

// The virtual work of division: what new nodes have, given to their sources, is what these lost.
TEST(NodalViscosity, IsInheritedByThePartsOfADividedElement) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        BodyWithPast body(seed);
        test::Random random(seed);
        const std::vector<Vec3> before = body.forces();
        const Memory history = body.history();
        MeshEdit edit(body.mesh);
        for (int i = 0; i < 4; ++i) {
            const auto elements = living_elements(body.mesh);
            const ElementId e = elements[random.below(elements.size())];
            const std::size_t a = random.below(4), b = (a + 1 + random.below(3)) % 4;
            edit.bisect(e, body.mesh.corners(e)[a], body.mesh.corners(e)[b],
                        random.uniform(0.3, 0.7));
        }
        const ChangeSet changes = edit.commit();
        body.model.apply(changes);
        std::vector<Vec3> after = body.forces();
        for (auto record = changes.nodes_added.rbegin(); record != changes.nodes_added.rend();
             ++record)
            for (int s = 0; s < record->num_sources; ++s) {
                const auto& source = record->sources[static_cast<std::size_t>(s)];
                after[source.node.index()] += source.weight * after[record->id.index()];
            }
        for (std::size_t n = 0; n < before.size(); ++n)
            EXPECT_LE((after[n] - before[n]).norm(), 1e-12 * largest(before));

        replay(body.mesh, inverse(changes));
        body.model.apply(inverse(changes));
        EXPECT_EQ(body.forces(), before);
        EXPECT_EQ(body.history(), history);
    }
}

// A node's memory goes to its copies with the elements that made it: none is lost, none doubled.
TEST(NodalViscosity, IsSharedAmongCopiesOfANode) {
    BodyWithPast body(3);
    const std::vector<Vec3> before = body.forces();
    MeshEdit edit(body.mesh);
    for (const ElementId e : living_elements(body.mesh))
        for (int f = 0; f < body.mesh.num_faces(e); ++f)
            if (body.mesh.neighbor({e, f}).is_valid()) edit.open({e, f});
    const ChangeSet changes = edit.commit();
    ASSERT_GT(changes.nodes_added.size(), 50u);
    body.model.apply(changes);
    std::vector<Vec3> after = body.forces();
    for (auto record = changes.nodes_added.rbegin(); record != changes.nodes_added.rend(); ++record)
        after[record->sources[0].node.index()] += after[record->id.index()];
    for (std::size_t n = 0; n < before.size(); ++n)
        EXPECT_LE((after[n] - before[n]).norm(), 1e-13 * largest(before));
}

TEST(NodalViscosity, OfAnEditedBodyIsThatOfAFreshOneAndEditsCanBeUndone) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        BodyWithPast body(seed);
        test::Random random(seed);
        for (int i = 0; i < 20 && body.mesh.num_elements() > 0; ++i) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", edit " << i);
            const std::vector<Vec3> before = body.forces();
            const Memory history = body.history();
            const ChangeSet changes = test::random_edit(body.mesh, random);
            body.model.apply(changes);
            replay(body.mesh, inverse(changes));
            body.model.apply(inverse(changes));
            EXPECT_EQ(body.forces(), before);
            EXPECT_EQ(body.history(), history);
            replay(body.mesh, changes);
            body.model.apply(changes);

            Model fresh(body.mesh, body.table);
            set_state(fresh, state_of(body.model));
            fresh.set_history(body.model.history().values());
            fresh.compute_forces(body.time);
            body.model.compute_forces(body.time);
            const double dt = 0.05 * std::min(body.model.stable_step(), 1.0);
            for (Model* model : {&body.model, &fresh}) {
                double time = body.time;
                for (int k = 0; k < 3; ++k) step(*model, time, dt);
                model->compute_forces(time);
            }
            EXPECT_EQ(state_of(body.model), state_of(fresh));
            EXPECT_TRUE(std::ranges::equal(body.model.elastic_forces(), fresh.elastic_forces()));
            for (const ElementId e : living_elements(body.mesh))
                EXPECT_TRUE(std::ranges::equal(body.model.history().of(e), fresh.history().of(e)));
        }
    }
}

}  // namespace
}  // namespace incise::physics
