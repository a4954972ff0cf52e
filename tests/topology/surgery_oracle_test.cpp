// Our edits against CGAL's managed operations on the same input.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <CGAL/Linear_cell_complex_for_combinatorial_map.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <set>

#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

struct Items {
    template <class Map>
    struct Dart_wrapper {
        using Dart_info = int;
        using Vertex_attribute = CGAL::Cell_attribute_with_point<Map, int>;
        using Volume_attribute = CGAL::Cell_attribute<Map, int>;
        using Attributes = std::tuple<Vertex_attribute, void, void, Volume_attribute>;
    };
};
using Complex = CGAL::Linear_cell_complex_for_combinatorial_map<
    3, 3, CGAL::Linear_cell_complex_traits<3, CGAL::Simple_cartesian<double>>, Items>;

/// A complex built by CGAL's own means: cells from points, sewn where their points coincide.
class Oracle {
  public:
    explicit Oracle(const Mesh& mesh) : mesh_(mesh) {
        for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
            const CellId e(i);
            std::array<Complex::Point, max_corners> p;
            for (std::size_t k = 0; k < mesh.corners(e).size(); ++k) {
                const Vec3& x = mesh.rest_position(mesh.corners(e)[k]);
                p[k] = {x.x(), x.y(), x.z()};
            }
            if (mesh.kind(e) == CellKind::tetrahedron)
                cells_.push_back(complex_.make_tetrahedron(p[0], p[1], p[2], p[3]));
            else
                cells_.push_back(
                    complex_.make_hexahedron(p[0], p[1], p[2], p[3], p[7], p[4], p[5], p[6]));
        }
        complex_.sew3_same_facets();
    }

    void remove(CellId e) { complex_.remove_cell<3>(cells_[e.index()]); }

    // Finds the face of e's cell whose corners are at the given points.
    void open(FaceId f) {
        std::set<Complex::Point> wanted;
        for (int p = 0; p < mesh_.face_size(f); ++p) {
            const Vec3& x = mesh_.rest_position(mesh_.face_corner(f, p));
            wanted.insert({x.x(), x.y(), x.z()});
        }
        Complex::Dart_handle found = nullptr;
        auto darts = complex_.darts_of_cell<3>(cells_[f.cell.index()]);
        for (auto it = darts.begin(); it.cont(); ++it) {
            std::set<Complex::Point> points;
            Complex::Dart_handle d = it;
            do {
                points.insert(complex_.point(d));
                d = complex_.beta<1>(d);
            } while (d != Complex::Dart_handle(it));
            if (points == wanted) found = it;
        }
        ASSERT_NE(found, nullptr);
        complex_.unsew<3>(found);
    }

    const Complex& complex() const { return complex_; }

    std::size_t num_volumes() const {  // CGAL's cell iterator does not bear an empty map
        return complex_.is_empty() ? 0 : complex_.one_dart_per_cell<3>().size();
    }

  private:
    const Mesh& mesh_;
    Complex complex_;
    std::vector<Complex::Dart_handle> cells_;
};

/// Returns the number of darts whose face is joined to another.
std::size_t num_sewn(const auto& complex) {
    std::size_t count = 0;
    for (auto d = complex.darts().begin(); d != complex.darts().end(); ++d)
        if (!complex.template is_free<3>(d)) ++count;
    return count;
}

TEST(Surgery, CountsAsCgalsManagedOperationsDo) {
    for (const auto& family : test::mesh_families()) {
        // CGAL makes tetrahedra and hexahedra only.
        if (family.name == "mixed" || family.name == "joined") continue;
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            SCOPED_TRACE(family.name + " " + std::to_string(seed));
            test::Random random(seed);
            Mesh mesh = Mesh::build(family.data).mesh;
            Oracle oracle(mesh);
            const std::size_t rounds = std::min<std::size_t>(mesh.num_elements(), 60);
            for (std::size_t i = 0; i < rounds; ++i) {
                const CellId e(random.below(mesh.element_capacity()));
                if (!mesh.is_alive(e)) continue;
                const FaceId f{
                    e, static_cast<int>(random.below(static_cast<std::size_t>(mesh.num_faces(e))))};
                MeshEdit edit(mesh);
                if (random.below(2) == 0) {
                    oracle.remove(e);
                    edit.remove(e);
                } else if (mesh.neighbor(f).is_valid()) {
                    oracle.open(f);
                    edit.open(f);
                }
                edit.commit();
                ASSERT_EQ(mesh.num_nodes(), oracle.complex().number_of_vertex_attributes());
                ASSERT_EQ(mesh.num_elements(), oracle.num_volumes());
            }
            const LinearCellComplex ours = to_linear_cell_complex(mesh);
            EXPECT_EQ(ours.number_of_darts(), oracle.complex().number_of_darts());
            EXPECT_EQ(num_sewn(ours), num_sewn(oracle.complex()));
            EXPECT_TRUE(ours.is_valid());
            EXPECT_TRUE(oracle.complex().is_valid());
        }
    }
}

}  // namespace
}  // namespace incise::topology
