// Cut bodies of hexahedra, wedges, pyramids and mixtures that go through files: they are the same
// bodies, and further cuts of them have the same bits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cut_programs.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/physics/body/model.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "random_tools.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/temporary_folder.h"
#include "tests/fragments/round_trip.h"
#include "tests/physics/test_bodies.h"

namespace incise::cutting {
namespace {

using fragments::FragmentMesh;
using test::Bricks;
using topology::Mesh;
using topology::MeshData;

struct NamedBody {
    std::string name;
    MeshData data;
};

const std::vector<NamedBody>& bodies() {
    static const std::vector<NamedBody> all = [] {
        constexpr double jitter = 0.15;
        std::vector<NamedBody> made;
        for (const auto& [name, bricks] :
             {std::pair("hexahedra", Bricks::hexahedra), std::pair("wedges", Bricks::wedges),
              std::pair("pyramids", Bricks::pyramids), std::pair("mixed", Bricks::mixed)}) {
            made.push_back({name, test::brick_cube(bricks, 3, 0.0, 11)});
            made.push_back(
                {std::string("jittered ") + name, test::brick_cube(bricks, 3, jitter, 11)});
        }
        return made;
    }();
    return all;
}

TEST(CutFiles, KeepBodiesOfRandomPrograms) {
    std::size_t num_polyhedra = 0;
    for (const NamedBody& body : bodies())
        for (std::uint64_t seed = 0; seed < test::num_cases(5); ++seed) {
            SCOPED_TRACE(body.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh mesh = Mesh::build(body.data).mesh;
            FragmentMesh fragments(mesh);
            for (int i = 0; i < 3; ++i) {
                const RandomCut cut = random_cut(mesh, random);
                SCOPED_TRACE("cut " + std::to_string(i) + ": " + cut.description);
                cut_cells(mesh, fragments, cut);
                const MeshData data = written(mesh, fragments);
                ASSERT_EQ(topology::check(data).errors, std::vector<std::string>());
                fragments::expect_round_trip(mesh, fragments);
                num_polyhedra += static_cast<std::size_t>(
                    std::ranges::count(data.kinds, topology::CellKind::polyhedron));
                if (testing::Test::HasFailure()) return;
            }
        }
    EXPECT_GT(num_polyhedra, test::num_cases(1000));
}

/// By place at rest, the sum of the forces on the nodes there, N.
using Forces = std::map<std::array<double, 3>, Vec3>;

/// Returns the elastic energy of a body in a smooth deformation, J, and the forces.
std::pair<double, Forces> deformed(physics::Model& model) {
    const auto displacement = [](const Vec3& X) {
        return Vec3(0.1 * X.y() + 0.05 * std::sin(3.0 * X.z()), 0.08 * X.x() * X.z(),
                    0.1 * X.z() - 0.04 * X.x());
    };
    std::vector<Vec3> x;
    for (const Vec3& X : model.fragments().rest_positions()) x.push_back(X + displacement(X));
    const std::vector<Vec3> at_rest(x.size(), Vec3::Zero());
    model.set_state(x, at_rest, 0.0);
    Forces forces;
    for (const NodeId n : model.fragments().nodes()) {
        const Vec3& X = model.fragments().rest_position(n);
        forces.try_emplace({X.x(), X.y(), X.z()}, Vec3::Zero()).first->second +=
            model.elastic_forces()[n.index()];
    }
    return {model.energetics().totals().elastic_energy, forces};
}

physics::MaterialTable table_of_laws() {
    physics::MaterialTable table;
    for (const physics::Law& law :
         {physics::Law(physics::NeoHookean{2000.0, 8000.0}),
          physics::Law(physics::StableNeoHookean::of_rest_moduli(8000.0, 2000.0)),
          physics::Law(physics::MooneyRivlin{1346.0, 577.0, 13462.0})}) {
        table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
        table.materials.push_back({1000.0, physics::HyperElasticLinks{law}});
    }
    return table;
}

TEST(CutFiles, KeepMassesAndForces) {
    for (const bool has_springs : {false, true})
        for (const NamedBody& body : bodies()) {
            if (has_springs && body.name != "hexahedra") continue;  // of boxes
            SCOPED_TRACE(body.name + (has_springs ? ", springs" : ""));
            const physics::MaterialTable table =
                has_springs ? physics::table_of_hybrid_springs() : table_of_laws();
            const MeshData data = physics::with_regions(body.data, table.materials.size());
            Mesh mesh = Mesh::build(data).mesh;
            physics::Model model(mesh, table);
            for (const auto& [point, normal] :
                 {std::pair(Vec3(0.47, 0.5, 0.5), Vec3(1.0, 0.2, 0.3)),
                  std::pair(Vec3(0.5, 0.52, 0.5), Vec3(-0.2, 1.0, 0.1))}) {
                const Plane plane(point, normal);
                LoopFront front;
                const auto rest = mesh.rest_positions();
                const Split done = split_cells(mesh, {mesh, rest, rest}, plane, front, {}, {});
                model.apply(mesh, done.changes);
            }
            const MeshData file = written(mesh, model.fragments());
            const Mesh read = Mesh::build(file).mesh;
            physics::Model again(read, table);
            constexpr double rounding = 1e-12;  // the order of sums differs with the ids
            EXPECT_NEAR(again.structure().rest_stable_step(), model.structure().rest_stable_step(),
                        rounding * model.structure().rest_stable_step());
            const auto sum = [](std::span<const double> values) {
                return std::accumulate(values.begin(), values.end(), 0.0);
            };
            EXPECT_NEAR(sum(again.masses()), sum(model.masses()), rounding * sum(model.masses()));
            const auto [energy, forces] = deformed(model);
            const auto [energy_again, forces_again] = deformed(again);
            EXPECT_GT(energy, 0.0);
            EXPECT_NEAR(energy_again, energy, rounding * energy);
            ASSERT_EQ(forces_again.size(), forces.size());
            double largest = 0.0, difference = 0.0;
            for (const auto& [place, force] : forces) {
                largest = std::max(largest, force.norm());
                difference = std::max(difference, (forces_again.at(place) - force).norm());
            }
            EXPECT_LT(difference, 1e3 * rounding * largest);
        }
}

/// Cuts a body through files: each tool cuts what was read from the file of the tool before.
MeshData cut_through_files(const MeshData& data, const std::vector<RestTool>& tools,
                           const std::filesystem::path& file) {
    MeshData now = data;
    for (const RestTool& tool : tools) {
        Mesh mesh = Mesh::build(now).mesh;
        io::write_mesh(file, cut_at_rest(mesh, {&tool, 1}, CutMode::split).mesh);
        now = io::read_mesh(file).mesh;
    }
    return now;
}

// Of the tools only the last may end inside the body: files do not hold cuts that have ended there.
TEST(CutFiles, LetFurtherCutsHaveTheSameBits) {
    const support::TemporaryFolder folder;
    std::size_t num_bodies = 0;
    for (const NamedBody& body : bodies())
        for (std::uint64_t seed = 0; seed < test::num_cases(13); ++seed) {
            SCOPED_TRACE(body.name + ", seed " + std::to_string(seed));
            test::Random random(100 + seed);
            std::vector<RestTool> tools;
            for (int i = 0; i < 3; ++i)
                tools.push_back(random.below(2) == 0 ? random_plane(random)
                                : i == 2             ? random_blade(random)
                                                     : random_blade(random, 2.0));
            if (seed % 4 == 0) tools.back() = tools.front();  // along a finished cut
            Mesh mesh = Mesh::build(body.data).mesh;
            const MeshData at_once = cut_at_rest(mesh, tools, CutMode::split).mesh;
            fragments::expect_same_mesh(cut_through_files(body.data, tools, folder / "cut.vtu"),
                                        at_once);
            ++num_bodies;
            if (testing::Test::HasFailure()) return;
        }
    EXPECT_GE(num_bodies, test::num_cases(100));
}

TEST(CutFiles, LetTheSamePlaneAddNothing) {
    const support::TemporaryFolder folder;
    for (const NamedBody& body : bodies())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(body.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            const RestTool plane = random_plane(random);
            const MeshData once = cut_through_files(body.data, {plane}, folder / "cut.vtu");
            const MeshData again = cut_through_files(once, {plane}, folder / "cut.vtu");
            EXPECT_EQ(again.num_cells(), once.num_cells());
            EXPECT_EQ(again.points.size(), once.points.size());
        }
}

}  // namespace
}  // namespace incise::cutting
