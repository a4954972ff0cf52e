// A block that is pulled, then notched by a blade during the run, against the converged solution
// of the notched block (data/references/notch_converged.json). No plane of the mesh fits the
// notch: the blade goes through elements and stops inside of some.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "incise/topology/box_mesh.h"
#include "incise/topology/validate.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

using topology::Mesh;

/// A block that is held at z = 0 and at its other end, which is moved in z by `pull` times the
/// height; notched in the middle of the height from x = 0 to `depth`, right through in y.
struct Notch {
    Vec3 size;                            // m
    double depth;                         // m
    double pull;                          // 1
    double young, poisson;                // Pa, 1
    double force;                         // that pulls, N
    double middle_opening, side_opening;  // at the mouth, along z, m
};

/// The solution for the law that is ours: mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2.
Notch notch_of_depth(double depth) {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/notch_converged.json");
    const auto json = nlohmann::json::parse(file);
    const auto size = json.at("L").get<std::array<double, 3>>();
    for (const auto& row : json.at("rows")) {
        if (row.at("a") != depth) continue;
        const auto& solution = row.at("nh26_tet10");
        return {.size = {size[0], size[1], size[2]},
                .depth = depth,
                .pull = row.at("d"),
                .young = row.at("E"),
                .poisson = row.at("nu"),
                .force = solution.at("Fz"),
                .middle_opening = solution.at("COD_mouth_mid"),
                .side_opening = solution.at("COD_mouth_surface")};
    }
    throw std::runtime_error("no notch of depth " + std::to_string(depth));
}

using Bricks = std::array<int, 3>;

// An odd number of layers: the notch is in the middle of one. Both notches end within bricks.
constexpr Bricks coarse{17, 6, 17}, refined{33, 12, 33};

/// Bricks of six tetrahedra, inner points moved by up to a fifth of a brick, those of the sides
/// within their side.
topology::MeshData jittered_block(const Vec3& size, const Bricks& bricks) {
    auto data = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), size, bricks);
    test::Random random(1);
    for (Vec3& x : data.points) {
        const Vec3 shift = random.vector(0.2);
        for (int c = 0; c < 3; ++c)
            if (x[c] > 0.0 && x[c] < size[c])
                x[c] += shift[c] * size[c] / bricks[static_cast<std::size_t>(c)];
    }
    return data;
}

constexpr double density = 1000.0;  // kg/m3
constexpr double damping = 100.0;   // 1/s, near critical for the slowest motion of a notched block
constexpr double ramp_time = 0.06;  // s, of the pull
constexpr double cut_time = 0.14;   // s, when the blade sets off; the block is all but at rest
constexpr double end_time = 2.0;    // s, by which it has to be at rest for good
constexpr double balance = 1e-3;    // then: net forces on free nodes, their sum over the pull

/// Of the block without tool. The bound on the step is well on the safe side: all of it is taken.
std::string pulled_block(const Notch& notch) {
    std::ostringstream text;
    text << std::setprecision(17) << R"([mesh]
file = "block.vtu"
[[material]]
law = "neo-hookean"
density = )"
         << density << "\nyoung = " << notch.young << "\npoisson = " << notch.poisson
         << "\n[dynamics]\nend_time = " << end_time << "\nsafety = 1\ndamping = " << damping << R"(
[output]
interval = 0
[[constraint]]
name = "held"
fix = "xyz"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
[[constraint]]
name = "moved"
where = { half_space = { point = [0, 0, )"
         << notch.size.z() << R"(], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = )"
         << ramp_time << ", by = [0, 0, " << notch.pull * notch.size.z() << "] }]\n";
    return text.str();
}

void run_until(Simulation& simulation, double time) {
    while (simulation.time() < time) simulation.step();
}

/// Where the tissue that is at X at rest is now.
Vec3 position_of(const Simulation& simulation, const Vec3& X) {
    const Mesh& mesh = simulation.mesh();
    double nearest = -std::numeric_limits<double>::infinity();
    Vec3 position = X;
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
        if (!mesh.is_alive(CellId(i))) continue;
        Eigen::Matrix4d rest;
        Eigen::Matrix<double, 3, 4> current;
        for (int k = 0; k < 4; ++k) {
            const VertexId n = mesh.corners(CellId(i))[static_cast<std::size_t>(k)];
            rest.col(k) << mesh.rest_position(n), 1.0;
            current.col(k) = simulation.model().positions()[n.index()];
        }
        const Eigen::Vector4d weights = rest.inverse() * X.homogeneous();
        if (weights.minCoeff() <= nearest) continue;
        nearest = weights.minCoeff();
        position = current * weights;
    }
    EXPECT_GE(nearest, -1e-9) << X.transpose() << " is outside";
    return position;
}

/// When and where in x the blade stops.
struct Stop {
    double time, x;
};

/// Where the tissue of the notch's end is in the block that is pulled and not yet notched. The
/// blade is twice as fast as pressure waves, so that it meets the tissue there and at rest; how
/// finely the block is meshed matters little for this.
Stop stop_of_blade(const Notch& notch) {
    const RunFolder folder;
    io::write_mesh(folder / "block.vtu", jittered_block(notch.size, coarse));
    Simulation pulled(folder.scenario(pulled_block(notch)));
    run_until(pulled, cut_time);
    const double mu = notch.young / (2.0 * (1.0 + notch.poisson));
    const double lambda = 2.0 * mu * notch.poisson / (1.0 - 2.0 * notch.poisson);
    const double wave_speed = std::sqrt((lambda + 2.0 * mu) / density);
    const double x =
        position_of(pulled, {notch.depth, 0.5 * notch.size.y(), 0.5 * notch.size.z()}).x();
    return {cut_time + x / (2.0 * wave_speed), x};
}

/// From outside to the stop, in the middle of the pulled block: where the notch's plane is, as the
/// two halves are alike.
std::string blade(const Notch& notch, const Stop& stop, const std::string& more) {
    std::ostringstream text;
    text << std::setprecision(17) << R"([[tool]]
kind = "blade"
mode = "split"
edge = [[0, )"
         << -notch.size.y() << ", 0], [0, " << 2.0 * notch.size.y() << ", 0]]\n"
         << more << "path = [{ time = " << cut_time << ", at = [0, 0, "
         << 0.5 * (1.0 + notch.pull) * notch.size.z() << "] }, { time = " << stop.time << ", at = ["
         << stop.x << ", 0, " << 0.5 * (1.0 + notch.pull) * notch.size.z() << "] }]\n";
    return text.str();
}

double pulling_force(const Simulation& simulation) {
    return simulation.model().boundary().reactions()[1].force.z();
}

/// Sum of the net forces on nodes between the ends, over the pulling force: no less than what the
/// forces at the two ends may differ by.
double imbalance(const Simulation& simulation, const Notch& notch) {
    const fragments::FragmentMesh& fragments = simulation.model().fragments();
    double sum = 0.0;
    for (const NodeId n : fragments.nodes()) {
        const double z = fragments.rest_position(n).z();
        if (z > 0.0 && z < notch.size.z())
            sum += simulation.model().elastic_forces()[n.index()].norm();
    }
    return sum / pulling_force(simulation);
}

void come_to_rest(Simulation& simulation, const Notch& notch) {
    do {
        for (int i = 0; i < 20 && !simulation.is_finished(); ++i) simulation.step();
    } while (imbalance(simulation, notch) > balance && !simulation.is_finished());
    EXPECT_LE(imbalance(simulation, notch), balance);
}

/// By y at rest, how far apart along z the lips are at the mouth: nodes that were one before the
/// cut. Where the lips are rough, several of them may lie above each other; the widest pair counts.
std::map<double, double> mouth(const Simulation& simulation) {
    const Mesh& mesh = simulation.mesh();
    std::map<std::pair<double, double>, std::vector<double>> heights;  // by y and z at rest
    for (std::size_t i = 0; i < mesh.node_capacity(); ++i) {
        const Vec3& X = mesh.rest_positions()[i];
        if (mesh.is_alive(VertexId(i)) && X.x() == 0.0)
            heights[{X.y(), X.z()}].push_back(simulation.world().positions()[i].z());
    }
    std::map<double, double> openings;
    for (const auto& [location, z] : heights) {
        if (z.size() == 1) continue;
        const auto [low, high] = std::minmax_element(z.begin(), z.end());
        double& opening = openings[location.first];
        opening = std::max(opening, *high - *low);
    }
    return openings;
}

/// Linear between the neighbours of y.
double value_at(const std::map<double, double>& values, double y) {
    const auto after = values.lower_bound(y);
    if (after == values.end()) throw std::runtime_error("the notch does not reach so far");
    if (after->first == y) return after->second;
    if (after == values.begin()) throw std::runtime_error("the notch does not reach so far");
    const auto before = std::prev(after);
    return std::lerp(before->second, after->second,
                     (y - before->first) / (after->first - before->first));
}

/// Relative to the reference.
struct Errors {
    double force, middle_opening, side_opening;
};

std::ostream& operator<<(std::ostream& out, const Errors& errors) {
    return out << "errors: force " << 100.0 * errors.force << " %, opening in the middle "
               << 100.0 * errors.middle_opening << " %, at the side " << 100.0 * errors.side_opening
               << " %";
}

/// Pulls, cuts and lets come to rest. `more` goes into the blade's section.
Errors errors_of_cut_block(const Notch& notch, const Bricks& bricks, const std::string& more = "") {
    const Stop stop = stop_of_blade(notch);
    const RunFolder folder;
    io::write_mesh(folder / "block.vtu", jittered_block(notch.size, bricks));
    Simulation simulation(folder.scenario(pulled_block(notch) + blade(notch, stop, more)));
    run_until(simulation, stop.time);
    come_to_rest(simulation, notch);

    EXPECT_EQ(topology::validate(simulation.mesh()), std::vector<std::string>{});
    const auto& edits = simulation.edits();
    EXPECT_GT(edits.size(), 5u);  // not at one go
    EXPECT_EQ(edits.back().after.components, 1);
    const auto openings = mouth(simulation);
    return {pulling_force(simulation) / notch.force - 1.0,
            value_at(openings, 0.5 * notch.size.y()) / notch.middle_opening - 1.0,
            value_at(openings, 0.0) / notch.side_opening - 1.0};
}

void expect_within(const Errors& errors, double force, double opening) {
    EXPECT_LE(std::abs(errors.force), force) << errors;
    EXPECT_LE(std::abs(errors.middle_opening), opening) << errors;
    EXPECT_LE(std::abs(errors.side_opening), opening) << errors;
}

void expect_smaller(const Errors& errors, const Errors& than) {
    EXPECT_LT(std::abs(errors.force), std::abs(than.force));
    EXPECT_LT(std::abs(errors.middle_opening), std::abs(than.middle_opening));
    EXPECT_LT(std::abs(errors.side_opening), std::abs(than.side_opening));
}

// Linear elements are too stiff: on a mesh of 10 x 5 x 10 bricks that fits the deeper notch the
// force is 7 % too high (notch_p1_exact.json). The error is of the order of the element size, hence
// half of the tolerance for half of the size.

TEST(NotchCutByABlade, HalfThroughConverges) {
    const Notch notch = notch_of_depth(0.05);
    const Errors of_coarse = errors_of_cut_block(notch, coarse);
    expect_within(of_coarse, 0.06, 0.04);
    const Errors of_refined = errors_of_cut_block(notch, refined);
    expect_within(of_refined, 0.03, 0.02);
    expect_smaller(of_refined, of_coarse);
}

// The opening of the shorter notch is more sensitive: on meshes that fit it, linear elements make
// it 10 % too small with 10 bricks along x and 3.6 % with 20, and each millimetre by which the end
// of the cut is rough, as snapping leaves it, matters 4 %.
TEST(NotchCutByABlade, LessDeepConvergesIfCutExactly) {
    const Notch notch = notch_of_depth(0.03);
    const std::string exact = "snap = 0\n";
    const Errors of_coarse = errors_of_cut_block(notch, {21, 8, 21}, exact);
    expect_within(of_coarse, 0.06, 0.07);
    const Errors of_refined = errors_of_cut_block(notch, refined, exact);
    expect_within(of_refined, 0.03, 0.03);
    expect_smaller(of_refined, of_coarse);
}

TEST(NotchCutByABlade, LessDeepConvergesIfSnapped) {
    const Notch notch = notch_of_depth(0.03);
    const Errors of_coarse = errors_of_cut_block(notch, coarse);
    expect_within(of_coarse, 0.06, 0.07);
    const Errors of_refined = errors_of_cut_block(notch, {41, 14, 41});
    expect_within(of_refined, 0.03, 0.03);
    expect_smaller(of_refined, of_coarse);
}

TEST(NotchCutByABlade, HardlyDependsOnSnapping) {
    for (const double depth : {0.03, 0.05}) {
        SCOPED_TRACE(testing::Message() << depth << " m deep");
        const Notch notch = notch_of_depth(depth);
        const Errors usual = errors_of_cut_block(notch, coarse);
        const Errors exact = errors_of_cut_block(notch, coarse, "snap = 0\n");
        EXPECT_NEAR(usual.force, exact.force, 0.005);
        EXPECT_NEAR(usual.middle_opening, exact.middle_opening, 0.005);
        EXPECT_NEAR(usual.side_opening, exact.side_opening, 0.005);
    }
}

}  // namespace
}  // namespace incise::runner
