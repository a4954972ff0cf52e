// Contact between parts of the surface of a body: faces of cuts, pieces, and folds.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "incise/contact/contact_settings.h"
#include "incise/contact/contact_solver.h"
#include "incise/contact/edge_contact.h"
#include "incise/contact/surface_tree.h"
#include "incise/contact/touching_pairs.h"
#include "incise/physics/body/model.h"
#include "incise/topology/boundary_surface.h"

namespace incise::contact {

/// Adds the shares of the nodes that a vertex follows to the last point of a solver.
void add_shares(const physics::Model& model, VertexId v, double weight, ContactSolver& solver);
/// The same for a point of the surface, with what ContactSolver::surface_impulses() needs.
void add_surface_weights(const physics::Model& model, const ContactSolver::OnSurface& at,
                         ContactSolver& solver);

/// Points of contact of the surface of a body with itself.
///
/// Nodes of the surface meet triangles. A node touches the triangle that is nearest to it of those
/// that face it. Of two surfaces that touch, the nodes of both act; of two nodes that are above
/// each other, one. Sharp edges meet edges: see EdgeContact.
class SurfaceContact {
  public:
    /// @param size  mean length of an element at rest, m: distances are parts of it
    SurfaceContact(ContactSettings settings, double size) : settings_(settings), size_(size) {}

    /// Begins with the surface of a body, or follows the edits of a step. Cost: O(n log n) in the
    /// triangles of the surface, and that of the pairs near the edits.
    void follow(const physics::Model& model, const topology::BoundarySurface& surface);
    /// Finds the points of contact at the present positions, and adds them to the solver.
    /// Cost: proportional to the nodes that are near another surface. Now and then, when a part of
    /// the surface has moved by a part of an element, O(n) in the surface and the search for the
    /// pairs of this part; O(n log n) if all of it has.
    /// @pre  follow() was called after the last edit
    void add_points(const physics::Model& model, ContactSolver& solver);
    /// Takes the impulses of the points that add_points() added: the next step begins with them.
    void take_impulses(const ContactSolver& solver);

    /// Returns the surface. The order of its triangles depends on no history of edits.
    TissueSurface surface() const { return {triangles_, faces_}; }
    /// Returns how many nodes and triangles, and edges, were compared so far: the cost of the
    /// searches.
    std::size_t num_tested() const { return pairs_.num_tested() + edges_.num_tested(); }
    /// Returns the largest overlap at the last call of add_points(), m.
    double max_penetration() const { return max_penetration_; }
    const ContactSettings& settings() const { return settings_; }
    double size() const { return size_; }

    void save(ArchiveWriter& ar) const {
        list(ar, *this);
        edges_.save(ar);
    }
    /// Restores what save() wrote. Throws InputError for the data of another body.
    void restore(ArchiveReader& ar, const physics::Model& model,
                 const topology::BoundarySurface& surface);

  private:
    /// A node of the surface that is near triangles.
    struct NearNode {
        std::int32_t touched = -1;  ///< triangle, or -1
        /// The least overlap since the node came to the triangle, m, at most 0. A cut in strained
        /// tissue may leave such an overlap, and edges that pass each other. It goes only as the
        /// sides part: pushed apart, they would gain energy.
        double slack = 0.0;
        /// How far the surface may move before the node can touch a triangle, m.
        double room = 0.0;
        Vec3 impulse = Vec3::Zero();  ///< of the last step, N s
        static void archive(auto& ar, auto& self) {
            ar(self.touched, self.slack, self.room, self.impulse);
        }
    };

    /// Where a node is above a triangle.
    struct Touch {
        Vec3 normal = Vec3::UnitZ();  ///< of the triangle, outward
        Vec3 weights = Vec3::Zero();  ///< of its corners, of the projection of the node
        double gap = std::numeric_limits<double>::infinity();  ///< along the normal, m
    };

    static void list(auto& ar, auto& self) {
        ar(self.settings_, self.size_, self.pairs_, self.near_, self.positions_of_pairs_,
           self.skin_, self.room_, self.max_penetration_);
    }
    ContactBody body(const physics::Model& model) const {
        return {model.mesh(), model.fragments(), faces_, takes_part_};
    }
    void list_triangles(const physics::Model& model, const topology::BoundarySurface& surface);
    void list_lengths(const physics::Model& model);
    Vec3 mean_move(std::span<const Vec3> positions) const;
    bool find_pairs_of_moved(const physics::Model& model);
    void find_pairs(const physics::Model& model);
    std::span<const NodeAndTriangle> touching_pairs();
    double pairs_per_node() const;
    bool has_many_pairs() const;
    bool has_moved_far(std::span<const Vec3> positions);
    void number_nodes(std::size_t node_capacity);
    void find_touched(std::size_t i, const physics::Model& model);
    double length_at(VertexId n, std::size_t t) const;
    bool is_over(VertexId n, std::size_t t, const Touch& at, double outside) const;
    Touch touch(VertexId n, std::size_t t, std::span<const Vec3> positions) const;
    bool is_with_twin(std::size_t i) const;
    void add_point(std::size_t i, const physics::Model& model, ContactSolver& solver);

    ContactSettings settings_;
    double size_;
    std::vector<FaceId> faces_;             // in ascending order
    std::vector<Triangle> triangles_;       // of these faces
    std::vector<std::uint8_t> takes_part_;  // by triangle
    std::vector<double> lengths_;           // of elements at nodes of the surface, by id, m
    SurfaceTree tree_;
    TouchingPairs pairs_;
    EdgeContact edges_;
    std::vector<std::int32_t> near_of_node_;  // by id, index of the node in pairs_, or -1
    std::vector<NearNode> near_;              // by node of pairs_
    std::vector<Vec3> positions_of_pairs_;    // at which pairs_ were found, by id
    double skin_ = 0.5;                       // see widest_skin
    double room_ = -1.0;  // how far the surface may move before pairs_ is out of date, m
    double max_penetration_ = 0.0;
    std::vector<Touch> touches_;             // scratch, by node of pairs_
    std::vector<NodeAndTriangle> touching_;  // scratch of touching_pairs()
    struct {
        std::vector<std::uint8_t> is_node, is_triangle, is_near;
        std::vector<NearNode> known;
        std::vector<VertexId> known_nodes;
    } part_;                                    // scratch of find_pairs_of_moved()
    std::size_t first_point_ = 0;               // in the solver
    std::vector<std::size_t> nodes_of_points_;  // by point from there on, its node in pairs_
};

}  // namespace incise::contact
