// Torsion, shear, compression and tension of bars between glued plates, by statics on tetrahedra,
// against the quadratic elements of CalculiX (data/references). Linear tetrahedra are stiffer by
// their discretisation alone, which has to vanish as it should when they are made smaller.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

struct Experiment {
    std::string kind, law;
    double amount, young, poisson;
    Vec3 size;      // m
    double action;  // of the top plate along what it does: N, or N m
    double volume_change;
};

std::vector<Experiment> experiments() {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/five_experiments_calculix.json");
    std::vector<Experiment> all;
    const auto json = nlohmann::json::parse(file);
    for (const auto& row : json.at("rows")) {
        const auto L = row.at("L").get<std::array<double, 3>>();
        const auto F = row.at("F").get<std::array<double, 3>>();
        const std::string kind = row.at("kind");
        all.push_back({kind, row.at("law"), row.at("amt"), row.at("E"), row.at("nu"),
                       Vec3(L[0], L[1], L[2]),
                       kind == "tors"    ? row.at("torque").get<double>()
                       : kind == "shear" ? F[0]
                                         : F[2],
                       row.at("e")});
    }
    return all;
}

Law law_of_experiment(const Experiment& experiment) {
    const double mu = experiment.young / (2.0 * (1.0 + experiment.poisson));
    const double lambda = 2.0 * mu * experiment.poisson / (1.0 - 2.0 * experiment.poisson);
    if (experiment.law == "stvk") return SaintVenantKirchhoff{lambda, mu};
    return IsochoricMooneyRivlin{0.5 * mu, 0.0, lambda + 2.0 / 3.0 * mu};
}

struct Outcome {
    double action, volume_change;
};

/// On bricks of which the shortest edge of the bar has n, each divided into six tetrahedra.
Outcome solve(const Experiment& experiment, int n) {
    const Vec3 &size = experiment.size, cells = n * size / size.minCoeff();
    const auto count = [&](int c) { return static_cast<int>(std::lround(cells[c])); };
    const auto mesh =
        topology::Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                                 size, {count(0), count(1), count(2)}))
            .mesh;
    const auto plate = [&](double z) {
        return VertexSet(nodes_where(
            mesh, [&](const Vec3& X) { return std::abs(X.z() - z) < 1e-9 * size.z(); }));
    };
    Constraint top = holding("top", plate(size.z()));
    const double amount = experiment.amount;
    if (experiment.kind == "tors") {
        top.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, amount}});
        top.point = {0.5 * size.x(), 0.5 * size.y(), size.z()};
    } else {
        const Vec3 direction = experiment.kind == "shear"  ? Vec3(1, 0, 0)
                               : experiment.kind == "comp" ? Vec3(0, 0, -1)
                                                           : Vec3(0, 0, 1);
        top.displacement =
            TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, amount * size.z() * direction}});
    }
    BoundaryConditions boundary_conditions;
    boundary_conditions.constraints = {holding("base", plate(0.0)), top};
    Model model(mesh, table_of_one_law(law_of_experiment(experiment)), boundary_conditions);
    Statics statics;
    const int num_steps = amount > 0.1 ? 5 : 1;
    for (int i = 0; i < num_steps; ++i)
        statics.step(model, static_cast<double>(i) / num_steps, 1.0 / num_steps);
    return {experiment.kind == "tors"    ? model.boundary().reactions()[1].torque.z()
            : experiment.kind == "shear" ? model.boundary().reactions()[1].force.x()
                                         : model.boundary().reactions()[1].force.z(),
            model.energetics().volume_change()};
}

TEST(FiveExperiments, ConvergeToTheQuadraticElementsOfCalculix) {
    for (const Experiment& experiment : experiments()) {
        if (experiment.poisson > 0.4) continue;  // linear tetrahedra lock
        SCOPED_TRACE(experiment.kind + " of " + std::to_string(experiment.amount) + ", " +
                     experiment.law);
        const Outcome coarse = solve(experiment, 3), fine = solve(experiment, 6);
        const double coarse_error = coarse.action / experiment.action - 1.0,
                     fine_error = fine.action / experiment.action - 1.0;
        EXPECT_GT(fine_error, 0.0);  // stiffer, always
        EXPECT_LT(fine_error, 0.5 * coarse_error);
        // Extrapolated with the order that stress singularities at the plates' rims leave, 1.8.
        EXPECT_NEAR(fine_error - (coarse_error - fine_error) / 2.5, 0.0, 0.04);
        EXPECT_LT(std::abs(fine.volume_change - experiment.volume_change),
                  0.5 * std::abs(coarse.volume_change - experiment.volume_change));
    }
}

}  // namespace
}  // namespace incise::physics
