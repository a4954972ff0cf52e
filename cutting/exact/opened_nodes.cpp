// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/opened_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_set>

#include "incise/cutting/exact/shortest_inside.h"
#include "incise/cutting/exact/split.h"

namespace incise::cutting {

using topology::ChangeSet;
using topology::Mesh;

namespace {

/// Two opened faces whose normals have at least this cosine count as one plane.
constexpr double least_cosine_of_plane = 0.98;
/// A node has at most so many planes, those of the widest faces.
constexpr std::size_t max_planes = 6;
/// A node is not moved by more than this many margins: in a wedge so sharp, or between the two
/// faces at the tip of a cut, there is no place inside.
constexpr double most_margins = 4.0;

/// An opened face at rest.
struct Face {
    std::array<VertexId, 3> corners;
    Vec3 normal;   // of unit length, outwards
    double width;  // the shortest altitude, m
};

/// Appends the opened faces of a cell.
void append_opened_faces(const Mesh& mesh, CellId e, std::vector<Face>& faces) {
    for (int f = 0; f < mesh.num_faces(e); ++f) {
        const FaceId face{e, f};
        if (!mesh.is_on_cut(face)) continue;
        const int size = mesh.face_size(face);
        const Vec3& first = mesh.rest_position(mesh.face_corner(face, 0));
        for (int p = 2; p < size; ++p) {
            const VertexId b = mesh.face_corner(face, p - 1), c = mesh.face_corner(face, p);
            const Vec3 u = mesh.rest_position(b) - first, v = mesh.rest_position(c) - first,
                       normal = u.cross(v);
            const double twice_area = normal.norm();
            if (twice_area > 0.0)
                faces.push_back({{mesh.face_corner(face, 0), b, c},
                                 normal / twice_area,
                                 twice_area / std::max({u.norm(), v.norm(), (v - u).norm()})});
        }
    }
}

/// True if a point is nearer to a face than `distance`, or beside one of its corners by little
/// more.
bool is_within(const Mesh& mesh, const Face& face, const Vec3& x, double distance) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = mesh.rest_position(face.corners[k]),
                   &b = mesh.rest_position(face.corners[(k + 1) % 3]);
        const Vec3 outwards = (b - a).cross(face.normal).stableNormalized();
        if (outwards.dot(x - a) >= distance) return false;
    }
    return std::abs(face.normal.dot(x - mesh.rest_position(face.corners[0]))) < distance;
}

/// What is near a node: nodes that hang together with it, itself included, their cells, and those
/// joined to these.
struct Near {
    std::vector<VertexId> nodes;
    std::vector<CellId> cells;
};
/// A cut through a node of the mesh makes nodes round it, whose cells are smaller than the margin.
Near near_to(const Mesh& mesh, VertexId n, double distance) {
    Near near{{n}, {}};
    std::vector<CellId> star;
    for (std::size_t i = 0; i < near.nodes.size(); ++i) {  // more are added
        mesh.star(near.nodes[i], star);
        for (const CellId e : star) {
            if (std::ranges::find(near.cells, e) != near.cells.end()) continue;
            near.cells.push_back(e);
            for (const VertexId other : mesh.corners(e))
                if ((mesh.rest_position(other) - mesh.rest_position(n)).norm() < distance &&
                    std::ranges::find(near.nodes, other) == near.nodes.end())
                    near.nodes.push_back(other);
        }
    }
    const std::size_t num_at_nodes = near.cells.size();
    for (std::size_t i = 0; i < num_at_nodes; ++i)
        for (int f = 0; f < mesh.num_faces(near.cells[i]); ++f) {
            const CellId e = mesh.neighbor({near.cells[i], f}).cell;
            if (e.is_valid() && std::ranges::find(near.cells, e) == near.cells.end())
                near.cells.push_back(e);
        }
    return near;
}

/// Returns the size of cells at a node, m, of which the tolerance of a cut is a share. A cut leaves
/// cells beside nodes of the mesh that are much smaller than the edges on which their nodes were
/// made: so cells count that are joined to those at the node, up to the first of a usual size.
/// @param usual  the size of cells, m
double size_at(const Mesh& mesh, VertexId n, double usual) {
    constexpr std::size_t most_cells = 64;
    std::vector<CellId> cells;
    mesh.star(n, cells);
    double longest = 0.0;
    for (const CellId e : cells)
        for (const VertexId corner : mesh.corners(e))
            longest =
                std::max(longest, (mesh.rest_position(corner) - mesh.rest_position(n)).norm());
    constexpr double small = 0.1;
    for (std::size_t begin = 0; longest < small * usual && cells.size() < most_cells;) {
        const std::size_t end = cells.size();
        for (; begin < end; ++begin)
            for (int f = 0; f < mesh.num_faces(cells[begin]); ++f) {
                const CellId other = mesh.neighbor({cells[begin], f}).cell;
                if (!other.is_valid() || std::ranges::find(cells, other) != cells.end()) continue;
                cells.push_back(other);
                Box box;
                for (const VertexId corner : mesh.corners(other))
                    box.extend(mesh.rest_position(corner));
                longest = std::max(longest, box.diagonal().norm() / std::sqrt(3.0));
            }
        if (cells.size() == end) break;
    }
    return longest;
}

}  // namespace

/// Notes that a cut with a tolerance has opened faces at a node. Of several, the largest holds.
void OpenedNodes::note_snap(VertexId n, double snap) {
    const auto [it, is_new] = snaps_.try_emplace(n, snap);
    if (!is_new) it->second = std::max(it->second, snap);
    if (it->second == default_snap) snaps_.erase(it);
}

/// Notes that a node is to be moved no more.
void OpenedNodes::forget(VertexId n, const Node& node) {
    if (node.offset.isZero(0.0)) return;
    const auto at = std::ranges::lower_bound(forgotten_, n);
    if (at == forgotten_.end() || *at != n) forgotten_.insert(at, n);
}

void OpenedNodes::apply(const Mesh& mesh, const ChangeSet& changes, double snap) {
    for (const topology::VertexRecord& record : changes.nodes_removed) {
        nodes_.erase(record.id);
        snaps_.erase(record.id);
    }
    std::vector<VertexId> touched, opened;
    for (const CellId e : topology::touched_cells(changes))
        if (e.index() < mesh.element_capacity() && mesh.is_alive(e))
            std::ranges::copy(mesh.corners(e), std::back_inserter(touched));
    for (const topology::VertexRecord& record : changes.nodes_added)  // sources first
        if (record.num_sources == 1)
            if (const auto known = snaps_.find(record.sources[0].node); known != snaps_.end())
                snaps_.emplace(record.id, double(known->second));
    for (const topology::FacePair& pair : changes.faces_opened)
        for (const FaceId f : {pair.a, pair.b})
            if (mesh.is_alive(f.cell) && mesh.is_on_cut(f))
                for (int p = 0; p < mesh.face_size(f); ++p)
                    opened.push_back(mesh.face_corner(f, p));
    std::ranges::sort(opened);
    opened.erase(std::unique(opened.begin(), opened.end()), opened.end());
    for (const VertexId n : opened) {
        // One that had opened faces before, by a cut with the default, is not in the list.
        const bool has_default = nodes_.contains(n) && !snaps_.contains(n);
        note_snap(n, has_default ? std::max(snap, default_snap) : snap);
    }
    find_at(mesh, std::move(touched));
}

void OpenedNodes::find_all(const Mesh& mesh, double usual) {
    usual_ = usual;
    std::vector<VertexId> nodes;
    for (const CellId e : mesh.elements())
        for (int f = 0; f < mesh.num_faces(e); ++f)
            if (mesh.is_on_cut({e, f})) {
                std::ranges::copy(mesh.corners(e), std::back_inserter(nodes));
                break;
            }
    find_at(mesh, std::move(nodes));
    settle(mesh, std::numeric_limits<std::size_t>::max());
}

/// Finds the opened faces at each of some nodes.
void OpenedNodes::find_at(const Mesh& mesh, std::vector<VertexId> nodes) {
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (unsettled_.size() > 2 * nodes_.size() + 1000) {  // while a blade rests in the body
        std::ranges::sort(unsettled_);
        unsettled_.erase(std::unique(unsettled_.begin(), unsettled_.end()), unsettled_.end());
    }
    std::vector<CellId> star;
    for (const VertexId n : nodes) {
        Node node, former;
        if (const auto before = nodes_.find(n); before != nodes_.end()) {
            node.is_moved = before->second.is_moved;
            node.offset = before->second.offset;
            former = std::move(before->second);
            nodes_.erase(before);
        }
        mesh.star(n, star);
        const Vec3& x = mesh.rest_position(n);
        Vec3 outwards = Vec3::Zero();
        double area = 0.0;
        bool is_beside = false;
        for (const CellId e : star) {
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                const FaceId face{e, f};
                if (!mesh.is_on_cut(face)) continue;
                is_beside = true;
                // That of a whole cell was there before the cut: its nodes are not moved while the
                // blade may still stand on them.
                if (!mesh.is_polyhedron(e) || mesh.whole_cell(e)) continue;
                const int size = mesh.face_size(face);
                for (int p = 0; p < size; ++p) {
                    if (mesh.face_corner(face, p) != n) continue;
                    const VertexId previous = mesh.face_corner(face, (p + size - 1) % size),
                                   next = mesh.face_corner(face, (p + 1) % size);
                    const Vec3 normal =
                        (mesh.rest_position(next) - x).cross(mesh.rest_position(previous) - x);
                    outwards += normal;
                    area += normal.norm();
                    node.around.emplace_back(previous, next);
                }
            }
        }
        if (is_beside) unsettled_.push_back(n);
        // At the end of a cut, both of its sides meet.
        constexpr double least_share = 0.1;
        if (!(outwards.norm() > least_share * area)) {
            // One on faces of whole cells stays as it is until it is settled again.
            const auto is_left = [&](const Plane& plane) {
                return std::ranges::all_of(plane, [&](VertexId v) { return mesh.is_alive(v); });
            };
            former.around.clear();
            if (is_beside && area == 0.0 && !former.planes.empty() &&
                std::ranges::all_of(former.planes, is_left))
                nodes_[n] = std::move(former);
            else
                forget(n, node);
            continue;
        }
        std::ranges::sort(node.around);  // so that sums do not depend on the order of the cells
        node.margin = std::max(snap_of(n), least_tolerance) * size_at(mesh, n, usual_);
        nodes_[n] = std::move(node);
    }
}

void OpenedNodes::settle(const Mesh& mesh, std::size_t most) {
    if (unsettled_.empty()) return;
    const auto is_gone = [&](VertexId n) { return !mesh.is_alive(n); };
    std::erase_if(unsettled_, is_gone);
    std::ranges::sort(unsettled_);
    unsettled_.erase(std::unique(unsettled_.begin(), unsettled_.end()), unsettled_.end());
    const std::size_t begin = unsettled_.size() - std::min(most, unsettled_.size());
    std::vector<VertexId> chosen(unsettled_.begin() + static_cast<std::ptrdiff_t>(begin),
                                 unsettled_.end());
    unsettled_.resize(begin);
    // What a node sees reaches as far as the cells joined to those at nodes near it.
    std::unordered_set<CellId> seen;
    std::vector<VertexId> more;
    double largest = default_snap;
    for (const auto& entry : snaps_) largest = std::max(largest, entry.second);
    for (const VertexId n : chosen)
        for (const CellId e :
             near_to(mesh, n, 2.0 * largest * std::max(size_at(mesh, n, usual_), usual_)).cells)
            if (seen.insert(e).second)
                std::ranges::copy_if(mesh.corners(e), std::back_inserter(more),
                                     [&](VertexId other) { return nodes_.contains(other); });
    chosen.insert(chosen.end(), more.begin(), more.end());
    std::ranges::sort(chosen);
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    std::unordered_map<CellId, std::vector<Face>> faces_of;
    for (const VertexId n : chosen) {
        Node node;
        if (const auto before = nodes_.find(n); before != nodes_.end()) {
            node = std::move(before->second);
            nodes_.erase(before);
        }
        const double size = size_at(mesh, n, usual_);
        node.margin = std::max(snap_of(n), least_tolerance) * size;
        node.is_moved = false;
        std::vector<Face> faces;
        double snap = 0.0;
        for (const CellId e : near_to(mesh, n, 2.0 * largest * size).cells) {
            const auto [it, is_new] = faces_of.try_emplace(e);
            if (is_new) append_opened_faces(mesh, e, it->second);
            for (const Face& face : it->second) {
                double of_face = least_tolerance;
                for (const VertexId corner : face.corners)
                    of_face = std::max(of_face, snap_of(corner));
                if (!is_within(mesh, face, mesh.rest_position(n), 2.0 * of_face * size)) continue;
                faces.push_back(face);
                snap = std::max(snap, of_face);
            }
        }
        if (!faces.empty()) node.margin = snap * size;
        // In an order that does not depend on that of the cells at a node, which a file forgets.
        std::ranges::sort(faces, [](const Face& a, const Face& b) {
            return a.width != b.width ? a.width > b.width : a.corners < b.corners;
        });
        std::vector<InnerSide> spaces;
        node.planes.clear();
        for (const Face& face : faces) {
            const auto is_same = [&](const InnerSide& other) {
                return other.normal.dot(face.normal) >= least_cosine_of_plane;
            };
            if (spaces.size() == max_planes || std::ranges::any_of(spaces, is_same)) continue;
            spaces.push_back({face.normal, node.margin});
            // The places of the nodes, which are not exactly on the cut, turn narrow faces.
            if (face.width < node.margin && spaces.size() > 1 &&
                shortest_inside(spaces, most_margins * node.margin).isZero(0.0)) {
                spaces.pop_back();
                continue;
            }
            node.planes.push_back(face.corners);
        }
        if (!node.planes.empty() || !node.around.empty())
            nodes_[n] = std::move(node);
        else
            forget(n, node);
    }
}

/// Moves a node into the body by its margin.
void OpenedNodes::move(VertexId n, Node& node, std::span<const Vec3> positions, Positions& seen) {
    node.is_moved = true;
    const Vec3& x = positions[n.index()];
    if (!node.planes.empty()) {
        std::array<InnerSide, max_planes> spaces;
        std::size_t count = 0;
        for (const auto& [a, b, c] : node.planes) {
            const Vec3& first = positions[a.index()];
            const Vec3 normal = (positions[b.index()] - first)
                                    .cross(positions[c.index()] - first)
                                    .stableNormalized();
            spaces[count++] = {normal, node.margin + normal.dot(x - first)};
        }
        node.offset = shortest_inside(std::span(spaces).first(count), most_margins * node.margin);
        seen[n] = x + node.offset;
        return;
    }
    Vec3 outwards = Vec3::Zero();
    for (const auto& [previous, next] : node.around)
        outwards += (positions[next.index()] - x).cross(positions[previous.index()] - x);
    node.offset = -node.margin * outwards.stableNormalized();
    seen[n] = x + node.offset;
}

void OpenedNodes::move_all(std::span<const Vec3> positions, Positions& seen) {
    for (auto& [n, node] : nodes_) move(n, node, positions, seen);
    forgotten_.clear();
}

double OpenedNodes::move_new(Positions& seen) {
    std::vector<Vec3> positions(seen.values().begin(), seen.values().end());
    for (const auto& [n, node] : nodes_) positions[n.index()] -= node.offset;
    double farthest = 0.0;
    for (auto& [n, node] : nodes_) {
        if (node.is_moved) continue;
        const Vec3 before = node.offset;
        move(n, node, positions, seen);
        farthest = std::max(farthest, (node.offset - before).norm());
    }
    return farthest;
}

bool OpenedNodes::has_new() const {
    return std::ranges::any_of(nodes_, [](const auto& entry) { return !entry.second.is_moved; });
}

bool OpenedNodes::is_on(const Mesh& mesh) const {
    const auto is_there = [&](VertexId n) { return n.index() < mesh.node_capacity(); };
    return std::ranges::all_of(unsettled_, is_there) &&
           std::ranges::all_of(snaps_, [&](const auto& entry) { return is_there(entry.first); }) &&
           std::ranges::all_of(nodes_, [&](const auto& entry) {
               const Node& node = entry.second;
               return is_there(entry.first) && node.planes.size() <= max_planes &&
                      std::ranges::all_of(node.around,
                                          [&](const auto& neighbours) {
                                              return is_there(neighbours.first) &&
                                                     is_there(neighbours.second);
                                          }) &&
                      std::ranges::all_of(node.planes, [&](const Plane& plane) {
                          return std::ranges::all_of(plane, is_there);
                      });
           });
}

}  // namespace incise::cutting
