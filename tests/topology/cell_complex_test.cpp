// The operations on cells of any shape: against CGAL's own on a copy, their inverses, and what
// stays true of every cell.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_complex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

using Map = CellComplex::Map;
using Dart = CellComplex::Dart;

void add_all(CellComplex& complex, const Mesh& mesh) {
    std::vector<Vec3> x;
    for (const CellId e : mesh.elements()) {
        x.clear();
        for (const VertexId n : mesh.corners(e)) x.push_back(mesh.rest_position(n));
        complex.add(e, mesh.kind(e), mesh.corners(e), x);
    }
    /// The dart of a face that starts at its corner at position 0.
    const auto dart_at = [&](FaceId f) {
        std::vector<Dart> faces, darts;
        complex.faces(f.cell, faces);
        for (const Dart face : faces) complex.face(face, darts);
        for (const Dart d : darts) {
            Dart at = d;
            bool fits = true;
            for (int p = 0; p < mesh.face_size(f); ++p, at = complex.next(at))
                fits = fits && complex.vertex(at) == mesh.face_corner(f, p);
            if (fits && at == d) return d;
        }
        return Dart(nullptr);
    };
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const FaceId here{e, f}, there = mesh.neighbor(here);
            if (!there.is_valid() || there < here) continue;
            const Dart a = dart_at(here);
            ASSERT_NE(a, nullptr);
            // The dart along the same edge on the other side starts where `a` ends.
            Dart b = dart_at(there);
            while (complex.vertex(b) != complex.vertex(complex.next(a))) b = complex.next(b);
            complex.join(a, b);
        }
}

void expect_sound(const CellComplex& complex, double least_volume = 0.0) {
    const auto faults = complex.faults(least_volume);
    EXPECT_EQ(faults, std::vector<std::string>{});
    EXPECT_TRUE(complex.map_of_cgal().is_valid());
}

/// The dart of a copy that a dart of the original became: CGAL's copies keep the order of darts.
Dart in_copy(const Map& original, Map& copy, Dart d) {
    auto there = copy.darts().begin();
    for (auto here = original.darts().begin(); Map::Dart_const_handle(here) != d; ++here) ++there;
    return there;
}

bool are_alike(const Map& a, const Map& b) { return a.is_isomorphic_to(b, false, false, true); }

/// Loops are taken anywhere, so that parts of a cell can have any volume.
constexpr double any_volume = -std::numeric_limits<double>::infinity();

/// A program of random operations, each checked against CGAL's.
class RandomOperations {
  public:
    RandomOperations(CellComplex& complex, const Mesh& mesh, std::uint64_t seed)
        : complex_(complex),
          random_(seed),
          next_vertex_(mesh.node_capacity()),
          next_cell_(mesh.element_capacity()) {}

    void run(int count) {
        for (int i = 0; i < count; ++i) {
            Map reference(complex_.map_of_cgal());
            const Dart d = random_dart();
            const Dart twin = in_copy(complex_.map_of_cgal(), reference, d);
            const std::size_t what = random_.below(3);
            const bool is_done = what == 0   ? divide_edge(d, reference, twin)
                                 : what == 1 ? divide_face(d, reference, twin)
                                             : divide_cell(d, reference, twin);
            if (!is_done) continue;
            ++num_done_;
            expect_sound(complex_, any_volume);
            EXPECT_TRUE(are_alike(complex_.map_of_cgal(), reference)) << "operation " << what;
        }
    }

    void take_back() {
        while (!inverses_.empty()) {
            inverses_.back()();
            inverses_.pop_back();
            expect_sound(complex_, any_volume);
        }
    }

    int num_done() const { return num_done_; }

  private:
    Dart random_dart() {
        std::vector<CellId> cells;
        for (std::size_t e = 0; e < next_cell_; ++e)
            if (complex_.has(CellId(e))) cells.emplace_back(e);
        std::vector<Dart> faces, darts;
        complex_.faces(cells[random_.below(cells.size())], faces);
        complex_.face(faces[random_.below(faces.size())], darts);
        return darts[random_.below(darts.size())];
    }

    bool divide_edge(Dart d, Map& reference, Dart twin) {
        const double t = random_.uniform(0.2, 0.8);
        const Vec3 x = (1.0 - t) * complex_.position(d) + t * complex_.position(complex_.next(d));
        const Dart made = complex_.divide_edge(d, VertexId(next_vertex_++), x);
        reference.insert_point_in_cell<1>(twin, Map::Point(x.x(), x.y(), x.z()));
        EXPECT_EQ(complex_.position(made), x);
        EXPECT_EQ(complex_.previous(made), d);
        inverses_.push_back([this, made] { complex_.join_edge(made); });
        return true;
    }

    bool divide_face(Dart d, Map& reference, Dart twin) {
        std::vector<Dart> darts;
        complex_.face(d, darts);
        if (darts.size() < 4) return false;
        const std::size_t other = 2 + random_.below(darts.size() - 3);
        Dart to_twin = twin;
        for (std::size_t i = 0; i < other; ++i) to_twin = reference.beta<1>(to_twin);
        reference.insert_cell_1_in_cell_2(twin, to_twin);
        const Dart made = complex_.divide_face(d, darts[other]);
        EXPECT_EQ(complex_.next(made), darts[other]);
        EXPECT_EQ(complex_.vertex(made), complex_.vertex(d));
        inverses_.push_back([this, made] { complex_.join_faces(made); });
        return true;
    }

    /// Cuts off two faces that meet at an edge.
    bool divide_cell(Dart d, Map& reference, Dart twin) {
        std::vector<Dart> loop, twins, faces;
        std::set<VertexId> vertices;
        complex_.faces(complex_.cell(d), faces);
        const auto collect = [&](Dart ours, Dart theirs) {
            for (Dart at = complex_.next(ours); at != ours; at = complex_.next(at)) {
                theirs = reference.beta<1>(theirs);
                loop.push_back(at);
                twins.push_back(theirs);
            }
        };
        collect(d, twin);
        collect(complex_.opposite(d), reference.beta<2>(twin));
        for (const Dart at : loop)
            if (!vertices.insert(complex_.vertex(at)).second) return false;
        if (loop.size() < 3 || faces.size() < 4) return false;
        const CellId whole = complex_.cell(d);
        const double volume = complex_.volume(whole);
        const CellId part(next_cell_++);
        const Dart made = complex_.divide_cell(loop, part);
        reference.insert_cell_2_in_cell_3(twins.begin(), twins.end());
        EXPECT_EQ(complex_.cell(made), part);
        EXPECT_EQ(complex_.cell(loop.front()), whole);
        // The new face need not be plane: its fans differ by side, unless it is a triangle.
        if (loop.size() == 3) {
            EXPECT_NEAR(complex_.volume(whole) + complex_.volume(part), volume, 1e-12 * volume);
        }
        inverses_.push_back([this, made] { complex_.join_cells(made); });
        return true;
    }

    CellComplex& complex_;
    test::Random random_;
    std::size_t next_vertex_, next_cell_;
    std::vector<std::function<void()>> inverses_;
    int num_done_ = 0;
};

/// The families of few cells: CGAL compares maps dart by dart from each of them.
std::vector<const test::MeshFamily*> small_families() {
    std::vector<const test::MeshFamily*> families;
    for (const auto& family : test::mesh_families())
        if (family.data.num_cells() <= 100) families.push_back(&family);
    return families;
}

TEST(CellComplex, IsSoundAndHasTheVolumesOfItsMesh) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        const Mesh mesh = Mesh::build(family.data).mesh;
        CellComplex complex;
        add_all(complex, mesh);
        expect_sound(complex);
        EXPECT_EQ(complex.num_cells(), mesh.num_elements());
        EXPECT_EQ(complex.num_vertices(), mesh.num_nodes());
        double volume = 0.0, expected = 0.0;
        for (const CellId e : mesh.elements()) {
            volume += complex.volume(e);
            expected += rest_volume(mesh, e);
        }
        EXPECT_NEAR(volume, expected, 1e-12 * expected);
    }
}

TEST(CellComplex, DividesAsCgalDoesAndTakesItBack) {
    int num_done = 0, num_programs = 0;
    for (const auto* family : small_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(family->name + " " + std::to_string(seed));
            const Mesh mesh = Mesh::build(family->data).mesh;
            CellComplex complex;
            add_all(complex, mesh);
            const Map before(complex.map_of_cgal());
            RandomOperations operations(complex, mesh, seed);
            operations.run(12);
            ++num_programs;
            num_done += operations.num_done();
            operations.take_back();
            EXPECT_TRUE(before.is_isomorphic_to(complex.map_of_cgal(), false, false, true));
            EXPECT_EQ(complex.num_cells(), mesh.num_elements());
            EXPECT_EQ(complex.num_vertices(), mesh.num_nodes());
            if (HasFailure()) return;
        }
    EXPECT_GT(num_done, 4 * num_programs);
}

/// Gives the parts of a star that came apart a vertex each. Returns how many copies were made.
int separate(CellComplex& complex, std::span<const Dart> at, std::size_t& next_vertex) {
    std::vector<std::vector<Dart>> parts;
    for (const Dart d : at) {
        const bool is_known = std::ranges::any_of(
            parts, [&](const auto& part) { return std::ranges::find(part, d) != part.end(); });
        if (!is_known) complex.star(d, parts.emplace_back());
    }
    std::ranges::sort(parts, {}, [&](const auto& part) {
        std::vector<Dart> darts;
        return complex.star(part.front(), darts);
    });
    const VertexId v = complex.vertex(at.front());
    for (std::size_t p = 0; p < parts.size(); ++p)
        complex.set_vertex(parts[p].front(), p == 0 ? v : VertexId(next_vertex++),
                           complex.position(parts[p].front()));
    return static_cast<int>(parts.size()) - 1;
}

TEST(CellComplex, OpensFacesAndRemovesCellsAsCgalDoes) {
    for (const auto* family : small_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
            SCOPED_TRACE(family->name + " " + std::to_string(seed));
            test::Random random(seed);
            const Mesh mesh = Mesh::build(family->data).mesh;
            CellComplex complex;
            add_all(complex, mesh);
            std::size_t next_vertex = mesh.node_capacity();
            for (int i = 0; i < 6; ++i) {
                std::vector<CellId> cells;
                for (const CellId e : mesh.elements())
                    if (complex.has(e)) cells.push_back(e);
                if (cells.size() < 2) break;
                const CellId e = cells[random.below(cells.size())];
                std::vector<Dart> faces;
                complex.faces(e, faces);
                const Dart f = faces[random.below(faces.size())];
                Map reference(complex.map_of_cgal());
                const Dart twin = in_copy(complex.map_of_cgal(), reference, f);
                std::vector<Dart> opened;
                if (random.below(2) == 0) {
                    reference.remove_cell<3>(twin);
                    complex.remove(e, opened);
                } else if (complex.across(f) != nullptr) {
                    reference.unsew<3>(twin);
                    opened = {f, complex.open(f)};
                }
                std::map<VertexId, std::vector<Dart>> touched;
                for (const Dart side : opened) {
                    std::vector<Dart> darts;
                    complex.face(side, darts);
                    for (const Dart d : darts) touched[complex.vertex(d)].push_back(d);
                }
                for (const auto& [v, darts] : touched) separate(complex, darts, next_vertex);
                expect_sound(complex);
                EXPECT_TRUE(are_alike(complex.map_of_cgal(), reference));
                EXPECT_EQ(complex.num_vertices(), reference.attributes<0>().size());
                if (HasFailure()) return;
            }
        }
}

TEST(CellComplex, LeavesAVertexThatCellsShareWithoutAFace) {
    const auto v = [](std::size_t i) { return VertexId(i); };
    for (const std::size_t gone : {0, 1}) {
        CellComplex complex;
        complex.add(CellId(std::size_t{0}), CellKind::tetrahedron,
                    std::array{v(0), v(1), v(2), v(3)},
                    std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
        complex.add(CellId(std::size_t{1}), CellKind::tetrahedron,
                    std::array{v(0), v(4), v(5), v(6)},
                    std::array{Vec3(0, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)});
        std::vector<Dart> opened;
        complex.remove(CellId(gone), opened);
        EXPECT_TRUE(opened.empty());
        expect_sound(complex, any_volume);
        EXPECT_EQ(complex.num_vertices(), 4u);
    }
}

TEST(CellComplex, FindsWhatIsWrong) {
    const Mesh mesh = Mesh::build(test::jittered_cube(1, 0.0, 1)).mesh;
    CellComplex complex;
    add_all(complex, mesh);
    EXPECT_FALSE(complex.faults(1.0).empty());  // no cell is that large
    const Dart d = complex.dart_of(CellId(std::size_t{0}));
    complex.divide_edge(d, VertexId(mesh.node_capacity()), Vec3(5, 5, 5));  // far off its edge
    EXPECT_FALSE(complex.faults().empty());
}

}  // namespace
}  // namespace incise::topology
