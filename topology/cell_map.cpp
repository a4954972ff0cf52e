// Operations on the darts of CGAL's linear cell complex. They link and unlink darts directly, since
// CGAL's own operations cost several times as much and do not report when a vertex is erased.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_map.h"

#include <CGAL/Cell_attribute.h>
#include <CGAL/Cell_attribute_with_point.h>
#include <CGAL/Linear_cell_complex_for_combinatorial_map.h>
#include <CGAL/Simple_cartesian.h>

#include <cassert>
#include <sstream>

#include "incise/topology/mesh.h"

namespace incise::topology {

namespace {

/// The position in a face at which a dart starts. A dart of 64 bytes has eight bytes to spare.
struct DartInfo {
    std::int32_t element = -1;
    std::int16_t face = -1;
    std::int16_t position = -1;
    bool operator==(const DartInfo&) const = default;
};

struct MapItems {
    template <class Map>
    struct Dart_wrapper {
        using Dart_info = DartInfo;
        using Vertex_attribute = CGAL::Cell_attribute_with_point<Map, VertexId>;
        using Volume_attribute = CGAL::Cell_attribute<Map, CellId>;
        using Attributes = std::tuple<Vertex_attribute, void, void, Volume_attribute>;
    };
};

using MapTraits = CGAL::Linear_cell_complex_traits<3, CGAL::Simple_cartesian<double>>;
using Complex = CGAL::Linear_cell_complex_for_combinatorial_map<3, 3, MapTraits, MapItems>;
using Dart = Complex::Dart_handle;
using ConstDart = Complex::Dart_const_handle;
using Vertex = Complex::Attribute_handle<0>::type;

/// The face and position of the dart along the same edge on the adjacent face of the same cell.
struct DartPlace {
    int face = -1, position = -1;
};
using FaceDarts = std::array<std::array<DartPlace, max_face_corners>, max_faces>;

constexpr FaceDarts opposite_darts(const CellTraits& t) {
    FaceDarts places{};
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        for (std::size_t p = 0; p < face.size(); ++p) {
            const int from = face[p], to = face[(p + 1) % face.size()];
            for (int g = 0; g < t.num_faces; ++g) {
                const auto other = t.face(g);
                for (std::size_t q = 0; q < other.size(); ++q)
                    if (other[q] == to && other[(q + 1) % other.size()] == from)
                        places[static_cast<std::size_t>(f)][p] = {g, static_cast<int>(q)};
            }
        }
    }
    return places;
}

constexpr std::array<FaceDarts, num_cell_kinds> opposite_places = {
    opposite_darts(cell_traits[0]), opposite_darts(cell_traits[1]), opposite_darts(cell_traits[2]),
    opposite_darts(cell_traits[3])};

Complex::Point to_point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

}  // namespace

struct CellMap::Impl {
    Complex complex;
    std::vector<Vertex> vertices;            // by node id; null if the node has no dart
    std::vector<CellKind> kinds;             // by element id
    std::vector<std::size_t> face_begin{0};  // by element id
    std::vector<Dart> first_darts;           // of each face, by element and face

    Dart dart(FaceId f, int position = 0) const {
        Dart d = first_darts[face_begin[f.cell.index()] + static_cast<std::size_t>(f.face)];
        for (int p = 0; p < position; ++p) d = complex_beta1(d);
        return d;
    }
    // The const overload of beta returns a const handle. This function needs a plain handle and
    // only reads.
    Dart complex_beta1(Dart d) const { return const_cast<Complex&>(complex).beta<1>(d); }

    Vertex vertex(VertexId n, const Vec3& rest_position) {
        if (n.index() >= vertices.size()) vertices.resize(n.index() + 1, nullptr);
        Vertex& v = vertices[n.index()];
        if (v == nullptr) {
            v = complex.create_vertex_attribute(to_point(rest_position));
            complex.info_of_attribute<0>(v) = n;
        }
        return v;
    }

    // To be called before `d` is removed: CGAL erases a vertex with its last dart without a report.
    void release(Dart d) {
        const Vertex v = complex.attribute<0>(d);
        if (complex.get_attribute_ref_counting<0>(v) == 1)
            vertices[complex.info_of_attribute<0>(v).index()] = nullptr;
    }
};

CellMap::CellMap() : impl_(std::make_unique<Impl>()) {}
CellMap::~CellMap() = default;
CellMap::CellMap(CellMap&&) noexcept = default;
CellMap& CellMap::operator=(CellMap&&) noexcept = default;

void CellMap::add_element(CellId e, CellKind kind, std::span<const VertexId> corners,
                          std::span<const Vec3> rest_positions) {
    Impl& m = *impl_;
    Complex& complex = m.complex;
    const CellTraits& t = traits(kind);
    // New ids come in ascending order. An element that an undo brings back has its old row.
    if (e.index() >= m.kinds.size()) {
        assert(e.index() == m.kinds.size());
        m.kinds.push_back(kind);
        m.face_begin.push_back(m.face_begin.back() + static_cast<std::size_t>(t.num_faces));
        m.first_darts.resize(m.face_begin.back(), nullptr);
    }

    const auto volume = complex.create_attribute<3>();
    complex.info_of_attribute<3>(volume) = e;
    std::array<std::array<Dart, max_face_corners>, max_faces> darts{};
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        auto& row = darts[static_cast<std::size_t>(f)];
        for (std::size_t p = 0; p < face.size(); ++p) {
            const VertexId n = corners[static_cast<std::size_t>(face[p])];
            row[p] = complex.create_dart();
            complex.info(row[p]) = {e.value, static_cast<std::int16_t>(f),
                                    static_cast<std::int16_t>(p)};
            complex.set_dart_attribute<0>(row[p], m.vertex(n, rest_positions[n.index()]));
            complex.set_dart_attribute<3>(row[p], volume);
        }
        for (std::size_t p = 0; p < face.size(); ++p)
            complex.basic_link_beta_1(row[p], row[(p + 1) % face.size()]);
        m.first_darts[m.face_begin[e.index()] + static_cast<std::size_t>(f)] = row[0];
    }
    const FaceDarts& places = opposite_places[static_cast<std::size_t>(kind)];
    for (int f = 0; f < t.num_faces; ++f)
        for (int p = 0; p < t.face_sizes[static_cast<std::size_t>(f)]; ++p) {
            const auto i = static_cast<std::size_t>(f), j = static_cast<std::size_t>(p);
            const DartPlace o = places[i][j];
            if (o.face > f)
                complex.basic_link_beta_for_involution<2>(
                    darts[i][j],
                    darts[static_cast<std::size_t>(o.face)][static_cast<std::size_t>(o.position)]);
        }
}

void CellMap::remove_element(CellId e) {
    Impl& m = *impl_;
    const CellTraits& t = traits(m.kinds[e.index()]);
    for (int f = 0; f < t.num_faces; ++f) {
        Dart d = m.dart({e, f});
        for (int p = 0; p < t.face_sizes[static_cast<std::size_t>(f)]; ++p) {
            const Dart next = m.complex.beta<1>(d);
            assert(m.complex.is_free<3>(d));
            m.release(d);
            m.complex.erase_dart(d);
            d = next;
        }
        m.first_darts[m.face_begin[e.index()] + static_cast<std::size_t>(f)] = nullptr;
    }
}

void CellMap::truncate(std::size_t node_capacity, std::size_t element_capacity) {
    Impl& m = *impl_;
    if (m.vertices.size() > node_capacity) m.vertices.resize(node_capacity);
    m.kinds.resize(element_capacity);
    m.face_begin.resize(element_capacity + 1);
    m.first_darts.resize(m.face_begin.back());
}

void CellMap::set_corner(CellId e, int corner, VertexId n, const Vec3& rest_position) {
    Impl& m = *impl_;
    const Vertex to = m.vertex(n, rest_position);
    const CellTraits& t = traits(m.kinds[e.index()]);
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        for (std::size_t p = 0; p < face.size(); ++p) {
            if (face[p] != corner) continue;
            const Dart d = m.dart({e, f}, static_cast<int>(p));
            m.release(d);
            m.complex.set_dart_attribute<0>(d, to);
        }
    }
}

void CellMap::set_incident_element(VertexId n, CellId e, int corner) {
    Impl& m = *impl_;
    const CellTraits& t = traits(m.kinds[e.index()]);
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        for (std::size_t p = 0; p < face.size(); ++p)
            if (face[p] == corner) {
                m.complex.set_dart_of_attribute<0>(m.vertices[n.index()],
                                                   m.dart({e, f}, static_cast<int>(p)));
                return;
            }
    }
}

void CellMap::glue(FaceId a, FaceId b, int shift) {
    Impl& m = *impl_;
    const int size = static_cast<int>(traits(m.kinds[a.cell.index()]).face(a.face).size());
    // The dart of `a` from corner p to p + 1 is linked to the dart of `b` in opposite direction.
    Dart d = m.dart(a);
    for (int p = 0; p < size; ++p, d = m.complex.beta<1>(d))
        m.complex.basic_link_beta_for_involution<3>(d,
                                                    m.dart(b, (shift - p - 1 + 2 * size) % size));
}

void CellMap::unglue(FaceId a) {
    Impl& m = *impl_;
    Dart d = m.dart(a);
    do {
        m.complex.unlink_beta_for_involution<3>(d);
        d = m.complex.beta<1>(d);
    } while (d != m.dart(a));
}

std::size_t CellMap::num_vertices() const { return impl_->complex.attributes<0>().size(); }
std::size_t CellMap::num_volumes() const { return impl_->complex.attributes<3>().size(); }
std::size_t CellMap::num_darts() const { return impl_->complex.number_of_darts(); }
bool CellMap::is_valid() const { return impl_->complex.is_valid(); }

std::vector<std::string> CellMap::differences_to(const Mesh& mesh) const {
    std::vector<std::string> found;
    const auto report = [&](auto&&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        found.push_back(text.str());
    };
    const Impl& m = *impl_;
    const Complex& complex = m.complex;
    if (num_vertices() != mesh.num_nodes())
        report("the map has ", num_vertices(), " vertices, the mesh ", mesh.num_nodes(), " nodes");
    if (num_volumes() != mesh.num_elements())
        report("the map has ", num_volumes(), " volumes, the mesh ", mesh.num_elements(),
               " elements");

    std::size_t expected_darts = 0;
    for (const CellId e : mesh.elements()) {
        const CellTraits& t = traits(mesh.kind(e));
        expected_darts += static_cast<std::size_t>(t.num_face_corners());
        for (int f = 0; f < t.num_faces; ++f) {
            const FaceId other = mesh.neighbor({e, f});
            Dart walking = m.dart({e, f});
            for (int p = 0; p < mesh.face_size({e, f}); ++p) {
                const ConstDart d = walking;
                const VertexId n = mesh.face_corner({e, f}, p);
                const DartInfo info = complex.info(d);
                if (info != DartInfo{e.value, static_cast<std::int16_t>(f),
                                     static_cast<std::int16_t>(p)} ||
                    complex.info<3>(d) != e)
                    report("element ", e.value, " face ", f, ": a dart refers to another face");
                if (complex.info<0>(d) != n)
                    report("element ", e.value, " face ", f, " position ", p, ": the map has node ",
                           complex.info<0>(d).value, ", the mesh ", n.value);
                const Vec3& x = mesh.rest_position(n);
                if (complex.point(d) != to_point(x)) report("node ", n.value, ": points differ");
                const bool is_joined = !complex.is_free<3>(d);
                if (is_joined != other.is_valid())
                    report("element ", e.value, " face ", f,
                           ": joined in the map or the mesh only");
                else if (is_joined) {
                    const DartInfo far = complex.info(complex.beta<3>(d));
                    if (far.element != other.cell.value || far.face != other.face)
                        report("element ", e.value, " face ", f, ": the neighbours differ");
                }
                walking = m.complex_beta1(walking);
            }
        }
    }
    if (expected_darts != num_darts())
        report("the map has ", num_darts(), " darts, the mesh needs ", expected_darts);
    return found;
}

}  // namespace incise::topology
