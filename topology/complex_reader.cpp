// The way from CGAL's linear cell complex to a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "incise/base/error.h"
#include "incise/topology/geometry.h"
#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh_import.h"

namespace incise::topology {

namespace {

using ConstHandle = LinearCellComplex::Dart_const_handle;
using ConstVertex = LinearCellComplex::Attribute_const_handle<0>::type;

/// The face and position of a dart in its cell. The dart starts at the corner that cell_kind.h
/// lists there.
struct DartPlace {
    int face = -1, position = -1;
};
template <class Value>
using ByPlace = std::array<std::array<Value, max_face_corners>, max_faces>;

/// Returns for each dart of a kind of cell the dart along the same edge on the other face there.
constexpr ByPlace<DartPlace> opposite_darts(const CellTraits& t) {
    ByPlace<DartPlace> places{};
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

constexpr std::array<ByPlace<DartPlace>, num_cell_kinds> opposite_places = {
    opposite_darts(cell_traits[0]), opposite_darts(cell_traits[1]), opposite_darts(cell_traits[2]),
    opposite_darts(cell_traits[3])};

auto& at(auto& by_place, int face, int position) {
    return by_place[static_cast<std::size_t>(face)][static_cast<std::size_t>(position)];
}

/// Visits the places of all darts of a kind of cell: visit(face, position).
void for_each_place(const CellTraits& t, auto visit) {
    for (int f = 0; f < t.num_faces; ++f)
        for (int p = 0; p < static_cast<int>(t.face(f).size()); ++p) visit(f, p);
}

class ComplexReader {
  public:
    explicit ComplexReader(const LinearCellComplex& complex) : complex_(complex) {}

    BuiltMesh run() {
        number_vertices();
        find_cells();
        for (const Cell& cell : cells_) add(cell);
        for (std::size_t c = 0; c < cells_.size(); ++c) read_faces(c);
        data_.points_may_coincide = true;  // a cut leaves two vertices at one position
        return import_mesh(data_, {.shared_faces = std::move(shared_),
                                   .diagonals = std::move(diagonals_),
                                   .joined_triangles = std::move(joined_triangles_),
                                   .keeps_order = true});
    }

  private:
    struct Cell {
        CellKind kind{};
        ComplexCell info;
        std::vector<ConstHandle> darts;
        std::vector<std::int64_t> corners;
    };

    /// Returns where an id stands in the order: after all valid ones if it is invalid.
    template <class Id>
    static std::int64_t rank(Id id) {
        return id.is_valid() ? id.value : std::numeric_limits<std::int64_t>::max();
    }

    void number_vertices() {
        std::vector<ConstVertex> vertices;
        const auto& all = complex_.attributes<0>();
        for (auto v = all.begin(); v != all.end(); ++v) vertices.push_back(v);
        const auto id_of = [&](ConstVertex v) { return rank(complex_.info_of_attribute<0>(v).id); };
        std::stable_sort(vertices.begin(), vertices.end(),
                         [&](ConstVertex a, ConstVertex b) { return id_of(a) < id_of(b); });
        for (const ConstVertex v : vertices) {
            const auto& x = complex_.point_of_vertex_attribute(v);
            numbers_[v] = std::ssize(data_.points);
            data_.points.emplace_back(x.x(), x.y(), x.z());
        }
    }

    void find_cells() {
        const auto& volumes = complex_.one_dart_per_cell<3>();
        for (auto d = volumes.begin(); d != volumes.end(); ++d) {
            Cell cell;
            const auto& darts = complex_.darts_of_cell<3>(d);
            for (auto it = darts.begin(); it != darts.end(); ++it) cell.darts.push_back(it);
            if (complex_.attribute<3>(d) != nullptr) cell.info = complex_.info<3>(d);
            read_corners(cell);
            cells_.push_back(std::move(cell));
        }
        std::stable_sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
            return rank(a.info.id) < rank(b.info.id);
        });
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (const ConstHandle d : cells_[c].darts) cell_of_[d] = c;
    }

    std::int64_t number_of(ConstHandle d) const {
        const ConstVertex v = complex_.attribute<0>(d);
        if (v == nullptr) throw InputError("linear cell complex: a dart has no vertex attribute");
        return numbers_.at(v);
    }

    /// Returns the dart that follows in a face before it was divided; null if there is none.
    ConstHandle next_of_whole(const Cell& cell, DartPlace at, ConstHandle d) const {
        const ConstHandle next = complex_.beta<1>(d);
        const int first = cell.info.diagonals.first_end(at.face);
        if (first < 0 || (at.position + 1 - first) % 2 != 0) return next;
        const ConstHandle other_half = complex_.beta<2>(next);
        return complex_.is_free<2>(next) || complex_.is_free<1>(other_half)
                   ? ConstHandle(nullptr)
                   : complex_.beta<1>(other_half);
    }

    /// Gives the corners of a cell their places, with `first` as the first dart of the first face.
    /// Returns false if the cell is of another kind.
    bool place_corners(Cell& cell, ConstHandle first) const {
        const CellTraits& t = traits(cell.kind);
        ByPlace<ConstHandle> darts{};
        at(darts, 0, 0) = first;
        std::vector<std::pair<DartPlace, ConstHandle>> open{{{0, 0}, first}};
        bool fits = true;
        const auto reach = [&](int f, int p, ConstHandle d) {
            ConstHandle& known = at(darts, f, p);
            if (known == nullptr) open.push_back({{f, p}, d});
            if (known == nullptr) known = d;
            fits = fits && known == d;
        };
        while (fits && !open.empty()) {
            const auto [place, d] = open.back();
            open.pop_back();
            const int size = static_cast<int>(t.face(place.face).size());
            if (complex_.is_free<1>(d) || complex_.is_free<2>(d)) return false;
            const ConstHandle next = next_of_whole(cell, place, d);
            if (next == nullptr) return false;
            reach(place.face, (place.position + 1) % size, next);
            const DartPlace other = at(opposite_places[static_cast<std::size_t>(cell.kind)],
                                       place.face, place.position);
            reach(other.face, other.position, complex_.beta<2>(d));
        }
        if (!fits) return false;
        cell.corners.assign(static_cast<std::size_t>(t.num_corners), -1);
        for_each_place(t, [&](int f, int p) {
            std::int64_t& corner =
                cell.corners[static_cast<std::size_t>(t.face(f)[static_cast<std::size_t>(p)])];
            const std::int64_t number = number_of(at(darts, f, p));
            fits = fits && (corner == -1 || corner == number);
            corner = number;
        });
        return fits;
    }

    void read_corners(Cell& cell) const {
        const auto is_first = [&](ConstHandle d) {
            const auto id = [&](ConstHandle dart) {
                const ConstVertex v = complex_.attribute<0>(dart);
                return v == nullptr ? VertexId() : complex_.info_of_attribute<0>(v).id;
            };
            return id(d).is_valid() && !complex_.is_free<1>(d) &&
                   std::array{id(d), id(complex_.beta<1>(d))} == cell.info.first_edge;
        };
        std::stable_partition(cell.darts.begin(), cell.darts.end(), is_first);
        for (int k = 0; k < num_cell_kinds; ++k) {
            cell.kind = static_cast<CellKind>(k);
            const Diagonals diagonals = cell.info.diagonals;
            if (!diagonals.fits(cell.kind) ||
                std::ssize(cell.darts) !=
                    traits(cell.kind).num_face_corners() + 2 * diagonals.count())
                continue;
            for (const ConstHandle d : cell.darts)
                if (place_corners(cell, d)) {
                    orient(cell);
                    return;
                }
        }
        std::ostringstream text;
        text << "linear cell complex: a volume of " << cell.darts.size() << " darts";
        if (cell.info.id.is_valid()) text << ", cell " << cell.info.id.value << ",";
        text << " is no tetrahedron, hexahedron, wedge or pyramid";
        throw InputError(text.str());
    }

    /// CGAL leaves it to the user whether faces run anticlockwise as seen from outside.
    void orient(Cell& cell) const {
        std::vector<Vec3> x;
        for (const std::int64_t p : cell.corners)
            x.push_back(data_.points[static_cast<std::size_t>(p)]);
        if (!(signed_volume(cell.kind, x) < 0.0)) return;  // import says what is not finite
        const auto before = cell.corners;
        for (std::size_t k = 0; k < before.size(); ++k)
            cell.corners[k] = before[static_cast<std::size_t>(traits(cell.kind).mirrored[k])];
        // A diagonal keeps its ends, on a face that may have another number.
        const CellTraits& t = traits(cell.kind);
        const auto ends = [&](const std::vector<std::int64_t>& corners, int f, int first) {
            const auto at = [&](int p) {
                return corners[static_cast<std::size_t>(t.face(f)[static_cast<std::size_t>(p)])];
            };
            return std::pair(std::min(at(first), at(first + 2)),
                             std::max(at(first), at(first + 2)));
        };
        Diagonals turned;
        for (int f = 0; f < t.num_faces; ++f)
            for (int g = 0; g < t.num_faces && cell.info.diagonals.divides(f); ++g)
                for (int p = 0; p < 2 && t.face(g).size() == 4; ++p)
                    if (ends(cell.corners, g, p) ==
                        ends(before, f, cell.info.diagonals.first_end(f)))
                        turned.divide(g, p);
        cell.info.diagonals = turned;
    }

    void add(const Cell& cell) {
        data_.add_cell(cell.kind, cell.corners, cell.info.region);
        data_.carriers.of_cell.push_back(Carriers::whole);
        if (!cell.info.carrier) return;
        std::vector<double> key{static_cast<double>(cell.info.carrier->kind())};
        for (const Vec3& x : *cell.info.carrier) key.insert(key.end(), x.begin(), x.end());
        auto& rows = data_.carriers.corners;
        const auto [row, is_new] = rows_.try_emplace(key, std::ssize(rows));
        if (is_new) rows.push_back(*cell.info.carrier);
        data_.carriers.of_cell.back() = row->second;
    }

    /// Returns the number of the face of a dart in its cell.
    int face_of(const Cell& cell, ConstHandle d) const {
        std::vector<std::int64_t> points;
        ConstHandle walking = d;
        do {
            points.push_back(number_of(walking));
            walking = complex_.beta<1>(walking);
        } while (walking != d);
        const CellTraits& t = traits(cell.kind);
        for (int f = 0; f < t.num_faces; ++f) {
            const auto face = t.face(f);
            const auto num_common = std::ranges::count_if(face, [&](int k) {
                return std::ranges::find(points, cell.corners[static_cast<std::size_t>(k)]) !=
                       points.end();
            });
            // Both have the same corners, or it is a half of the face.
            if (num_common == std::ssize(points) &&
                (face.size() == points.size() ||
                 (cell.info.diagonals.divides(f) && points.size() == 3)))
                return f;
        }
        throw InputError("linear cell complex: a face has other corners than its cell");
    }

    void read_faces(std::size_t c) {
        const Cell& cell = cells_[c];
        std::array<bool, max_faces> is_read{};
        std::int32_t on_cuts = 0;
        for (const ConstHandle d : cell.darts) {
            const int f = face_of(cell, d);
            if (cell.info.diagonals.divides(f)) {
                if (complex_.is_free<3>(d) && complex_.attribute<2>(d) != nullptr &&
                    complex_.info<2>(d).is_on_cut)
                    on_cuts |= 1 << f;
                continue;
            }
            if (std::exchange(is_read[static_cast<std::size_t>(f)], true)) continue;
            if (complex_.is_free<3>(d)) {
                if (complex_.attribute<2>(d) != nullptr && complex_.info<2>(d).is_on_cut)
                    on_cuts |= 1 << f;
                continue;
            }
            const ConstHandle far = complex_.beta<3>(d);
            const std::size_t other = cell_of_.at(far);
            const SourceFace here{c, f}, there{other, face_of(cells_[other], far)};
            if (cells_[other].info.diagonals.divides(there.face))
                join_triangle(there, here);
            else if (here < there)
                shared_.push_back({here, there, shift_of(here, there)});
        }
        data_.cut_faces.push_back(on_cuts);
        diagonals_.push_back(cell.info.diagonals);
    }

    void join_triangle(SourceFace quad, SourceFace triangle) {
        const Cell &of_quad = cells_[quad.cell], &of_triangle = cells_[triangle.cell];
        for (const int k : traits(of_triangle.kind).face(triangle.face))
            if (std::ranges::find(of_quad.corners,
                                  of_triangle.corners[static_cast<std::size_t>(k)]) ==
                of_quad.corners.end())
                refuse_sewn_faces();
        joined_triangles_.emplace_back(quad, triangle);
    }
    [[noreturn]] static void refuse_sewn_faces() {
        throw InputError("linear cell complex: two faces that are sewn have other vertices");
    }

    /// Returns the position in a face of a cell of the point at position 0 of another face.
    int shift_of(SourceFace a, SourceFace b) const {
        const auto point = [&](SourceFace face, int position) {
            const Cell& cell = cells_[face.cell];
            return cell.corners[static_cast<std::size_t>(
                traits(cell.kind).face(face.face)[static_cast<std::size_t>(position)])];
        };
        const int size = static_cast<int>(traits(cells_[a.cell].kind).face(a.face).size());
        for (int shift = 0; shift < size; ++shift) {
            bool fits = true;
            for (int p = 0; p < size && fits; ++p)
                fits = point(a, p) == point(b, (shift - p + size) % size);
            if (fits) return shift;
        }
        refuse_sewn_faces();
    }

    const LinearCellComplex& complex_;
    std::unordered_map<ConstVertex, std::int64_t> numbers_;
    std::unordered_map<ConstHandle, std::size_t> cell_of_;
    std::vector<Cell> cells_;
    MeshData data_;
    std::map<std::vector<double>, std::int64_t> rows_;  // of carriers, by their corners
    std::vector<SharedFace> shared_;
    std::vector<Diagonals> diagonals_;                                 // by cell
    std::vector<std::pair<SourceFace, SourceFace>> joined_triangles_;  // see ImportRules
};

}  // namespace

BuiltMesh from_linear_cell_complex(const LinearCellComplex& complex) {
    return ComplexReader(complex).run();
}

}  // namespace incise::topology
