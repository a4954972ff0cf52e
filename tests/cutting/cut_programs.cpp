// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cut_programs.h"

#include <cmath>
#include <sstream>

#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/surfaces/triangle_surface.h"

namespace incise::cutting {

using test::Random;

namespace {

Vec3 direction(Random& random) {
    for (;;)
        if (const Vec3 v = random.vector(1.0); v.norm() > 0.1) return v.normalized();
}

void choose_plane(RandomCut& cut, const Box& box, std::span<const Vec3> positions, Random& random) {
    const auto node = [&]() -> const Vec3& { return positions[random.below(positions.size())]; };
    cut.normal = direction(random);
    switch (random.below(6)) {
        case 0: {  // through three nodes, which rounding leaves a hair off
            cut.point = node();
            const Vec3 along = node() - cut.point, across = node() - cut.point;
            const Vec3 normal = along.cross(across);
            if (normal.norm() > 1e-3 * along.norm() * across.norm()) cut.normal = normal;
            cut.description = "plane through three nodes";
            break;
        }
        case 1:
            cut.point = node();
            cut.normal = Vec3::Unit(static_cast<int>(random.below(3)));
            cut.description = "plane through a node along the axes";
            break;
        default:
            cut.point = box.center() + 0.3 * box.sizes().cwiseProduct(random.vector(1.0));
            cut.description = "plane";
    }
    cut.stroke.emplace_back(std::make_unique<Plane>(cut.point, cut.normal));
}

void choose_blade(RandomCut& cut, const Box& box, Random& random) {
    const double size = box.diagonal().norm();
    const Vec3 centre = box.center() + 0.2 * box.sizes().cwiseProduct(random.vector(1.0));
    const Vec3 normal = direction(random), u = normal.unitOrthogonal(), v = normal.cross(u);
    const bool is_flat = random.below(2) == 0;
    const double reach = random.below(2) == 0 ? 1.0 : 0.2;  // of the edge to either side
    const double end = random.below(2) == 0 ? 1.0 : random.uniform(-0.3, 0.3);
    const auto num_segments = static_cast<int>(1 + random.below(3));
    const auto num_steps = static_cast<int>(1 + random.below(5));
    const auto edge = [&](double along) {
        Polyline points;
        for (int i = 0; i <= num_segments; ++i) {
            const double s = reach * (2.0 * i / num_segments - 1.0);
            points.push_back(centre + size * (s * u + along * v));
            points.back() += 0.1 * size * random.uniform(-1.0, 1.0) * v;
            if (!is_flat) points.back() += 0.1 * size * random.uniform(-1.0, 1.0) * normal;
        }
        return points;
    };
    Polyline from = edge(-1.0);
    for (int i = 1; i <= num_steps; ++i) {
        Polyline to = edge(-1.0 + (end + 1.0) * i / num_steps);
        cut.stroke.emplace_back(from, to);
        std::vector<Vec3> motion;
        for (std::size_t k = 0; k < to.size(); ++k) motion.push_back(to[k] - from[k]);
        cut.end.emplace(to, motion);
        from = std::move(to);
    }
    cut.description = "blade of " + std::to_string(num_segments) + " segments in " +
                      std::to_string(num_steps) + " steps" + (is_flat ? ", flat" : "");
}

void choose_branch(RandomCut& cut, const Box& box, Random& random) {
    const double size = box.diagonal().norm();
    const Vec3 centre = box.center() + 0.3 * box.sizes().cwiseProduct(random.vector(1.0));
    const Vec3 normal = direction(random), u = normal.unitOrthogonal(), v = normal.cross(u);
    const double wave = random.uniform(0.0, 0.08) * size, phase = random.uniform(0.0, 6.0);
    const double reach = size * (random.below(2) == 0 ? 1.0 : random.uniform(0.1, 0.4));
    const double s_waves = random.uniform(0.0, 4.0), t_waves = random.uniform(0.0, 4.0);
    const auto surface = sheet(centre, reach * u, reach * v, 12, [&](double s, double t) -> Vec3 {
        return wave * std::sin(s_waves * s + t_waves * t + phase) * normal;
    });
    cut.stroke.emplace_back(std::make_unique<TriangleSurface>(surface));
    cut.description = "sheet, " + std::to_string(reach / size) + " of the body's size";
}

void choose_sphere(RandomCut& cut, const Box& box, Random& random) {
    const Vec3 centre = box.center() + 0.5 * box.sizes().cwiseProduct(random.vector(1.0));
    const double radius = random.uniform(0.05, 0.3) * box.diagonal().norm();
    const auto num_divisions = static_cast<int>(random.below(3));
    cut.stroke.push_back(
        std::make_unique<TriangleSurface>(icosphere(centre, radius, num_divisions)));
    cut.description = "sphere of radius " + std::to_string(radius);
}

}  // namespace

RandomCut random_cut(std::span<const Vec3> positions, Random& random) {
    Box box;
    for (const Vec3& x : positions) box.extend(x);
    RandomCut cut;
    cut.kind = static_cast<CutKind>(random.below(4));
    switch (cut.kind) {
        case CutKind::plane:
            choose_plane(cut, box, positions, random);
            break;
        case CutKind::blade:
            choose_blade(cut, box, random);
            break;
        case CutKind::sheet:
            choose_branch(cut, box, random);
            break;
        case CutKind::sphere:
            choose_sphere(cut, box, random);
            break;
    }
    return cut;
}

RandomCut random_cut(const topology::Mesh& mesh, Random& random) {
    std::vector<Vec3> positions;
    for (const VertexId n : mesh.nodes()) positions.push_back(mesh.rest_position(n));
    return random_cut(positions, random);
}

void cut_cells(topology::Mesh& mesh, fragments::FragmentMesh& fragments, const RandomCut& cut) {
    LoopFront front;
    for (const StrokePart& part : cut.stroke) {
        const auto rest = mesh.rest_positions();
        const Split done = split_cells(mesh, {mesh, rest, rest}, *part.surface, front, {}, {});
        fragments.apply(mesh, done.changes);
    }
}

SmoothField::SmoothField(double strain, double size, Random& random) {
    for (int c = 0; c < 3; ++c) gradient_.col(c) = random.vector(0.5 * strain);
    for (Wave& wave : waves_) {
        wave.number = random.vector(5.0 / size);
        wave.amplitude = random.vector(0.15 * strain / std::max(wave.number.norm(), 1.0 / size));
        wave.phase = random.uniform(0.0, 6.0);
    }
}

Vec3 SmoothField::at(const Vec3& X) const {
    Vec3 u = gradient_ * X;
    for (const Wave& wave : waves_) u += std::sin(wave.number.dot(X) + wave.phase) * wave.amplitude;
    return u;
}

void deform(physics::Model& model, double strain, double size, Random& random) {
    const SmoothField displacement(strain, size, random), motion(1.0, size, random);
    std::vector<Vec3> x, v;
    for (std::size_t n = 0; n < model.positions().size(); ++n) {
        const Vec3& X = model.fragments().rest_position(NodeId(n));
        x.push_back(model.positions()[n] + displacement.at(X));
        v.push_back(motion.at(X) + random.vector(0.1 * size));
    }
    model.set_state(x, v, 0.0);
}

}  // namespace incise::cutting
