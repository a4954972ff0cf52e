// Static equilibria of whole and cut bodies, reached by the model's own damped motion, against
// independent finite elements (data/references). A cut that is there from the start and one that
// comes while the body moves have to end in the same state.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using test::CutReference;
using test::StaticSolution;
using topology::Mesh;

constexpr double displacement_tolerance = 1e-9;  // of the largest displacement
constexpr double reaction_tolerance = 1e-9;      // of the reaction
constexpr double ramp_time = 0.2;                // s, of the moved points
constexpr double damping = 60.0;                 // 1/s, near critical for the lowest modes

topology::ChangeSet open_cut_faces(Mesh& mesh, const CutReference& reference) {
    std::set<std::array<std::int64_t, 3>> wanted;
    for (auto face : reference.cut_faces) {
        std::sort(face.begin(), face.end());
        wanted.insert(face);
    }
    topology::MeshEdit edit(mesh);
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId face{e, f};
            if (!mesh.neighbor(face).is_valid()) continue;
            std::array<std::int64_t, 3> labels{};
            for (int p = 0; p < 3; ++p)
                labels[static_cast<std::size_t>(p)] = mesh.label(mesh.face_corner(face, p));
            std::sort(labels.begin(), labels.end());
            if (wanted.contains(labels)) edit.open(face);
        }
    const auto changes = edit.commit();
    EXPECT_EQ(changes.faces_opened.size(), wanted.size());
    return changes;
}

// The point of the reference that each corner of the mesh came from: `tets` are the corners of the
// reference's elements, by their labels. Throws if a node is two points.
std::map<VertexId, std::int64_t> points_of_nodes(
    const Mesh& mesh, const std::vector<std::array<std::int64_t, 4>>& tets) {
    std::map<VertexId, std::int64_t> points;
    for (const CellId e : living_elements(mesh))
        for (std::size_t k = 0; k < 4; ++k) {
            const std::int64_t point = tets.at(static_cast<std::size_t>(mesh.label(e)))[k];
            const auto [place, is_new] = points.try_emplace(mesh.corners(e)[k], point);
            if (place->second != point) throw std::runtime_error("a node stands for two points");
        }
    return points;
}

std::vector<std::array<std::int64_t, 4>> uncut_tets(const CutReference& reference) {
    std::vector<std::array<std::int64_t, 4>> tets;
    for (std::size_t c = 0; c < reference.mesh.num_cells(); ++c) {
        const auto cell = reference.mesh.cell(c);
        tets.push_back({cell[0], cell[1], cell[2], cell[3]});
    }
    return tets;
}

Constraint constraint(const Mesh& mesh, const CutReference& reference, const std::string& name,
                      const std::vector<std::int64_t>& points, const Vec3& displacement) {
    const std::set<std::int64_t> selected(points.begin(), points.end());
    std::vector<VertexId> nodes;
    for (const auto& [node, point] : points_of_nodes(mesh, uncut_tets(reference)))
        if (selected.contains(point)) nodes.push_back(node);
    Constraint s;
    s.name = name;
    s.nodes = VertexSet(nodes);
    s.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {ramp_time, displacement}});
    return s;
}

/// A body of the reference on its way to equilibrium.
class Relaxation {
  public:
    Relaxation(const Mesh& mesh, const CutReference& reference, const Law& law)
        : model_(mesh, table_of_one_law(law), boundary_conditions(mesh, reference)),
          dt_(0.85 * model_.stable_step()) {}

    void run_until(double time) {
        while (time_ < time) step(model_, time_, dt_);
    }

    /// Goes on until no free node feels a net force of more than 1e-11 of the reaction.
    /// Damping lets motion die only with the net force, so that one tells of both.
    void run_to_equilibrium() {
        run_until(ramp_time + 2.0 * dt_);
        for (int round = 0; round < 400; ++round) {
            for (int i = 0; i < 100; ++i) step(model_, time_, dt_);
            if (net_force_in_next_step() < 1e-11 * model_.boundary().reactions()[1].force.norm())
                return;
        }
        FAIL() << "no equilibrium by " << time_ << " s";
    }

    void apply(const topology::ChangeSet& changes) {
        model_.apply(model_.mesh(), changes);
        dt_ = 0.85 * model_.stable_step();
    }

    const Model& model() const { return model_; }

    static BoundaryConditions boundary_conditions(const Mesh& mesh, const CutReference& reference) {
        BoundaryConditions s;
        s.damping = damping;
        s.constraints.push_back(
            constraint(mesh, reference, "fixed", reference.fixed, Vec3::Zero()));
        s.constraints.push_back(
            constraint(mesh, reference, "moved", reference.moved, reference.displacement));
        return s;
    }

  private:
    // What accelerates a node and what damping takes from it; constrained nodes stand still.
    double net_force_in_next_step() {
        const BodyState before = state_of(model_);
        step(model_, time_, dt_);
        double largest = 0.0;
        for (std::size_t n = 0; n < before.velocities.size(); ++n) {
            const Vec3& v = model_.velocities()[n];
            const Vec3 force =
                model_.masses()[n] * ((v - before.velocities[n]) / dt_ + damping * v);
            largest = std::max(largest, force.norm());
        }
        return largest;
    }

    Model model_;
    double time_ = 0.0, dt_;
};

void expect_solution(const Model& model, const CutReference& reference,
                     const StaticSolution& solution) {
    const Mesh& mesh = model.mesh();
    const auto points =
        points_of_nodes(mesh, solution.is_cut ? reference.cut_tets : uncut_tets(reference));
    ASSERT_EQ(points.size(), solution.displacements.size());
    double largest = 0.0, largest_error = 0.0;
    std::set<std::int64_t> seen;
    for (const auto& [node, point] : points) {
        EXPECT_TRUE(seen.insert(point).second) << "point " << point << " is two nodes";
        const std::int64_t origin =
            solution.is_cut ? reference.origin[static_cast<std::size_t>(point)] : point;
        EXPECT_EQ(mesh.rest_position(node),
                  reference.mesh.points[static_cast<std::size_t>(origin)]);
        const Vec3& u = solution.displacements[static_cast<std::size_t>(point)];
        const Vec3 ours = model.positions()[node.index()] - mesh.rest_position(node);
        largest = std::max(largest, u.norm());
        largest_error = std::max(largest_error, (ours - u).norm());
    }
    EXPECT_LE(largest_error, displacement_tolerance * largest);

    const Vec3& reaction = model.boundary().reactions()[1].force;
    for (int c = 0; c < 3; ++c) {
        if (std::isnan(solution.reaction[c])) continue;
        EXPECT_NEAR(reaction[c], solution.reaction[c], reaction_tolerance * reaction.norm());
    }
    if (solution.deformed_volume) {
        double volume = 0.0;
        for (const ElementId e : living_elements(model.fragments())) {
            const ElementResult result = model.element_result(e);
            volume += result.volume * result.volume_ratio;
        }
        EXPECT_NEAR(volume, *solution.deformed_volume, 1e-8 * volume);
    }
}

/// Calls visit(mesh, law, solution) on the whole body, for each of its solutions with a known law.
template <class Visit>
void for_each_solution(const CutReference& reference, bool is_cut, Visit visit) {
    std::size_t num_solutions = 0;
    for (const StaticSolution& solution : reference.solutions) {
        const auto law = law_of(solution.law);
        if (!law || solution.is_cut != is_cut) continue;
        SCOPED_TRACE(reference.name + ", " + solution.law.name);
        Mesh mesh = Mesh::build(reference.mesh).mesh;
        visit(mesh, *law, solution);
        ++num_solutions;
    }
    EXPECT_GE(num_solutions, 2u);
}

void check_uncut(const CutReference& reference) {
    for_each_solution(reference, false, [&](Mesh& mesh, const Law& law, const auto& solution) {
        Relaxation relaxation(mesh, reference, law);
        relaxation.run_to_equilibrium();
        expect_solution(relaxation.model(), reference, solution);
    });
}

void check_cut_from_the_start(const CutReference& reference) {
    for_each_solution(reference, true, [&](Mesh& mesh, const Law& law, const auto& solution) {
        open_cut_faces(mesh, reference);
        Relaxation relaxation(mesh, reference, law);
        relaxation.run_to_equilibrium();
        expect_solution(relaxation.model(), reference, solution);
    });
}

void check_cut_during_the_run(const CutReference& reference) {
    for_each_solution(reference, true, [&](Mesh& mesh, const Law& law, const auto& solution) {
        Relaxation relaxation(mesh, reference, law);
        relaxation.run_until(1.1 * ramp_time);  // loaded, and still in motion
        relaxation.apply(open_cut_faces(mesh, reference));
        EXPECT_EQ(topology::validate(mesh), std::vector<std::string>());
        relaxation.run_to_equilibrium();
        expect_solution(relaxation.model(), reference, solution);
    });
}

// Statics finds the same states in two load steps.
void check_statics(const CutReference& reference, bool is_cut) {
    for_each_solution(reference, is_cut, [&](Mesh& mesh, const Law& law, const auto& solution) {
        Model model(mesh, table_of_one_law(law), Relaxation::boundary_conditions(mesh, reference));
        Statics statics;
        statics.step(model, 0.0, 0.5 * ramp_time);
        if (is_cut) {
            model.apply(model.mesh(), open_cut_faces(mesh, reference));
            statics.equilibrate(model, 0.5 * ramp_time);
        }
        statics.step(model, 0.5 * ramp_time, 0.5 * ramp_time);
        expect_solution(model, reference, solution);
    });
}
TEST(StaticReference, StaticsOfTheOrgan) {
    check_statics(test::organ_reference(), false);
    check_statics(test::organ_reference(), true);
}
TEST(StaticReference, StaticsOfNotches) {
    for (const auto& reference : test::notch_references()) check_statics(reference, true);
}

TEST(StaticReference, StaticsOfABeamUnderItsOwnWeight) {
    std::ifstream file(INCISE_DATA_DIR "/references/beam.json");
    const auto beams = nlohmann::json::parse(file).at("p1_same_mesh");
    ASSERT_EQ(beams.size(), 2u);
    for (const auto& beam : beams) {
        SCOPED_TRACE(beam.at("law"));
        const double E = beam.at("E"), nu = beam.at("nu"), g = beam.at("g");
        const double mu = E / (2.0 * (1.0 + nu)), lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        const bool is_stvk = beam.at("law") == "stvk";
        const Law law =
            is_stvk ? Law(SaintVenantKirchhoff{lambda, mu}) : Law(NeoHookean{0.5 * mu, lambda});
        const Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron,
                                                         Vec3::Zero(), {0.4, 0.4, 2.4}, {4, 4, 24}))
                              .mesh;
        const auto at = [&](auto is_there) { return nodes_where(mesh, is_there); };
        BoundaryConditions s;
        s.gravity = {0.0, -g, 0.0};
        s.constraints = {
            holding("root", VertexSet(at([](const Vec3& X) { return X.z() < 1e-9; })))};
        Model model(mesh, table_of_one_law(law, beam.at("rho")), s);
        Statics().step(model, 0.0, 1.0);
        const auto tips = at([](const Vec3& X) { return (X - Vec3(0.2, 0.2, 2.4)).norm() < 1e-9; });
        ASSERT_EQ(tips.size(), 1u);
        const Vec3 u = model.positions()[tips[0].index()] - mesh.rest_position(tips[0]);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(u[c], beam.at("tip_u")[static_cast<std::size_t>(c)].get<double>(), 1e-8);
    }
}

TEST(StaticReference, OrganUncut) { check_uncut(test::organ_reference()); }
TEST(StaticReference, OrganCutFromTheStart) { check_cut_from_the_start(test::organ_reference()); }
TEST(StaticReference, OrganCutDuringTheRun) { check_cut_during_the_run(test::organ_reference()); }
TEST(StaticReference, NotchCutFromTheStart) {
    for (const auto& reference : test::notch_references()) check_cut_from_the_start(reference);
}
TEST(StaticReference, NotchCutDuringTheRun) {
    for (const auto& reference : test::notch_references()) check_cut_during_the_run(reference);
}

}  // namespace
}  // namespace incise::physics
