// Impulses at points of contact: no approach, and Coulomb's friction.
// Source: Moreau 1988; Guendelman, Bridson, Fedkiw 2003. Equations: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "incise/base/types.h"

namespace incise::contact {

/// A share of a point that is a combination of nodes: x = sum of weight times x_node.
struct NodeWeight {
    NodeId node;
    std::uint32_t number;  ///< of the node in ContactSolver::nodes()
    double weight;
};

/// A point of contact: the relative position of two points of bodies, sum of weight times x_node.
/// The weights of a point against another one sum to 0, those of a point against a rigid body to 1.
struct ContactPoint {
    Vec3 normal = Vec3::UnitZ();   ///< along which the relative position grows when they part
    double gap = 0.0;              ///< m; below 0: they overlap
    double friction = 0.0;         ///< Coulomb's coefficient
    Vec3 velocity = Vec3::Zero();  ///< of a rigid body at the point, m/s; else 0
    Vec3 impulse = Vec3::Zero();   ///< of the step before, N s: where the search begins
    /// True if the point is held: its relative position is to become 0 in all directions. Then
    /// `offset` is what it is now, m, and normal, gap and friction have no meaning. The segment of
    /// a thread is held too.
    bool is_bilateral = false;
    Vec3 offset = Vec3::Zero();
    /// Above it a point that is held slips, and another one is passed through, N.
    double largest_force = std::numeric_limits<double>::infinity();
};

/// A thread through points of bodies, between which it has straight segments. It bears tension
/// only, and the same everywhere.
struct Thread {
    double length = 0.0;     ///< without tension, at the end of the step, m
    double stiffness = 0.0;  ///< N/m, above 0
    double largest_force = std::numeric_limits<double>::infinity();  ///< N
    double impulse = 0.0;  ///< tension times time in the step before, N s: where the search begins
};

/// The points of contact and the threads of a step, and their impulses.
class ContactSolver {
  public:
    /// The share of an overlap that goes in a stable step at rest.
    static constexpr double correction = 0.1;

    /// @param size  mean length of an element, m. An approach by a trillionth of it in a step is
    ///              none, so that a cut without load exerts no force. An overlap goes by a
    ///              thousandth of it in a stable step at rest, so that it does not throw the sides
    ///              apart.
    explicit ContactSolver(double size)
        : rounding_of_length_(1e-12 * size), largest_correction_(1e-3 * size) {}

    /// Forgets all points and threads.
    void clear();
    /// Begins a point; its shares follow.
    void begin(const ContactPoint& point);
    /// Adds a share to the last point. Several shares of one node become one.
    void add_weight(NodeId node, double weight);
    /// Vertices of the surface with their weights: at most four, the others have no weight.
    struct OnSurface {
        std::array<VertexId, 4> vertices = {};
        std::array<double, 4> weights = {};
    };
    /// Notes which vertices of the surface the last point depends on. It is for surface_impulses()
    /// alone.
    void note_surface(const OnSurface& at) { on_surface_.emplace_back(points_.size() - 1, at); }
    /// Begins a thread; its segments follow.
    void begin_thread(const Thread& thread);
    /// Begins a segment of the last thread; its shares follow.
    /// @param span     from one end of the segment to the other, m: sum of weight times x_node
    /// @param impulse  that of the step before, N s: where the search begins
    void begin_segment(const Vec3& span, const Vec3& impulse);
    bool is_empty() const { return points_.empty(); }
    std::size_t size() const { return points_.size(); }
    const ContactPoint& point(std::size_t i) const { return points_[i]; }
    /// Returns the nodes of all points and threads, each once.
    std::span<const NodeId> nodes() const { return node_ids_; }
    std::span<const NodeWeight> weights(std::size_t i) const {
        const std::size_t end = i + 1 < begins_.size() ? begins_[i + 1] : weights_.size();
        return std::span(weights_).subspan(begins_[i], end - begins_[i]);
    }

    /// Finds impulses such that gaps that are open do not become negative in the step, and overlaps
    /// shrink by a tenth of their depth in a stable step at rest, or less. The tension of a thread
    /// is that at the end of the step, so that no stiffness is too large for the step.
    ///
    /// Makes four sweeps of the method of Gauss and Seidel in the order of the points and then of
    /// the threads, and begins with the impulses of the step before, or the best share of them. The
    /// two sweeps in the middle leave out points without impulse.
    /// Linear momentum is kept to rounding: an impulse acts on the shares of a point by their
    /// weights. Source: docs/theory.md, Contact. Cost: O(n) in the shares.
    /// @param velocities      by node id, at the end of the step without contact, m/s
    /// @param inverse_masses  by node id and component, 1/kg; 0 for what is prescribed. Only those
    ///                        of nodes() are read.
    /// @param dt              s
    /// @param rest_step       stable step at rest, s
    /// @param removes_overlaps  false: overlaps stay as deep as they are
    void solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses, double dt,
               double rest_step, bool removes_overlaps = true);

    /// Returns the impulse of point `i`, N s. It acts on shares by their weights.
    const Vec3& impulse(std::size_t i) const { return impulses_[i]; }
    /// Sums what the points exert on the vertices of the surface, N s, where it is not zero, in
    /// ascending order of the vertices.
    std::vector<std::pair<VertexId, Vec3>> surface_impulses() const;
    /// Returns the relative velocity of the shares of point `i` after solve(), m/s.
    Vec3 velocity(std::size_t i) const;

    std::size_t num_threads() const { return threads_.size(); }
    /// Returns the tension of a thread times the step, N s.
    double thread_impulse(std::size_t thread) const { return thread_rows_[thread].impulse; }

  private:
    /// Three components and a zero: two instructions where three numbers take three.
    using Padded = Eigen::Vector4d;
    /// A node of shares, while the impulses are found.
    struct Node {
        Padded velocity, inverse_mass;
    };
    /// What a point needs in each sweep.
    struct Row {
        std::uint32_t point, begin, end;  // of its shares
        bool is_bilateral;
        double friction, largest_impulse;  // the latter in N s
        double allowed;                    // approach, m/s
        double hardness, all_hardness;     // impulse for a change of the relative velocity, kg:
                                           // along the normal, and in the softest direction
        double normal_impulse = 0.0;       // N s
        Vec3 impulse = Vec3::Zero();       // N s
        Vec3 normal, velocity;             // of the point
        Vec3 softness = Vec3::Zero();      // of a point that is held: by component, 1/kg
        Vec3 drift = Vec3::Zero();         // of the same: velocity that removes its offset, m/s
    };
    /// The same for a thread.
    struct ThreadRow {
        std::size_t begin, end;  // of its segments in segments_
        double softness;         // of the thread itself, 1/kg
        double rest_rate;        // its length without tension over the step, m/s
        double largest_impulse;  // N s
        double impulse = 0.0;    // its tension times the step, N s
    };
    std::uint32_t number_of(NodeId node);
    Vec3 velocity(std::size_t begin, std::size_t end) const;
    void take_nodes(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses);
    void make_rows(double dt, double rest_step, bool removes_overlaps);
    void begin_with_impulse(Row& row);
    void begin_with_impulses();
    double best_share_of_impulses() const;
    void relax(Row& row);
    void relax_held(Row& row);
    void change_impulse(Row& row, const Vec3& to);
    void make_thread_rows(double dt);
    Vec3 span_rate(const Row& segment) const;
    static Vec3 limited(const Row& segment, const Vec3& impulse, double tension);
    void relax_segment(Row& segment, double tension);
    void relax_tension(ThreadRow& thread);
    void relax_thread(ThreadRow& thread);

    double rounding_of_length_, largest_correction_;
    std::vector<ContactPoint> points_;
    std::vector<std::size_t> begins_;  // by point, of its shares
    std::vector<NodeWeight> weights_;
    std::vector<std::pair<std::size_t, OnSurface>> on_surface_;  // with the numbers of points
    std::vector<NodeId> node_ids_;                               // by number
    std::vector<std::int32_t> number_by_id_;                     // by node id, -1: none
    std::vector<std::size_t> last_weights_;  // by number, the last share of the node
    std::vector<Vec3> impulses_;
    // Scratch of solve().
    std::vector<Node> nodes_;                // by number
    std::vector<Padded> velocities_before_;  // by number, without impulses
    std::vector<Row> rows_;
    double rounding_ = 0.0;  // an approach that is none, m/s
    // Threads.
    std::vector<Thread> threads_;
    std::vector<std::size_t> segment_points_;  // by segment, its number as a point
    std::vector<std::size_t> thread_begins_;   // by thread, of its segments
    std::vector<ThreadRow> thread_rows_;       // by thread
    std::vector<Row> segments_;
    std::vector<Padded> directions_, changes_;  // by segment, by number: scratch of a relaxation
};

}  // namespace incise::contact
