// The methods of bench/comparators give the forces of HEML: they are the same formulas, written
// otherwise, and so may be timed beside each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "bench/comparators/heml.h"
#include "bench/comparators/mass_springs.h"
#include "bench/comparators/mass_tensor.h"
#include "bench/comparators/mjed.h"
#include "bench/comparators/tled.h"
#include "tests/physics/test_bodies.h"

namespace incise::bench {
namespace {

using physics::BodyState;
using physics::Model;
using topology::Mesh;

constexpr physics::SaintVenantKirchhoff stvk{5769.0, 3846.0};
constexpr physics::NeoHookean nh{1923.0, 5769.0};
constexpr physics::MooneyRivlin mr{1346.0, 577.0, 3462.0};
constexpr physics::IsochoricMooneyRivlin mr_isochoric{1346.0, 577.0, 8333.0};
constexpr double young = 1e4;        // Pa, of springs
constexpr double tolerance = 1e-12;  // of the largest force on a node

/// A random state in which no element is pressed below the inversion threshold of HEML, 0.4: the
/// comparators know no such thing.
void move_at_random(Model& model, test::Random& random) {
    for (double shake = 0.1;; shake *= 0.5) {
        physics::set_state(model, physics::random_state(model.mesh(), random, shake, 0.0));
        if (model.energetics().min_volume_ratio() > 0.45) return;
        ASSERT_GT(shake, 1e-6);
    }
}

void expect_forces_of(const Model& model, std::span<const Vec3> forces) {
    double largest = 0.0, error = 0.0;
    for (std::size_t n = 0; n < forces.size(); ++n) {
        largest = std::max(largest, model.elastic_forces()[n].norm());
        error = std::max(error, (forces[n] - model.elastic_forces()[n]).norm());
    }
    EXPECT_GT(largest, 0.0);
    EXPECT_LE(error, tolerance * largest);
}

/// On every family and in random states: `make(tetrahedra, rest positions)` makes a method, a
/// function that adds its forces at positions, and these have to be the program's.
template <class Make>
void expect_forces_of_program(const physics::MaterialTable& table, Make make) {
    for (const test::MeshFamily* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        topology::MeshData data = family->data;
        for (int& region : data.regions) region = 0;
        const Mesh mesh = Mesh::build(data).mesh;
        const auto method = make(tetrahedra_of(mesh), mesh.rest_positions());
        Model model(mesh, table);
        test::Random random(7);
        for (int i = 0; i < 4; ++i) {
            SCOPED_TRACE(i);
            move_at_random(model, random);
            std::vector<Vec3> forces(mesh.node_capacity(), Vec3::Zero());
            method(model.positions(), forces);
            expect_forces_of(model, forces);
        }
    }
}

template <class Kernel>
auto method_of(const Kernel& kernel) {
    return [kernel](const std::vector<Nodes>& tetrahedra, std::span<const Vec3> rest_positions) {
        return [loop = ElementLoop<Kernel>(kernel, tetrahedra, rest_positions)](
                   std::span<const Vec3> x, std::span<Vec3> f) { loop.add_forces(x, f); };
    };
}
template <class Kernel>
void expect_forces_of_heml(const physics::Law& law, const Kernel& kernel) {
    expect_forces_of_program(physics::table_of_one_law(law), method_of(kernel));
}

TEST(Heml, AsPrintedHasTheForcesOfTheProgram) {
    expect_forces_of_heml(stvk, PrintedHeml<double>{stvk.lambda, stvk.mu});
}

TEST(Heml, CountedHasTheForcesOfTheProgram) {
    expect_forces_of_heml(stvk, LinkHeml<double, physics::SaintVenantKirchhoff>{stvk});
    expect_forces_of_heml(nh, LinkHeml<double, physics::NeoHookean>{nh});
    expect_forces_of_heml(mr, LinkHeml<double, physics::MooneyRivlin>{mr});
}

TEST(Tled, HasTheForcesOfHeml) {
    expect_forces_of_heml(stvk, Tled<double, physics::SaintVenantKirchhoff>{stvk});
    expect_forces_of_heml(nh, Tled<double, physics::NeoHookean>{nh});
    expect_forces_of_heml(mr, Tled<double, physics::MooneyRivlin>{mr});
}

TEST(Mjed, HasTheForcesOfHeml) {
    expect_forces_of_heml(stvk, Mjed<double, physics::SaintVenantKirchhoff>{stvk});
    expect_forces_of_heml(nh, Mjed<double, physics::NeoHookean>{nh});
    expect_forces_of_heml(mr, Mjed<double, physics::MooneyRivlin>{mr});
    expect_forces_of_heml(mr_isochoric, Mjed<double, physics::IsochoricMooneyRivlin>{mr_isochoric});
}

TEST(MassTensor, HasTheForcesOfSaintVenantKirchhoffHeml) {
    expect_forces_of_program(
        physics::table_of_one_law(stvk),
        [](const std::vector<Nodes>& tetrahedra, std::span<const Vec3> rest_positions) {
            return [tensor = MassTensor(stvk, tetrahedra, rest_positions)](std::span<const Vec3> x,
                                                                           std::span<Vec3> f) {
                std::vector<Vec3> displacements;
                tensor.add_forces<double>(x, f, displacements);
            };
        });
}

// What HEML 2015, section 5.4, says of it: displacements are taken from where the body was at rest,
// so the farther it has gone, the more digits its forces lose. HEML sees differences of positions
// only.
TEST(MassTensor, LosesDigitsFarFromItsRestPosition) {
    const Mesh mesh = Mesh::build(test::jittered_cube(3, 0.2, 1)).mesh;
    const auto tetrahedra = tetrahedra_of(mesh);
    Model model(mesh, physics::table_of_one_law(stvk));
    test::Random random(3);
    BodyState state = physics::random_state(mesh, random, 0.02, 0.0);
    const MassTensor tensor(stvk, tetrahedra, mesh.rest_positions());
    const auto error_at = [&](double distance) {
        BodyState moved = state;
        for (Vec3& x : moved.positions) x += Vec3::Constant(distance);
        physics::set_state(model, moved);
        std::vector<Vec3> forces(mesh.node_capacity(), Vec3::Zero()), displacements;
        tensor.add_forces<double>(moved.positions, forces, displacements);
        double error = 0.0;
        for (std::size_t n = 0; n < forces.size(); ++n)
            error = std::max(error, (forces[n] - model.elastic_forces()[n]).norm());
        return error;
    };
    const double near = error_at(0.0), far = error_at(100.0);
    // Terms of the third order grow with the third power of the distance, but their sum does not.
    EXPECT_GT(far, 1e4 * near);
}

TEST(MassSprings, PerEdgeHaveTheForcesOfTheProgram) {
    expect_forces_of_program(
        physics::table_of_one_material(physics::MassSprings{young}),
        [](const std::vector<Nodes>& tetrahedra, std::span<const Vec3> rest_positions) {
            return [springs = MassSprings(young, tetrahedra, rest_positions)](
                       std::span<const Vec3> x, std::span<Vec3> f) {
                springs.add_forces<double>(x, f);
            };
        });
}

// HEML 2015, section 5.3.
TEST(MassSprings, AreDegenerateHeml) {
    expect_forces_of_program(physics::table_of_one_material(physics::MassSprings{young}),
                             method_of(SpringLinks{young}));
}

}  // namespace
}  // namespace incise::bench
