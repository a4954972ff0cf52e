// Cut bodies of all kinds of cells that go through CGAL's linear cell complex, in memory and in
// CGAL's own file: they are the same bodies, and further cuts of them have the same bits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <CGAL/Combinatorial_map_save_load.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cut_programs.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh.h"
#include "random_tools.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "support/temporary_folder.h"
#include "tests/fragments/round_trip.h"

namespace incise::cutting {
namespace {

using fragments::FragmentMesh;
using test::Bricks;
using topology::LinearCellComplex;
using topology::Mesh;
using topology::MeshData;

/// Bodies of each kind of cell, and of several, with three regions.
std::vector<std::pair<std::string, MeshData>> bodies_for_complexes() {
    constexpr double jitter = 0.15;
    std::vector<std::pair<std::string, MeshData>> bodies;
    bodies.emplace_back("tetrahedra", test::jittered_cube(3, 0.0, 11));
    bodies.emplace_back("jittered tetrahedra", test::jittered_cube(3, jitter, 11));
    for (const auto& [name, bricks] :
         {std::pair("hexahedra", Bricks::hexahedra), std::pair("wedges", Bricks::wedges),
          std::pair("pyramids", Bricks::pyramids), std::pair("mixed", Bricks::mixed),
          std::pair("joined", Bricks::joined)})
        bodies.emplace_back(name, test::brick_cube(bricks, 3, jitter, 11));
    for (auto& [name, data] : bodies)
        for (std::size_t c = 0; c < data.num_cells(); ++c)
            data.regions[c] = static_cast<int>(c % 3);
    return bodies;
}

LinearCellComplex through_file(const LinearCellComplex& complex,
                               const std::filesystem::path& file) {
    LinearCellComplex read;
    EXPECT_TRUE(CGAL::save_combinatorial_map(complex, file.c_str()));
    EXPECT_TRUE(CGAL::load_combinatorial_map(file.c_str(), read));
    return read;
}

/// Returns by living cell and face, in ascending order, the cell in this order and the face on the
/// other side; -1 where there is none.
std::vector<std::pair<std::int64_t, int>> joins_of(const Mesh& mesh) {
    std::vector<std::int64_t> row(mesh.element_capacity(), -1);
    std::int64_t next = 0;
    for (const CellId e : mesh.elements()) row[e.index()] = next++;
    std::vector<std::pair<std::int64_t, int>> joins;
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId other = mesh.neighbor({e, f});
            joins.emplace_back(other.is_valid() ? row[other.cell.index()] : -1, other.face);
        }
    return joins;
}

/// Expects that a complex is the body: its cells, faces, regions, carriers and rest places, and
/// which faces are joined and on cuts.
void expect_same_body(const LinearCellComplex& complex, const Mesh& mesh, const MeshData& data) {
    const topology::BuiltMesh built = topology::from_linear_cell_complex(complex);
    EXPECT_TRUE(built.warnings.empty());
    fragments::expect_same_mesh(fragments::written(built.mesh, FragmentMesh(built.mesh)), data);
    EXPECT_EQ(joins_of(built.mesh), joins_of(mesh));
}

TEST(CutComplexes, AreTheSameBodiesAfterRandomPrograms) {
    const support::TemporaryFolder folder;
    std::size_t num_polyhedra = 0, num_on_cuts = 0;
    for (const auto& [name, body] : bodies_for_complexes())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh mesh = Mesh::build(body).mesh;
            FragmentMesh fragments(mesh);
            for (int i = 0; i < 3; ++i) {
                const RandomCut cut = random_cut(mesh, random);
                SCOPED_TRACE("cut " + std::to_string(i) + ": " + cut.description);
                cut_cells(mesh, fragments, cut);
                const MeshData data = fragments::written(mesh, fragments);
                const auto complex = topology::to_linear_cell_complex(mesh, data.carriers);
                ASSERT_TRUE(complex.is_valid());
                expect_same_body(complex, mesh, data);
                if (i == 2) expect_same_body(through_file(complex, folder / "cut.xml"), mesh, data);
                num_polyhedra += static_cast<std::size_t>(
                    std::ranges::count(data.kinds, topology::CellKind::polyhedron));
                num_on_cuts += data.cut_faces.empty() ? 0 : 1;
                if (testing::Test::HasFailure()) return;
            }
        }
    EXPECT_GT(num_polyhedra, test::num_cases(1000));
    EXPECT_GT(num_on_cuts, test::num_cases(20));
}

// Of the tools only the last may end inside the body: complexes do not hold cuts that have ended.
TEST(CutComplexes, LetFurtherCutsHaveTheSameBits) {
    const support::TemporaryFolder folder;
    for (const auto& [name, body] : bodies_for_complexes())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            test::Random random(100 + seed);
            std::vector<RestTool> tools;
            for (int i = 0; i < 3; ++i)
                tools.push_back(random.below(2) == 0 ? random_plane(random)
                                : i == 2             ? random_blade(random)
                                                     : random_blade(random, 2.0));
            Mesh mesh = Mesh::build(body).mesh;
            const MeshData at_once = cut_at_rest(mesh, tools, CutMode::split).mesh;
            Mesh now = Mesh::build(body).mesh;
            MeshData data;
            for (const RestTool& tool : tools) {
                data = cut_at_rest(now, {&tool, 1}, CutMode::split).mesh;
                auto complex = topology::to_linear_cell_complex(now, data.carriers);
                if (seed % 2 == 0) complex = through_file(complex, folder / "cut.xml");
                now = topology::from_linear_cell_complex(complex).mesh;
            }
            fragments::expect_same_mesh(data, at_once);
            if (testing::Test::HasFailure()) return;
        }
}

}  // namespace
}  // namespace incise::cutting
