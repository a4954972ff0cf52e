// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact_solver.h"

#include <algorithm>

namespace incise::contact {

namespace {

constexpr int num_sweeps = 4;
/// The share of an overlap that goes in a stable step at rest.
constexpr double correction = 0.1;
/// Two sides that follow the same nodes cannot give way: then the softness of their point is below
/// this part of that of its softest node.
constexpr double least_softness = 1e-9;

}  // namespace

void ContactSolver::clear() {
    points_.clear();
    begins_.clear();
    shares_.clear();
    impulses_.clear();
    std::ranges::fill(share_of_node_, -1);
}

void ContactSolver::begin(const ContactPoint& point) {
    points_.push_back(point);
    begins_.push_back(shares_.size());
}

void ContactSolver::add_share(NodeId node, double weight) {
    if (node.index() >= share_of_node_.size()) share_of_node_.resize(node.index() + 1, -1);
    std::int64_t& known = share_of_node_[node.index()];
    if (known >= static_cast<std::int64_t>(begins_.back())) {
        shares_[static_cast<std::size_t>(known)].weight += weight;
        return;
    }
    known = static_cast<std::int64_t>(shares_.size());
    shares_.push_back({node, weight});
}

void ContactSolver::number_nodes(std::span<const Vec3> velocities,
                                 std::span<const Vec3> inverse_masses) {
    local_of_node_.resize(velocities.size(), -1);
    nodes_.clear();
    local_shares_.clear();
    for (const Share& share : shares_) {
        const std::size_t n = share.node.index();
        if (local_of_node_[n] < 0) {
            local_of_node_[n] = static_cast<std::int32_t>(nodes_.size());
            nodes_.push_back({velocities[n], inverse_masses[n]});
        }
        local_shares_.push_back({static_cast<std::uint32_t>(local_of_node_[n]), share.weight});
    }
    for (const Share& share : shares_) local_of_node_[share.node.index()] = -1;
}

/// Lists the points that can give way.
void ContactSolver::make_rows(double dt, double rest_step) {
    rows_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const ContactPoint& point = points_[i];
        const std::size_t begin = begins_[i], end = begin + shares(i).size();
        Vec3 softness = Vec3::Zero();
        double softest = 0.0;
        for (std::size_t s = begin; s < end; ++s) {
            const Vec3& of_node = nodes_[local_shares_[s].node].inverse_mass;
            softness += local_shares_[s].weight * local_shares_[s].weight * of_node;
            softest = std::max(softest, of_node.maxCoeff());
        }
        if (point.is_held) {
            Row row{};
            row.point = i;
            row.begin = begin;
            row.end = end;
            row.softness = softness;
            row.drift = correction / rest_step * point.offset;
            row.largest_impulse = point.largest_force * dt;
            rows_.push_back(row);
            continue;
        }
        const double along_normal = point.normal.cwiseAbs2().dot(softness);
        if (!(along_normal > least_softness * softest)) continue;
        const double approach =
            point.gap >= 0.0 ? point.gap / dt
                             : std::max(correction * point.gap, -largest_correction_) / rest_step;
        rows_.push_back(
            {i, begin, end, along_normal, softness.maxCoeff(), approach, rounding_of_length_ / dt});
    }
}

void ContactSolver::relax_held(Row& row) {
    Vec3 approach = row.drift - points_[row.point].velocity;
    for (std::size_t s = row.begin; s < row.end; ++s)
        approach += local_shares_[s].weight * nodes_[local_shares_[s].node].velocity;
    Vec3 impulse = impulses_[row.point];
    for (int c = 0; c < 3; ++c)
        if (row.softness[c] > 0.0) impulse[c] -= approach[c] / row.softness[c];
    const double length = impulse.norm();
    if (length > row.largest_impulse) impulse *= row.largest_impulse / length;
    change_impulse(row, impulse);
}

void ContactSolver::relax(Row& row) {
    const ContactPoint& point = points_[row.point];
    if (point.is_held) return relax_held(row);
    const Vec3& known = impulses_[row.point];
    Vec3 relative = -point.velocity;
    for (std::size_t s = row.begin; s < row.end; ++s)
        relative += local_shares_[s].weight * nodes_[local_shares_[s].node].velocity;
    const double parting = relative.dot(point.normal);
    const double before = row.normal_impulse;
    const double normal = std::max(0.0, before - (parting + row.allowed) / row.along_normal);
    if (before == 0.0 && parting + row.allowed > -row.rounding) return;
    Vec3 impulse = normal * point.normal;
    if (point.friction > 0.0) {
        const Vec3 slip = relative - parting * point.normal;
        Vec3 tangential = known - before * point.normal - slip / row.along_all;
        const double most = point.friction * normal, length = tangential.norm();
        if (length > most) tangential *= most / length;
        impulse += tangential;
    }
    row.normal_impulse = normal;
    change_impulse(row, impulse);
}

void ContactSolver::begin_with_impulse(Row& row) {
    const ContactPoint& point = points_[row.point];
    if (point.is_held) {
        const double length = point.impulse.norm();
        const double share = length > row.largest_impulse ? row.largest_impulse / length : 1.0;
        // What is prescribed by now needs no impulse.
        const Vec3 start = (row.softness.array() > 0.0).select(share * point.impulse, 0.0);
        return change_impulse(row, start);
    }
    row.normal_impulse = std::max(0.0, point.impulse.dot(point.normal));
    if (row.normal_impulse == 0.0) return;
    Vec3 tangential = point.impulse - point.impulse.dot(point.normal) * point.normal;
    const double most = point.friction * row.normal_impulse, length = tangential.norm();
    if (length > most) tangential *= most / length;
    change_impulse(row, row.normal_impulse * point.normal + tangential);
}

void ContactSolver::change_impulse(const Row& row, const Vec3& to) {
    Vec3& known = impulses_[row.point];
    const Vec3 change = to - known;
    for (std::size_t s = row.begin; s < row.end; ++s) {
        Node& node = nodes_[local_shares_[s].node];
        node.velocity += local_shares_[s].weight * node.inverse_mass.cwiseProduct(change);
    }
    known = to;
}

void ContactSolver::solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses,
                          double dt, double rest_step) {
    number_nodes(velocities, inverse_masses);
    impulses_.assign(points_.size(), Vec3::Zero());
    make_rows(dt, rest_step);
    for (Row& row : rows_) begin_with_impulse(row);
    for (int sweep = 0; sweep < num_sweeps; ++sweep)
        for (Row& row : rows_) relax(row);
}

}  // namespace incise::contact
