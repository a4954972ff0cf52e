// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <sstream>

#include "incise/topology/carrier_check.h"
#include "incise/topology/cell_advice.h"
#include "incise/topology/corner_check.h"
#include "incise/topology/equal_faces.h"
#include "incise/topology/flat_cell.h"
#include "incise/topology/geometry.h"
#include "incise/topology/joined_quads.h"
#include "incise/topology/mesh_repair.h"
#include "incise/topology/polyhedron_check.h"

namespace incise::topology {

namespace {

/// A list of errors that contains the first few of each kind and counts the others.
class Complaints {
  public:
    explicit Complaints(std::vector<std::string>& lines) : lines_(lines) {}

    /// True if the next error of the kind will be listed, and not only counted.
    bool lists_next(const char* kind) const {
        const auto it = counts_.find(kind);
        return it == counts_.end() || it->second < max_listed;
    }

    template <class... Parts>
    void add(const char* kind, const Parts&... parts) {
        if (++counts_[kind] > max_listed) return;
        std::ostringstream text;
        text.precision(6);
        (text << ... << parts);
        lines_.push_back(text.str());
    }

    void finish() {
        for (const auto& [kind, count] : counts_)
            if (count > max_listed)
                lines_.push_back("and " + std::to_string(count - max_listed) + " more " + kind);
    }

  private:
    static constexpr std::size_t max_listed = 5;
    std::vector<std::string>& lines_;
    std::map<std::string, std::size_t> counts_;
};

/// Returns an error of MeshData::cut_faces of a cell; empty if there is none.
std::string fault_of_cut_faces(const MeshData& data, std::size_t c, int num_faces) {
    int first = 0;  // face of the list
    const auto fault = [&](std::int32_t faces) -> std::string {
        const int count = std::clamp(num_faces - first, 0, max_cut_faces);
        if (faces >= 0 && faces >> count == 0) return "";
        const std::string name = "cut_faces" + (first == 0 ? "" : "_" + std::to_string(first));
        return data.cell_name(c) + " has the " + name + " " + std::to_string(faces) +
               ", which must be one bit for each of its " + std::to_string(num_faces) + " faces" +
               (first == 0 ? "" : " from face " + std::to_string(first) + " on") +
               "; write the file again, or leave out its cell array '" + name + "'";
    };
    std::string found = data.cut_faces.empty() ? "" : fault(data.cut_faces[c]);
    for (const auto& further : data.further_cut_faces) {
        first += max_cut_faces;
        if (found.empty()) found = fault(further[c]);
    }
    return found;
}

/// Returns the error of polyhedra without carriers; empty if all have one.
std::string fault_of_polyhedra_alone(const MeshData& data) {
    const auto is_alone = [&](std::size_t c) {
        return data.kinds[c] == CellKind::polyhedron &&
               (c >= data.carriers.of_cell.size() || data.carriers.of_cell[c] == Carriers::whole);
    };
    std::size_t first = 0, count = 0;
    for (std::size_t c = data.num_cells(); c-- > 0;)
        if (is_alone(c)) {
            first = c;
            ++count;
        }
    if (count == 0) return "";
    return data.cell_name(first) +
           (count == 1 ? "" : " and " + std::to_string(count - 1) + " more") +
           " without a carrier: forces need the tetrahedron, hexahedron, wedge or pyramid that a "
           "polyhedron is a part of, and " +
           data.words.name_carriers;
}

/// Returns an error of the lists themselves; empty if all cells can be read.
std::string fault_of_lists(const MeshData& data) {
    const std::size_t num_cells = data.kinds.size();
    const auto is_one_each = [](std::size_t size, std::size_t count) {
        return size == 0 || size == count;  // optional lists may be empty
    };
    if (data.offsets.size() != num_cells + 1)
        return "offsets has " + std::to_string(data.offsets.size()) + " entries for " +
               std::to_string(num_cells) + " cells, and needs one more than cells";
    if (data.regions.size() != num_cells)
        return "regions has " + std::to_string(data.regions.size()) + " entries for " +
               std::to_string(num_cells) + " cells";
    for (std::size_t k = 0; k <= data.further_cut_faces.size(); ++k)
        if (const auto& list = k == 0 ? data.cut_faces : data.further_cut_faces[k - 1];
            !(list.size() == num_cells || (k == 0 && list.empty())))
            return (k == 0 ? "cut_faces has "
                           : "list " + std::to_string(k - 1) + " of further_cut_faces has ") +
                   std::to_string(list.size()) + " entries for " + std::to_string(num_cells) +
                   " cells";
    if (!is_one_each(data.welded_to.size(), data.points.size()))
        return "welded_to has " + std::to_string(data.welded_to.size()) + " entries for " +
               std::to_string(data.points.size()) + " points";
    if (!std::ranges::all_of(data.welded_to, [&](std::int64_t p) {
            return p >= 0 && p < static_cast<std::int64_t>(data.points.size());
        }))
        return "welded_to names a point that is not there";
    if (data.offsets.front() != 0 || data.offsets.back() != data.corners.size())
        return "offsets has to begin with 0 and to end with the number of corners, " +
               std::to_string(data.corners.size());
    for (std::size_t c = 0; c < num_cells; ++c) {
        if (static_cast<std::size_t>(data.kinds[c]) > num_cell_kinds)
            return "cell " + std::to_string(c) + " is of no kind that is known";
        const CellTraits& t = traits(data.kinds[c]);
        if (data.kinds[c] == CellKind::polyhedron) {
            if (data.offsets[c + 1] < data.offsets[c] || data.offsets[c + 1] > data.corners.size())
                return "cell " + std::to_string(c) + " (polyhedron) has offsets out of range";
        } else if (data.offsets[c + 1] !=
                   data.offsets[c] + static_cast<std::size_t>(t.num_corners)) {
            return "cell " + std::to_string(c) + " (" + t.name + ") needs " +
                   std::to_string(t.num_corners) + " corners, and offsets gives it another number";
        }
    }
    if (std::string fault = fault_of_polyhedra_alone(data); !fault.empty()) return fault;
    if (std::string fault = fault_of_face_lists(data); !fault.empty()) return fault;
    const SourceFaces faces(data);
    for (std::size_t c = 0; c < num_cells; ++c)
        if (std::string fault = fault_of_cut_faces(data, c, faces.num_faces(c)); !fault.empty())
            return fault;
    return "";
}

/// Returns the advice for a cell with a repeated corner: to write it as the kind that it is.
std::string advice_of_collapsed(const MeshData& data, std::size_t c) {
    if (data.kinds[c] == CellKind::polyhedron) return "; remove the cell";
    const auto cell = collapsed_cell(data.kinds[c], data.cell(c));
    if (!cell) return "; remove the cell";
    const bool is_numbered_in_file = !data.source_points.empty();
    std::string points;
    for (const std::int64_t p : cell->corners) {
        const auto point = static_cast<std::size_t>(p);
        points += (points.empty() ? "" : ", ") +
                  std::to_string(is_numbered_in_file ? data.source_points[point] : p);
    }
    const std::string name = traits(cell->kind).name;
    return ", so that it is a " + name + ": write it as a " + name + " of the points " + points +
           (is_numbered_in_file ? std::string(" of the ") + data.words.name : "") +
           ", in VTK's order";
}

/// Returns false if it complains, or if a point of the cell is not finite.
bool corners_are_usable(const MeshData& data, std::size_t c, Complaints& complaints) {
    const auto corners = data.cell(c);
    const auto num_points = static_cast<std::int64_t>(data.points.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
        if (corners[k] < 0 || corners[k] >= num_points) {
            complaints.add("cells with a node index out of range", data.cell_name(c),
                           ": node index ", corners[k], " is out of range (", num_points,
                           " points)");
            return false;
        }
        for (std::size_t j = 0; j < k; ++j)
            if (corners[j] == corners[k]) {
                constexpr const char* repeated = "cells with a repeated corner";
                complaints.add(repeated, data.cell_name(c), ": ",
                               data.point_name(static_cast<std::size_t>(corners[k])),
                               " stands at two of its corners",
                               data.welded_to.empty() ? "" : " after welding",
                               complaints.lists_next(repeated) ? advice_of_collapsed(data, c) : "");
                return false;
            }
    }
    for (const std::int64_t p : corners)
        // The point is reported elsewhere.
        if (!data.points[static_cast<std::size_t>(p)].allFinite()) return false;
    return true;
}

/// Returns the advice for a cell whose corners are in a wrong order, or nothing if no order is
/// known that makes it sound.
std::optional<std::string> advice_of_order(CellKind kind, std::span<const Vec3> x) {
    const auto order = sound_order(kind, x);
    if (!order) return std::nullopt;
    std::string text = "take them in the order ";
    for (std::size_t k = 0; k < x.size(); ++k)
        text += (k == 0 ? "" : ", ") + std::to_string((*order)[k]);
    return text + " (counted from 0)";
}

/// Returns false if it complains: the polyhedron is no ball. What its volume may be depends on its
/// carrier: see fault_of_carriers().
bool check_polyhedron(const MeshData& data, const SourceFaces& faces, std::size_t c,
                      Complaints& complaints) {
    const std::string fault = fault_of_polyhedron(data, faces, c);
    if (!fault.empty()) complaints.add("polyhedra that are no balls", fault);
    return fault.empty();
}

/// Returns false if it complains: the cell has no positive volume, or is turned inside out at a
/// corner.
bool check_volume(const MeshData& data, std::size_t c, Complaints& complaints) {
    std::array<Vec3, max_corners> all;
    const auto corners = data.cell(c);
    const std::span<Vec3> x(all.data(), corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k)
        x[k] = data.points[static_cast<std::size_t>(corners[k])];
    const CellKind kind = data.kinds[c];
    const double volume = signed_volume(kind, x);
    if (!std::isfinite(volume)) {
        complaints.add("cells of no finite volume", data.cell_name(c),
                       " has no finite volume; its coordinates are too large: scale the mesh");
        return false;
    }
    const bool is_tetrahedron = kind == CellKind::tetrahedron;
    const auto inverted = is_tetrahedron ? std::nullopt : first_inverted_corner(kind, x);
    if (volume > 0.0 && !inverted) return true;
    if (const auto advice = advice_of_order(kind, x)) {
        if (volume < 0.0)
            complaints.add("cells without positive volume", data.cell_name(c),
                           " has negative volume ", volume,
                           "; its corners run the wrong way round: ", *advice);
        else
            complaints.add("cells with corners in a wrong order", data.cell_name(c),
                           " has its corners in a wrong order: ", *advice);
    } else if (volume == 0.0) {
        complaints.add("cells without positive volume", data.cell_name(c),
                       " has zero volume; remove it or remesh");
    } else if (is_flat_to_rounding(kind, x, volume)) {
        complaints.add("cells without positive volume", data.cell_name(c),
                       " is flat: its volume of ", volume,
                       " is nothing but rounding; remove it or remesh");
    } else if (volume < 0.0) {
        complaints.add("cells without positive volume", data.cell_name(c), " has negative volume ",
                       volume,
                       "; it is distorted, or its corners are in no usual order: remesh it, or "
                       "compare their order with that of VTK");
    } else {
        const auto point = corners[static_cast<std::size_t>(*inverted)];
        complaints.add("cells with a corner turned inside out", data.cell_name(c),
                       " is turned inside out or flat at its corner ", *inverted, ", ",
                       data.point_name(static_cast<std::size_t>(point)), "; remesh it");
    }
    return false;
}

/// Returns a text with number_of(face) for the first few faces and the number of the others.
/// @pre  at least two faces
template <class NumberOf>
std::string number_list(std::span<const FaceKey> faces, NumberOf number_of) {
    constexpr std::size_t max_listed = 5;
    const std::size_t num_listed = faces.size() > max_listed + 1 ? max_listed : faces.size() - 1;
    std::string text = std::to_string(number_of(faces[0]));
    for (std::size_t k = 1; k < num_listed; ++k) text += ", " + std::to_string(number_of(faces[k]));
    return text + " and " +
           (num_listed + 1 == faces.size() ? std::to_string(number_of(faces.back()))
                                           : std::to_string(faces.size() - num_listed) + " more");
}

std::string cell_numbers(const MeshData& data, std::span<const FaceKey> faces) {
    std::string here = number_list(faces, [](const FaceKey& f) { return f.face.cell; });
    if (data.source_cells.empty()) return here;
    return here + " (in the " + data.words.name + " " +
           number_list(faces, [&](const FaceKey& f) { return data.source_cells[f.face.cell]; }) +
           ")";
}

bool same_points(const MeshData& data, std::size_t a, std::size_t b) {
    if (data.kinds[a] != data.kinds[b]) return false;
    std::vector<std::int64_t> x(data.cell(a).begin(), data.cell(a).end());
    std::vector<std::int64_t> y(data.cell(b).begin(), data.cell(b).end());
    std::sort(x.begin(), x.end());
    std::sort(y.begin(), y.end());
    return x == y;
}

/// True if two cells have the same nodes, so that one of them is too much. Flat polyhedra on both
/// sides of a face can have them, too, and do not overlap.
bool are_duplicates(const MeshData& data, std::size_t a, std::size_t b) {
    return data.kinds[a] != CellKind::polyhedron && same_points(data, a, b);
}

/// @param are_sound  false if one of the cells is turned inside out. That it lies on the wrong side
///                   of its neighbours follows from that, and is no error of its own.
void check_pair(const MeshData& data, const SourceFaces& faces, SourceFace a, SourceFace b,
                bool are_sound, MeshCheck& result, Complaints& complaints) {
    if (are_duplicates(data, a.cell, b.cell)) {
        if (a.face == 0)  // one report for each pair of cells, not for each face
            complaints.add("duplicate cells", data.cell_name(a.cell), " and ",
                           data.cell_name(b.cell), " have the same nodes; remove one of them");
        return;
    }
    const int size = faces.size(a);
    int shift = 0;
    while (faces.point(b, shift) != faces.point(a, 0)) ++shift;
    bool opposite = true, parallel = true;
    for (int p = 0; p < size; ++p) {
        const std::int64_t point = faces.point(a, p);
        opposite = opposite && faces.point(b, (shift + size - p) % size) == point;
        parallel = parallel && faces.point(b, (shift + p) % size) == point;
    }
    if (opposite)
        result.shared_faces.push_back({a, b, shift});
    else if (!are_sound)
        return;
    else if (parallel)
        complaints.add("overlapping neighbours", data.cell_name(a.cell), " and ",
                       data.cell_name(b.cell),
                       " lie on the same side of the face that they share, so they overlap; "
                       "remove one of them");
    else
        complaints.add("twisted neighbours", data.cell_name(a.cell), " and ",
                       data.cell_name(b.cell), " share ", size == 4 ? "four" : std::to_string(size),
                       " nodes but join them in different orders; remesh");
}

}  // namespace

MeshCheck check(const MeshData& data, const WeldAdvice& advice) {
    MeshCheck result;
    Complaints errors(result.errors), warnings(result.warnings);
    if (data.num_cells() == 0) {
        result.errors.emplace_back(
            "holds no tetrahedra, hexahedra, wedges or pyramids: a volume mesh is needed");
        return result;
    }

    if (std::string fault = fault_of_lists(data); !fault.empty()) {
        result.errors.push_back(std::move(fault));
        return result;
    }

    const SourceFaces source_faces(data);
    std::vector<std::uint8_t> used(data.points.size(), 0);
    std::vector<std::uint8_t> usable(data.num_cells(), 0), sound(data.num_cells(), 0);
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        for (const std::int64_t p : data.cell(c))
            if (p >= 0 && p < static_cast<std::int64_t>(used.size()))
                used[static_cast<std::size_t>(p)] = 1;
        usable[c] = corners_are_usable(data, c, errors);
        sound[c] = usable[c] && (data.kinds[c] == CellKind::polyhedron
                                     ? check_polyhedron(data, source_faces, c, errors)
                                     : check_volume(data, c, errors));
    }
    for (std::size_t p = 0; p < data.points.size(); ++p) {
        if (used[p] && !data.points[p].allFinite())
            errors.add("points that are not finite", data.point_name(p), " is not finite: (",
                       data.points[p].x(), ", ", data.points[p].y(), ", ", data.points[p].z(), ")");
        if (!used[p] && !data.is_welded(p))
            warnings.add("points that no cell uses", data.point_name(p),
                         " belongs to no cell and is left out");
    }

    std::vector<FaceKey> faces = sorted_faces(data, source_faces, usable);
    result.shared_faces.reserve(faces.size() / 2);
    std::vector<SourceFace> boundary;
    for_each_equal_faces(data, faces, [&](const EqualFaces& same) {
        if (same.is_lone()) boundary.push_back(same.inner[0].face);
        if (same.num_meeting() == 2) {
            const auto [a, b] = same.joined();
            check_pair(data, source_faces, a, b, sound[a.cell] && sound[b.cell], result, errors);
        }
        if (same.num_meeting() > 2)
            errors.add(
                "faces shared by more than two cells", "cells ", cell_numbers(data, same.inner),
                " all share one face; a face joins two cells at the most: remove the others");
    });
    std::sort(result.shared_faces.begin(), result.shared_faces.end(),
              [](const SharedFace& a, const SharedFace& b) { return a.a < b.a; });
    result.joined_quads = find_joined_quads(data, source_faces, boundary);
    errors.finish();
    warnings.finish();
    if (result.errors.empty())
        if (std::string fault = fault_of_carriers(data, result.shared_faces); !fault.empty())
            result.errors.push_back(std::move(fault));
    if (result.errors.empty())
        if (auto warning = coincidence_warning(data, advice))
            result.warnings.push_back(std::move(*warning));
    return result;
}

}  // namespace incise::topology
