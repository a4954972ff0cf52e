// Contact against analytic answers that need fine meshes: Hertz, flat punch, penny, and strap.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/sim/contact_answers.h"

namespace incise::sim {
namespace {

using std::numbers::pi;

constexpr Solid slab_solid{.young = 5e3, .poisson = 0.3};
constexpr double slab_damping = 200.0;  // 1/s: motions of graded bodies fade in 10 ms
constexpr double slab_growth = 1.4;     // of shells
constexpr double slab_extent = 60.0;    // of a slab, radii of the contact: it adds 1.5 % of force

/// Holds a graded body far away, and keeps what is on its planes of symmetry there.
/// @param has_x  its plane x = 0 is one of symmetry
void hold_graded(World& world, double extent, bool has_x = true) {
    const auto fix = [&](std::string name, std::array<bool, 3> components, const Part& part) {
        physics::Constraint constraint{.name = std::move(name)};
        constraint.nodes = physics::VertexSet(nodes_where(world, part));
        constraint.components = components;
        world.add_constraint(std::move(constraint));
    };
    const auto is_far = [=](const Vec3& x) {
        return x.cwiseAbs().maxCoeff() > extent * (1.0 - 1e-9);
    };
    fix("far", {true, true, true}, is_far);
    if (has_x)
        fix("x", {true, false, false}, [&](const Vec3& x) { return x.x() == 0.0 && !is_far(x); });
    fix("y", {false, true, false}, [&](const Vec3& x) { return x.y() == 0.0 && !is_far(x); });
}

/// A ball that is pressed into half of a slab, and then drawn aside in its plane of symmetry.
class DrawnBall {
  public:
    static constexpr double radius = 0.02, depth = 0.01 * radius;  // m
    static constexpr double contact_radius = 0.1 * radius;
    static constexpr int num_cells = 6;  // from the middle of the contact to its rim

    explicit DrawnBall(double friction) : friction_(friction), world_(make_world()) {
        tool_ = world_.add_tool({"ball", cutting::Probe{cutting::Sphere{radius}, friction}});
        world_.place_tool(tool_, at({0, 0, radius}));
        move(-depth * Vec3::UnitZ());
    }
    void draw(double by) { move(by * Vec3::UnitX()); }
    Vec3 force() const { return 2.0 * world_.report().tools[0].force; }  ///< on both halves, N

    /// The areas of both halves that touch, and that stick: there the friction is below its limit.
    struct Areas {
        double touching = 0.0, sticking = 0.0;  // m2
    };
    Areas areas() {
        std::vector<double> area_at(world_.mesh().node_capacity());
        for (const auto& [p, q, r] : world_.surface().triangles()) {
            const auto X = [&](VertexId n) { return world_.mesh().rest_position(n); };
            const Vec3 area = 0.5 * (X(q) - X(p)).cross(X(r) - X(p));
            for (const VertexId n : {p, q, r}) area_at[n.index()] += 2.0 * area.norm() / 3.0;
        }
        Areas sum;
        const auto forces = world_.contact_forces();
        for (const auto& [n, force] : forces.value()) {
            const Vec3 outward =
                (world_.tool_pose(tool_).position - world_.positions()[n.index()]).normalized();
            const double normal = -force.dot(outward);
            // Points of contact are between the nodes, where normals are others.
            constexpr double nearly = 0.93;
            if (normal <= 0.0) continue;
            sum.touching += area_at[n.index()];
            const Vec3 tangential = force + normal * outward;
            if (tangential.norm() < nearly * friction_ * normal) sum.sticking += area_at[n.index()];
        }
        return sum;
    }

  private:
    static World make_world() {
        constexpr Solid solid{.young = 5e3, .poisson = 0.45};
        const auto radii =
            shells(contact_radius / num_cells, num_cells + 2, slab_growth, 15.0 * contact_radius);
        WorldDef def;
        def.mesh = graded_block(radii, {-1, 0, -1}, {1, 1, 0});
        set_graded_materials(def, solid, radii);
        def.damping = slab_damping;
        World world(std::move(def));
        hold_graded(world, radii.back(), false);
        return world;
    }
    void move(const Vec3& by) {
        constexpr double duration = 0.02, wait = 0.04;  // s
        const Vec3 from = world_.tool_pose(tool_).position;
        const double begin = world_.time();
        while (world_.time() < begin + duration) {
            const double dt = 0.8 * world_.stable_step();
            const double part = std::min(1.0, (world_.time() + dt - begin) / duration);
            world_.step(dt, StepInputs().move(tool_, at(from + part * by)));
        }
        run_until(world_, begin + duration + wait);
    }

    double friction_;
    World world_;
    ToolId tool_{};
};

// Drawn aside with less than the largest friction, a ball sticks within the radius c and slips
// round it: c/a = (1 - Q/(mu P))^(1/3). Source: Cattaneo 1938, Mindlin 1949. They take equal
// bodies; here one is rigid, and the slab almost incompressible, which is near to it.
TEST(ContactPressure, OfABallThatIsDrawnAsidePartlySlips) {
    constexpr double friction = 0.3;
    DrawnBall ball(friction);
    double last = 1.0;
    for (int i = 0; i < 3; ++i) {
        ball.draw(0.1 * DrawnBall::depth);
        const double ratio = std::abs(ball.force().x()) / (friction * ball.force().z());
        ASSERT_LT(ratio, 1.0);
        const auto areas = ball.areas();
        const double radius_ratio = std::sqrt(areas.sticking / areas.touching);
        const double answer = std::cbrt(1.0 - ratio);
        record_result("C14 ball drawn aside, Q/(mu P) = " +
                          short_text(0.01 * std::round(100.0 * ratio)) + ": c/a",
                      radius_ratio, answer);
        EXPECT_NEAR(radius_ratio, answer, 0.5 / DrawnBall::num_cells);  // half an element
        EXPECT_LT(radius_ratio, last);
        last = radius_ratio;
    }
    // Without friction it slips everywhere.
    DrawnBall slippery(0.0);
    slippery.draw(0.1 * DrawnBall::depth);
    EXPECT_LT(std::abs(slippery.force().x()), 0.01 * slippery.force().z());
}

/// A quarter of a slab and a rigid tool that touches it at the origin.
class Indented {
  public:
    Indented(const std::vector<double>& radii, cutting::ProbeShape shape, double above)
        : world_(def_of(radii)) {
        hold_graded(world_, radii.back());
        tool_ = world_.add_tool({"tool", cutting::Probe{std::move(shape)}});
        world_.place_tool(tool_, at({0, 0, above}));
    }
    /// Moves the tool down by some way, waits, and returns the force on all four quarters, N.
    double press(double by) {
        constexpr double duration = 0.01, wait = 0.04;  // s
        const Vec3 from = world_.tool_pose(tool_).position;
        const double begin = world_.time();
        while (world_.time() < begin + duration) {
            const double dt = 0.8 * world_.stable_step();
            const double part = std::min(1.0, (world_.time() + dt - begin) / duration);
            world_.step(dt, StepInputs().move(tool_, at(from - part * by * Vec3::UnitZ())));
        }
        run_until(world_, begin + duration + wait);
        return 4.0 * world_.report().tools[0].force.z();
    }

  private:
    static WorldDef def_of(const std::vector<double>& radii) {
        WorldDef def;
        def.mesh = graded_quarter(radii);
        set_graded_materials(def, slab_solid, radii);
        def.damping = slab_damping;
        return def;
    }

    World world_;
    ToolId tool_{};
};

// Hertz: F = 4/3 E* sqrt(R) d^1.5. Linear tetrahedra make the slab some per cent too stiff, by
// about the same part at all depths.
TEST(ContactPressure, OfASphereOnASlabIsThatOfHertz) {
    constexpr double radius = 0.02, h = 0.0125 * radius, deepest = 0.01 * radius;  // m
    constexpr int num_depths = 6;
    Indented slab(shells(h, 10, slab_growth, slab_extent * std::sqrt(radius * deepest)),
                  cutting::Sphere{radius}, radius);
    double depth = 0.0, last = 0.0, answer = 0.0;
    std::vector<std::array<double, 2>> points;  // logarithms of depth and force
    for (int i = 0; i < num_depths; ++i) {
        const double next = deepest * std::pow(10.0, i / (num_depths - 1.0) - 1.0);
        last = slab.press(next - depth);
        depth = next;
        answer = 4.0 / 3.0 * slab_solid.plane_modulus() * std::sqrt(radius) * std::pow(depth, 1.5);
        record_point("sphere force", depth, last);
        record_point("sphere hertz", depth, answer);
        points.push_back({std::log(depth), std::log(last)});
    }
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const auto& [x, y] : points) {
        const Eigen::Vector2d row(1.0, x);
        normal += row * row.transpose();
        right += y * row;
    }
    const Eigen::Vector2d line = normal.inverse() * right;
    expect_answer("C6 sphere: exponent over a decade", line[1], 1.5, 0.02);
    expect_answer("C6 sphere: force at the deepest, N", last, answer, 0.1);
}

// A square punch of edge s: F = pi E* c s d, with the capacitance c = 0.3667896 of a unit square,
// as pressure on a half space and charge on a plate obey the same equation. (The same for a disc of
// radius a, whose capacitance is 2a/pi, is 2 a E* d.) The pressure is infinite at the edges, and
// linear tetrahedra are too stiff there.
TEST(ContactPressure, OfASquarePunchIsNearThatOfAChargedPlate) {
    constexpr double half = 0.002, depth = 0.005 * half, capacitance = 0.3667896;
    constexpr int cells = 6;  // from the middle to an edge
    Indented slab(shells(half / cells, cells + 3, slab_growth, slab_extent * half),
                  cutting::Cuboid{Vec3::Constant(2.0 * half)}, half);
    expect_answer("C7 square punch, h = a/6: force, N", slab.press(depth),
                  pi * capacitance * 2.0 * half * slab_solid.plane_modulus() * depth, 0.18);
}

/// Two bodies of equal curvature, one above the other, fine where they touch.
class TwoSpheres {
  public:
    static constexpr double radius = 0.02, approach = 0.02 * radius;
    const double a = std::sqrt(0.5 * radius * approach);  // of the contact, by Hertz
    const double edge = a / 6;                            // of elements there

    TwoSpheres() : world_(make_world()) { run_until(world_, 0.1); }

    /// The force along the axis at a node of the lower surface, with its distance from the axis and
    /// the area at it.
    struct NodeForce {
        double distance, force, area;  // m, N, m2
    };
    std::vector<NodeForce> forces() {
        std::vector<double> areas(world_.mesh().node_capacity());
        for (const auto& [p, q, r] : world_.surface().triangles()) {
            const auto X = [&](VertexId n) { return world_.mesh().rest_position(n); };
            const Vec3 area = 0.5 * (X(q) - X(p)).cross(X(r) - X(p));
            if (area.z() < 0.9 * area.norm()) continue;
            for (const VertexId n : {p, q, r}) areas[n.index()] += area.norm() / 3.0;
        }
        const auto all = world_.model().mesh_elastic_forces();
        std::vector<NodeForce> forces;
        for (const VertexId n : world_.mesh().nodes()) {
            const Vec3& X = world_.mesh().rest_position(n);
            const double r = X.head<2>().norm();
            if (areas[n.index()] > 0.0 && r < 3.0 * a && X.z() <= 0.0)
                forces.push_back({r, all[n.index()].z(), areas[n.index()]});
        }
        return forces;
    }

  private:
    topology::MeshData rounded(const std::vector<double>& radii) const {
        topology::MeshData mesh = graded_quarter(radii);
        for (Vec3& x : mesh.points) {
            // The profile of a sphere near the contact, then a cone. It fades with the depth.
            const double r = std::hypot(x.x(), x.y()), cone = 3.0 * a;
            const double profile = r < cone ? r * r / (2.0 * radius)
                                            : cone / radius * (std::min(r, 6.0 * a) - 0.5 * cone);
            x.z() -= profile * std::exp(x.z() / (4.0 * a));
        }
        return mesh;
    }
    World make_world() const {
        constexpr double finer = 0.87;  // the upper mesh
        const auto radii = shells(edge, 8, slab_growth, slab_extent * a);
        std::vector<double> upper_radii = radii;
        for (double& r : upper_radii) r *= finer;
        topology::MeshData mesh = rounded(radii), upper = rounded(upper_radii);
        // A half turn keeps the quarter and the orientation of cells.
        for (Vec3& x : upper.points) x = Vec3(x.y(), x.x(), -x.z());
        append(mesh, upper);
        WorldDef def;
        def.mesh = std::move(mesh);
        set_graded_materials(def, slab_solid, radii);
        def.damping = slab_damping;
        World world(std::move(def));
        const auto is_far = [&](const Vec3& x) {
            return x.cwiseAbs().maxCoeff() > (x.z() > 0.0 ? finer : 1.0) * radii.back() * 0.9999;
        };
        const auto fix = [&](std::string name, std::array<bool, 3> components, const Part& part,
                             double down = 0.0) {
            physics::Constraint constraint{.name = std::move(name)};
            constraint.nodes = physics::VertexSet(nodes_where(world, part));
            constraint.components = components;
            constraint.displacement =
                physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {0.02, -down * Vec3::UnitZ()}});
            world.add_constraint(std::move(constraint));
        };
        constexpr std::array<bool, 3> all{true, true, true};
        fix("below", all, [&](const Vec3& x) { return is_far(x) && x.z() < 0.0; });
        fix(
            "above", all, [&](const Vec3& x) { return is_far(x) && x.z() > 0.0; }, approach);
        fix("x", {true, false, false}, [&](const Vec3& x) { return x.x() == 0.0 && !is_far(x); });
        fix("y", {false, true, false}, [&](const Vec3& x) { return x.y() == 0.0 && !is_far(x); });
        return world;
    }

    World world_;
};

// F = 4/3 E' sqrt(R/2) d^1.5 with E' = E*/2 for two equal spheres, on a circle with a^2 = R d/2,
// and the pressure 3F/(2 pi a^2) in its middle.
TEST(ContactPressure, OfTwoElasticSpheresIsThatOfHertz) {
    TwoSpheres spheres;
    const double R = TwoSpheres::radius, a = spheres.a;
    const double answer = 4.0 / 3.0 * 0.5 * slab_solid.plane_modulus() * std::sqrt(0.5 * R) *
                          std::pow(TwoSpheres::approach, 1.5);
    const double highest = 1.5 * answer / (pi * a * a);
    constexpr double part = 0.4;  // of the radius, in which the pressure is averaged
    double force = 0.0, inner_force = 0.0, inner_area = 0.0, outermost = 0.0;
    for (const auto& node : spheres.forces()) {
        force += 4.0 * node.force;
        if (node.distance < part * a) {
            inner_force += node.force;
            inner_area += node.area;
        }
        if (node.force > 0.02 * highest * node.area) outermost = std::max(outermost, node.distance);
        record_point("two spheres pressure", node.distance / a, node.force / node.area / highest);
    }
    const double mean = 2.0 / 3.0 * (1.0 - std::pow(1.0 - part * part, 1.5)) / (part * part);
    expect_answer("C5 two spheres: force, N", force, answer, 0.1);
    expect_answer("C5 two spheres: pressure in the middle, Pa", inner_force / inner_area / mean,
                  highest, 0.1);
    expect_answer("C5 two spheres: radius of the contact, m", outermost, a, spheres.edge / a);
}

/// A cut of the shape of a penny in the middle of a body, with a pressure on both of its faces.
struct Penny {
    static constexpr double radius = 0.01, pressure = 0.002 * slab_solid.young;  // m, Pa

    /// The distance of its faces in the middle, at rest under a part of the pressure, m.
    static double opening(double part, bool has_contact) {
        const auto radii = shells(radius / 8, 11, slab_growth, 12.0 * radius);
        WorldDef def;
        def.mesh = graded_quarter(radii, true);
        set_graded_materials(def, slab_solid, radii);
        def.damping = 60.0;
        def.contact.enabled = has_contact;
        World world(std::move(def));
        hold_graded(world, radii.back());
        cut_disc(world);
        std::vector<FaceId> faces;
        const topology::BoundarySurface& surface = world.surface();
        for (std::size_t t = 0; t < surface.faces().size(); ++t)
            if (surface.is_cut()[t]) faces.push_back(surface.faces()[t]);
        std::ranges::sort(faces);
        physics::Load load{.name = "pressure"};
        load.kind = physics::PressureLoad{physics::FaceSet(faces), part * pressure};
        load.factor = physics::TimeCurve<double>({{0.0, 0.0}, {0.02, 1.0}});
        world.add_load(std::move(load));
        run_until(world, 0.15);
        const auto middle =
            nodes_where(world, [](const Vec3& x) { return x.norm() < 1e-6 * radius; });
        EXPECT_EQ(middle.size(), 2u);
        const double first = world.positions()[middle[0].index()].z(),
                     second = world.positions()[middle[1].index()].z();
        return is_above(world, middle[0]) ? first - second : second - first;
    }

  private:
    static bool is_above(const World& world, VertexId n) {
        const CellId e = world.mesh().incident_element(n);
        double sum = 0.0;
        for (const VertexId corner : world.mesh().corners(e))
            sum += world.mesh().rest_position(corner).z();
        return sum > 0.0;
    }
    /// Cuts along a quarter of a disc, which goes on a little beyond the planes of symmetry.
    static void cut_disc(World& world) {
        constexpr int num_points = 48;
        topology::SurfaceData disc;
        disc.points.push_back({-0.01 * radius, -0.01 * radius, 0.0});
        for (int i = 0; i <= num_points; ++i) {
            const double at = (0.5 * pi + 0.04) * i / num_points - 0.02;
            disc.points.push_back({radius * std::cos(at), radius * std::sin(at), 0.0});
        }
        for (std::int64_t i = 1; i <= num_points; ++i) disc.triangles.push_back({0, i, i + 1});
        const ToolId tool = world.add_tool({"disc", cutting::SurfaceCut{std::move(disc)}});
        world.step(0.8 * world.stable_step(), StepInputs().move(tool, Pose()).withdraw(tool));
    }
};

// Opening 8 (1 - nu^2) p a / (pi E) in the middle. Source: Sneddon 1946. The front of the cut is
// inside elements, where the physics has no nodes: the penny that opens is smaller by half an
// element. Suction closes it, and it stays closed.
TEST(ContactPressure, OfAPennyThatClosesKeepsItClosed) {
    const double answer = 8.0 * Penny::pressure * Penny::radius / (pi * slab_solid.plane_modulus());
    expect_answer("C13 penny, h = a/8: opening, m", Penny::opening(1.0, true), answer, 0.2);
    const double closed = Penny::opening(-1.0, true), overlap = -Penny::opening(-1.0, false);
    record_result("C13 penny, closed by suction: opening, m", closed, 0.0);
    EXPECT_NEAR(closed, 0.0, 1e-6 * answer);
    EXPECT_GT(overlap, 0.7 * answer);
}

/// The ratio of the tensions at the ends of a strap that slides round a drum.
double tension_ratio(double friction, double angle) {
    constexpr double drum = 0.02, width = 0.002, thick = 2e-4, straight = 0.006;  // m
    constexpr int num_bent = 40, num_straight = 6;  // elements along it
    constexpr Solid solid{.young = 1e6, .relaxation_time = 1e-4};
    constexpr double pull = 0.03 * solid.young * width * thick;  // N
    topology::MeshData mesh = box(Vec3::Zero(), {num_bent + 2.0 * num_straight, width, thick},
                                  {num_bent + 2 * num_straight, 2, 1});
    for (Vec3& x : mesh.points) {
        const double at = x.x() - num_straight, r = drum + x.z();
        const double turned = angle * std::clamp(at / num_bent, 0.0, 1.0);
        const double beyond = std::min(at, 0.0) + std::max(at - num_bent, 0.0);
        const Vec3 radial(std::sin(turned), 0.0, std::cos(turned));
        const Vec3 along(radial.z(), 0.0, -radial.x());
        x = x.y() * Vec3::UnitY() + r * radial + beyond * straight / num_straight * along;
    }
    WorldDef def;
    def.mesh = std::move(mesh);
    def.materials = {solid};
    World world(std::move(def));
    world.place_tool(
        world.add_tool({"drum", cutting::Probe{cutting::Capsule{{0, -0.05, 0}, {0, 0.05, 0}, drum},
                                               friction}}),
        Pose());
    physics::Load load{.name = "pull"};
    load.kind = physics::TractionLoad{
        physics::FaceSet(faces_where(
            world, [&](const Vec3& x) { return x.x() < 1e-9 - straight && x.z() > 0.9 * drum; })),
        -pull / (width * thick) * Vec3::UnitX()};
    load.factor = physics::TimeCurve<double>({{0.0, 0.0}, {0.01, 1.0}});
    world.add_load(std::move(load));
    const Vec3 end(std::sin(angle), 0.0, std::cos(angle)), out(end.z(), 0.0, -end.x());
    physics::Constraint draw{.name = "draw"};
    draw.nodes = physics::VertexSet(nodes_where(world, [&](const Vec3& x) {
        return x.dot(out) > straight - 1e-9 && x.dot(end) > 0.9 * drum;
    }));
    draw.displacement = physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {0.04, 0.004 * out}});
    world.add_constraint(std::move(draw));
    run_until(world, 0.025);
    return mean_until(world, 0.035,
                      [&] { return world.reaction(world.constraints()[0]).force.dot(out); }) /
           pull;
}

// T2/T1 = exp(friction times angle). Source: Euler, Eytelwein.
TEST(ContactPressure, OfAStrapRoundADrumIsEulers) {
    for (const double friction : {0.0, 0.3}) {
        const double ratio = tension_ratio(friction, 0.5 * pi);
        expect_answer("C15 strap, quarter turn, friction " + short_text(friction) + ": T2/T1",
                      ratio, std::exp(0.5 * pi * friction), friction > 0.0 ? 0.01 : 0.015);
    }
}

}  // namespace
}  // namespace incise::sim
