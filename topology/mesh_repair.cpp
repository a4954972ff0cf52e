// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/topology/flat_cell.h"
#include "incise/topology/geometry.h"
#include "incise/topology/source_faces.h"
#include "incise/topology/weld_outlook.h"

namespace incise::topology {

namespace {

const Vec3& position_of(const MeshData& data, std::int64_t point) {
    return data.points[static_cast<std::size_t>(point)];
}

/// Returns the length of the shortest edge. If squares of lengths overflow or underflow, it returns
/// zero, so that only equal positions count as one.
double shortest_edge(const MeshData& data) {
    double shortest = std::numeric_limits<double>::infinity();
    const SourceFaces faces(data);
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        if (data.kinds[c] == CellKind::polyhedron)
            for (int f = 0; f < faces.num_faces(c); ++f)
                for (int p = faces.size({c, f}) - 1, q = 0; q < faces.size({c, f}); p = q++)
                    shortest = std::min(
                        shortest,
                        (faces.position({c, f}, q) - faces.position({c, f}, p)).squaredNorm());
        const CellTraits& cell = traits(data.kinds[c]);
        const auto corners = data.cell(c);
        for (std::size_t e = 0; e < static_cast<std::size_t>(cell.num_edges); ++e) {
            const auto [a, b] = cell.edges[e];
            const Vec3 edge = position_of(data, corners[static_cast<std::size_t>(b)]) -
                              position_of(data, corners[static_cast<std::size_t>(a)]);
            shortest = std::min(shortest, edge.squaredNorm());
        }
    }
    return std::isfinite(shortest) ? std::sqrt(shortest) : 0.0;
}

std::vector<std::int64_t> used_points(const MeshData& data) {
    std::vector<bool> is_used(data.points.size(), false);
    for (const std::int64_t corner : data.corners) is_used[static_cast<std::size_t>(corner)] = true;
    std::vector<std::int64_t> used;
    for (std::size_t p = 0; p < is_used.size(); ++p)
        if (is_used[p]) used.push_back(static_cast<std::int64_t>(p));
    return used;
}

/// Returns, by point, the lowest point at the same position: at a distance of at most `part` of the
/// shortest edge. For points that no cell uses it returns the point itself.
/// A sweep along one direction finds few candidates, and a second direction excludes most of these.
/// Both directions are oblique, since meshes often have many points in one plane normal to an axis.
std::vector<std::int64_t> lowest_at_position(const MeshData& data, double part) {
    struct Leader {
        double at, across;
        std::int64_t point;
    };
    static const Vec3 direction = Vec3(1.0, std::sqrt(2.0), std::sqrt(3.0)) / std::sqrt(6.0),
                      second = Vec3(std::sqrt(5.0), -1.0, std::sqrt(7.0)) / std::sqrt(13.0);
    const double tolerance = part * shortest_edge(data);

    std::vector<Leader> order;
    for (const std::int64_t p : used_points(data))
        order.push_back({direction.dot(position_of(data, p)), second.dot(position_of(data, p)), p});
    std::sort(order.begin(), order.end(), [](const Leader& a, const Leader& b) {
        return std::pair(a.at, a.point) < std::pair(b.at, b.point);
    });

    std::vector<std::int64_t> leader_of(data.points.size());
    std::iota(leader_of.begin(), leader_of.end(), 0);
    std::vector<Leader> leaders;
    std::size_t begin = 0;  // of the leaders that may be near later points
    for (const Leader& one : order) {
        while (begin < leaders.size() && leaders[begin].at < one.at - 2.0 * tolerance) ++begin;
        const Vec3& here = position_of(data, one.point);
        const auto found = std::find_if(
            leaders.begin() + static_cast<std::ptrdiff_t>(begin), leaders.end(),
            [&](const Leader& leader) {
                return !(std::abs(leader.across - one.across) > 2.0 * tolerance) &&
                       (position_of(data, leader.point) - here).stableNorm() <= tolerance;
            });
        if (found == leaders.end())
            leaders.push_back(one);
        else
            leader_of[static_cast<std::size_t>(one.point)] = found->point;
    }

    std::vector<std::int64_t> lowest(data.points.size(), -1);
    for (std::size_t p = 0; p < leader_of.size(); ++p) {
        std::int64_t& first = lowest[static_cast<std::size_t>(leader_of[p])];
        if (first < 0) first = static_cast<std::int64_t>(p);
        leader_of[p] = first;
    }
    return leader_of;
}

/// Returns the points for which `lowest` names another point.
std::vector<std::size_t> doubles(const std::vector<std::int64_t>& lowest) {
    std::vector<std::size_t> found;
    for (std::size_t p = 0; p < lowest.size(); ++p)
        if (lowest[p] != static_cast<std::int64_t>(p)) found.push_back(p);
    return found;
}

/// Returns a name such as "point 3 of cell 5 (tetrahedron)". The cell is the first with this point.
std::string corner_name(const MeshData& data, std::size_t point) {
    std::size_t c = 0;
    while (std::ranges::find(data.cell(c), static_cast<std::int64_t>(point)) == data.cell(c).end())
        ++c;
    return data.point_name(point) + " of " + data.cell_name(c);
}

/// Returns a sentence that says whether and how to weld the points.
std::string remedy_for_coincidence(const MeshData& data, const WeldAdvice& advice) {
    const std::string apart =
        "if they are meant to be apart, as the faces of a cut are, " + advice.keep;
    const std::string or_apart = ", or, " + apart;
    const WeldOutlook outlook = outlook_of_weld(data);
    if (outlook.error)
        return "welding them leaves no sound mesh (" + *outlook.error + "): remesh" + or_apart;
    const bool is_of_use = outlook.num_idle < outlook.num_joined;
    std::string obstacle = "no faces there have the same corners";
    if (const auto& unlike = outlook.unlike_faces)
        obstacle += ", such as " + name_of(*unlike, data);
    if (!is_of_use)
        return "welding does not join the cells, since " + obstacle + ": " +
               (outlook.unlike_faces ? remedy_for_unlike_faces
                                     : "let the meshes match where they meet") +
               or_apart;
    std::string text = advice.join;
    if (outlook.num_idle > 0)
        text += ", which joins no cells at " + std::to_string(outlook.num_idle) +
                " of them, since " + obstacle;
    return text + "; " + apart;
}

/// Returns a warning if boundary points are near each other but not joined.
std::optional<std::string> nearness_warning(const MeshData& data,
                                            const std::vector<std::int64_t>& lowest,
                                            const WeldAdvice& advice) {
    const auto is_on_boundary = points_of_boundary(data);
    std::size_t num_near = 0, example = 0;
    for (const std::size_t p : doubles(lowest)) {
        if (!is_on_boundary[p] || !is_on_boundary[static_cast<std::size_t>(lowest[p])]) continue;
        if (num_near++ == 0) example = p;
    }
    if (num_near == 0) return std::nullopt;
    const auto other = static_cast<std::size_t>(lowest[example]);
    std::ostringstream text;
    text << num_near << (num_near == 1 ? " point is" : " points are") << " within "
         << near_tolerance << " of the shortest edge of " << (num_near == 1 ? "another" : "others")
         << " and not joined, so the cells do not hang together there: " << corner_name(data, other)
         << " and " << corner_name(data, example) << " are "
         << (data.points[example] - data.points[other]).norm()
         << " apart; move them onto each other where the mesh is made, since welding joins only "
            "points within "
         << weld_tolerance << " of it, or, if the gap is meant, " << advice.keep;
    return text.str();
}

}  // namespace

std::optional<std::string> coincidence_warning(const MeshData& data, const WeldAdvice& advice) {
    if (data.points_may_coincide) return std::nullopt;
    const auto near = lowest_at_position(data, near_tolerance);
    if (doubles(near).empty()) return std::nullopt;
    const auto lowest = lowest_at_position(data, weld_tolerance);
    const auto found = doubles(lowest);
    // In a mesh that has been welded, points at one position differ only by rounding.
    if (found.empty() || !data.welded_to.empty()) return nearness_warning(data, near, advice);
    const std::size_t example = found.front();
    const Vec3& x = data.points[example];
    std::ostringstream text;
    text << found.size()
         << (found.size() == 1 ? " point is not joined to another"
                               : " points are not joined to others")
         << " at the same position, so the cells do not hang together there: "
         << corner_name(data, static_cast<std::size_t>(lowest[example])) << " and "
         << corner_name(data, example) << " are both at (" << x.x() << ", " << x.y() << ", "
         << x.z() << "); " << remedy_for_coincidence(data, advice);
    return text.str();
}

namespace {

/// Returns the faces of a cell that is turned by CellTraits::mirrored, as bits by face.
std::int32_t mirrored_faces(CellKind kind, std::int32_t faces) {
    const CellTraits& t = traits(kind);
    const auto corners_of = [&](int f, auto corner_before) {
        int corners = 0;
        for (const int k : t.face(f)) corners |= 1 << corner_before(k);
        return corners;
    };
    std::int32_t mirrored = 0;
    for (int f = 0; f < t.num_faces; ++f)
        for (int before = 0; before < t.num_faces; ++before)
            if ((faces >> before & 1) != 0 &&
                corners_of(before, std::identity{}) ==
                    corners_of(f, [&](int k) { return t.mirrored[static_cast<std::size_t>(k)]; }))
                mirrored |= 1 << f;
    return mirrored;
}

/// Moves the corners of carriers with the points at the same positions that are joined to others.
void move_corners_of_carriers(MeshData& data, const std::vector<std::int64_t>& lowest) {
    const auto key = [](const Vec3& x) { return std::array{x.x(), x.y(), x.z()}; };
    std::map<std::array<double, 3>, Vec3> moved;
    if (data.carriers.is_empty()) return;
    for (std::size_t p = 0; p < lowest.size(); ++p)
        if (const Vec3& to = position_of(data, lowest[p]); to != data.points[p])
            moved.emplace(key(data.points[p]), to);
    for (CarrierCorners& corners : data.carriers.corners)
        for (Vec3& x : corners)
            if (const auto it = moved.find(key(x)); it != moved.end()) x = it->second;
}

/// Lets faces on cuts be joined where two of them now have the same points.
void close_cuts(MeshData& data) {
    if (data.cut_faces.empty()) return;
    const SourceFaces faces(data);
    std::map<std::vector<std::int64_t>, SourceFace> known;
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (int f = 0; f < faces.num_faces(c); ++f) {
            if (!data.is_on_cut(c, f)) continue;
            std::vector<std::int64_t> points = faces.points({c, f});
            std::ranges::sort(points);
            const auto [other, is_first] = known.try_emplace(points, SourceFace{c, f});
            if (is_first) continue;
            data.set_on_cut(c, f, false);
            data.set_on_cut(other->second.cell, other->second.face, false);
        }
}

}  // namespace

// Welding is repeated, since it can change the shortest edge and the points that others are joined
// to. At the end, a further call finds no points at one position.
std::size_t weld(MeshData& data) {
    std::size_t num_joined = 0;
    while (true) {
        const auto lowest = lowest_at_position(data, weld_tolerance);
        const std::size_t num_found = doubles(lowest).size();
        if (num_found == 0) {
            close_cuts(data);
            return num_joined;
        }
        num_joined += num_found;
        move_corners_of_carriers(data, lowest);
        const auto join = [&](std::int64_t& p) { p = lowest[static_cast<std::size_t>(p)]; };
        std::ranges::for_each(data.corners, join);
        data.for_each_point_of_faces(join);
        if (data.welded_to.empty()) {
            data.welded_to = lowest;
        } else {
            for (std::int64_t& p : data.welded_to) p = lowest[static_cast<std::size_t>(p)];
        }
        data.points_may_coincide = false;
    }
}

std::string weld_report(std::size_t num_joined) {
    if (num_joined == 0) return "no two points are at the same position: none was joined";
    return std::to_string(num_joined) +
           (num_joined == 1 ? " point was joined to another" : " points were joined to others") +
           " at the same position";
}

void drop_welded_points(MeshData& data) {
    std::vector<std::int64_t> new_number(data.points.size());
    std::size_t num_kept = 0;
    for (std::size_t p = 0; p < data.points.size(); ++p) {
        if (data.is_welded(p)) continue;
        new_number[p] = static_cast<std::int64_t>(num_kept);
        data.points[num_kept] = data.points[p];
        if (!data.source_points.empty()) data.source_points[num_kept] = data.source_points[p];
        ++num_kept;
    }
    data.points.resize(num_kept);
    if (!data.source_points.empty()) data.source_points.resize(num_kept);
    const auto renumber = [&](std::int64_t& p) { p = new_number[static_cast<std::size_t>(p)]; };
    std::ranges::for_each(data.corners, renumber);
    data.for_each_point_of_faces(renumber);
    data.welded_to.clear();
}

namespace {

/// Reverses the direction of all faces of polyhedra.
void turn_polyhedra(MeshData& data) {
    data.for_each_polyhedron([&](std::size_t, std::size_t at) {
        const std::int64_t count = data.faces[at++];
        for (std::int64_t f = 0; f < count; ++f) {
            const auto size = static_cast<std::ptrdiff_t>(data.faces[at++]);
            const auto begin = data.faces.begin() + static_cast<std::ptrdiff_t>(at);
            std::reverse(begin + 1, begin + size);
            at += static_cast<std::size_t>(size);
        }
    });
}

/// Turns the carriers of each kind of which every one has negative volume.
void turn_carriers(Carriers& carriers) {
    std::array<bool, num_cell_kinds> has_inverted{}, has_sound{};
    for (const CarrierCorners& corners : carriers.corners) {
        const auto kind = static_cast<std::size_t>(corners.kind());
        (signed_volume(corners.kind(), corners) < 0.0 ? has_inverted : has_sound)[kind] = true;
    }
    for (CarrierCorners& corners : carriers.corners) {
        const auto kind = static_cast<std::size_t>(corners.kind());
        if (!has_inverted[kind] || has_sound[kind]) continue;
        const CarrierCorners before = corners;
        const auto& mirrored = traits(corners.kind()).mirrored;
        for (std::size_t k = 0; k < corners.size(); ++k)
            corners[k] = before[static_cast<std::size_t>(mirrored[k])];
    }
}

}  // namespace

TurnedCells turn_inverted_cells(MeshData& data) {
    std::array<Vec3, max_corners> x;
    std::array<std::size_t, num_cell_kinds + 1> num_inverted{};
    std::array<bool, num_cell_kinds + 1> has_sound{};
    const SourceFaces faces(data);
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        const auto kind = static_cast<std::size_t>(data.kinds[c]);
        const double volume = faces.volume(c);
        if (data.kinds[c] != CellKind::polyhedron) {
            const auto corners = data.cell(c);
            for (std::size_t k = 0; k < corners.size(); ++k) x[k] = position_of(data, corners[k]);
            if (is_flat_to_rounding(data.kinds[c], {x.data(), corners.size()}, volume)) continue;
        }
        if (volume < 0.0)
            ++num_inverted[kind];
        else
            has_sound[kind] = true;
    }
    TurnedCells turned;
    std::array<bool, num_cell_kinds + 1> is_turned{};
    for (std::size_t kind = 0; kind <= num_cell_kinds; ++kind) {
        if (num_inverted[kind] == 0 || has_sound[kind]) continue;
        is_turned[kind] = true;
        turned.kinds.push_back(static_cast<CellKind>(kind));
        turned.num_cells += num_inverted[kind];
    }
    turn_carriers(data.carriers);
    if (turned.kinds.empty()) return turned;
    std::array<std::int64_t, max_corners> old{};
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        if (!is_turned[static_cast<std::size_t>(data.kinds[c])] ||
            data.kinds[c] == CellKind::polyhedron)
            continue;
        std::ranges::copy(data.cell(c), old.begin());
        const auto& mirrored = traits(data.kinds[c]).mirrored;
        for (std::size_t k = 0; k < data.cell(c).size(); ++k)
            data.corners[data.offsets[c] + k] = old[static_cast<std::size_t>(mirrored[k])];
        if (!data.cut_faces.empty())
            data.cut_faces[c] = mirrored_faces(data.kinds[c], data.cut_faces[c]);
    }
    if (is_turned[static_cast<std::size_t>(CellKind::polyhedron)]) turn_polyhedra(data);
    return turned;
}

}  // namespace incise::topology
