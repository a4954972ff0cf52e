// Bodies crushed flat, turned inside out, drawn together to a line or a point, and scattered: what
// they come back from (the table of docs/theory.md, Beyond inversion), and how runs that cannot go
// on say so.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/physics/body/winding.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::Mesh;

enum class Start { flat, mirrored, line, point, scattered };
constexpr Start all_starts[] = {Start::flat, Start::mirrored, Start::line, Start::point,
                                Start::scattered};
constexpr const char* start_names[] = {"flat", "mirrored", "line", "point", "scattered"};

/// A tetrahedron, a cube of six round a diagonal, a cube of 48, a bar of 96.
const std::vector<Mesh>& bodies() {
    static const std::vector<Mesh> all = [] {
        std::vector<Mesh> meshes;
        meshes.push_back(Mesh::build(test::tetrahedral_families().front()->data).mesh);
        for (const int n : {1, 2})
            meshes.push_back(Mesh::build(test::jittered_cube(n, 0.1, 3)).mesh);
        meshes.push_back(Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron,
                                                        Vec3::Zero(), {2, 1, 1}, {4, 2, 2}))
                             .mesh);
        return meshes;
    }();
    return all;
}

/// Lines and points are shaken by a hundredth of a body's side: without, nothing breaks symmetry.
BodyState state_at(Start start, const Mesh& mesh, std::uint64_t seed) {
    test::Random random(seed);
    Eigen::AlignedBox3d box;
    for (const Vec3& x : mesh.rest_positions()) box.extend(x);
    const Vec3 c = box.center();
    BodyState state = rest_state(mesh);
    for (Vec3& x : state.positions) switch (start) {
            case Start::flat:
                x.z() = c.z();
                break;
            case Start::mirrored:
                x.z() = 2.0 * c.z() - x.z();
                break;
            case Start::line:
                x = Vec3(x.x(), c.y(), c.z()) + random.vector(0.01);
                break;
            case Start::point:
                x = c + random.vector(0.01);
                break;
            case Start::scattered:
                for (int k = 0; k < 3; ++k) x[k] = random.uniform(box.min()[k], box.max()[k]);
        }
    return state;
}

struct Ending {
    bool is_at_rest = false;  ///< at rest as it was made: all that is left is a rigid motion
    bool is_finite = true;
    double min_volume_ratio = 0.0;
    std::size_t num_wound_edges = 0;
    std::string message;  ///< of the error that stopped the run
};

/// Lets the damped body move until it is back, at rest elsewhere, or its time is over.
Ending run(const Mesh& mesh, const Law& law, Start start, std::uint64_t seed, double safety = 0.1) {
    BoundaryConditions boundary_conditions;
    boundary_conditions.damping =
        5.0;  // 1/s; sound takes some tenths of a second across the bodies
    Model model(mesh, table_of_one_law(law), boundary_conditions);
    Ending ending;
    const double scale = model.structure().stiffness_energy(), dt = safety * model.stable_step();
    double time = 0.0;
    try {
        set_state(model, state_at(start, mesh, seed));
        for (int i = 1; i * safety <= 600.0 && ending.is_finite; ++i) {
            step(model, time, dt);
            if (i % 100 != 0) continue;
            const Totals now = model.energetics().totals();
            ending.is_finite = std::isfinite(now.elastic_energy + now.kinetic_energy);
            // Isochoric laws have energies below zero in elements of no volume.
            ending.is_at_rest = std::abs(now.elastic_energy) < 1e-8 * scale &&
                                now.kinetic_energy < 1e-8 * scale &&
                                model.energetics().min_volume_ratio() > 0.5;
            if (ending.is_at_rest || (time > 4.0 && now.kinetic_energy < 1e-16 * scale)) break;
        }
        ending.min_volume_ratio = model.energetics().min_volume_ratio();
        ending.num_wound_edges = find_winding(mesh, model.positions()).num_edges;
        for (const Vec3& x : model.positions()) ending.is_finite &= x.allFinite();
    } catch (const PhysicsError& error) {
        ending.message = error.what();
    }
    return ending;
}

/// Calls visit(start, seed, mesh) for all starts and bodies; for those left to chance several
/// times.
template <class Visit>
void for_each_start(std::uint64_t num_seeds, Visit visit) {
    for (const Start start : all_starts)
        for (std::size_t b = 0; b < bodies().size(); ++b)
            for (std::uint64_t seed = 1; seed <= num_seeds; ++seed) {
                if (start < Start::line && seed > 1) continue;
                SCOPED_TRACE(testing::Message() << start_names[static_cast<std::size_t>(start)]
                                                << ", body " << b << ", seed " << seed);
                visit(start, seed, bodies()[b]);
            }
}

void expect_clear(const std::string& message) {
    for (const char* part :
         {"element ", "node ", " in the step from t = ", " s, farther than the body is wide",
          "; likely cause: ", " of what is stable at rest)"})
        EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(Inversion, EndsSomewhereOrStopsWithAClearMessage) {
    int num_stopped = 0, num_recovered = 0;
    for (const NamedLaw& named : test_laws())
        for (const double safety : {0.8, 0.1}) {
            SCOPED_TRACE(testing::Message() << named.name << ", safety " << safety);
            for_each_start(1, [&](Start start, std::uint64_t seed, const Mesh& mesh) {
                const Ending ending = run(mesh, named.law, start, seed, safety);
                EXPECT_TRUE(ending.is_finite);
                num_recovered += ending.is_at_rest;
                if (ending.message.empty()) return;
                ++num_stopped;
                expect_clear(ending.message);
            });
        }
    EXPECT_GT(num_stopped, 50);
    EXPECT_GT(num_recovered, 300);
}

bool resists_inversion(const NamedLaw& named) {
    // Negative powers of stretches make flat elements so stiff that steps would be tiny.
    return !std::holds_alternative<SaintVenantKirchhoff>(named.law) &&
           named.name != "Ogden, brain-like";
}

TEST(Inversion, FlatBodiesRise) {
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        for (const Mesh& mesh : bodies())
            EXPECT_EQ(run(mesh, named.law, Start::flat, 1).is_at_rest, resists_inversion(named));
    }
}

// What the tangent extension cannot do: there points are minima of the energy.
TEST(Inversion, NeoHookeanReturnsFromMirrorsNotFromPoints) {
    const Law law = NeoHookean{2500.0, 0.0};
    for (const Mesh& mesh : bodies()) {
        EXPECT_TRUE(run(mesh, law, Start::mirrored, 1).is_at_rest);
        EXPECT_FALSE(run(mesh, law, Start::point, 1).is_at_rest);
    }
}

// Where a body does not come back, all its elements have: it is wound up, with the ring of
// elements round an edge going round it twice, which is told.
TEST(Inversion, StableNeoHookeanLeavesNoElementInverted) {
    for (const NamedLaw& named : test_laws()) {
        const auto* law = std::get_if<StableNeoHookean>(&named.law);
        if (law == nullptr) continue;
        SCOPED_TRACE(named.name);
        const bool is_nearly_incompressible = law->rest_lambda() > 10.0 * law->rest_mu();
        int num_runs = 0, num_recovered = 0;
        for_each_start(5, [&](Start start, std::uint64_t seed, const Mesh& mesh) {
            const Ending ending = run(mesh, named.law, start, seed);
            EXPECT_EQ(ending.message, "");
            EXPECT_GT(ending.min_volume_ratio, 0.1);
            EXPECT_EQ(ending.is_at_rest, ending.num_wound_edges == 0);
            ++num_runs;
            num_recovered += ending.is_at_rest;
            if (mesh.num_elements() == 1 || start == Start::flat) {
                EXPECT_TRUE(ending.is_at_rest);
            }
        });
        EXPECT_GE(num_recovered, (is_nearly_incompressible ? 0.5 : 0.9) * num_runs);
    }
}

// No run ends lost without a sign of it: a message, elements of no volume, or wound edges; and none
// that comes back has such a sign.
TEST(Inversion, IsNeverLeftUnreported) {
    for (const NamedLaw& named : test_laws()) {
        SCOPED_TRACE(named.name);
        for_each_start(2, [&](Start start, std::uint64_t seed, const Mesh& mesh) {
            const Ending ending = run(mesh, named.law, start, seed);
            const bool is_told = !ending.message.empty() || ending.min_volume_ratio < 0.01 ||
                                 ending.num_wound_edges > 0;
            EXPECT_NE(ending.is_at_rest, is_told) << "J " << ending.min_volume_ratio;
        });
    }
}

/// Round the diagonal of a unit cube all angles are so many times what they are at rest.
BodyState turned_round_the_diagonal(const Mesh& mesh, double factor) {
    BodyState state = rest_state(mesh);
    const Vec3 axis = Vec3::Ones().normalized(), across = Vec3(1, -1, 0).normalized();
    for (Vec3& x : state.positions) {
        const Vec3 beside = x - axis.dot(x) * axis;
        if (beside.norm() < 1e-9) continue;
        const double angle = std::atan2(axis.cross(across).dot(beside), across.dot(beside));
        x = Eigen::AngleAxisd((factor - 1.0) * angle, axis) * x;
    }
    return state;
}

// Each element keeps its sign.
TEST(Winding, IsFoundWhereElementsCircleAnEdgeTwice) {
    const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                     Vec3::Ones(), {1, 1, 1}))
                          .mesh;
    EXPECT_EQ(find_winding(mesh, turned_round_the_diagonal(mesh, 1.0).positions).num_edges, 0u);
    Model model(mesh, table_of_one_law(NeoHookean{1923.0, 5769.0}));
    set_state(model, turned_round_the_diagonal(mesh, 2.0));
    EXPECT_GT(model.energetics().min_volume_ratio(), 0.3);
    EXPECT_EQ(find_winding(mesh, model.positions()).num_edges, 1u);
}

// Five of six, which close past each other as the lips of a cut do.
TEST(Winding, IsNotFoundWhereBoundariesOverlap) {
    Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                               Vec3::Ones(), {1, 1, 1}))
                    .mesh;
    // The one on whose far side angles jump from pi to -pi.
    const Vec3 axis = Vec3::Ones().normalized(), across = Vec3(1, -1, 0).normalized();
    for (const CellId e : living_elements(mesh)) {
        Vec3 centre = Vec3::Zero();
        for (const VertexId n : mesh.corners(e)) centre += 0.25 * mesh.rest_position(n);
        const double angle = std::atan2(axis.cross(across).dot(centre), across.dot(centre));
        if (std::abs(angle) < 2.8) continue;
        topology::MeshEdit edit(mesh);
        edit.remove(e);
        edit.commit();
        break;
    }
    ASSERT_EQ(mesh.num_elements(), 5u);
    EXPECT_EQ(find_winding(mesh, turned_round_the_diagonal(mesh, 1.3).positions).num_edges, 0u);
}

// The message looks at the state before the step that failed.
TEST(Inversion, IsNamedWhereItStoppedTheRun) {
    const auto message = [](const Law& law, Start start) {
        return run(bodies()[1], law, start, 1, 0.8).message;
    };
    const Law brain = Ogden{{{{670.0, -19.0}}}, 1, 6000.0};
    for (const char* part : {" there was crushed (its volume ratio was ",
                             "), where tissue is stiffer than at rest (the step of "})
        EXPECT_NE(message(brain, Start::flat).find(part), std::string::npos)
            << message(brain, Start::flat);
    const std::string mirrored =
        message(IsochoricFungDemiray{3846.0, 0.5, 8333.0}, Start::mirrored);
    EXPECT_NE(mirrored.find(" there was turned inside out (its volume ratio was -1"),
              std::string::npos)
        << mirrored;
}

}  // namespace
}  // namespace incise::physics
