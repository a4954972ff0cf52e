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
    surface_shares_.clear();
    threads_.clear();
    thread_begins_.clear();
    pulls_.clear();
    thread_impulses_.clear();
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

void ContactSolver::begin_thread(const Thread& thread) {
    threads_.push_back(thread);
    thread_begins_.push_back(pulls_.size());
}

void ContactSolver::add_pull(NodeId node, const Vec3& gradient) {
    for (std::size_t p = thread_begins_.back(); p < pulls_.size(); ++p)
        if (pulls_[p].node == node) {
            pulls_[p].gradient += gradient;
            return;
        }
    pulls_.push_back({node, gradient});
}

std::span<const Pull> ContactSolver::pulls(std::size_t thread) const {
    const std::size_t begin = thread_begins_[thread];
    const std::size_t end =
        thread + 1 < thread_begins_.size() ? thread_begins_[thread + 1] : pulls_.size();
    return std::span(pulls_).subspan(begin, end - begin);
}

std::vector<std::pair<NodeId, Vec3>> ContactSolver::surface_impulses() const {
    std::vector<std::pair<NodeId, Vec3>> sums;
    for (const auto& [point, share] : surface_shares_)
        if (const Vec3& impulse = impulses_[point]; !impulse.isZero(0.0))
            sums.emplace_back(share.node, share.weight * impulse);
    std::ranges::stable_sort(sums, {}, &std::pair<NodeId, Vec3>::first);
    std::size_t count = 0;
    for (const auto& [node, impulse] : sums) {
        if (count > 0 && sums[count - 1].first == node)
            sums[count - 1].second += impulse;
        else
            sums[count++] = {node, impulse};
    }
    sums.resize(count);
    return sums;
}

Vec3 ContactSolver::velocity(std::size_t i) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t s = begins_[i], end = s + shares(i).size(); s < end; ++s)
        sum += local_shares_[s].weight * nodes_[local_shares_[s].node].velocity;
    return sum;
}

double ContactSolver::lengthening(std::size_t thread) const {
    double sum = 0.0;
    for (std::size_t p = thread_begins_[thread], end = p + pulls(thread).size(); p < end; ++p)
        sum += pulls_[p].gradient.dot(nodes_[local_pulls_[p]].velocity);
    return sum;
}

void ContactSolver::number_nodes(std::span<const Vec3> velocities,
                                 std::span<const Vec3> inverse_masses) {
    local_of_node_.resize(velocities.size(), -1);
    nodes_.clear();
    local_shares_.clear();
    local_pulls_.clear();
    const auto number_of = [&](NodeId node) {
        const std::size_t n = node.index();
        if (local_of_node_[n] < 0) {
            local_of_node_[n] = static_cast<std::int32_t>(nodes_.size());
            nodes_.push_back({velocities[n], inverse_masses[n]});
        }
        return static_cast<std::uint32_t>(local_of_node_[n]);
    };
    for (const Share& share : shares_)
        local_shares_.push_back({number_of(share.node), share.weight});
    for (const Pull& pull : pulls_) local_pulls_.push_back(number_of(pull.node));
    for (const Share& share : shares_) local_of_node_[share.node.index()] = -1;
    for (const Pull& pull : pulls_) local_of_node_[pull.node.index()] = -1;
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
        rows_.back().largest_impulse = point.largest_force * dt;
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
    const double normal =
        std::clamp(before - (parting + row.allowed) / row.along_normal, 0.0, row.largest_impulse);
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
    row.normal_impulse = std::clamp(point.impulse.dot(point.normal), 0.0, row.largest_impulse);
    if (row.normal_impulse == 0.0) return;
    Vec3 tangential = point.impulse - point.impulse.dot(point.normal) * point.normal;
    const double most = point.friction * row.normal_impulse, length = tangential.norm();
    if (length > most) tangential *= most / length;
    change_impulse(row, row.normal_impulse * point.normal + tangential);
}

/// Begins with the impulses of the step before, or with the share of them that is best. Without
/// this, impulses that have become wrong could do work: four sweeps do not undo all of it.
void ContactSolver::begin_with_impulses() {
    velocities_before_.resize(nodes_.size());
    std::ranges::transform(nodes_, velocities_before_.begin(), &Node::velocity);
    for (Row& row : rows_) begin_with_impulse(row);
    for (std::size_t t = 0; t < threads_.size(); ++t)
        change_thread_impulse(t, std::min(threads_[t].impulse, thread_rows_[t].largest_impulse));
    const double share = best_share_of_impulses();
    if (share == 1.0) return;
    for (Vec3& impulse : impulses_) impulse *= share;
    for (Row& row : rows_) row.normal_impulse *= share;
    for (double& impulse : thread_impulses_) impulse *= share;
    for (std::size_t n = 0; n < nodes_.size(); ++n)
        nodes_[n].velocity =
            velocities_before_[n] + share * (nodes_[n].velocity - velocities_before_[n]);
}

/// The impulses that are sought make the sum of J . (A J / 2 + r) least, with the relative
/// velocities r without them and what they change, A J. Each relaxation lowers it. Returns the
/// share of the present impulses at which it is least, from 0 to 1: it is then not above 0, and the
/// impulses do no work but that of tools and of overlaps that go.
double ContactSolver::best_share_of_impulses() const {
    double linear = 0.0, square = 0.0;
    for (const Row& row : rows_) {
        const ContactPoint& point = points_[row.point];
        Vec3 before = -point.velocity, change = Vec3::Zero();
        for (std::size_t s = row.begin; s < row.end; ++s) {
            const auto [node, weight] = local_shares_[s];
            before += weight * velocities_before_[node];
            change += weight * (nodes_[node].velocity - velocities_before_[node]);
        }
        before += point.is_held ? row.drift : Vec3(row.allowed * point.normal);
        linear += impulses_[row.point].dot(before);
        square += impulses_[row.point].dot(change);
    }
    for (std::size_t t = 0; t < threads_.size(); ++t) {
        const ThreadRow& row = thread_rows_[t];
        const double impulse = thread_impulses_[t];
        double before = row.drift, change = row.own_softness * impulse;
        for (std::size_t p = row.begin; p < row.end; ++p) {
            const Vec3& known = velocities_before_[local_pulls_[p]];
            before += pulls_[p].gradient.dot(known);
            change -= pulls_[p].gradient.dot(nodes_[local_pulls_[p]].velocity - known);
        }
        linear -= impulse * before;
        square += impulse * change;
    }
    if (!(square > 0.0)) return 1.0;
    return std::clamp(-linear / square, 0.0, 1.0);
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

void ContactSolver::make_thread_rows(double dt) {
    thread_rows_.clear();
    for (std::size_t t = 0; t < threads_.size(); ++t) {
        const Thread& thread = threads_[t];
        const std::size_t begin = thread_begins_[t], end = begin + pulls(t).size();
        double softness = 0.0;
        for (std::size_t p = begin; p < end; ++p)
            softness += pulls_[p].gradient.cwiseAbs2().dot(nodes_[local_pulls_[p]].inverse_mass);
        thread_rows_.push_back({begin, end, softness, 1.0 / (thread.stiffness * dt * dt),
                                thread.stretch / dt - thread.rest_rate, thread.largest_force * dt});
    }
}

/// Makes the tension that of the length that the thread then has at the end of the step.
void ContactSolver::relax_thread(std::size_t thread) {
    const ThreadRow& row = thread_rows_[thread];
    const double known = thread_impulses_[thread];
    const double missing = row.drift + lengthening(thread) - row.own_softness * known;
    change_thread_impulse(thread, std::clamp(known + missing / (row.softness + row.own_softness),
                                             0.0, row.largest_impulse));
}

void ContactSolver::change_thread_impulse(std::size_t thread, double to) {
    const ThreadRow& row = thread_rows_[thread];
    const double change = to - thread_impulses_[thread];
    for (std::size_t p = row.begin; p < row.end; ++p) {
        Node& node = nodes_[local_pulls_[p]];
        node.velocity -= change * node.inverse_mass.cwiseProduct(pulls_[p].gradient);
    }
    thread_impulses_[thread] = to;
}

void ContactSolver::solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses,
                          double dt, double rest_step) {
    number_nodes(velocities, inverse_masses);
    impulses_.assign(points_.size(), Vec3::Zero());
    thread_impulses_.assign(threads_.size(), 0.0);
    make_rows(dt, rest_step);
    make_thread_rows(dt);
    begin_with_impulses();
    for (int sweep = 0; sweep < num_sweeps; ++sweep) {
        for (Row& row : rows_) relax(row);
        for (std::size_t t = 0; t < threads_.size(); ++t) relax_thread(t);
    }
}

}  // namespace incise::contact
