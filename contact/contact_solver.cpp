// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace incise::contact {

namespace {

constexpr int num_sweeps = 4;
/// Two sides that follow the same nodes cannot give way: then the softness of their point is below
/// this part of that of its softest node.
constexpr double least_softness = 1e-9;
/// Relaxations of a thread stop when the impulses change by less than this part of the tension.
constexpr double thread_accuracy = 1e-6;
constexpr int most_thread_sweeps = 20;
/// A segment turns within a step if it is shorter than this multiple of the way on which its own
/// tension moves its ends in a step. Else its tension, times its turning, would be a stiffness
/// against motion across it that is too large for the step.
constexpr double turning_length = 4.0;

}  // namespace

void ContactSolver::clear() {
    points_.clear();
    begins_.clear();
    weights_.clear();
    on_surface_.clear();
    impulses_.clear();
    for (const NodeId node : node_ids_) number_by_id_[node.index()] = -1;
    node_ids_.clear();
    last_weights_.clear();
    threads_.clear();
    thread_begins_.clear();
    segment_points_.clear();
}

std::uint32_t ContactSolver::number_of(NodeId node) {
    if (node.index() >= number_by_id_.size()) number_by_id_.resize(node.index() + 1, -1);
    std::int32_t& number = number_by_id_[node.index()];
    if (number < 0) {
        number = static_cast<std::int32_t>(node_ids_.size());
        node_ids_.push_back(node);
        last_weights_.push_back(std::numeric_limits<std::size_t>::max());
    }
    return static_cast<std::uint32_t>(number);
}

void ContactSolver::begin(const ContactPoint& point) {
    points_.push_back(point);
    begins_.push_back(weights_.size());
}

void ContactSolver::add_weight(NodeId node, double weight) {
    const std::uint32_t number = number_of(node);
    std::size_t& last = last_weights_[number];
    if (last < weights_.size() && last >= begins_.back()) {
        weights_[last].weight += weight;
        return;
    }
    last = weights_.size();
    weights_.push_back({node, number, weight});
}

void ContactSolver::begin_thread(const Thread& thread) {
    threads_.push_back(thread);
    thread_begins_.push_back(segment_points_.size());
}

void ContactSolver::begin_segment(const Vec3& span, const Vec3& impulse) {
    segment_points_.push_back(points_.size());
    begin({.impulse = impulse, .is_bilateral = true, .offset = span});
}

std::vector<std::pair<VertexId, Vec3>> ContactSolver::surface_impulses() const {
    std::vector<std::pair<VertexId, Vec3>> sums;
    for (const auto& [point, at] : on_surface_) {
        if (impulses_[point].isZero(0.0)) continue;
        for (std::size_t k = 0; k < at.vertices.size(); ++k)
            if (at.weights[k] != 0.0)
                sums.emplace_back(at.vertices[k], at.weights[k] * impulses_[point]);
    }
    std::ranges::stable_sort(sums, {}, &std::pair<VertexId, Vec3>::first);
    std::size_t count = 0;
    for (const auto& [vertex, impulse] : sums) {
        if (count > 0 && sums[count - 1].first == vertex)
            sums[count - 1].second += impulse;
        else
            sums[count++] = {vertex, impulse};
    }
    sums.resize(count);
    return sums;
}

Vec3 ContactSolver::velocity(std::size_t begin, std::size_t end) const {
    Padded sum = Padded::Zero();
    for (std::size_t s = begin; s < end; ++s)
        sum += weights_[s].weight * nodes_[weights_[s].number].velocity;
    return sum.head<3>();
}

Vec3 ContactSolver::velocity(std::size_t i) const {
    return velocity(begins_[i], begins_[i] + weights(i).size());
}

void ContactSolver::take_nodes(std::span<const Vec3> velocities,
                               std::span<const Vec3> inverse_masses) {
    nodes_.resize(node_ids_.size());
    velocities_before_.resize(node_ids_.size());
    changes_.resize(node_ids_.size());
    for (std::size_t i = 0; i < node_ids_.size(); ++i) {
        nodes_[i].velocity << velocities[node_ids_[i].index()], 0.0;
        nodes_[i].inverse_mass << inverse_masses[node_ids_[i].index()], 0.0;
        velocities_before_[i] = nodes_[i].velocity;
    }
}

/// Lists the points that can give way.
void ContactSolver::make_rows(double dt, double rest_step, bool removes_overlaps) {
    rows_.clear();
    rounding_ = rounding_of_length_ / dt;
    auto segment = segment_points_.begin();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (segment != segment_points_.end() && *segment == i) {
            ++segment;
            continue;
        }
        const ContactPoint& point = points_[i];
        const std::size_t begin = begins_[i], end = begin + weights(i).size();
        Padded padded_softness = Padded::Zero();
        double softest = 0.0;
        for (std::size_t s = begin; s < end; ++s) {
            const Padded& of_node = nodes_[weights_[s].number].inverse_mass;
            padded_softness += weights_[s].weight * weights_[s].weight * of_node;
            softest = std::max(softest, of_node.maxCoeff());
        }
        const Vec3 softness = padded_softness.head<3>();
        const double along_normal = point.normal.cwiseAbs2().dot(softness);
        if (!point.is_bilateral && !(along_normal > least_softness * softest)) continue;
        Row& row = rows_.emplace_back();
        row.point = static_cast<std::uint32_t>(i);
        row.begin = static_cast<std::uint32_t>(begin);
        row.end = static_cast<std::uint32_t>(end);
        row.is_bilateral = point.is_bilateral;
        row.velocity = point.velocity;
        row.largest_impulse = point.largest_force * dt;
        if (point.is_bilateral) {
            row.softness = softness;
            row.drift = correction / rest_step * point.offset;
            continue;
        }
        row.normal = point.normal;
        row.friction = point.friction;
        row.hardness = 1.0 / along_normal;
        row.all_hardness = 1.0 / softness.maxCoeff();
        row.allowed = 0.0;
        if (point.gap >= 0.0)
            row.allowed = point.gap / dt;
        else if (removes_overlaps)
            row.allowed = std::max(correction * point.gap, -largest_correction_) / rest_step;
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
    if (row.is_bilateral) return relax_held(row);
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
    if (row.is_bilateral) {
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
    for (const ThreadRow& thread : thread_rows_)
        for (std::size_t k = thread.begin; k < thread.end; ++k) {
            const Vec3& known = points_[segments_[k].point].impulse;
            change_impulse(segments_[k], limited(segments_[k], known, thread.impulse));
        }
    const double share = best_share_of_impulses();
    if (share == 1.0) return;
    for (Row& row : rows_) {
        row.impulse *= share;
        row.normal_impulse *= share;
    }
    for (Row& segment : segments_) segment.impulse *= share;
    for (ThreadRow& thread : thread_rows_) thread.impulse *= share;
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
    const auto add = [&](const Row& row) {
        if (row.impulse.isZero(0.0)) return;
        Padded before = Padded::Zero(), after = Padded::Zero();
        for (std::size_t s = row.begin; s < row.end; ++s) {
            before += weights_[s].weight * velocities_before_[weights_[s].number];
            after += weights_[s].weight * nodes_[weights_[s].number].velocity;
        }
        const Vec3 aim = row.is_bilateral ? row.drift : Vec3(row.allowed * row.normal);
        linear += row.impulse.dot(before.head<3>() - row.velocity + aim);
        square += row.impulse.dot((after - before).head<3>());
    };
    for (const Row& row : rows_) add(row);
    for (const Row& segment : segments_) add(segment);
    for (const ThreadRow& thread : thread_rows_) {
        linear += thread.impulse * thread.rest_rate;
        square += thread.impulse * thread.impulse * thread.softness;
    }
    if (!(square > 0.0)) return 1.0;
    return std::clamp(-linear / square, 0.0, 1.0);
}

void ContactSolver::change_impulse(Row& row, const Vec3& to) {
    Padded change;
    change << to - row.impulse, 0.0;
    for (std::size_t s = row.begin; s < row.end; ++s) {
        Node& node = nodes_[weights_[s].number];
        node.velocity += weights_[s].weight * node.inverse_mass.cwiseProduct(change);
    }
    row.impulse = to;
}

void ContactSolver::make_thread_rows(double dt) {
    thread_rows_.clear();
    segments_.clear();
    for (std::size_t t = 0; t < threads_.size(); ++t) {
        const Thread& thread = threads_[t];
        const std::size_t begin = thread_begins_[t];
        const std::size_t end =
            t + 1 < threads_.size() ? thread_begins_[t + 1] : segment_points_.size();
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t point = segment_points_[k], first = begins_[point];
            const Vec3& span = points_[point].offset;
            Row& segment = segments_.emplace_back();
            segment.point = static_cast<std::uint32_t>(point);
            segment.begin = static_cast<std::uint32_t>(first);
            segment.end = static_cast<std::uint32_t>(first + weights(point).size());
            segment.is_bilateral = true;
            segment.velocity.setZero();
            segment.drift = span / dt;
            Padded padded_softness = Padded::Zero();
            for (std::size_t s = segment.begin; s < segment.end; ++s)
                padded_softness += weights_[s].weight * weights_[s].weight *
                                   nodes_[weights_[s].number].inverse_mass;
            segment.softness = padded_softness.head<3>();
            const double softest = segment.softness.maxCoeff(), length = span.norm();
            const bool turns = length <= turning_length * softest * thread.impulse * dt;
            segment.normal = turns ? Vec3(Vec3::Zero()) : Vec3(span / length);
        }
        thread_rows_.push_back({begin, end, 1.0 / (thread.stiffness * dt * dt), thread.length / dt,
                                thread.largest_force * dt,
                                std::min(thread.impulse, thread.largest_force * dt)});
    }
    directions_.resize(segments_.size());
}

/// Returns the span of a segment at the end of the step over the step.
Vec3 ContactSolver::span_rate(const Row& segment) const {
    return velocity(segment.begin, segment.end) + segment.drift;
}

/// Returns the nearest impulse that a segment can have at a tension.
Vec3 ContactSolver::limited(const Row& segment, const Vec3& impulse, double tension) {
    if (!segment.normal.isZero(0.0))
        return -std::clamp(-impulse.dot(segment.normal), 0.0, tension) * segment.normal;
    const double length = impulse.norm();
    return length > tension ? Vec3(tension / length * impulse) : impulse;
}

/// Pulls the ends of a segment towards each other with the tension, or with less if they then meet.
void ContactSolver::relax_segment(Row& segment, double tension) {
    const Vec3 rate = span_rate(segment);
    const double softest = segment.softness.maxCoeff();
    if (softest > 0.0)
        return change_impulse(segment, limited(segment, segment.impulse - rate / softest, tension));
    const double length = rate.norm();
    if (length > 0.0) change_impulse(segment, -tension / length * rate);
}

/// Makes the tension that of the length that the thread then has at the end of the step. The
/// impulses of the segments grow with it.
void ContactSolver::relax_tension(ThreadRow& thread) {
    double largest = 0.0;
    for (std::size_t k = thread.begin; k < thread.end; ++k)
        largest = std::max(largest, segments_[k].impulse.norm());
    thread.impulse = std::min(thread.impulse, largest);
    double missing = -thread.rest_rate - thread.softness * thread.impulse;
    for (std::size_t k = thread.begin; k < thread.end; ++k) {
        const Row& segment = segments_[k];
        const Vec3 rate = span_rate(segment);
        Vec3 direction = segment.impulse / thread.impulse;
        if (thread.impulse == 0.0)
            direction =
                segment.normal.isZero(0.0) ? Vec3(-rate.stableNormalized()) : Vec3(-segment.normal);
        missing -= direction.dot(rate);
        directions_[k] << direction, 0.0;
        for (std::size_t s = segment.begin; s < segment.end; ++s)
            changes_[weights_[s].number].setZero();
    }
    for (std::size_t k = thread.begin; k < thread.end; ++k)
        for (std::size_t s = segments_[k].begin; s < segments_[k].end; ++s)
            changes_[weights_[s].number] += weights_[s].weight * directions_[k];
    double softness = thread.softness;
    for (std::size_t k = thread.begin; k < thread.end; ++k)
        for (std::size_t s = segments_[k].begin; s < segments_[k].end; ++s) {
            const std::uint32_t n = weights_[s].number;
            softness += weights_[s].weight *
                        directions_[k].dot(nodes_[n].inverse_mass.cwiseProduct(changes_[n]));
        }
    thread.impulse = std::clamp(thread.impulse + missing / softness, 0.0, thread.largest_impulse);
    for (std::size_t k = thread.begin; k < thread.end; ++k)
        change_impulse(segments_[k], thread.impulse * directions_[k].head<3>());
}

void ContactSolver::relax_thread(ThreadRow& thread) {
    for (int sweep = 0; sweep < most_thread_sweeps; ++sweep) {
        const double before = thread.impulse;
        double change = 0.0;
        for (std::size_t k = thread.begin; k < thread.end; ++k) {
            const Vec3 known = segments_[k].impulse;
            relax_segment(segments_[k], thread.impulse);
            change = std::max(change, (segments_[k].impulse - known).norm());
        }
        relax_tension(thread);
        change = std::max(change, std::abs(thread.impulse - before));
        if (change <= thread_accuracy * thread.impulse) return;
    }
}

void ContactSolver::solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses,
                          double dt, double rest_step, bool removes_overlaps) {
    take_nodes(velocities, inverse_masses);
    make_rows(dt, rest_step, removes_overlaps);
    make_thread_rows(dt);
    begin_with_impulses();
    for (int sweep = 0; sweep < num_sweeps; ++sweep) {
        const bool visits_all = sweep == 0 || sweep == num_sweeps - 1;
        for (Row& row : rows_)
            if (visits_all || row.is_bilateral || row.normal_impulse > 0.0) relax(row);
        for (ThreadRow& thread : thread_rows_) relax_thread(thread);
    }
    impulses_.assign(points_.size(), Vec3::Zero());
    for (const Row& row : rows_) impulses_[row.point] = row.impulse;
    for (const Row& segment : segments_) impulses_[segment.point] = segment.impulse;
}

}  // namespace incise::contact
