// The way from CGAL's linear cell complex to a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "incise/base/disjoint_set.h"
#include "incise/base/error.h"
#include "incise/topology/carrier_check.h"
#include "incise/topology/complex_volume.h"
#include "incise/topology/geometry.h"
#include "incise/topology/linear_cell_complex.h"
#include "incise/topology/mesh_import.h"

namespace incise::topology {

namespace {

using ConstHandle = LinearCellComplex::Dart_const_handle;
using ConstVertex = LinearCellComplex::Attribute_const_handle<0>::type;

constexpr SourceWords words_of_complexes = {
    .name = "complex",
    .mend_faces = "mend the volume, or remove it with remove_cell<3>()",
    .mend_polyhedron = "mend the volume, or remove it with remove_cell<3>()",
    .mend_carriers =
        "mend the volume or its ComplexCell::carrier, or remove the volume with remove_cell<3>()",
    .name_carriers =
        "no ComplexCell::carrier names it; set it, give to_linear_cell_complex() the "
        "carriers of the body, or divide the volume into tetrahedra"};

[[noreturn]] void refuse(const auto&... parts) {
    std::ostringstream text;
    (text << "linear cell complex: " << ... << parts);
    throw InputError(text.str());
}

class ComplexReader {
  public:
    explicit ComplexReader(const LinearCellComplex& complex) : complex_(complex) {}

    BuiltMesh run() {
        data_.words = words_of_complexes;
        number_vertices();
        find_volumes();
        for (std::size_t c = 0; c < volumes_.size(); ++c) find_faces(c);
        orient();
        for (std::size_t c = 0; c < volumes_.size(); ++c) add(c);
        for (std::size_t c = 0; c < volumes_.size(); ++c) read_faces(c);
        if (data_.carriers.corners.empty()) data_.carriers.of_cell.clear();
        data_.points_may_coincide = true;  // a cut leaves two vertices at one position
        try {
            return import_mesh(data_, {.shared_faces = std::move(shared_),
                                       .diagonals = std::move(diagonals_),
                                       .joined_triangles = std::move(joined_triangles_),
                                       .keeps_order = true});
        } catch (const InputError& error) {
            refuse(error.what());
        }
    }

  private:
    /// A volume of the complex, which becomes a cell.
    struct Volume {
        ComplexCell info;
        std::vector<ConstHandle> darts;                 // in the order of the complex
        std::vector<ConstHandle> faces;                 // the first dart of each, in the same order
        std::vector<std::vector<std::int64_t>> points;  // by face, its points
        bool is_mirrored = false;  // true if the faces run clockwise as seen from outside
    };
    /// Where a dart is.
    struct DartPlace {
        std::size_t order = 0;  // among all darts
        std::size_t volume = 0;
        std::size_t face = 0;  // number in Volume::faces
    };

    /// Returns where an id stands in the order: after all valid ones if it is invalid.
    template <class Id>
    static std::int64_t rank(Id id) {
        return id.is_valid() ? id.value : std::numeric_limits<std::int64_t>::max();
    }
    /// Returns the ids as numbers for messages; none if one is invalid.
    static std::vector<std::int64_t> numbers_for_messages(std::vector<std::int64_t> ranks) {
        if (!ranks.empty() && ranks.back() == rank(CellId())) ranks.clear();
        return ranks;
    }

    void number_vertices() {
        std::vector<ConstVertex> vertices;
        const auto& all = complex_.attributes<0>();
        for (auto v = all.begin(); v != all.end(); ++v) vertices.push_back(v);
        const auto id_of = [&](ConstVertex v) { return rank(complex_.info_of_attribute<0>(v).id); };
        std::stable_sort(vertices.begin(), vertices.end(),
                         [&](ConstVertex a, ConstVertex b) { return id_of(a) < id_of(b); });
        std::vector<std::int64_t> ranks;
        for (const ConstVertex v : vertices) {
            const auto& x = complex_.point_of_vertex_attribute(v);
            numbers_[v] = std::ssize(data_.points);
            data_.points.emplace_back(x.x(), x.y(), x.z());
            ranks.push_back(id_of(v));
        }
        data_.source_points = numbers_for_messages(std::move(ranks));
    }

    void find_volumes() {
        std::vector<ConstHandle> all;
        for (auto d = complex_.darts().begin(); d != complex_.darts().end(); ++d) {
            if (complex_.attribute<0>(d) == nullptr) refuse("a dart has no vertex attribute");
            places_[d].order = all.size();
            all.push_back(d);
        }
        std::vector<bool> is_known(all.size(), false);
        const auto order_of = [&](ConstHandle d) { return places_.at(d).order; };
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (is_known[i]) continue;
            Volume& volume = volumes_.emplace_back();
            const auto& darts = complex_.darts_of_cell<3>(all[i]);
            for (auto d = darts.begin(); d != darts.end(); ++d) volume.darts.push_back(d);
            std::ranges::sort(volume.darts, {}, order_of);
            for (const ConstHandle d : volume.darts) is_known[order_of(d)] = true;
            if (complex_.attribute<3>(all[i]) != nullptr) volume.info = complex_.info<3>(all[i]);
        }
        std::ranges::stable_sort(volumes_, {}, [](const Volume& v) { return rank(v.info.id); });
        std::vector<std::int64_t> ranks;
        for (std::size_t c = 0; c < volumes_.size(); ++c) {
            ranks.push_back(rank(volumes_[c].info.id));
            for (const ConstHandle d : volumes_[c].darts) places_.at(d).volume = c;
        }
        data_.source_cells = numbers_for_messages(std::move(ranks));
    }

    /// Returns the name of a volume before its kind is known.
    std::string name_of(std::size_t c) const {
        const CellId id = volumes_[c].info.id;
        return "volume " + std::to_string(c) +
               (id.is_valid() ? " (number " + std::to_string(id.value) + " in the complex)" : "");
    }
    std::string text_of(ConstHandle d) const {
        const auto& x = complex_.point(d);
        std::ostringstream text;
        text << '(' << x.x() << ", " << x.y() << ", " << x.z() << ')';
        return text.str();
    }

    /// Lists the faces of a volume. Throws InputError if it is not closed.
    void find_faces(std::size_t c) {
        Volume& volume = volumes_[c];
        const auto refuse_open = [&](const std::string& what) {
            refuse(name_of(c), " is not closed: ", what,
                   "; close it with sew<2>(), or remove it with remove_cell<3>()");
        };
        for (const ConstHandle d : volume.darts)
            if (complex_.is_free<0>(d) || complex_.is_free<1>(d))
                refuse_open("a face has an edge at " + text_of(d) + " that no other one follows");
        for (const ConstHandle d : volume.darts)
            if (complex_.is_free<2>(d))
                refuse_open("the edge from " + text_of(d) + " to " + text_of(complex_.beta<1>(d)) +
                            " has only one face");
        constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
        for (const ConstHandle d : volume.darts) places_.at(d).face = none;
        for (const ConstHandle first : volume.darts) {
            if (places_.at(first).face != none) continue;
            auto& points = volume.points.emplace_back();
            ConstHandle d = first;
            do {
                points.push_back(number_of(d));
                places_.at(d).face = volume.faces.size();
                d = complex_.beta<1>(d);
            } while (d != first);
            volume.faces.push_back(first);
        }
    }

    std::int64_t number_of(ConstHandle d) const { return numbers_.at(complex_.attribute<0>(d)); }

    /// CGAL leaves it to the user whether faces run anticlockwise as seen from outside. It is the
    /// same for all volumes that are sewn.
    void orient() {
        DisjointSet sewn(volumes_.size());
        for (std::size_t c = 0; c < volumes_.size(); ++c)
            for (const ConstHandle d : volumes_[c].faces)
                if (!complex_.is_free<3>(d))
                    sewn.join(static_cast<std::int32_t>(c),
                              static_cast<std::int32_t>(places_.at(complex_.beta<3>(d)).volume));
        struct Sum {
            double volume = 0.0, largest_carrier = 0.0;
        };
        std::vector<Sum> sums(volumes_.size());
        double all = 0.0;
        const auto sum_with = [&](std::size_t c) -> Sum& {
            return sums[static_cast<std::size_t>(sewn.find(static_cast<std::int32_t>(c)))];
        };
        for (std::size_t c = 0; c < volumes_.size(); ++c) {
            const double volume = volume_as_run(volumes_[c]);
            Sum& sum = sum_with(c);
            sum.volume += volume;
            all += volume;
            if (const auto& carrier = volumes_[c].info.carrier)
                sum.largest_carrier = std::max(sum.largest_carrier,
                                               std::abs(signed_volume(carrier->kind(), *carrier)));
        }
        for (std::size_t c = 0; c < volumes_.size(); ++c) {
            const Sum& sum = sum_with(c);
            // A crumb can be turned inside out by the cut itself: it turns as the other volumes do.
            const bool is_crumb =
                std::abs(sum.volume) <= least_volume_of_part * sum.largest_carrier;
            volumes_[c].is_mirrored = (is_crumb ? all : sum.volume) < 0.0;
            if (volumes_[c].is_mirrored)
                for (auto& points : volumes_[c].points)
                    std::reverse(points.begin() + 1, points.end());
        }
    }

    /// Returns the volume, m3, negative if the faces run clockwise as seen from outside.
    double volume_as_run(const Volume& of) const {
        const auto at = [&](std::int64_t p) { return data_.points[static_cast<std::size_t>(p)]; };
        const Vec3 o = at(of.points[0][0]);
        double volume = 0.0;
        for (const auto& face : of.points)
            if (face.size() >= 3)
                volume += flux_of_face(static_cast<int>(face.size()), [&](int p) -> Vec3 {
                    return at(face[static_cast<std::size_t>(p)]) - o;
                });
        return volume;
    }

    void add(std::size_t c) {
        const Volume& volume = volumes_[c];
        const ComplexCell& info = volume.info;
        // Cuts leave polyhedra, whatever their shapes. Parts of tetrahedra can be tetrahedra.
        std::optional<VolumeOfKind> known;
        if (!info.carrier ||
            (info.carrier->kind() == CellKind::tetrahedron && info.first_edge[0].is_valid()))
            known = volume_of_kind(complex_, volume.darts, info);
        if (info.carrier && known && known->kind != CellKind::tetrahedron) known.reset();
        diagonals_.emplace_back();
        if (known)
            add_of_kind(c, *known);
        else
            add_polyhedron(volume);
        add_carrier(c);
    }

    void add_polyhedron(const Volume& volume) {
        std::vector<std::int64_t> faces{std::ssize(volume.faces)};
        for (const auto& points : volume.points) {
            faces.push_back(std::ssize(points));
            faces.insert(faces.end(), points.begin(), points.end());
        }
        data_.add_polyhedron(faces, volume.info.region);
    }

    void add_of_kind(std::size_t c, const VolumeOfKind& known) {
        const Volume& volume = volumes_[c];
        const CellTraits& t = traits(known.kind);
        std::vector<std::int64_t> corners;
        for (const ConstHandle d : known.corners) corners.push_back(number_of(d));
        diagonals_.back() = volume.info.diagonals;
        if (volume.is_mirrored) {
            const auto before = corners;
            for (std::size_t k = 0; k < before.size(); ++k)
                corners[k] = before[static_cast<std::size_t>(t.mirrored[k])];
            diagonals_.back() = with_ends_kept(volume.info.diagonals, t, before, corners);
        }
        data_.add_cell(known.kind, corners, volume.info.region);
        std::vector<Vec3> x;
        for (const std::int64_t p : corners) x.push_back(data_.points[static_cast<std::size_t>(p)]);
        if (const double size = signed_volume(known.kind, x); size < 0.0)
            refuse(data_.cell_name(c), " is turned inside out: it has the volume ", size,
                   ", and those that it is sewn to have positive ones; move its vertices, or "
                   "remove it with remove_cell<3>()");
    }

    /// Returns diagonals between the same points, for corners in another order: a diagonal keeps
    /// its ends, on a face that may have another number.
    static Diagonals with_ends_kept(Diagonals diagonals, const CellTraits& t,
                                    const std::vector<std::int64_t>& before,
                                    const std::vector<std::int64_t>& corners) {
        const auto ends = [&](const std::vector<std::int64_t>& of, int f, int first) {
            const auto at = [&](int p) {
                return of[static_cast<std::size_t>(t.face(f)[static_cast<std::size_t>(p)])];
            };
            return std::pair(std::min(at(first), at(first + 2)),
                             std::max(at(first), at(first + 2)));
        };
        Diagonals turned;
        for (int f = 0; f < t.num_faces; ++f)
            for (int g = 0; g < t.num_faces && diagonals.divides(f); ++g)
                for (int p = 0; p < 2 && t.face(g).size() == 4; ++p)
                    if (ends(corners, g, p) == ends(before, f, diagonals.first_end(f)))
                        turned.divide(g, p);
        return turned;
    }

    void add_carrier(std::size_t c) {
        data_.carriers.of_cell.push_back(Carriers::whole);
        const auto& carrier = volumes_[c].info.carrier;
        if (!carrier) return;
        if (!carrier->diagonals.fits(carrier->kind()))
            refuse("the carrier of ", data_.cell_name(c),
                   " divides faces that its kind does not have; set its diagonals anew");
        std::vector<double> key{static_cast<double>(carrier->kind()),
                                static_cast<double>(carrier->diagonals.bits())};
        for (const Vec3& x : *carrier) key.insert(key.end(), x.begin(), x.end());
        auto& rows = data_.carriers.corners;
        const auto [row, is_new] = rows_.try_emplace(key, std::ssize(rows));
        if (is_new) rows.push_back(*carrier);
        data_.carriers.of_cell.back() = row->second;
    }

    bool is_polyhedron(std::size_t c) const { return data_.kinds[c] == CellKind::polyhedron; }

    /// Returns the number in its cell of the face of a dart. A half of a divided face has the
    /// number of that face.
    SourceFace source_face(ConstHandle d) const {
        const DartPlace& place = places_.at(d);
        const std::size_t c = place.volume;
        if (is_polyhedron(c)) return {c, static_cast<int>(place.face)};
        const auto& points = volumes_[c].points[place.face];
        const CellTraits& t = traits(data_.kinds[c]);
        for (int f = 0; f < t.num_faces; ++f) {
            const auto face = t.face(f);
            const auto num_common = std::ranges::count_if(face, [&](int k) {
                return std::ranges::find(points, data_.cell(c)[static_cast<std::size_t>(k)]) !=
                       points.end();
            });
            if (num_common == std::ssize(points) &&
                (face.size() == points.size() || (diagonals_[c].divides(f) && points.size() == 3)))
                return {c, f};
        }
        refuse(data_.cell_name(c), " has a face with other corners than the cell");
    }

    /// Says which faces of a cell are joined, and which are on cuts.
    void read_faces(std::size_t c) {
        for (const ConstHandle d : volumes_[c].faces) {
            const SourceFace here = source_face(d);
            if (complex_.is_free<3>(d)) {
                if (complex_.attribute<2>(d) != nullptr && complex_.info<2>(d).is_on_cut)
                    data_.set_on_cut(c, here.face);
                continue;
            }
            const ConstHandle far = complex_.beta<3>(d);
            const SourceFace there = source_face(far);
            if (diagonals_[c].divides(here.face)) continue;  // the other cell joins the two
            if (shift_between(volumes_[c].points[places_.at(d).face],
                              volumes_[there.cell].points[places_.at(far).face]) < 0)
                refuse("the sewn faces of ", data_.cell_name(c), " and ",
                       data_.cell_name(there.cell),
                       " have other vertices; take them apart with unsew<3>()");
            if (diagonals_[there.cell].divides(there.face))
                joined_triangles_.emplace_back(there, here);
            else if (here < there)
                shared_.push_back({here, there, shift_of(here, there)});
        }
    }

    /// Returns the position in `b` of the point at position 0 of `a`, if both have the same points
    /// in opposite directions; else -1.
    static int shift_between(const std::vector<std::int64_t>& a,
                             const std::vector<std::int64_t>& b) {
        if (a.size() != b.size()) return -1;
        for (std::size_t shift = 0; shift < a.size(); ++shift) {
            bool fits = true;
            for (std::size_t p = 0; p < a.size() && fits; ++p)
                fits = a[p] == b[(shift + a.size() - p) % a.size()];
            if (fits) return static_cast<int>(shift);
        }
        return -1;
    }

    /// The same for two faces as the cells name them.
    int shift_of(SourceFace a, SourceFace b) const {
        const auto points = [&](SourceFace f) {
            if (is_polyhedron(f.cell))
                return volumes_[f.cell].points[static_cast<std::size_t>(f.face)];
            std::vector<std::int64_t> found;
            for (const int k : traits(data_.kinds[f.cell]).face(f.face))
                found.push_back(data_.cell(f.cell)[static_cast<std::size_t>(k)]);
            return found;
        };
        return shift_between(points(a), points(b));
    }

    const LinearCellComplex& complex_;
    std::unordered_map<ConstVertex, std::int64_t> numbers_;
    std::unordered_map<ConstHandle, DartPlace> places_;
    std::vector<Volume> volumes_;  // in the order of the cells
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
