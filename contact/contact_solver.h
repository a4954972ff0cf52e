// Impulses at points of contact: no approach, and Coulomb's friction.
// Source: Moreau 1988; Guendelman, Bridson, Fedkiw 2003. Equations: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::contact {

/// A share of a point that is a combination of nodes: x = sum of weight times x_node.
struct Share {
    NodeId node;
    double weight = 0.0;
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
    /// `offset` is what it is now, m, and normal, gap and friction have no meaning.
    bool is_held = false;
    Vec3 offset = Vec3::Zero();
    double largest_force = std::numeric_limits<double>::infinity();  ///< of a point that is held, N
};

/// The points of contact of a step, and their impulses.
class ContactSolver {
  public:
    /// @param size  mean length of an element, m. An approach by a trillionth of it in a step is
    ///              none, so that a cut without load exerts no force. An overlap goes by a
    ///              thousandth of it in a stable step at rest, so that it does not throw the sides
    ///              apart.
    explicit ContactSolver(double size)
        : rounding_of_length_(1e-12 * size), largest_correction_(1e-3 * size) {}

    /// Forgets all points.
    void clear();
    /// Begins a point; its shares follow.
    void begin(const ContactPoint& point);
    /// Adds a share to the last point. Several shares of one node become one.
    void add_share(NodeId node, double weight);
    bool is_empty() const { return points_.empty(); }
    std::size_t size() const { return points_.size(); }
    const ContactPoint& point(std::size_t i) const { return points_[i]; }
    std::span<const Share> shares(std::size_t i) const {
        const std::size_t end = i + 1 < begins_.size() ? begins_[i + 1] : shares_.size();
        return std::span(shares_).subspan(begins_[i], end - begins_[i]);
    }

    /// Finds impulses such that gaps that are open do not become negative in the step, and overlaps
    /// shrink by a tenth of their depth in a stable step at rest, or
    /// less. Makes four sweeps of the method of Gauss and Seidel in the
    /// order of the points, and begins with the impulses of the step before. Linear momentum is
    /// kept to rounding: an impulse acts on the shares of a point by their weights.
    /// @param velocities      by node, at the end of the step without contact, m/s
    /// @param inverse_masses  by node and component, 1/kg; 0 for what is prescribed
    /// @param dt              s
    /// @param rest_step       stable step at rest, s
    void solve(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses, double dt,
               double rest_step);

    /// Returns the impulse of point `i`, N s. It acts on shares by their weights.
    const Vec3& impulse(std::size_t i) const { return impulses_[i]; }

  private:
    /// A node of shares, while the impulses are found.
    struct Node {
        Vec3 velocity, inverse_mass;
    };
    struct LocalShare {
        std::uint32_t node;  // number in nodes_
        double weight;
    };
    /// What a point needs in each sweep.
    struct Row {
        std::size_t point, begin, end;   // of its shares
        double along_normal, along_all;  // change of the relative velocity by an impulse, 1/kg
        double allowed;                  // approach, m/s
        double rounding;                 // an approach that is none, m/s
        double normal_impulse = 0.0;     // N s
        Vec3 softness = Vec3::Zero();    // of a point that is held: by component, 1/kg
        Vec3 drift = Vec3::Zero();       // of the same: velocity that removes its offset, m/s
        double largest_impulse = 0.0;    // of the same, N s
    };
    void number_nodes(std::span<const Vec3> velocities, std::span<const Vec3> inverse_masses);
    void make_rows(double dt, double rest_step);
    void begin_with_impulse(Row& row);
    void relax(Row& row);
    void relax_held(Row& row);
    void change_impulse(const Row& row, const Vec3& to);

    double rounding_of_length_, largest_correction_;
    std::vector<ContactPoint> points_;
    std::vector<std::size_t> begins_;  // by point, of its shares
    std::vector<Share> shares_;
    std::vector<std::int64_t> share_of_node_;  // by node, the last share of it
    std::vector<Vec3> impulses_;
    // Scratch of solve().
    std::vector<std::int32_t> local_of_node_;  // by node; -1 between calls
    std::vector<Node> nodes_;
    std::vector<LocalShare> local_shares_;
    std::vector<Row> rows_;
};

}  // namespace incise::contact
