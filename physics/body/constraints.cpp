// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/constraints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "incise/base/error.h"

namespace incise::physics {

namespace {

/// The position of a node depends on a corner if its weight there is above this. A smaller one may
/// be that of a node on a face of the carrier, by rounding of its rest position.
constexpr double least_weight = 1e-9;

/// True if two displacements have the same component `c` at all times.
bool move_alike(const TimeCurve<Vec3>& a, const TimeCurve<Vec3>& b, std::size_t c) {
    const auto axis = static_cast<Eigen::Index>(c);
    const auto rests = [&](const TimeCurve<Vec3>& u) {
        return std::ranges::all_of(u.keys(),
                                   [&](const auto& key) { return key.second[axis] == 0.0; });
    };
    if (rests(a) && rests(b)) return true;
    return std::ranges::equal(a.keys(), b.keys(), [&](const auto& p, const auto& q) {
        return p.first == q.first && p.second[axis] == q.second[axis];
    });
}

/// True if two constraints prescribe the same value of component `c` at every node and time.
bool prescribe_alike(const Constraint& a, const Constraint& b, std::size_t c) {
    if (!a.grip.is_empty() || !b.grip.is_empty()) return false;
    const bool turn_alike = a.angle.keys() == b.angle.keys() &&
                            (a.angle.is_empty() || (a.point == b.point && a.axis == b.axis));
    return turn_alike && move_alike(a.displacement, b.displacement, c);
}

}  // namespace

Vec3 Constraint::target(const fragments::FragmentMesh& fragments, NodeId n, double time) const {
    if (!grip.is_empty()) return grip.at(time).to_world(gripped.at(n));
    const Vec3& X = fragments.rest_position(n);
    Vec3 x = X;
    if (!angle.is_empty()) x = point + Eigen::AngleAxisd(angle.at(time), axis) * (X - point);
    if (!displacement.is_empty()) x += displacement.at(time);
    return x;
}

void Constraint::require_fit(const topology::Mesh& mesh) const {
    nodes.require_fit(mesh);
    for (const auto& [time, pose] : grip.keys())
        if (!pose.is_sound()) throw InputError("the pose of a grip is none");
}

Constraint make_grip(std::string name, std::vector<VertexId> nodes, const Pose& pose) {
    Constraint constraint;
    constraint.name = std::move(name);
    constraint.nodes = VertexSet(std::move(nodes));
    constraint.grip = TimeCurve<Pose>({{0.0, pose}});
    return constraint;
}

std::vector<ConstraintConflict> find_conflicts(const topology::Mesh& mesh,
                                               std::span<const Constraint> constraints) {
    constexpr auto nobody = static_cast<std::size_t>(-1);
    constexpr std::array<std::size_t, 3> free{nobody, nobody, nobody};
    std::vector<std::array<std::size_t, 3>> first_of(mesh.node_capacity(), free);
    std::vector<std::size_t> last_second(constraints.size(), nobody);  // found with each first one
    std::vector<ConstraintConflict> conflicts;
    for (std::size_t s = 0; s < constraints.size(); ++s)
        for (const VertexSet::Member& member : constraints[s].nodes.members())
            for (std::size_t c = 0; c < 3 && mesh.is_alive(member.node); ++c) {
                if (!constraints[s].components[c]) continue;
                std::size_t& first = first_of[member.node.index()][c];
                if (first == nobody) {
                    first = s;
                } else if (last_second[first] != s &&
                           !prescribe_alike(constraints[first], constraints[s], c)) {
                    last_second[first] = s;
                    conflicts.push_back({member.node, c, first, s});
                }
            }
    return conflicts;
}

std::string describe(const ConstraintConflict& conflict, const topology::Mesh& mesh,
                     std::span<const Constraint> constraints) {
    return "node " + std::to_string(mesh.label(conflict.node)) + " is held in " +
           "xyz"[conflict.component] + " by both '" + constraints[conflict.first].name + "' and '" +
           constraints[conflict.second].name +
           "', with different motion; make their selections disjoint or their motion there equal";
}

Constraints::Constraints(const BodyView& body, std::vector<Constraint> constraints)
    : constraints_(std::move(constraints)) {
    require_agreement(body.mesh);
    index_all(body);
}

void Constraints::require_agreement(const topology::Mesh& mesh) const {
    const auto conflicts = find_conflicts(mesh, constraints_);
    if (conflicts.empty()) return;
    const ConstraintConflict& first = conflicts.front();
    throw ConflictingConstraints(describe(first, mesh, constraints_), first);
}

template <class Visit>
void Constraints::for_each_corner(const BodyView& body, VertexId member, Visit visit) {
    const topology::Mesh& mesh = body.mesh;
    const fragments::FragmentMesh& fragments = body.fragments;
    if (!mesh.is_alive(member)) return;
    std::vector<CellId> cells;
    mesh.star(member, cells);
    for (const CellId cell : cells) {
        const CarrierId carrier = fragments.carrier_of_cell(cell);
        const auto origins = fragments.origins_of(carrier);
        const auto weights = fragments.weights_in_carrier(carrier, mesh.rest_position(member));
        for (const NodeId n : fragments.corners(fragments.fragment_of_cell(cell))) {
            const auto k = std::ranges::find(origins, fragments.origin(n)) - origins.begin();
            if (k < std::ssize(origins) && weights[static_cast<std::size_t>(k)] > least_weight)
                visit(n);
        }
    }
}

bool Constraints::does_prescribe(std::size_t constraint, const BodyView& body, NodeId n) const {
    const topology::Mesh& mesh = body.mesh;
    const fragments::FragmentMesh& fragments = body.fragments;
    const NodeId origin = fragments.origin(n);
    if (!std::ranges::binary_search(origins_[constraint], origin)) return false;
    const VertexSet& nodes = constraints_[constraint].nodes;
    std::vector<ElementId> star;
    fragments.star(n, star);
    for (const ElementId e : star)
        for (const CellId cell : fragments.cells_of(e)) {
            const CarrierId carrier = fragments.carrier_of_cell(cell);
            const auto origins = fragments.origins_of(carrier);
            const auto k = std::ranges::find(origins, origin) - origins.begin();
            if (k == std::ssize(origins)) continue;
            for (const VertexId corner : mesh.corners(cell))
                if (nodes.contains(corner) &&
                    fragments.weights_in_carrier(
                        carrier, mesh.rest_position(corner))[static_cast<std::size_t>(k)] >
                        least_weight)
                    return true;
        }
    return false;
}

void Constraints::index_all(const BodyView& body) {
    rows_.clear();
    row_of_node_.assign(body.fragments.node_capacity(), -1);
    origins_.assign(constraints_.size(), {});
    std::vector<NodeId> prescribed;
    for (std::size_t s = 0; s < constraints_.size(); ++s) {
        for (const VertexSet::Member& member : constraints_[s].nodes.members())
            for_each_corner(body, member.node, [&](NodeId n) {
                prescribed.push_back(n);
                origins_[s].push_back(body.fragments.origin(n));
            });
        std::ranges::sort(origins_[s]);
        origins_[s].erase(std::unique(origins_[s].begin(), origins_[s].end()), origins_[s].end());
    }
    std::ranges::sort(prescribed);
    prescribed.erase(std::unique(prescribed.begin(), prescribed.end()), prescribed.end());
    for (const NodeId n : prescribed) index(body, n);
    for (const NodeId n : prescribed) begin_grasps(n, body.positions);
}

void Constraints::add(const BodyView& body, Constraint constraint) {
    constraints_.push_back(std::move(constraint));
    try {
        require_agreement(body.mesh);
    } catch (const InputError&) {
        constraints_.pop_back();
        throw;
    }
    index_all(body);
}

void Constraints::remove(const BodyView& body, std::size_t i) {
    constraints_.erase(constraints_.begin() + static_cast<std::ptrdiff_t>(i));
    index_all(body);
}

void Constraints::index(const BodyView& body, NodeId n) {
    constexpr std::array<int, 3> free{-1, -1, -1};
    std::array<int, 3> row = free;
    for (std::size_t s = 0; s < constraints_.size() && body.fragments.is_alive(n); ++s) {
        if (!does_prescribe(s, body, n)) continue;
        for (std::size_t c = 0; c < 3; ++c)
            if (constraints_[s].components[c] && row[c] < 0) row[c] = static_cast<int>(s);
    }
    row_of_node_[n.index()] = -1;
    if (row == free) return;
    const auto it = std::find(rows_.begin(), rows_.end(), row);
    row_of_node_[n.index()] = static_cast<std::int32_t>(it - rows_.begin());
    if (it == rows_.end()) rows_.push_back(row);
}

/// Notes where the grasps among the constraints of a node have it, unless this is known.
void Constraints::begin_grasps(NodeId n, std::span<const Vec3> positions) {
    const auto* constraint_of = of_node(n.index());
    if (!constraint_of) return;
    for (const int s : *constraint_of) {
        if (s < 0) continue;
        Constraint& constraint = constraints_[static_cast<std::size_t>(s)];
        if (!constraint.grip.is_empty())
            constraint.gripped.try_emplace(
                n, constraint.grip.keys().back().second.to_tool(positions[n.index()]));
    }
}

void Constraints::prescribe(const std::array<int, 3>& constraint_of,
                            const fragments::FragmentMesh& fragments, NodeId n, double time,
                            Vec3& x) const {
    int last = -1;
    Vec3 target = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
        const int s = constraint_of[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        if (s != last)
            target = constraints_[static_cast<std::size_t>(s)].target(fragments, n, time);
        last = s;
        x[c] = target[c];
    }
}

void Constraints::apply(const BodyView& body, const BodyEdit& edit) {
    const fragments::FragmentMeshChanges& of_fragments = edit.physics.mesh;
    for (Constraint& constraint : constraints_) {
        constraint.nodes.apply(body.mesh, edit.material);
        auto& gripped = constraint.gripped;
        gripped.erase(gripped.lower_bound(NodeId(of_fragments.node_capacity_after)), gripped.end());
        for (const fragments::NodeRecord& record : of_fragments.nodes_added) {
            const auto source = gripped.find(record.sources[0].node);
            if (record.num_sources == 1 && source != gripped.end())
                gripped.try_emplace(record.id, source->second);
        }
    }
    row_of_node_.resize(of_fragments.node_capacity_after, -1);
    if (constraints_.empty()) return;
    for (const NodeId n : edit.touched_nodes) {
        index(body, n);
        begin_grasps(n, body.positions);
    }
}

}  // namespace incise::physics
