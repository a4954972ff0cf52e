// Cells of any shape: the operations that divide them against CGAL's on a copy, and what stays true
// of every edit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "incise/base/error.h"
#include "incise/topology/darts.h"
#include "incise/topology/geometry.h"
#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_archive.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

using test::MeshSnapshot;
using test::Random;

/// The families of few cells: CGAL compares maps dart by dart from each of them.
std::vector<const test::MeshFamily*> small_families() {
    std::vector<const test::MeshFamily*> families;
    for (const auto& family : test::mesh_families())
        if (family.data.num_cells() <= 100) families.push_back(&family);
    return families;
}

/// What validate() finds, but for volumes: random paths cut off parts of any volume.
std::vector<std::string> faults_of(const Mesh& mesh) {
    std::vector<std::string> faults = validate(mesh);
    std::erase_if(
        faults, [](const std::string& fault) { return fault.find("volume") != std::string::npos; });
    return faults;
}

bool are_alike(const LinearCellComplex& a, const LinearCellComplex& b) {
    return a.is_isomorphic_to(b, false, false, true);
}

LinearCellComplex::Dart_handle in_complex(LinearCellComplex& complex, const Mesh& mesh, Dart d) {
    for (auto it = complex.darts().begin(); it != complex.darts().end(); ++it)
        if (complex.info<3>(it).id == d.face.cell && complex.info<0>(it).id == from(mesh, d) &&
            complex.info<0>(complex.beta<1>(it)).id == to(mesh, d))
            return it;
    return nullptr;
}

Dart random_dart(const Mesh& mesh, Random& random) {
    std::vector<CellId> cells;
    for (const CellId e : mesh.elements()) cells.push_back(e);
    const CellId e = cells[random.below(cells.size())];
    const FaceId f{e, static_cast<int>(random.below(static_cast<std::size_t>(mesh.num_faces(e))))};
    return {f, static_cast<int>(random.below(static_cast<std::size_t>(mesh.face_size(f))))};
}

LinearCellComplex::Point point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Divides an edge, both here and there.
bool divide_edge(MeshEdit& edit, const Mesh& mesh, Dart d, Random& random,
                 LinearCellComplex* reference) {
    const auto twin = reference ? in_complex(*reference, mesh, d) : nullptr;
    const VertexId v = edit.divide_edge(d, random.uniform(0.2, 0.8));
    if (reference) reference->insert_point_in_cell<1>(twin, point(mesh.rest_position(v)));
    return true;
}

/// True if two corners have no edge in the cells at a face.
bool may_join(const Mesh& mesh, FaceId f, VertexId a, VertexId b) {
    const FaceId other = mesh.neighbor(f);
    return !find_dart(mesh, f.cell, a, b).is_valid() &&
           (!other.is_valid() || !find_dart(mesh, other.cell, a, b).is_valid());
}

bool divide_face(MeshEdit& edit, const Mesh& mesh, Dart d, Random& random,
                 LinearCellComplex* reference) {
    const int size = mesh.face_size(d.face);
    if (size < 4) return false;
    const int other = 2 + static_cast<int>(random.below(static_cast<std::size_t>(size) - 3));
    Dart end = d;
    for (int i = 0; i < other; ++i) end = next(mesh, end);
    const VertexId a = from(mesh, d), b = from(mesh, end);
    if (!may_join(mesh, d.face, a, b)) return false;
    if (reference) {
        const auto twin = in_complex(*reference, mesh, d);
        auto to_twin = twin;
        for (int i = 0; i < other; ++i) to_twin = reference->beta<1>(to_twin);
        reference->insert_cell_1_in_cell_2(twin, to_twin);
    }
    const FaceId part = edit.divide_face(d.face, a, b);
    EXPECT_EQ(mesh.face_size(d.face), other + 1);
    EXPECT_EQ(mesh.face_size(part), size - other + 1);
    EXPECT_TRUE(find_dart(mesh, d.face, b, a).is_valid());
    return true;
}

bool divide_face_at_centre(MeshEdit& edit, const Mesh& mesh, Dart d, LinearCellComplex* reference) {
    if (mesh.face_size(d.face) > max_corners) return false;
    const auto twin = reference ? in_complex(*reference, mesh, d) : nullptr;
    const VertexId v = edit.divide_face_at_centre(d.face);
    if (reference) reference->insert_point_in_cell<2>(twin, point(mesh.rest_position(v)));
    return true;
}

/// Cuts off two faces that meet at an edge.
bool divide_cell(MeshEdit& edit, const Mesh& mesh, Dart d, LinearCellComplex* reference) {
    std::vector<VertexId> path;
    std::vector<LinearCellComplex::Dart_handle> twins;
    for (const Dart start : {d, opposite(mesh, d)})
        for (Dart at = next(mesh, start); at != start; at = next(mesh, at)) {
            path.push_back(from(mesh, at));
            if (reference) twins.push_back(in_complex(*reference, mesh, at));
        }
    if (std::set(path.begin(), path.end()).size() != path.size()) return false;
    if (path.size() < 3 || mesh.num_faces(d.face.cell) < 4) return false;
    const double volume = rest_volume(mesh, d.face.cell);
    if (reference) reference->insert_cell_2_in_cell_3(twins.begin(), twins.end());
    const CellId added = edit.divide_cell(d.face.cell, path);
    EXPECT_EQ(mesh.num_faces(d.face.cell), 3);
    // The new face need not be plane: then its fans differ by side.
    if (path.size() <= 4) {
        EXPECT_NEAR(rest_volume(mesh, d.face.cell) + rest_volume(mesh, added), volume,
                    1e-12 * volume);
    }
    return true;
}

bool random_operation(MeshEdit& edit, const Mesh& mesh, Random& random,
                      LinearCellComplex* reference = nullptr) {
    const Dart d = random_dart(mesh, random);
    switch (random.below(4)) {
        case 0:
            return divide_edge(edit, mesh, d, random, reference);
        case 1:
            return divide_face(edit, mesh, d, random, reference);
        case 2:
            return divide_face_at_centre(edit, mesh, d, reference);
        default:
            return divide_cell(edit, mesh, d, reference);
    }
}

template <class Check>
void for_programs(int num_seeds, Check check) {
    for (const auto* family : small_families())
        for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::num_cases(num_seeds));
             ++seed) {
            SCOPED_TRACE(family->name + " " + std::to_string(seed));
            Mesh mesh = Mesh::build(family->data).mesh;
            Random random(seed);
            check(mesh, random);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(Polyhedra, AreDividedAsCgalDividesThem) {
    int num_done = 0, num_programs = 0;
    for_programs(6, [&](Mesh& mesh, Random& random) {
        ++num_programs;
        for (int i = 0; i < 12; ++i) {
            LinearCellComplex reference = to_linear_cell_complex(mesh);
            MeshEdit edit(mesh);
            if (!random_operation(edit, mesh, random, &reference)) continue;
            edit.commit();
            ++num_done;
            EXPECT_TRUE(are_alike(to_linear_cell_complex(mesh), reference));
            EXPECT_EQ(faults_of(mesh), std::vector<std::string>{});
            if (testing::Test::HasFailure()) return;
        }
    });
    EXPECT_GT(num_done, 4 * num_programs);
}

/// A few operations, then some faces are opened.
void change(MeshEdit& edit, const Mesh& mesh, Random& random) {
    for (int i = 0; i < 6; ++i) random_operation(edit, mesh, random);
    for (int i = 0; i < 3; ++i) {
        const Dart d = random_dart(mesh, random);
        if (mesh.neighbor(d.face).is_valid()) edit.open(d.face);
    }
}

TEST(Polyhedra, ComeAndGoWithEditsThatAreTakenBackAndMadeAgain) {
    int num_restored = 0;
    for_programs(10, [&](Mesh& mesh, Random& random) {
        std::vector<MeshSnapshot> states{MeshSnapshot(mesh)};
        std::vector<ChangeSet> edits;
        for (int i = 0; i < 4; ++i) {
            {
                MeshEdit abandoned(mesh);
                Random other = random;
                change(abandoned, mesh, other);
            }
            EXPECT_TRUE(MeshSnapshot(mesh) == states.back());
            MeshEdit edit(mesh);
            change(edit, mesh, random);
            if (i == 2 && mesh.num_elements() > 2) edit.remove(*mesh.elements().begin());
            edits.push_back(edit.commit());
            states.emplace_back(mesh);
            EXPECT_EQ(faults_of(mesh), std::vector<std::string>{});
            if (testing::Test::HasFailure()) return;
        }
        const auto is_at = [&](std::size_t i) { return MeshSnapshot(mesh) == states[i]; };
        for (std::size_t i = edits.size(); i-- > 0;) {
            replay(mesh, inverse(edits[i]));
            EXPECT_TRUE(is_at(i)) << "back to " << i;
        }
        for (std::size_t i = 0; i < edits.size(); ++i) {
            replay(mesh, edits[i]);
            EXPECT_TRUE(is_at(i + 1)) << "on to " << i + 1;
        }
        ArchiveWriter writer;
        save(mesh, writer);
        const std::string bytes = writer.bytes();
        if (!validate(mesh).empty()) return;  // a path has cut off a negative volume
        ArchiveReader reader(bytes);
        EXPECT_TRUE(MeshSnapshot(load_mesh(reader)) == states.back());
        ++num_restored;
    });
    EXPECT_GT(num_restored, 3);
}

// bisect() gives it a row of corners, which the record of a new polyhedron does not tell.
TEST(Polyhedra, AreNotMadeOfCellsThatTheSameEditHasBisected) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    const MeshSnapshot uncut(mesh);
    const std::array<void (*)(MeshEdit&, const Mesh&, CellId), 4> operations = {
        [](MeshEdit& edit, const Mesh&, CellId e) {
            edit.divide_edge({{e, 0}, 0}, 0.5);
        },
        [](MeshEdit& edit, const Mesh&, CellId e) {
            edit.divide_face_at_centre({e, 1});
        },
        [](MeshEdit& edit, const Mesh& m, CellId e) {
            for (int f = 0; f < 4; ++f)
                if (const FaceId other = m.neighbor({e, f}); other.is_valid())
                    edit.divide_face_at_centre(other);
        },
        [](MeshEdit& edit, const Mesh& m, CellId e) {
            const auto corners = m.corners(e);
            edit.divide_cell(e, std::array{corners[0], corners[1], corners[2]});
        }};
    for (std::size_t i = 0; i < operations.size(); ++i) {
        SCOPED_TRACE(i);
        {
            MeshEdit edit(mesh);
            const CellId e = *mesh.elements().begin();
            const auto& bisection = edit.bisect(e, mesh.corners(e)[0], mesh.corners(e)[1], 0.5);
            const CellId added = bisection.elements.front().added;
            try {
                operations[i](edit, mesh, added);
                FAIL();
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find("commit first"), std::string::npos);
            }
        }
        EXPECT_TRUE(MeshSnapshot(mesh) == uncut);
    }
}

bool has_plane_faces(const Mesh& mesh) {
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const auto at = [&](int p) { return mesh.rest_position(mesh.face_corner({e, f}, p)); };
            const Vec3 area = area_vector(mesh.face_size({e, f}), at);
            for (int p = 1; p < mesh.face_size({e, f}); ++p) {
                const Vec3 along = at(p) - at(0);
                if (std::abs(area.dot(along)) > 1e-12 * area.norm() * along.norm()) return false;
            }
        }
    return true;
}

TEST(Polyhedra, KeepTheVolumeOfCellsWhosePlaneFacesAreDivided) {
    std::set<CellKind> kinds;
    for_programs(10, [&](Mesh& mesh, Random& random) {
        if (!has_plane_faces(mesh)) return;
        for (const CellId e : mesh.elements()) kinds.insert(mesh.kind(e));
        double before = 0.0, after = 0.0;
        for (const CellId e : mesh.elements()) before += rest_volume(mesh, e);
        MeshEdit edit(mesh);
        for (int i = 0; i < 10; ++i) {
            const Dart d = random_dart(mesh, random);
            if (mesh.face_size(d.face) > 4) continue;
            if (mesh.face_size(d.face) == 3 && random.below(2) == 0)
                edit.divide_edge(d, 0.25);
            else
                edit.divide_face_at_centre(d.face);
        }
        edit.commit();
        for (const CellId e : mesh.elements()) after += rest_volume(mesh, e);
        EXPECT_NEAR(after, before, 1e-13 * before);
    });
    EXPECT_EQ(kinds.size(), 4u);
}

TEST(Polyhedra, ADartIsFoundOnAllSides) {
    for_programs(1, [&](Mesh& mesh, Random&) {
        for (const CellId e : mesh.elements())
            for (int f = 0; f < mesh.num_faces(e); ++f)
                for (int p = 0; p < mesh.face_size({e, f}); ++p) {
                    const Dart d{{e, f}, p};
                    EXPECT_EQ(previous(mesh, next(mesh, d)), d);
                    EXPECT_EQ(opposite(mesh, opposite(mesh, d)), d);
                    EXPECT_EQ(from(mesh, opposite(mesh, d)), to(mesh, d));
                    const Dart other = across(mesh, d);
                    EXPECT_EQ(other.is_valid(), mesh.neighbor(d.face).is_valid());
                    if (!other.is_valid()) continue;
                    EXPECT_EQ(across(mesh, other), d);
                    EXPECT_EQ(from(mesh, other), to(mesh, d));
                }
    });
}

}  // namespace
}  // namespace incise::topology
