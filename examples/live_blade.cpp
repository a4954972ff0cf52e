// The loop of a live program: a blade moved from outside, and a surface that a renderer keeps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/io/mesh/mesh_reader.h>
#include <incise/sim/selection.h>
#include <incise/sim/world.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <string>
#include <vector>

using namespace incise;

namespace {

/// What a renderer has of a body: triangles over points, and which of them are faces of cuts.
struct Picture {
    std::vector<Vec3> points;
    std::vector<std::array<VertexId, 3>> triangles;
    std::vector<bool> is_cut;
    std::size_t num_uploaded = 0;

    void update(sim::World& world) {
        const auto positions = world.positions();
        points.assign(positions.begin(), positions.end());
        const topology::BoundarySurface& surface = world.surface();
        const auto changes = world.take_surface_changes();
        triangles.resize(surface.triangles().size());
        is_cut.resize(triangles.size());
        for (const std::size_t slot : changes) {
            if (slot >= triangles.size()) continue;  // gone
            triangles[slot] = surface.triangles()[slot];
            is_cut[slot] = surface.is_cut()[slot] != 0;
            ++num_uploaded;
        }
    }
};

/// A hand that draws the blade through the skin, s after the start.
Pose pose_of_hand(double time) {
    return {Eigen::Quaterniond::Identity(), {-0.03 + 0.3 * time, 0.0, 0.0}};
}

}  // namespace

int main(int argc, char** argv) {
    const std::string data = argc > 1 ? argv[1] : "data";
    sim::WorldDef def;
    def.mesh = io::read_mesh(data + "/skin_block.vtu").mesh;
    def.materials = {{.density = 1000.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{5000.0, 40000.0}}}};
    def.damping = 20.0;
    sim::World world(std::move(def));

    Eigen::AlignedBox3d box;
    for (const Vec3& x : world.mesh().rest_positions()) box.extend(x);
    const sim::Selection bottom{.half_space = sim::HalfSpaceRegion{box.min(), Vec3(0, 0, -1)}};
    world.add_constraint({.name = "base", .nodes = sim::select_nodes(world.mesh(), bottom)});

    // The edge hangs down into the upper half of the block.
    const double y = 0.5 * (box.min().y() + box.max().y()) + 1e-4;
    const double deep = 0.5 * (box.min().z() + box.max().z());
    const sim::ToolId scalpel = world.add_tool(
        {.name = "scalpel", .shape = cutting::Blade{{{0, y, deep}, {0, y, box.max().z() + 0.01}}}});

    Picture picture;
    picture.update(world);
    const std::size_t num_triangles = picture.triangles.size();
    world.place_tool(scalpel, pose_of_hand(0.0));
    constexpr double frame = 1.0 / 60.0;
    for (int i = 1; i <= 6; ++i) {
        // As many stable steps as one frame takes; the hand goes evenly meanwhile.
        while (world.time() < i * frame) {
            const double end = std::min(world.time() + 0.8 * world.stable_step(), i * frame);
            world.step_to(end, sim::StepInputs().move(scalpel, pose_of_hand(end)));
        }
        picture.num_uploaded = 0;
        picture.update(world);
        std::cout << "frame " << i << ": " << picture.triangles.size() << " triangles, "
                  << picture.num_uploaded << " of them new\n";
    }
    const auto num_cut = std::count(picture.is_cut.begin(), picture.is_cut.end(), true);
    std::cout << num_cut << " triangles are faces of the cut\n";
    return num_cut > 0 && picture.triangles.size() > num_triangles ? 0 : 1;
}
