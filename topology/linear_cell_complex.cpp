// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/linear_cell_complex.h"

#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/topology/darts.h"

namespace incise::topology {

namespace {

using Handle = LinearCellComplex::Dart_handle;
using Vertex = LinearCellComplex::Attribute_handle<0>::type;

// Links and attributes are written dart by dart: CGAL's own operations cost several times as much.
class ComplexMaker {
  public:
    ComplexMaker(const Mesh& mesh, const Carriers& carriers, LinearCellComplex& complex)
        : mesh_(mesh), carriers_(carriers), complex_(complex) {}

    void run() {
        vertices_.resize(mesh_.node_capacity(), nullptr);
        for (const VertexId n : mesh_.nodes()) {
            const Vec3& x = mesh_.rest_position(n);
            vertices_[n.index()] =
                complex_.create_vertex_attribute(LinearCellComplex::Point(x.x(), x.y(), x.z()));
            complex_.info_of_attribute<0>(vertices_[n.index()]) = {n};
        }
        cells_.resize(mesh_.element_capacity());
        for (const CellId e : mesh_.elements()) add(e);
        for (const CellId e : mesh_.elements())
            for (int f = 0; f < mesh_.num_faces(e); ++f) finish({e, f});
    }

  private:
    void add(CellId e) {
        const auto volume = complex_.create_attribute<3>();
        ComplexCell& info = complex_.info_of_attribute<3>(volume);
        info.id = e;
        info.region = mesh_.region(e);
        if (!carriers_.is_empty())
            if (const std::int64_t row = carriers_.of_cell[num_cells_]; row != Carriers::whole)
                info.carrier = carriers_.corners[static_cast<std::size_t>(row)];
        const auto whole = mesh_.whole_cell(e);
        if (whole && !(info.carrier && mesh_.is_polyhedron(e))) {
            info.diagonals = whole->diagonals;
            const auto face = traits(whole->kind).face(0);
            for (std::size_t p = 0; p < 2; ++p)
                info.first_edge[p] = whole->at[static_cast<std::size_t>(face[p])];
        }
        ++num_cells_;
        auto& faces = cells_[e.index()];
        faces.resize(static_cast<std::size_t>(mesh_.num_faces(e)));
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            for (int p = 0; p < mesh_.face_size({e, f}); ++p) {
                const Handle d = complex_.create_dart();
                complex_.set_dart_attribute<0>(d, vertices_[mesh_.face_corner({e, f}, p).index()]);
                complex_.set_dart_attribute<3>(d, volume);
                faces[static_cast<std::size_t>(f)].push_back(d);
            }
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            for (int p = 0; p < mesh_.face_size({e, f}); ++p) {
                const Dart here{{e, f}, p}, there = opposite(mesh_, here);
                complex_.basic_link_beta_1(dart(here), dart(next(mesh_, here)));
                if (f < there.face.face)
                    complex_.basic_link_beta_for_involution<2>(dart(here), dart(there));
            }
    }

    Handle& dart(const Dart& d) {
        return cells_[d.face.cell.index()][static_cast<std::size_t>(d.face.face)]
                     [static_cast<std::size_t>(d.position)];
    }

    /// Joins a face to its neighbour, or says that it is on a cut.
    void finish(FaceId f) {
        const FaceId other = mesh_.neighbor(f);
        if (!other.is_valid()) {
            if (mesh_.is_on_cut(f))
                complex_.set_attribute<2>(dart({f, 0}),
                                          complex_.create_attribute<2>(ComplexFace{}));
            return;
        }
        if (other < f) return;
        for (int p = 0; p < mesh_.face_size(f); ++p)
            complex_.basic_link_beta_for_involution<3>(dart({f, p}), dart(across(mesh_, {f, p})));
    }

    const Mesh& mesh_;
    const Carriers& carriers_;
    LinearCellComplex& complex_;
    std::vector<Vertex> vertices_;                         // by node id
    std::vector<std::vector<std::vector<Handle>>> cells_;  // by element id, by face, by position
    std::size_t num_cells_ = 0;
};

/// Reads numbers from an attribute in a file.
template <class... Numbers>
bool read_numbers(std::istringstream& text, Numbers&... numbers) {
    return static_cast<bool>((text >> ... >> numbers));
}

[[noreturn]] void refuse_attribute(const std::string& text) {
    throw InputError("linear cell complex: '" + text + "' is no attribute of a mesh of Incise");
}

}  // namespace

LinearCellComplex to_linear_cell_complex(const Mesh& mesh, const Carriers& carriers) {
    LinearCellComplex complex;
    ComplexMaker(mesh, carriers, complex).run();
    return complex;
}

void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexVertex& vertex) {
    node.add("v", vertex.id.value);
}

void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexFace& face) {
    node.add("v", face.is_on_cut ? 1 : 0);
}

void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexCell& cell) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << cell.id.value << ' ' << cell.region << ' ' << cell.first_edge[0].value << ' '
         << cell.first_edge[1].value << ' '
         << (cell.carrier ? 1 + static_cast<int>(cell.carrier->kind()) : 0);
    if (cell.carrier)
        for (const Vec3& x : *cell.carrier) text << ' ' << x[0] << ' ' << x[1] << ' ' << x[2];
    // Numbers at the end that are zero are left out.
    const int of_carrier = cell.carrier ? cell.carrier->diagonals.bits() : 0;
    if (!cell.diagonals.is_none() || of_carrier != 0) text << ' ' << cell.diagonals.bits();
    if (of_carrier != 0) text << ' ' << of_carrier;
    node.add("v", text.str());
}

void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexVertex& vertex) {
    std::istringstream text(node.second.data());
    if (!read_numbers(text, vertex.id.value)) refuse_attribute(node.second.data());
}

void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexFace& face) {
    std::istringstream text(node.second.data());
    if (!read_numbers(text, face.is_on_cut)) refuse_attribute(node.second.data());
}

void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexCell& cell) {
    std::istringstream text(node.second.data());
    int carrier = 0;  // 0 for none, else its kind, from 1
    bool is_read = read_numbers(text, cell.id.value, cell.region, cell.first_edge[0].value,
                                cell.first_edge[1].value, carrier) &&
                   carrier >= 0 && carrier <= num_cell_kinds;
    if (is_read && carrier > 0) {
        const std::vector<Vec3> zeros(max_corners, Vec3::Zero());
        for (Vec3& x : cell.carrier.emplace(static_cast<CellKind>(carrier - 1), zeros))
            is_read = is_read && read_numbers(text, x[0], x[1], x[2]);
    }
    if (std::uint16_t bits = 0; is_read && read_numbers(text, bits))
        cell.diagonals = Diagonals::of_bits(bits);
    if (std::uint16_t bits = 0; is_read && cell.carrier && read_numbers(text, bits))
        cell.carrier->diagonals = Diagonals::of_bits(bits);
    if (!is_read) refuse_attribute(node.second.data());
}

}  // namespace incise::topology
