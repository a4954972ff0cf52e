// A body whose elements are cut: its fragments have the mass, motion, energy and loads of the
// whole. SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "incise/base/archive.h"
#include "incise/fragments/validate.h"
#include "incise/physics/body/body_arrays.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "support/exact_plane.h"
#include "support/num_cases.h"
#include "tests/physics/balance.h"
#include "tests/physics/model_snapshot.h"

namespace incise::physics {
namespace {

using fragments::FragmentMesh;
using topology::ChangeSet;
using topology::Mesh;

const std::vector<std::string> no_violations;

Box box_of(const Mesh& mesh) {
    Box box;
    for (const VertexId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    return box;
}

ChangeSet random_cut(Mesh& mesh, test::Random& random) {
    const Box box = box_of(mesh);
    const Vec3 point = box.center() + random.vector(0.1 * box.diagonal().norm());
    return test::cut_along_plane(mesh, point, random.vector(1.0));
}

/// A body of all materials, in motion and with a viscous history.
struct MovingBody {
    MaterialTable table;
    Mesh mesh;
    Model model;
    double time = 0.3;

    MovingBody(const topology::MeshData& data, double light_share, std::uint64_t seed,
               Precision precision = Precision::double_precision, bool has_regions = true)
        : table(table_for(data, precision)),
          mesh(Mesh::build(has_regions ? with_regions(data, table.materials.size(), seed) : data)
                   .mesh),
          model(mesh, FragmentMesh(mesh, light_share), table) {
        test::Random random(seed);
        set_state(model, random_state(mesh, random, 0.005 * model.structure().size(),
                                      model.structure().size()));
        for (int i = 0; i < 3; ++i) step(model, time, 0.05 * model.stable_step());
        model.compute_totals_and_forces();
    }
};

TEST(CutBodies, KeepAllTotalsWithoutLightFragments) {
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            MovingBody body(family->data, 0.0, seed);
            test::Random random(seed);
            for (int i = 0; i < 3; ++i) {
                const Balance before(body.model);
                const BodyEdit done = follow(body.model, random_cut(body.mesh, random));
                EXPECT_FALSE(done.physics.has_joins());
                ASSERT_EQ(fragments::validate(body.model.fragments(), body.mesh), no_violations);
                expect_balance(before, body.model, done, {});
            }
        }
}

TEST(CutBodies, KeepMassAndMomentaWithLightFragments) {
    int num_joins = 0;
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            // One region: light fragments only join within theirs.
            MovingBody body(family->data, fragments::default_light_share, seed,
                            Precision::double_precision, false);
            test::Random random(seed);
            for (int i = 0; i < 3; ++i) {
                const Balance before(body.model);
                const BodyEdit done = follow(body.model, random_cut(body.mesh, random));
                ASSERT_EQ(fragments::validate(body.model.fragments(), body.mesh), no_violations);
                const Totals &a = before.totals, b = body.model.energetics().totals();
                EXPECT_NEAR(a.mass, b.mass, round_off * a.mass);
                EXPECT_NEAR(a.rest_volume, b.rest_volume, round_off * a.rest_volume);
                EXPECT_LE((a.momentum - b.momentum).norm(), 1e-12 * before.momentum_scale);
                EXPECT_LE((a.angular_momentum - b.angular_momentum).norm(),
                          1e-12 * before.angular_scale);
                num_joins += done.physics.has_joins() ? 1 : 0;
            }
        }
    EXPECT_GT(num_joins, 10);
}

/// Expects that the sums over the arrays of a body are its totals.
void expect_totals_of_arrays(const Model& model, const Balance& balance) {
    const BodyArrays arrays = body_arrays(model);
    Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
    double mass = 0.0, energy = 0.0;
    for (std::size_t n = 0; n < arrays.masses.size(); ++n) {
        const Vec3 of_node = arrays.masses[n] * arrays.velocities[n];
        mass += arrays.masses[n];
        momentum += of_node;
        angular_momentum += arrays.mesh.points[n].cross(of_node);
        energy += 0.5 * of_node.dot(arrays.velocities[n]);
    }
    const Totals totals = model.energetics().totals();
    EXPECT_NEAR(mass, totals.mass, 1e-12 * mass);
    EXPECT_NEAR(energy, totals.kinetic_energy, 1e-12 * energy);
    EXPECT_LE((momentum - totals.momentum).norm(), 1e-12 * balance.momentum_scale);
    EXPECT_LE((angular_momentum - totals.angular_momentum).norm(), 1e-12 * balance.angular_scale);

    ASSERT_EQ(arrays.cell_of_element.size(), model.mesh().num_elements());
    std::vector<double> volumes(arrays.mesh.num_cells(), 0.0);
    auto cell = arrays.cell_of_element.begin();
    for (const CellId e : model.mesh().elements())
        volumes.at(static_cast<std::size_t>(*cell++)) += rest_volume(model.mesh(), e);
    auto volume = volumes.begin();
    for (const ElementId e : model.fragments().elements()) {
        EXPECT_NEAR(*volume, model.fragments().volume(e), 1e-9 * *volume);
        ++volume;
    }
}

TEST(CutBodies, HaveArraysThatAddUpToTheirTotals) {
    for (const auto* family : test::tetrahedral_families())
        for (const double light_share : {0.0, fragments::default_light_share}) {
            SCOPED_TRACE(family->name);
            MovingBody body(family->data, light_share, 1);
            test::Random random(1);
            expect_totals_of_arrays(body.model, Balance(body.model));
            for (int i = 0; i < 2; ++i) {
                follow(body.model, random_cut(body.mesh, random));
                body.model.compute_totals_and_forces();
                expect_totals_of_arrays(body.model, Balance(body.model));
            }
        }
}

TEST(CutBodies, EqualFreshOnesAndArchivedOnesAndCanBeUndone) {
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            MovingBody body(family->data, fragments::default_light_share, seed);
            test::Random random(seed);
            std::vector<BodyEdit> edits;
            std::vector<ModelSnapshot> before;
            std::vector<double> gains;
            for (int i = 0; i < 3; ++i) {
                before.emplace_back(body.model, body.time);
                gains.push_back(body.model.structure().embedding().largest_gain());
                edits.push_back(follow(body.model, random_cut(body.mesh, random)));
                const ModelSnapshot now(body.model, body.time);
                MaterialTable table = body.table;
                table.fibres = now.fibres;
                Model fresh(body.mesh, body.model.fragments(), table);
                set_state(fresh, now.state, body.time);
                fresh.state().change().history.set_values(now.history);
                expect_equal(ModelSnapshot(fresh, body.time), now);

                ArchiveWriter writer;
                body.model.save(writer);
                ArchiveReader reader(writer.bytes());
                MaterialTable without_fibres = body.table;
                without_fibres.fibres.clear();
                Model restored(body.mesh, without_fibres, reader, body.time);
                EXPECT_TRUE(reader.is_at_end());
                EXPECT_TRUE(restored.fragments() == body.model.fragments());
                EXPECT_EQ(restored.structure().embedding().largest_gain(),
                          body.model.structure().embedding().largest_gain());
                expect_equal(ModelSnapshot(restored, body.time), now);
                EXPECT_TRUE(
                    std::ranges::equal(restored.mesh_positions(), body.model.mesh_positions()));
            }
            for (; !edits.empty(); edits.pop_back(), before.pop_back(), gains.pop_back()) {
                take_back(body.mesh, body.model, edits.back());
                EXPECT_EQ(body.model.structure().embedding().largest_gain(), gains.back());
                expect_equal(ModelSnapshot(body.model, body.time), before.back());
            }
        }
}

// Lanes and the readable kernels agree, and forces are those of the energy.
TEST(CutBodies, HaveTheForcesOfTheirEnergy) {
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        MovingBody body(test::jittered_cube(3, 0.2, 5), fragments::default_light_share, 2,
                        precision);
        test::Random random(4);
        follow(body.model, random_cut(body.mesh, random));
        follow(body.model, random_cut(body.mesh, random));
        Model& model = body.model;
        std::size_t num_cut = 0;
        for (const ElementId e : model.fragments().elements())
            num_cut += model.fragments().volume_share(e) != 1.0 ? 1 : 0;
        ASSERT_GT(num_cut, 50u);
        model.compute_forces(body.time);
        std::vector<Vec3> readable(model.positions().size(), Vec3::Zero());
        // Without time, the terms of the Prony series stay as they are.
        model.structure().elements().for_each_block([&](const ElementBlock& block) {
            for (const ElementId e : block.elements()) {
                const ElementResult result =
                    block.result(e, model.positions(), model.state().history());
                EXPECT_TRUE(std::isfinite(result.energy));
            }
        });
        model.structure().elements().add_forces({model.positions(), model.state().history(), 0.0},
                                                readable);
        double scale = 0.0;
        for (const Vec3& f : readable) scale = std::max(scale, f.norm());
        const double rounding = precision == Precision::double_precision ? 1e-11 : 1e-4;
        for (std::size_t n = 0; n < readable.size(); ++n)
            EXPECT_LE((readable[n] - model.elastic_forces()[n]).norm(), rounding * scale);
        // The potential of an end of step falls along the forces.
        std::vector<Vec3> x(model.positions().begin(), model.positions().end());
        const double h = 1e-6;
        for (int i = 0; i < 20; ++i) {
            const std::size_t n = random.below(x.size());
            if (!model.fragments().is_alive(NodeId(n))) continue;
            for (int c = 0; c < 3; ++c) {
                const auto potential = [&](double at) {
                    std::vector<Vec3> moved = x;
                    moved[n][c] += at;
                    double sum = 0.0;
                    model.structure().elements().for_each_block([&](const ElementBlock& block) {
                        sum += block.potential({moved, model.state().history(), 0.01});
                    });
                    return sum;
                };
                std::vector<Vec3> forces(x.size(), Vec3::Zero());
                model.structure().elements().add_forces({x, model.state().history(), 0.01}, forces);
                EXPECT_NEAR(-(potential(h) - potential(-h)) / (2.0 * h), forces[n][c],
                            1e-5 * scale);
            }
        }
    }
}

/// What the cuts of bodies in smooth motion change, as root mean square over several cuts.
struct CutError {
    double elastic = 0.0, kinetic = 0.0, centre = 0.0;
};

/// Cuts cubes of n^3 bricks with a side of 1 m, which are stretched by 30 %, bent, and tumble.
CutError error_of_cuts(int n, int num_cuts) {
    CutError error;
    for (int seed = 0; seed < num_cuts; ++seed) {
        Mesh mesh = Mesh::build(test::jittered_cube(n, 0.0, 1)).mesh;
        Model model(mesh, table_of_one_law(soft_law));
        BodyState state = rest_state(mesh);
        for (std::size_t i = 0; i < state.positions.size(); ++i) {
            const Vec3 X = state.positions[i];
            state.positions[i] = {1.3 * X.x(), 0.9 * X.y(), 0.9 * X.z() + 0.2 * X.x() * X.x()};
            state.velocities[i] =
                Vec3(1.0, 2.0, -3.0).cross(state.positions[i]) + Vec3(0.5, 0.0, X.x() * X.y());
        }
        set_state(model, state);
        test::Random random(static_cast<std::uint64_t>(seed));
        const Vec3 point = Vec3(0.51, 0.48, 0.52) + random.vector(0.05);
        const Balance before(model);
        follow(model, test::cut_along_plane(mesh, point, random.vector(1.0)));
        const Balance after(model);
        const Totals &a = before.totals, &b = after.totals;
        EXPECT_NEAR(a.mass, b.mass, 1e-13 * a.mass);
        EXPECT_LE((a.momentum - b.momentum).norm(), 1e-12 * before.momentum_scale);
        EXPECT_LE((a.angular_momentum - b.angular_momentum).norm(), 1e-12 * before.angular_scale);
        const auto add = [&](double& sum, double x) { sum += x * x / num_cuts; };
        add(error.elastic, b.elastic_energy / a.elastic_energy - 1.0);
        add(error.kinetic, b.kinetic_energy / a.kinetic_energy - 1.0);
        add(error.centre, (a.centre_of_mass - b.centre_of_mass).norm());
    }
    return {std::sqrt(error.elastic), std::sqrt(error.kinetic), std::sqrt(error.centre)};
}

// What a cut changes by light fragments falls fast with the size of elements.
TEST(CutBodies, ChangeEnergiesLittleInSmoothMotion) {
    const CutError coarse = error_of_cuts(6, 12), fine = error_of_cuts(12, 12);
    EXPECT_LT(fine.elastic, coarse.elastic / 4.0);
    EXPECT_LT(fine.kinetic, coarse.kinetic / 4.0);
    EXPECT_LT(fine.centre, coarse.centre / 4.0);
    EXPECT_LE(fine.elastic, 1e-5);
    EXPECT_LE(fine.kinetic, 4e-5);
    EXPECT_LE(fine.centre, 4e-5);
}

BoundaryConditions all_loads_on(const Mesh& mesh) {
    std::vector<FaceId> right, all = topology::boundary_faces(mesh);
    for (const FaceId f : all) {
        bool is_right = true;
        for (int p = 0; p < mesh.face_size(f); ++p)
            is_right &= mesh.rest_position(mesh.face_corner(f, p)).x() == 1.0;
        if (is_right) right.push_back(f);
    }
    std::vector<CellId> half;
    for (const CellId e : mesh.elements())
        if (e.index() % 2 == 0) half.push_back(e);
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -9.81};
    s.loads = {{"wind", TractionLoad{right, {3.0, -2.0, 5.0}}, {}},
               {"gas", PressureLoad{all, 70.0}, {}},
               {"field", BodyLoad{CellSet(half), {0.0, 4.0, 0.0}}, {}},
               {"hooks",
                NodalLoad{VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.z() == 1.0; })),
                          {0.1, -0.2, 0.3},
                          {}},
                {}}};
    return s;
}

TEST(CutBodies, BearTheLoadsOfTheWhole) {
    for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
        SCOPED_TRACE(seed);
        Mesh mesh = Mesh::build(test::jittered_cube(3, 0.1, 2)).mesh;
        Model model(mesh, table_of_one_law(soft_law), all_loads_on(mesh));
        test::Random random(seed);
        const Mat3 F = Mat3::Identity() + 0.1 * Mat3::Ones();
        const auto force_and_moment = [&] {
            BodyState state = rest_state(model.fragments());
            for (Vec3& x : state.positions) x = F * x;
            set_state(model, state);
            Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
            for (const NodeId n : model.fragments().nodes()) {
                const Vec3 f =
                    model.boundary().outer_forces()[n.index()] + model.elastic_forces()[n.index()];
                force += f;
                moment += model.positions()[n.index()].cross(f);
            }
            return std::pair{force, moment};
        };
        const auto [force, moment] = force_and_moment();
        for (int i = 0; i < 3; ++i) {
            follow(model, random_cut(mesh, random));
            const auto [force_now, moment_now] = force_and_moment();
            EXPECT_LE((force_now - force).norm(), 1e-12 * force.norm());
            // Gravity acts on the corners of the fragment that carries a light one, and the hooks
            // on copies by their masses; in an affine motion nothing else differs.
            EXPECT_LE((moment_now - moment).norm(), 0.02 * moment.norm());
        }
    }
}

// The two pieces of a block that is cut through, each with one end clamped, fall only with the
// other one's clamp gone.
TEST(CutBodies, AreHeldByTheConstraintsThatTheirMaterialTouches) {
    for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        Mesh mesh = Mesh::build(test::jittered_cube(4, 0.1, seed)).mesh;
        BoundaryConditions s;
        s.gravity = {0.0, 0.0, -9.81};
        s.constraints = {holding("left", left_end(mesh))};
        Model model(mesh, table_of_one_law(soft_law), s);
        const Vec3 normal = Vec3(1.0, 0.0, 0.0) + random.vector(0.3);
        follow(model, test::cut_along_plane(mesh, {random.uniform(0.1, 0.4), 0.5, 0.5}, normal));
        ASSERT_EQ(topology::components(mesh).count, 2);
        double time = 0.0;
        for (int i = 0; i < 5; ++i) step(model, time, 0.5 * model.stable_step());
        const auto pieces = topology::components(mesh).of_element;
        const auto velocities = model.mesh_velocities();
        std::vector<bool> is_constrained(2, false);
        for (const VertexId n : mesh.nodes())
            if (mesh.rest_position(n).x() == 0.0) {
                // Material of the clamped face stays where it is, wherever the cut meets it.
                EXPECT_LE(velocities[n.index()].norm(), 1e-12);
                is_constrained[static_cast<std::size_t>(pieces[mesh.incident_element(n).index()])] =
                    true;
            }
        for (const VertexId n : mesh.nodes()) {
            const auto piece = static_cast<std::size_t>(pieces[mesh.incident_element(n).index()]);
            if (is_constrained[piece]) continue;
            EXPECT_LE((velocities[n.index()] - Vec3(0, 0, -9.81 * time)).norm(), 1e-9);
        }
    }
}

// Cuts through a clamped face leave thin parts at it. Those stay where the clamp holds them.
TEST(CutBodies, KeepTheirClampedFaceBetweenCutsNearEachOther) {
    int num_small = 0;
    for (const double distance : {0.02, 0.1, 0.3})  // of the cuts, in edges
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(std::to_string(distance) + ", seed " + std::to_string(seed));
            test::Random random(seed);
            const int n = 4;
            Mesh mesh = Mesh::build(test::jittered_cube(n, 0.1, seed)).mesh;
            BoundaryConditions s;
            s.gravity = {0.0, 0.0, -9.81};
            s.constraints = {holding("left", left_end(mesh))};
            Model model(mesh, table_of_one_law(soft_law), s);
            Vec3 normal = random.vector(1.0);
            normal.x() *= 0.1;
            normal.normalize();
            const Vec3 point = Vec3::Constant(0.5) + random.vector(0.1);
            follow(model, test::cut_along_plane(mesh, point, normal));
            follow(model, test::cut_along_plane(mesh, point + distance / n * normal,
                                                normal + random.vector(0.02)));
            for (const ElementId e : model.fragments().elements())
                num_small +=
                    model.fragments().volume_share(e) < fragments::default_light_share ? 1 : 0;
            double time = 0.0;
            for (int i = 0; i < 20; ++i) step(model, time, 0.5 * model.stable_step());
            const auto positions = model.mesh_positions();
            for (const VertexId k : mesh.nodes()) {
                const Vec3& X = mesh.rest_position(k);
                if (X.x() == 0.0) {
                    EXPECT_LE((positions[k.index()] - X).norm(), 1e-12) << "node " << k.value;
                }
            }
        }
    EXPECT_GT(num_small, 0);
}

TEST(CutBodies, MoveInImplicitStepsAsInExplicitOnes) {
    const auto data = test::jittered_cube(3, 0.1, 2);
    std::vector<std::vector<Vec3>> ends;
    for (const bool is_implicit : {false, true}) {
        Mesh mesh = Mesh::build(data).mesh;
        BoundaryConditions s;
        s.gravity = {3.0, 0.0, -9.81};
        s.constraints = {holding("left", left_end(mesh))};
        s.loads = {{"gas", PressureLoad{topology::boundary_faces(mesh), 50.0}, {}}};
        Model model(mesh, table_of_one_law(soft_law), s);
        follow(model, test::cut_along_plane(mesh, {0.52, 0.5, 0.47}, {0.2, 1.0, 0.3},
                                            [](const Vec3& x) { return x.x() > 0.4; }));
        model.compute_forces(0.0);
        ImplicitEuler implicit;
        SemiImplicitEuler explicit_steps;
        Integrator& integrator = is_implicit ? static_cast<Integrator&>(implicit) : explicit_steps;
        const double dt = 0.1 * model.stable_step();
        double time = 0.0;
        for (int i = 0; i < 60; ++i, time += dt) {
            model.compute_forces(time);
            integrator.step(model, time, dt);
        }
        ends.emplace_back(model.mesh_positions().begin(), model.mesh_positions().end());
        for (std::size_t n = 0; n < ends.back().size(); ++n)
            ends.back()[n] -= mesh.rest_positions()[n];
    }
    double largest = 0.0, difference = 0.0;
    for (std::size_t n = 0; n < ends[0].size(); ++n) {
        largest = std::max(largest, ends[0][n].norm());
        difference = std::max(difference, (ends[1][n] - ends[0][n]).norm());
    }
    EXPECT_GT(largest, 1e-4);
    EXPECT_LE(difference, 0.05 * largest);
}

TEST(CutBodies, FindTheirEquilibrium) {
    Mesh mesh = Mesh::build(test::jittered_cube(4, 0.1, 2)).mesh;
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -1.0};
    s.constraints = {holding("left", left_end(mesh))};
    s.loads = {{"gas", PressureLoad{topology::boundary_faces(mesh), 20.0}, {}}};
    Model model(mesh, table_of_one_law(soft_law), s);
    follow(model, test::cut_along_plane(mesh, {0.52, 0.5, 0.47}, {0.2, 1.0, 0.3},
                                        [](const Vec3& x) { return x.x() > 0.3; }));
    Statics statics;
    statics.step(model, 0.0, 1.0);
    model.compute_forces(1.0);
    double scale = 0.0, imbalance = 0.0;
    for (const NodeId n : model.fragments().nodes()) {
        if (model.boundary().constraints().of_node(n.index())) continue;
        const Vec3 f =
            model.elastic_forces()[n.index()] + model.boundary().outer_forces()[n.index()];
        imbalance = std::max(imbalance, f.norm());
        scale = std::max(scale, model.boundary().outer_forces()[n.index()].norm());
    }
    EXPECT_LE(imbalance, 1e-7 * scale);
    EXPECT_GT(model.max_displacement(), 1e-3);
}

TEST(CutBodies, AreNeverStifferThanTheirStiffestElement) {
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            MovingBody body(family->data, fragments::default_light_share, seed);
            double least = std::numeric_limits<double>::infinity();
            for (const ElementId e : body.model.fragments().elements())
                least = std::min(least, body.model.structure().element_stable_step(e));
            test::Random random(seed);
            for (int i = 0; i < 4; ++i) {
                follow(body.model, random_cut(body.mesh, random));
                EXPECT_GE(body.model.structure().rest_stable_step(), least * (1.0 - 1e-12));
            }
        }
}

}  // namespace
}  // namespace incise::physics
