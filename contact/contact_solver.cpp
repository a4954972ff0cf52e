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
    on_surface_.clear();
    impulses_.clear();
    for (const NodeId node : node_ids_) number_by_id_[node.index()] = -1;
    node_ids_.clear();
    last_shares_.clear();
    threads_.clear();
    thread_begins_.clear();
    pulls_.clear();
    thread_impulses_.clear();
}

std::uint32_t ContactSolver::number_of(NodeId node) {
    if (node.index() >= number_by_id_.size()) number_by_id_.resize(node.index() + 1, -1);
    std::int32_t& number = number_by_id_[node.index()];
    if (number < 0) {
        number = static_cast<std::int32_t>(node_ids_.size());
        node_ids_.push_back(node);
        last_shares_.push_back(std::numeric_limits<std::size_t>::max());
    }
    return static_cast<std::uint32_t>(number);
}

void ContactSolver::begin(const ContactPoint& point) {
    points_.push_back(point);
    begins_.push_back(shares_.size());
}

void ContactSolver::add_share(NodeId node, double weight) {
    const std::uint32_t number = number_of(node);
    std::size_t& last = last_shares_[number];
    if (last < shares_.size() && last >= begins_.back()) {
        shares_[last].weight += weight;
        return;
    }
    last = shares_.size();
    shares_.push_back({node, number, weight});
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
    pulls_.push_back({node, number_of(node), gradient});
}

std::span<const Pull> ContactSolver::pulls(std::size_t thread) const {
    const std::size_t begin = thread_begins_[thread];
    const std::size_t end =
        thread + 1 < thread_begins_.size() ? thread_begins_[thread + 1] : pulls_.size();
    return std::span(pulls_).subspan(begin, end - begin);
}

std::vector<std::pair<NodeId, Vec3>> ContactSolver::surface_impulses() const {
    std::vector<std::pair<NodeId, Vec3>> sums;
    for (const auto& [point, at] : on_surface_) {
        if (impulses_[point].isZero(0.0)) continue;
        for (std::size_t k = 0; k < at.nodes.size(); ++k)
            if (at.weights[k] != 0.0)
                sums.emplace_back(at.nodes[k], at.weights[k] * impulses_[point]);
    }
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

Vec3 ContactSolver::velocity(std::size_t begin, std::size_t end) const {
    Padded sum = Padded::Zero();
    for (std::size_t s = begin; s < end; ++s)
        sum += shares_[s].weight * nodes_[shares_[s].number].velocity;
    return sum.head<3>();
}

Vec3 ContactSolver::velocity(std::size_t i) const {
    return velocity(begins_[i], begins_[i] + shares(i).size());
}

double ContactSolver::lengthening(std::size_t thread) const {
    double sum = 0.0;
    for (const Pull& pull : pulls(thread))
        sum += pull.gradient.dot(nodes_[pull.number].velocity.head<3>());
    return sum;
}

void ContactSolver::take_nodes(std::span<const Vec3> velocities,
                               std::span<const Vec3> inverse_masses) {
    nodes_.resize(node_ids_.size());
    velocities_before_.resize(node_ids_.size());
    for (std::size_t i = 0; i < node_ids_.size(); ++i) {
        nodes_[i].velocity << velocities[node_ids_[i].index()], 0.0;
        nodes_[i].inverse_mass << inverse_masses[node_ids_[i].index()], 0.0;
        velocities_before_[i] = nodes_[i].velocity;
    }
}

/// Lists the points that can give way.
void ContactSolver::make_rows(double dt, double rest_step) {
    rows_.clear();
    rounding_ = rounding_of_length_ / dt;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const ContactPoint& point = points_[i];
        const std::size_t begin = begins_[i], end = begin + shares(i).size();
        Padded padded_softness = Padded::Zero();
        double softest = 0.0;
        for (std::size_t s = begin; s < end; ++s) {
            const Padded& of_node = nodes_[shares_[s].number].inverse_mass;
            padded_softness += shares_[s].weight * shares_[s].weight * of_node;
            softest = std::max(softest, of_node.maxCoeff());
        }
        const Vec3 softness = padded_softness.head<3>();
        const double along_normal = point.normal.cwiseAbs2().dot(softness);
        if (!point.is_held && !(along_normal > least_softness * softest)) continue;
        Row& row = rows_.emplace_back();
        row.point = static_cast<std::uint32_t>(i);
        row.begin = static_cast<std::uint32_t>(begin);
        row.end = static_cast<std::uint32_t>(end);
        row.is_held = point.is_held;
        row.velocity = point.velocity;
        row.largest_impulse = point.largest_force * dt;
        if (point.is_held) {
            row.softness = softness;
            row.drift = correction / rest_step * point.offset;
            continue;
        }
        row.normal = point.normal;
        row.friction = point.friction;
        row.hardness = 1.0 / along_normal;
        row.all_hardness = 1.0 / softness.maxCoeff();
        row.allowed = point.gap >= 0.0
                          ? point.gap / dt
                          : std::max(correction * point.gap, -largest_correction_) / rest_step;
    }
}

void ContactSolver::relax_held(Row& row) {
    const Vec3 approach = velocity(row.begin, row.end) + row.drift - row.velocity;
    Vec3 impulse = row.impulse;
    for (int c = 0; c < 3; ++c)
        if (row.softness[c] > 0.0) impulse[c] -= approach[c] / row.softness[c];
    const double length = impulse.norm();
    if (length > row.largest_impulse) impulse *= row.largest_impulse / length;
    change_impulse(row, impulse);
}

void ContactSolver::relax(Row& row) {
    if (row.is_held) return relax_held(row);
    const Vec3 relative = velocity(row.begin, row.end) - row.velocity;
    const double parting = relative.dot(row.normal), before = row.normal_impulse;
    if (before == 0.0 && parting + row.allowed > -rounding_) return;
    const double normal =
        std::clamp(before - (parting + row.allowed) * row.hardness, 0.0, row.largest_impulse);
    Vec3 impulse = normal * row.normal;
    if (row.friction > 0.0) {
        const Vec3 slip = relative - parting * row.normal;
        Vec3 tangential = row.impulse - before * row.normal - slip * row.all_hardness;
        const double most = row.friction * normal, length = tangential.norm();
        if (length > most) tangential *= most / length;
        impulse += tangential;
    }
    row.normal_impulse = normal;
    change_impulse(row, impulse);
}

void ContactSolver::begin_with_impulse(Row& row) {
    const Vec3& known = points_[row.point].impulse;
    if (row.is_held) {
        const double length = known.norm();
        const double share = length > row.largest_impulse ? row.largest_impulse / length : 1.0;
        // What is prescribed by now needs no impulse.
        const Vec3 start = (row.softness.array() > 0.0).select(share * known, 0.0);
        return change_impulse(row, start);
    }
    const double along_normal = known.dot(row.normal);
    row.normal_impulse = std::clamp(along_normal, 0.0, row.largest_impulse);
    if (row.normal_impulse == 0.0) return;
    Vec3 tangential = known - along_normal * row.normal;
    const double most = row.friction * row.normal_impulse, length = tangential.norm();
    if (length > most) tangential *= most / length;
    change_impulse(row, row.normal_impulse * row.normal + tangential);
}

/// Begins with the impulses of the step before, or with the share of them that is best. Without
/// this, impulses that have become wrong could do work: four sweeps do not undo all of it.
void ContactSolver::begin_with_impulses() {
    for (Row& row : rows_) begin_with_impulse(row);
    for (std::size_t t = 0; t < threads_.size(); ++t)
        change_thread_impulse(t, std::min(threads_[t].impulse, thread_rows_[t].largest_impulse));
    const double share = best_share_of_impulses();
    if (share == 1.0) return;
    for (Row& row : rows_) {
        row.impulse *= share;
        row.normal_impulse *= share;
    }
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
        if (row.impulse.isZero(0.0)) continue;
        Padded before = Padded::Zero(), after = Padded::Zero();
        for (std::size_t s = row.begin; s < row.end; ++s) {
            before += shares_[s].weight * velocities_before_[shares_[s].number];
            after += shares_[s].weight * nodes_[shares_[s].number].velocity;
        }
        const Vec3 aim = row.is_held ? row.drift : Vec3(row.allowed * row.normal);
        linear += row.impulse.dot(before.head<3>() - row.velocity + aim);
        square += row.impulse.dot((after - before).head<3>());
    }
    for (std::size_t t = 0; t < threads_.size(); ++t) {
        const ThreadRow& row = thread_rows_[t];
        const double impulse = thread_impulses_[t];
        double before = row.drift, change = row.own_softness * impulse;
        for (const Pull& pull : pulls(t)) {
            const Padded& known = velocities_before_[pull.number];
            before += pull.gradient.dot(known.head<3>());
            change -= pull.gradient.dot((nodes_[pull.number].velocity - known).head<3>());
        }
        linear -= impulse * before;
        square += impulse * change;
    }
    if (!(square > 0.0)) return 1.0;
    return std::clamp(-linear / square, 0.0, 1.0);
}

void ContactSolver::change_impulse(Row& row, const Vec3& to) {
    Padded change;
    change << to - row.impulse, 0.0;
    for (std::size_t s = row.begin; s < row.end; ++s) {
        Node& node = nodes_[shares_[s].number];
        node.velocity += shares_[s].weight * node.inverse_mass.cwiseProduct(change);
    }
    row.impulse = to;
}

void ContactSolver::make_thread_rows(double dt) {
    thread_rows_.clear();
    for (std::size_t t = 0; t < threads_.size(); ++t) {
        const Thread& thread = threads_[t];
        double softness = 0.0;
        for (const Pull& pull : pulls(t))
            softness += pull.gradient.cwiseAbs2().dot(nodes_[pull.number].inverse_mass.head<3>());
        thread_rows_.push_back({softness, 1.0 / (thread.stiffness * dt * dt),
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
    const double change = to - thread_impulses_[thread];
    for (const Pull& pull : pulls(thread)) {
        Node& node = nodes_[pull.number];
        node.velocity.head<3>() -= change * node.inverse_mass.head<3>().cwiseProduct(pull.gradient);
    }
    thread_impulses_[thread] = to;
}

void ContactSolver::solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses,
                          double dt, double rest_step) {
    take_nodes(velocities, inverse_masses);
    thread_impulses_.assign(threads_.size(), 0.0);
    make_rows(dt, rest_step);
    make_thread_rows(dt);
    begin_with_impulses();
    for (int sweep = 0; sweep < num_sweeps; ++sweep) {
        const bool visits_all = sweep == 0 || sweep == num_sweeps - 1;
        for (Row& row : rows_)
            if (visits_all || row.is_held || row.normal_impulse > 0.0) relax(row);
        for (std::size_t t = 0; t < threads_.size(); ++t) relax_thread(t);
    }
    impulses_.assign(points_.size(), Vec3::Zero());
    for (const Row& row : rows_) impulses_[row.point] = row.impulse;
}

}  // namespace incise::contact
