// Static equilibria of hybrid mass-spring lattices, reached by the model's own damped motion,
// against Newton's method on the same energy (data/references/hybmss_static.json).
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::Mesh;

constexpr double tolerance = 1e-7;  // relative

/// One row of the file.
struct Case {
    nlohmann::json row;

    std::string kind() const { return row.at("kind"); }
    double at(const char* key) const { return row.at(key); }
    Vec3 size() const {
        const auto L = row.at("L").get<std::array<double, 3>>();
        return {L[0], L[1], L[2]};
    }
    Mesh mesh() const {
        return Mesh::build(topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), size(),
                                              row.at("N").get<std::array<int, 3>>()))
            .mesh;
    }
    MaterialTable materials() const {
        const double G = at("E") / (2.0 * (1.0 + at("nu")));
        const double kappa = G * (4.0 * at("nu") - 1.0) / (1.0 - 2.0 * at("nu"));
        return table_of_one_material(HybridSprings{G, kappa, at("A")}, row.value("rho", 1000.0));
    }
};

std::vector<Case> cases_of(const std::vector<std::string>& kinds) {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/hybmss_static.json");
    std::vector<Case> cases;
    const auto json = nlohmann::json::parse(file);
    for (const auto& row : json.at("rows"))
        if (std::find(kinds.begin(), kinds.end(), row.at("kind")) != kinds.end())
            cases.push_back({row});
    return cases;
}

/// The plates at both ends in z: the lower one held, the upper one as `move` says.
std::vector<Constraint> plates(const Case& c, const Mesh& mesh, double ramp_time) {
    const double height = c.size().z();
    const auto at = [&](double z) {
        return VertexSet(
            nodes_where(mesh, [&](const Vec3& X) { return std::abs(X.z() - z) < 1e-9 * height; }));
    };
    Constraint top = holding("top", at(height));
    const double amount = c.kind() == "notch" ? c.at("d") : c.at("amt");
    const auto move_by = [&](const Vec3& u) {
        top.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {ramp_time, u}});
    };
    if (c.kind() == "tors") {
        top.angle = TimeCurve<double>({{0.0, 0.0}, {ramp_time, amount}});
        top.point = {0.5 * c.size().x(), 0.5 * c.size().y(), height};
    } else if (c.kind() == "shear") {
        move_by(amount * height * Vec3::UnitX());
    } else {
        move_by((c.kind() == "comp" ? -amount : amount) * height * Vec3::UnitZ());
    }
    return {holding("base", at(0.0)), top};
}

/// A body on its way to equilibrium. Times are in units of how long a shear wave takes through it.
class PlateRelaxation {
  public:
    PlateRelaxation(const Case& c, const Mesh& mesh)
        : mesh_(mesh),
          unit_(c.size().maxCoeff() *
                std::sqrt(2.0 * (1.0 + c.at("nu")) * c.row.value("rho", 1000.0) / c.at("E"))),
          model_(mesh, c.materials(), boundary_conditions(c)),
          dt_(0.9 * model_.stable_step()) {}

    void run_until(double units) {
        while (time_ < units * unit_) step(model_, time_, dt_);
    }

    /// Until no free node feels more than this share of all forces; damping lets motion die only
    /// with the net force.
    void run_to_equilibrium(double share = 1e-12) {
        for (int round = 0; round < 4000; ++round) {
            for (int i = 0; i < 50; ++i) step(model_, time_, dt_);
            if (imbalance() < share) return;
        }
        FAIL() << "no equilibrium by " << time_ / unit_ << ", imbalance " << imbalance();
    }

    /// By statics, in so many load steps.
    void equilibrate(int num_steps) {
        const double dt = 2.0 * unit_ / num_steps;
        for (int i = 0; i < num_steps; ++i) statics_.step(model_, i * dt, dt);
    }

    Model& model() { return model_; }
    double time() const { return time_; }

  private:
    BoundaryConditions boundary_conditions(const Case& c) const {
        BoundaryConditions s;
        if (c.kind() == "cantilever_gravity") {
            s.gravity = {0.0, -c.at("g"), 0.0};
            s.constraints = {holding("root", VertexSet(nodes_where(mesh_, [](const Vec3& X) {
                                         return std::abs(X.z()) < 1e-9;
                                     })))};
            s.damping = 0.35 / unit_;  // near critical for the first bending mode
        } else {
            s.constraints = plates(c, mesh_, 2.0 * unit_);
            s.damping = 3.0 / unit_;
        }
        return s;
    }

    double imbalance() {
        model_.compute_forces(time_);
        double net = 0.0, all = 0.0;
        for (std::size_t n = 0; n < mesh_.node_capacity(); ++n) {
            const Vec3 speed = model_.velocities()[n];
            const double force = model_.elastic_forces()[n].norm();
            all += force;
            net = std::max(net, model_.masses()[n] * speed.norm() / unit_);
        }
        return net / all;
    }

    const Mesh& mesh_;
    double unit_;
    Model model_;
    Statics statics_;
    double dt_, time_ = 0.0;
};

TEST(HybMssStatic, PlatesFeelForceAndTorqueOfTheReference) {
    const auto check = [](const Case& c, bool is_static) {
        SCOPED_TRACE(c.row.dump());
        const Mesh mesh = c.mesh();
        PlateRelaxation body(c, mesh);
        if (is_static)
            body.equilibrate(2);
        else
            body.run_to_equilibrium();
        const Vec3 force = body.model().boundary().reactions()[1].force;
        const auto F = c.row.at("F").get<std::array<double, 3>>();
        const Vec3 expected(F[0], F[1], F[2]);
        if (c.kind() == "tors") {
            EXPECT_NEAR(body.model().boundary().reactions()[1].torque.z(), c.at("torque"),
                        tolerance * c.at("torque"));
        } else {
            EXPECT_LE((force - expected).norm(), tolerance * expected.norm());
        }
        EXPECT_NEAR(body.model().energetics().volume_change(), c.at("e_param"),
                    tolerance * (1e-2 + std::abs(c.at("e_param"))));
        EXPECT_NEAR(body.model().energetics().totals().elastic_energy, c.at("energy"),
                    tolerance * c.at("energy"));
    };
    for (const Case& c : cases_of({"comp", "tens", "shear", "tors"}))
        for (const bool is_static : {false, true}) check(c, is_static);
}

topology::ChangeSet open_notch(Mesh& mesh, const Case& c) {
    topology::MeshEdit edit(mesh);
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            if (!mesh.neighbor({e, f}).is_valid()) continue;
            Vec3 centre = Vec3::Zero();
            for (int p = 0; p < 4; ++p)
                centre += 0.25 * mesh.rest_position(mesh.face_corner({e, f}, p));
            if (std::abs(centre.z() - 0.5 * c.size().z()) < 1e-6 && centre.x() < c.at("a"))
                edit.open({e, f});
        }
    return edit.commit();
}

/// How far apart in z two nodes are that were one, at the mouth of the notch.
double opening(const Mesh& mesh, const Model& model, const Vec3& X) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const VertexId n :
         nodes_where(mesh, [&](const Vec3& at) { return (at - X).norm() < 1e-9; })) {
        low = std::min(low, model.positions()[n.index()].z());
        high = std::max(high, model.positions()[n.index()].z());
    }
    return high - low;
}

// The same state, whether the notch is there from the start or comes while the body moves.
TEST(HybMssStatic, ANotchOpensAsTheReferenceWheneverCut) {
    for (const Case& c : cases_of({"notch"}))
        for (const bool is_cut_before : {true, false}) {
            SCOPED_TRACE(c.row.dump());
            Mesh mesh = c.mesh();
            if (is_cut_before) open_notch(mesh, c);
            PlateRelaxation body(c, mesh);
            if (!is_cut_before) {
                body.run_until(1.0);
                body.model().apply(body.model().mesh(), open_notch(mesh, c));
            }
            ASSERT_TRUE(topology::validate(mesh).empty());
            body.run_to_equilibrium();
            EXPECT_NEAR(body.model().boundary().reactions()[1].force.z(), c.at("Fz_top"),
                        tolerance * c.at("Fz_top"));
            const double reference = c.at("COD_mouth_surface");
            EXPECT_NEAR(opening(mesh, body.model(), {0.0, 0.0, 0.5 * c.size().z()}), reference,
                        tolerance * reference);
        }
}

TEST(HybMssStatic, ABeamBendsUnderGravityAsTheReference) {
    for (const Case& c : cases_of({"cantilever_gravity"})) {
        SCOPED_TRACE(c.row.dump());
        const Mesh mesh = c.mesh();
        PlateRelaxation body(c, mesh);
        body.run_to_equilibrium();
        const Vec3 end(0.5 * c.size().x(), 0.5 * c.size().y(), c.size().z());
        const auto tip = nodes_where(mesh, [&](const Vec3& X) { return (X - end).norm() < 1e-9; });
        ASSERT_EQ(tip.size(), 1u);
        const auto u = c.row.at("tip_u").get<std::array<double, 3>>();
        const Vec3 moved = body.model().positions()[tip[0].index()] - end;
        EXPECT_LE((moved - Vec3(u[0], u[1], u[2])).norm(), tolerance * std::abs(u[1]));
    }
}

// Boxes as slender as they may be, and whatever ratio of springs is asked for: pressed together by
// a fifth they neither wrinkle nor are much softer or stiffer than cubes.
TEST(HybMssStatic, BoxesArePressedTogetherLikeCubes) {
    const auto pressed = [](const std::array<int, 3>& cells, double ratio) {
        const Case c{{{"kind", "comp"},
                      {"amt", 0.2},
                      {"nu", 0.25},
                      {"A", ratio},
                      {"E", 1e4},
                      {"L", {1.0, 1.0, 1.0}},
                      {"N", cells}}};
        const Mesh mesh = c.mesh();
        PlateRelaxation body(c, mesh);
        body.run_to_equilibrium(1e-7);
        EXPECT_GT(body.model().energetics().min_volume_ratio(), 0.75);
        return body.model().energetics().totals().elastic_energy;
    };
    for (const double ratio : {0.5, 1.0, 1e9}) {
        const double cubes = pressed({6, 6, 6}, ratio);
        for (const auto& cells :
             {std::array{5, 5, 7}, {7, 7, 5}, {6, 6, 8}, {7, 5, 5}, {5, 6, 7}}) {
            SCOPED_TRACE(testing::Message()
                         << cells[0] << " x " << cells[1] << " x " << cells[2] << ", A " << ratio);
            EXPECT_NEAR(pressed(cells, ratio), cubes, 0.08 * cubes);
        }
    }
}

}  // namespace
}  // namespace incise::physics
