// Cut bodies of hexahedra, of several kinds of cells, and of boxes with hybrid springs, which
// become cells of HEML where a cut divides them: forces, edits, stable steps, equilibria.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/cutting/cutter.h"
#include "incise/fragments/validate.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/physics/solve/integrator.h"
#include "incise/sim/world.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "tests/physics/balance.h"
#include "tests/physics/model_snapshot.h"

namespace incise::sim {
namespace {

using physics::BodyState;
using physics::HybridSprings;
using physics::MaterialTable;
using physics::Model;
using physics::ModelSnapshot;
using physics::Precision;
using test::Bricks;
using topology::Mesh;
using topology::MeshData;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Tissue {
    std::string name;
    MeshData data;  ///< of a cube with a side of 1 m
    MaterialTable table;
};

/// Boxes of hybrid springs, and cells of other kinds of the material of divided boxes.
Tissue springs_beside_triangles(int n) {
    Tissue tissue{"hybrid springs beside triangles", test::brick_cube(Bricks::joined, n, 0.0, 2),
                  physics::table_of_one_material(HybridSprings{3e3, 1e4, infinite})};
    for (std::size_t c = 0; c < tissue.data.num_cells(); ++c)
        tissue.data.regions[c] = tissue.data.kinds[c] == topology::CellKind::hexahedron ? 0 : 1;
    tissue.table.of_region[1] = 1;
    tissue.table.materials.push_back(
        {1000.0, links_of_divided_box(HybridSprings{3e3, 1e4, infinite})});
    return tissue;
}

std::vector<Tissue> tissues(int n) {
    return {{"jittered cells, quadrilaterals of which meet triangles",
             test::brick_cube(Bricks::joined, n, 0.08, 4),
             physics::table_of_one_law(physics::soft_law)},
            springs_beside_triangles(n),
            {"jittered hexahedra", test::brick_cube(Bricks::hexahedra, n, 0.15, 3),
             physics::table_of_one_law(physics::soft_law)},
            {"jittered cells of all kinds", test::brick_cube(Bricks::mixed, n, 0.15, 4),
             physics::table_of_one_law(physics::soft_law)},
            {"hybrid springs", test::brick_cube(Bricks::hexahedra, n, 0.0, 1),
             physics::table_of_one_material(HybridSprings{3e3, 1e4, infinite})},
            {"hybrid springs with inner diagonals", test::brick_cube(Bricks::hexahedra, n, 0.0, 1),
             physics::table_of_one_material(HybridSprings{3e3, 1e4, 1.0})}};
}

/// A body that is cut along planes.
struct CutBody {
    MaterialTable table;
    Mesh mesh;
    Model model;
    cutting::Cutter cutter;
    std::vector<physics::BodyEdit> edits;

    CutBody(const MeshData& data, MaterialTable of_regions,
            const std::function<physics::BoundaryConditions(const Mesh&)>& acting = {})
        : table(std::move(of_regions)),
          mesh(Mesh::build(data).mesh),
          model(mesh, table, acting ? acting(mesh) : physics::BoundaryConditions()),
          cutter(mesh, model.mesh_positions()) {}

    void cut(const Vec3& point, const Vec3& normal) {
        cutter.follow_motion(mesh, model.mesh_positions());
        const cutting::PlaneCut plane{point, normal};
        const auto done = cutter.split(mesh, *cutting::cut_surface_of(plane), plane.snap);
        edits.push_back(model.apply(mesh, done.changes));
        cutter.apply(mesh, done.changes);
        ASSERT_EQ(fragments::validate(model.fragments(), mesh), std::vector<std::string>{});
    }
    /// Cuts through the body as it is, anywhere from its middle to its corners.
    void cut(test::Random& random) {
        Box box;
        for (const VertexId n : mesh.nodes()) box.extend(model.mesh_positions()[n.index()]);
        cut(box.center() + random.vector(0.45).cwiseProduct(box.sizes()), random.vector(1.0));
    }

    std::size_t num_divided() const {
        std::size_t num = 0;
        for (const ElementId e : model.fragments().elements())
            num += test::is_divided(model.fragments(), e) ? 1 : 0;
        return num;
    }
    double energy() const {
        const physics::Totals totals = model.energetics().totals();
        return totals.kinetic_energy + totals.elastic_energy;
    }
    /// Strains and shakes the body.
    void deform(test::Random& random, double shake, double speed) {
        set_state(model, physics::random_state(model.fragments(), random, shake, speed));
    }
};

double potential_of(const Model& model, std::span<const Vec3> positions) {
    double sum = 0.0;
    model.structure().elements().for_each_block([&](const physics::ElementBlock& some) {
        sum += some.potential({positions, model.state().history(), 0.0});
    });
    return sum;
}

double largest(std::span<const Vec3> vectors) {
    double norm = 0.0;
    for (const Vec3& v : vectors) norm = std::max(norm, v.norm());
    return norm;
}

TEST(CutCells, HaveTheForcesOfTheirEnergy) {
    for (const Tissue& tissue : tissues(3))
        for (const Precision precision :
             {Precision::double_precision, Precision::single_precision}) {
            SCOPED_TRACE(tissue.name);
            MaterialTable table = tissue.table;
            table.precision = precision;
            CutBody body(tissue.data, table);
            test::Random random(7);
            for (int i = 0; i < 2; ++i) body.cut(random);
            ASSERT_GT(body.num_divided(), 10u);
            body.deform(random, 0.02, 0.0);
            const Model& model = body.model;
            const auto& elements = model.structure().elements();
            std::vector<Vec3> readable(model.positions().size(), Vec3::Zero());
            elements.add_forces({model.positions(), model.state().history(), 0.0}, readable);
            const double scale = largest(readable);
            const double rounding = precision == Precision::double_precision ? 1e-12 : 1e-5;
            for (std::size_t n = 0; n < readable.size(); ++n)
                EXPECT_LE((readable[n] - model.elastic_forces()[n]).norm(), rounding * scale);
            const double energy = model.energetics().totals().elastic_energy;
            EXPECT_NEAR(potential_of(model, model.positions()), energy, 1e-12 * energy);
            std::vector<Vec3> x(model.positions().begin(), model.positions().end());
            constexpr double h = 1e-5;  // m
            for (int i = 0; i < 20; ++i) {
                const std::size_t n = random.below(x.size());
                if (!model.fragments().is_alive(NodeId(n))) continue;
                for (int c = 0; c < 3; ++c) {
                    const double at = x[n][c];
                    x[n][c] = at + h;
                    const double ahead = potential_of(model, x);
                    x[n][c] = at - h;
                    const double behind = potential_of(model, x);
                    x[n][c] = at;
                    EXPECT_NEAR((behind - ahead) / (2.0 * h), readable[n][c], 1e-6 * scale);
                }
            }
        }
}

TEST(CutCells, ExertNoForceAtRest) {
    for (const Tissue& tissue : tissues(2))
        for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
            SCOPED_TRACE(tissue.name + ", seed " + std::to_string(seed));
            CutBody body(tissue.data, tissue.table);
            test::Random random(seed);
            for (int i = 0; i < 3; ++i) body.cut(random);
            body.model.compute_forces(0.0);
            // N, of some 1e3 at a strain of one.
            EXPECT_LE(largest(body.model.elastic_forces()), 1e-11);
            EXPECT_LE(std::abs(body.energy()), 1e-13);  // J, of some 1e4
        }
}

/// Materials for the cells of a mesh, each in a region of its own: laws, viscosity, fibres, and
/// hybrid springs where there are boxes.
Tissue tissue_of_all_materials(Bricks bricks, double jitter) {
    Tissue tissue{"", test::brick_cube(bricks, 3, jitter, 5), {}};
    if (jitter == 0.0) {
        tissue.table = physics::table_for(tissue.data);
    } else {
        for (const physics::Material& material : physics::materials_of_any_cells()) {
            tissue.table.of_region[static_cast<int>(tissue.table.materials.size())] =
                tissue.table.materials.size();
            tissue.table.materials.push_back(material);
        }
        tissue.table.fibres = physics::random_fibres(tissue.data.num_cells());
    }
    tissue.data = physics::with_regions(tissue.data, tissue.table.materials.size());
    return tissue;
}

TEST(CutCells, EqualFreshOnesAndArchivedOnesAndCanBeUndone) {
    for (const auto& [bricks, jitter] :
         {std::pair(Bricks::hexahedra, 0.0), std::pair(Bricks::hexahedra, 0.15),
          std::pair(Bricks::mixed, 0.0), std::pair(Bricks::mixed, 0.15),
          std::pair(Bricks::joined, 0.0), std::pair(Bricks::joined, 0.08)})
        for (std::uint64_t seed = 0; seed < test::num_cases(3); ++seed) {
            SCOPED_TRACE("jitter " + std::to_string(jitter) + ", seed " + std::to_string(seed));
            const Tissue tissue = tissue_of_all_materials(bricks, jitter);
            CutBody body(tissue.data, tissue.table);
            test::Random random(seed);
            body.deform(random, 0.02, 1.0);
            double time = 0.0;
            const auto walk = [&] {
                for (int i = 0; i < 3; ++i) step(body.model, time, 0.05 * body.model.stable_step());
            };
            walk();
            std::vector<ModelSnapshot> before;
            for (int i = 0; i < 3; ++i) {
                before.emplace_back(body.model, time);
                body.cut(random);
                const ModelSnapshot now(body.model, time);
                MaterialTable table = body.table;
                table.fibres = now.fibres;
                Model fresh(body.mesh, body.model.fragments(), table);
                set_state(fresh, now.state, time);
                fresh.state().change().history.set_values(now.history);
                expect_equal(ModelSnapshot(fresh, time), now);

                ArchiveWriter writer;
                body.model.save(writer);
                ArchiveReader reader(writer.bytes());
                table.fibres.clear();
                Model restored(body.mesh, table, reader, time);
                EXPECT_TRUE(reader.is_at_end());
                expect_equal(ModelSnapshot(restored, time), now);
            }
            EXPECT_GT(body.num_divided(), 10u);
            for (; !before.empty(); before.pop_back(), body.edits.pop_back()) {
                take_back(body.mesh, body.model, body.edits.back());
                expect_equal(ModelSnapshot(body.model, time), before.back());
            }
        }
}

TEST(CutCells, KeepMassAndMomenta) {
    for (const Tissue& tissue : tissues(3))
        for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
            SCOPED_TRACE(tissue.name + ", seed " + std::to_string(seed));
            CutBody body(tissue.data, tissue.table);
            test::Random random(seed);
            // Faces that are not plane: the parts of a cell fill it to 1e-10 of it.
            const bool is_jittered = tissue.name.starts_with("jittered");
            const double rounding = is_jittered ? 1e-10 : physics::round_off;
            body.deform(random, is_jittered ? 0.0 : 0.02, 1.0);
            for (int i = 0; i < 3; ++i) {
                const physics::Balance before(body.model);
                body.cut(random);
                const physics::Totals &a = before.totals, b = body.model.energetics().totals();
                EXPECT_NEAR(a.mass, b.mass, rounding * a.mass);
                EXPECT_NEAR(a.rest_volume, b.rest_volume, rounding * a.rest_volume);
                EXPECT_LE((a.momentum - b.momentum).norm(), 1e-12 * before.momentum_scale);
                EXPECT_LE((a.angular_momentum - b.angular_momentum).norm(),
                          1e-12 * before.angular_scale);
                if (!body.edits.back().physics.has_joins()) {
                    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 1e-12 * a.kinetic_energy);
                }
            }
        }
}

/// The tangent of a body as a full matrix, by components of nodes.
class FullTangent final : public physics::TangentSink {
  public:
    explicit FullTangent(const Model& model)
        : K(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * model.positions().size()),
                                  static_cast<Eigen::Index>(3 * model.positions().size()))) {
        model.structure().elements().for_each_block([&](const physics::ElementBlock& some) {
            some.visit_tangents({model.positions(), model.state().history(), 0.0},
                                physics::TangentKind::exact, *this);
        });
    }
    void add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) override {
        const auto size = static_cast<Eigen::Index>(3 * nodes.size());
        for (Eigen::Index column = 0; column < size; ++column)
            for (Eigen::Index row = 0; row < size; ++row)
                K(index(nodes, row), index(nodes, column)) +=
                    tangent[static_cast<std::size_t>(column * size + row)];
    }
    Eigen::MatrixXd K;

  private:
    static Eigen::Index index(std::span<const std::uint32_t> nodes, Eigen::Index i) {
        return 3 * static_cast<Eigen::Index>(nodes[static_cast<std::size_t>(i / 3)]) + i % 3;
    }
};

/// 2 / omega_max of the motion about the present positions.
double true_stable_step(const Model& model) {
    FullTangent tangent(model);
    for (Eigen::Index i = 0; i < tangent.K.rows(); ++i) {
        const double mass = model.masses()[static_cast<std::size_t>(i / 3)];
        const double by = mass > 0.0 ? 1.0 / std::sqrt(mass) : 0.0;
        tangent.K.row(i) *= by;
        tangent.K.col(i) *= by;
    }
    return 2.0 / std::sqrt(physics::spectrum(tangent.K).values.maxCoeff());
}

/// Hybrid springs of a Poisson's ratio below and above 1/4 and near 1/2.
std::vector<HybridSprings> some_springs() {
    return {{3e3, -500.0, 1.0}, {3e3, 1e4, 1.0}, {3e3, 1e4, infinite}, {3e3, 1e5, infinite}};
}

/// A block of 2 x 2 x 2 cubes or, if `edges` are not equal, boxes.
MeshData small_block(const Vec3& edges) {
    return topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), 2.0 * edges, {2, 2, 2});
}

TEST(CutCells, OfHybridSpringsHaveAStableStepAtRestAndInStrain) {
    double least = 1.0;
    for (const HybridSprings& springs : some_springs())
        for (const Vec3& edges : {Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0.6, 0.45)})
            for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
                SCOPED_TRACE(testing::Message() << "kappa " << springs.volume_modulus << ", A "
                                                << springs.stiffness_ratio << ", seed " << seed);
                CutBody body(small_block(edges), physics::table_of_one_material(springs));
                test::Random random(seed);
                const double whole = body.model.stable_step();
                for (int i = 0; i < 1 + static_cast<int>(seed % 2); ++i) body.cut(random);
                const double bound = body.model.stable_step(), exact = true_stable_step(body.model);
                EXPECT_LE(bound, exact * (1.0 + 1e-9));
                least = std::min(least, bound / whole);
                body.deform(random, 0.02, 0.0);
                EXPECT_LE(body.model.stable_step(), true_stable_step(body.model) * (1.0 + 1e-9));
            }
    EXPECT_GT(least, 0.7);  // of that of the uncut body: the step has a floor
}

// Undamped motion swings in energy by the step, but does not gain any: from a small disturbance of
// rest, and from a strain of 10 % in motion, with cuts that leave parts of any size.
TEST(CutCells, OfHybridSpringsGainNoEnergy) {
    for (const HybridSprings& springs : some_springs())
        for (const bool is_strained : {false, true})
            for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
                SCOPED_TRACE(testing::Message()
                             << "kappa " << springs.volume_modulus << ", A "
                             << springs.stiffness_ratio
                             << (is_strained ? ", strained" : ", at rest") << ", seed " << seed);
                CutBody body(small_block(Vec3::Constant(0.5)),
                             physics::table_of_one_material(springs));
                test::Random random(seed);
                for (int i = 0; i < 2; ++i) body.cut(random);
                if (is_strained) {
                    body.deform(random, 0.01, 0.1);
                } else {
                    BodyState state = physics::rest_state(body.model.fragments());
                    for (Vec3& v : state.velocities) v = random.vector(1e-3);
                    set_state(body.model, state);
                }
                physics::SemiImplicitEuler steps;
                double time = 0.0, early = 0.0, late = 0.0, dt = 1.0;
                constexpr int num_steps = 400;
                for (int i = 0; i < num_steps; ++i) {
                    dt = std::min(dt, 0.6 * body.model.stable_step());
                    steps.step(body.model, time, dt);
                    time += dt;
                    body.model.compute_forces(time);
                    double& most = i < num_steps / 2 ? early : late;
                    if (i % 3 == 0) most = std::max(most, body.energy());
                }
                EXPECT_LE(late, 1.1 * early);
            }
}

physics::BoundaryConditions hanging(const Mesh& mesh) {
    physics::BoundaryConditions acting;
    acting.gravity = {0.0, 0.0, -0.3};
    acting.damping = 3.0;
    acting.constraints = {physics::holding("left", physics::left_end(mesh))};
    return acting;
}

/// A cut half-way through the cube, which then hangs from its left side.
void cut_half_way(CutBody& body) {
    // Two planes leave a piece on the right, and a notch.
    body.cut({0.62, 0.5, 0.55}, {1.0, 0.35, 0.2});
    body.cut({0.5, 0.45, 0.52}, {0.1, 0.2, 1.0});
}

std::vector<Vec3> displacements(const CutBody& body) {
    std::vector<Vec3> u;
    for (const VertexId n : body.mesh.nodes())
        u.push_back(body.model.mesh_positions()[n.index()] - body.mesh.rest_position(n));
    return u;
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
    return most;
}

// Two layers that no cut parts from the clamp, so that there is an equilibrium: statics, implicit
// steps and explicit ones, in doubles and with forces in floats, all come to it.
TEST(CutCells, ComeToTheSameEquilibriumByAllSolvers) {
    for (const Tissue& tissue : tissues(3)) {
        SCOPED_TRACE(tissue.name);
        const auto rest_by = [&](physics::Integrator& integrator, Precision precision, double dt,
                                 double duration) {
            MaterialTable table = tissue.table;
            table.precision = precision;
            CutBody body(tissue.data, table, hanging);
            body.cut({0.5, 0.47, 0.52}, {0.1, 0.2, 1.0});
            EXPECT_GT(body.num_divided(), 8u);
            body.model.compute_forces(0.0);
            for (double time = 0.0; time < duration;) {
                const double now = dt > 0.0 ? dt : 0.7 * body.model.stable_step();
                integrator.step(body.model, time, now);
                time += now;
                body.model.compute_forces(time);
            }
            return displacements(body);
        };
        physics::Statics statics;
        const auto exact = rest_by(statics, Precision::double_precision, 1.0, 1.0);
        const double scale = largest(exact);
        EXPECT_GT(scale, 0.01);
        physics::ImplicitEuler implicit;
        EXPECT_LE(difference(rest_by(implicit, Precision::double_precision, 0.5, 20.0), exact),
                  1e-4 * scale);
        for (const Precision precision :
             {Precision::double_precision, Precision::single_precision}) {
            physics::SemiImplicitEuler explicit_steps;
            EXPECT_LE(difference(rest_by(explicit_steps, precision, 0.0, 20.0), exact),
                      1e-4 * scale);
        }
    }
}

TEST(CutCells, MoveInImplicitStepsAsInExplicitOnes) {
    for (const Tissue& tissue : tissues(2)) {
        SCOPED_TRACE(tissue.name);
        std::vector<std::vector<Vec3>> ends;
        for (const bool is_implicit : {false, true}) {
            CutBody body(tissue.data, tissue.table, hanging);
            cut_half_way(body);
            physics::ImplicitEuler implicit;
            physics::SemiImplicitEuler explicit_steps;
            physics::Integrator& integrator =
                is_implicit ? static_cast<physics::Integrator&>(implicit) : explicit_steps;
            double time = 0.0;
            for (int i = 0; i < 50; ++i) {
                body.model.compute_forces(time);
                integrator.step(body.model, time, 2e-3);
                time += 2e-3;
            }
            ends.push_back(displacements(body));
        }
        EXPECT_GT(largest(ends[0]), 1e-3);
        EXPECT_LE(difference(ends[0], ends[1]), 0.03 * largest(ends[0]));
    }
}

}  // namespace
}  // namespace incise::sim
