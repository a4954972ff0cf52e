// Carriers of a cut body: written from its fragments, they give the same fragments again.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "incise/base/error.h"
#include "incise/fragments/fragment_archive.h"
#include "incise/fragments/validate.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/mesh_repair.h"
#include "incise/topology/validate.h"
#include "support/exact_plane.h"
#include "support/fragment_shape.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "tests/fragments/round_trip.h"

namespace incise::fragments {
namespace {

using namespace topology;

std::size_t num_carried_away(const Mesh& material, const FragmentMesh& fragments) {
    std::size_t count = 0;
    for (const CellId cell : material.elements()) count += fragments.is_at_home(cell) ? 0 : 1;
    return count;
}

std::size_t num_faces_closed_by_file(const Mesh& material, const FragmentMesh& fragments) {
    MeshData data = to_mesh_data(material, material.rest_positions());
    if (!data.faces.empty()) data.carriers = carriers_of(material, fragments);
    const Mesh read = Mesh::build(data).mesh;
    return boundary_faces(material).size() - boundary_faces(read).size();
}

TEST(Carriers, AreLeftOutOfABodyWithoutDivisions) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        Mesh material = Mesh::build(family.data).mesh;
        FragmentMesh fragments(material);
        EXPECT_TRUE(carriers_of(material, fragments).is_empty());
        if (family.name == "joined")
            continue;  // opened at one triangle, it is a polyhedron in files
        MeshEdit edit(material);
        for (const FaceId f : test::inner_faces(material))
            if (f.cell.index() % 3 == 0 && material.neighbor(f).is_valid()) edit.open(f);
        fragments.apply(material, edit.commit());
        EXPECT_TRUE(carriers_of(material, fragments).is_empty());
        expect_round_trip(material, fragments);
    }
}

TEST(Carriers, GiveTheFragmentsOfPlanesAgain) {
    std::size_t num_away = 0;
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh material = Mesh::build(family->data).mesh;
            FragmentMesh fragments(material);
            for (int i = 0; i < 4; ++i) {
                const Vec3 point(0.5 + 0.1 * i, 0.4, 0.5);
                const Vec3 normal = i == 1 ? Vec3(0.0, 0.0, 1.0) : random.vector(1.0);
                fragments.apply(material, test::cut_along_plane(material, point, normal));
                num_away += num_carried_away(material, fragments);
                expect_round_trip(material, fragments);
            }
        }
    EXPECT_GT(num_away, test::num_cases(100));
}

TEST(Carriers, GiveTheFragmentsOfAnyEditsAgain) {
    int num_cases = 0;
    for (const auto& family : test::mesh_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(10); ++seed) {
            SCOPED_TRACE(family.name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh material = Mesh::build(family.data).mesh;
            FragmentMesh fragments(material);
            for (int i = 0; i < 8; ++i) {
                fragments.apply(material, test::random_edit(material, random));
                // A face that is open while both its sides have the same nodes is closed in a file.
                if (material.num_elements() == 0 ||
                    num_faces_closed_by_file(material, fragments) > 0)
                    continue;
                expect_round_trip(material, fragments);
                ++num_cases;
            }
        }
    EXPECT_GT(num_cases, test::num_cases(100));
}

TEST(Carriers, LetTheBodyBeCutAgain) {
    std::size_t num_added = 0;
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(family->name + ", seed " + std::to_string(seed));
            test::Random random(seed);
            Mesh material = Mesh::build(family->data).mesh;
            FragmentMesh fragments(material);
            fragments.apply(material,
                            test::cut_along_plane(material, {0.5, 0.4, 0.5}, random.vector(1.0)));
            BuiltMesh built = expect_round_trip(material, fragments);
            FragmentMesh read(built.mesh);
            const std::vector<FragmentMesh> before{read};
            const Vec3 normal = random.vector(1.0);
            fragments.apply(material, test::cut_along_plane(material, {0.45, 0.5, 0.5}, normal));
            const ChangeSet changes = test::cut_along_plane(built.mesh, {0.45, 0.5, 0.5}, normal);
            const FragmentChanges done = read.apply(built.mesh, changes);
            num_added += done.mesh.elements_added.size();
            EXPECT_EQ(validate(read, built.mesh), std::vector<std::string>());
            EXPECT_TRUE(shape_in_file(built.mesh, read) == shape_in_file(material, fragments));
            expect_round_trip(built.mesh, read);
            if (changes.is_empty()) continue;
            replay(built.mesh, inverse(changes));
            read.go_back(built.mesh, inverse(done));
            EXPECT_TRUE(read == before.front());
        }
    EXPECT_GT(num_added, test::num_cases(100));
}

/// A cube that is cut twice, as a file contains it.
MeshData cut_cube() {
    Mesh material = Mesh::build(test::jittered_cube(3, 0.1, 3)).mesh;
    FragmentMesh fragments(material);
    for (const Vec3& normal : {Vec3(1.0, 0.1, 0.2), Vec3(0.2, 1.0, 0.1)})
        fragments.apply(material, test::cut_along_plane(material, {0.51, 0.5, 0.5}, normal));
    return written(material, fragments);
}

TEST(Carriers, FollowScaleMirrorAndWelding) {
    const MeshData data = cut_cube();
    const auto num_fragments = [](const MeshData& from) {
        return FragmentMesh(Mesh::build(from).mesh).num_elements();
    };
    MeshData scaled = data;
    scaled.scale(0.3);
    EXPECT_EQ(num_fragments(scaled), num_fragments(data));

    MeshData mirrored = data;
    const auto mirror = [](Vec3& x) { x.x() = -x.x(); };
    std::ranges::for_each(mirrored.points, mirror);
    for (auto& corners : mirrored.carriers.corners) std::ranges::for_each(corners, mirror);
    EXPECT_EQ(turn_inverted_cells(mirrored).num_cells, mirrored.num_cells());
    EXPECT_EQ(num_fragments(mirrored), num_fragments(data));

    // Welding closes the cut: the carriers are whole again, though they consist of several cells.
    MeshData welded = data;
    EXPECT_GT(weld(welded), 0u);
    const Mesh closed = Mesh::build(welded).mesh;
    const FragmentMesh fragments(closed);
    EXPECT_EQ(validate(fragments, closed), std::vector<std::string>());
    EXPECT_EQ(fragments.num_elements(),
              Mesh::build(test::jittered_cube(3, 0.1, 3)).mesh.num_elements());
    for (const ElementId e : fragments.elements()) EXPECT_EQ(fragments.volume_share(e), 1.0);
}

TEST(Carriers, MoveWithPointsThatWeldingMoves) {
    MeshData data = cut_cube();
    double shortest = 1.0;
    const auto at = [&](std::int64_t p) -> Vec3& {
        return data.points[static_cast<std::size_t>(p)];
    };
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (const std::int64_t p : data.cell(c))
            for (const std::int64_t q : data.cell(c))
                if (p != q) shortest = std::min(shortest, (at(p) - at(q)).norm());
    // The last corner of a carrier that has a point. All cells but one use a second point there. It
    // has a higher number, so that welding moves it to the first one, which is a little off.
    const auto num_points = std::ssize(data.points);
    std::int64_t corner = -1;
    for (std::int64_t p = 0; p < num_points; ++p)
        for (const auto& corners : data.carriers.corners)
            if (std::ranges::find(corners, at(p)) != corners.end()) corner = p;
    ASSERT_GE(corner, 0);
    data.points.push_back(at(corner));
    at(corner).x() += 0.1 * weld_tolerance * shortest;
    const auto first = std::ranges::find(data.corners, corner);
    std::replace(first + 1, data.corners.end(), corner, num_points);
    ASSERT_GT(std::ranges::count(data.corners, num_points), 0);
    weld(data);
    const Mesh mesh = Mesh::build(data).mesh;
    EXPECT_EQ(validate(FragmentMesh(mesh), mesh), std::vector<std::string>());
}

TEST(Carriers, ThatCannotBeRightAreRefused) {
    const MeshData sound = cut_cube();
    EXPECT_TRUE(topology::check(sound).errors.empty());
    std::size_t cut = 0;  // the first cell that is a part
    while (sound.carriers.of_cell[cut] == Carriers::whole) ++cut;
    const auto expect_fault = [&](const std::string& text,
                                  const std::function<void(MeshData&)>& forge) {
        SCOPED_TRACE(text);
        MeshData forged = sound;
        forge(forged);
        const auto errors = topology::check(forged).errors;
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_NE(errors.front().find(text), std::string::npos) << errors.front();
        EXPECT_NE(errors.front().find("leave out"), std::string::npos) << errors.front();
        EXPECT_THROW(Mesh::build(forged), InputError);
    };
    const std::string cell = "cell " + std::to_string(cut);
    expect_fault("there are carriers for", [](MeshData& m) { m.carriers.of_cell.pop_back(); });
    expect_fault("do not name", [](MeshData& m) { m.carriers.of_cell.clear(); });
    for (const std::int64_t row : {std::int64_t{-2}, std::int64_t{1} << 40})
        expect_fault(cell + " (tetrahedron) has the carrier " + std::to_string(row) +
                         ", which is out of range",
                     [&](MeshData& m) { m.carriers.of_cell[cut] = row; });
    expect_fault("out of range",
                 [&](MeshData& m) { m.carriers.of_cell[cut] = std::ssize(m.carriers.corners); });
    expect_fault("which must be positive", [](MeshData& m) {
        std::swap(m.carriers.corners[2][0], m.carriers.corners[2][1]);
    });
    expect_fault("carrier 2 has the volume nan", [](MeshData& m) {
        m.carriers.corners[2][1].y() = std::numeric_limits<double>::quiet_NaN();
    });
    expect_fault("which must be positive",
                 [](MeshData& m) { m.carriers.corners[2][3] = m.carriers.corners[2][0]; });
    expect_fault("is not inside its carrier", [&](MeshData& m) {
        for (Vec3& x : m.carriers.corners[0]) x.x() += 0.5;
    });
    expect_fault("more volume than the carrier", [&](MeshData& m) {
        // Both parts of the carrier are the same cell.
        const std::int64_t row = m.carriers.of_cell[cut];
        m.add_cell(CellKind::tetrahedron, std::array<std::int64_t, 4>{0, 0, 0, 0});
        m.carriers.of_cell.push_back(row);
        const auto first = std::ssize(m.points);
        for (const Vec3& x : m.carriers.corners[static_cast<std::size_t>(row)])
            m.points.push_back(x);
        for (std::size_t k = 0; k < 4; ++k)
            m.corners[m.offsets[m.num_cells() - 1] + k] = first + static_cast<std::int64_t>(k);
    });
    expect_fault("of region 7 has the carrier", [&](MeshData& m) {
        for (std::size_t c = m.num_cells(); c-- > 0;)
            if (m.carriers.of_cell[c] == m.carriers.of_cell[cut]) {
                m.regions[c] = 7;
                return;
            }
    });
    expect_fault("share a face, but of their carriers only", [&](MeshData& m) {
        for (auto& corners : m.carriers.corners)
            for (Vec3& x : corners)
                for (int c = 0; c < 3; ++c) x[c] = static_cast<double>(static_cast<float>(x[c]));
    });
}

}  // namespace
}  // namespace incise::fragments
