// Contact between edges of the surface of a body.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/base/types.h"
#include "incise/contact/contact_solver.h"
#include "incise/contact/surface_edges.h"
#include "incise/contact/surface_tree.h"
#include "incise/contact/touching_pairs.h"
#include "incise/physics/body/model.h"

namespace incise::contact {

/// Points of contact of two edges of the surface that cross each other between their nodes.
///
/// One of the two edges is sharp at rest; the other one may be any. They touch if a direction at
/// right angles to both is between the normals of the two triangles at each: no point of contact
/// arises where a surface is flat or hollow, and nodes meet triangles. If they overlap, it is
/// enough if that holds for one of the edges: then the other one is inside the wedge there.
class EdgeContact {
  public:
    /// Takes note of a new surface. Pairs of edges that it still has are kept.
    void set_surface(const SurfaceTree& tree, const ContactBody& body);
    /// Finds the pairs of edges that are near each other. Cost: that of the sharp edges and of the
    /// pairs found.
    /// @param tree   fitted to the positions
    /// @param reach  distance that counts as near, m
    void find(const SurfaceTree& tree, const ContactBody& body, std::span<const Vec3> positions,
              double reach);
    /// Finds anew the pairs with edges at some nodes, and keeps the others.
    /// @param is_moved  by vertex id, 1: edges there are found anew
    /// @param is_near   likewise, 1: edges there may have such edges near them
    void find_again(const SurfaceTree& tree, const ContactBody& body,
                    std::span<const Vec3> positions, double reach,
                    std::span<const std::uint8_t> is_moved, std::span<const std::uint8_t> is_near);

    /// What add_points() needs of the surface.
    struct Surface {
        TissueSurface triangles;
        std::span<const double> lengths;  ///< of elements at nodes of the surface, by id, m
        double reach;                     ///< at which edges are a point of contact at most, m
        double rounding;                  ///< an overlap that is none, m
        double friction;                  ///< Coulomb's coefficient
    };
    /// Finds the points of contact at the present positions, and adds them to the solver.
    void add_points(const physics::Model& model, const Surface& surface, ContactSolver& solver);
    /// Takes the impulses of the points that add_points() added: the next step begins with them.
    void take_impulses(const ContactSolver& solver);
    /// Returns the largest overlap at the last call of add_points(), m.
    double max_penetration() const { return max_penetration_; }
    /// Returns how many edges were compared so far: the cost of the searches.
    std::size_t num_tested() const { return num_tested_; }

    void save(ArchiveWriter& ar) const { list(ar, *this); }
    /// Restores what save() wrote. Throws InputError for the data of another body.
    /// @pre  set_surface() was called
    void restore(ArchiveReader& ar, std::size_t node_capacity);

  private:
    static void list(auto& ar, auto& self) {
        ar(self.pairs_, self.touching_, self.nodes_, self.last_positions_, self.max_penetration_);
    }
    struct Edges {
        std::uint32_t sharp, other;  // if both are sharp, the lower one is first
        auto operator<=>(const Edges&) const = default;
        static void archive(auto& ar, auto& self) { ar(self.sharp, self.other); }
    };
    struct Pair {
        Edges edges;
        double room = 0.0;  // by how much they may come nearer before they can touch, m
        static void archive(auto& ar, auto& self) { ar(self.edges, self.room); }
    };
    struct Touching {
        Edges edges;
        double gap;    // m
        double slack;  // see SurfaceContact::NearNode, m
        Vec3 impulse;  // of the last step, N s
        static void archive(auto& ar, auto& self) {
            ar(self.edges, self.gap, self.slack, self.impulse);
        }
    };
    /// Where two edges are closest.
    struct Touch {
        double on_first, on_second;  // parts of the ways from the first node to the second
        Vec3 normal;                 // out of the second
        double gap;                  // along the normal, m
        double slack;                // see Touching
        Vec3 impulse;                // likewise
    };
    void append_pairs(const SurfaceTree& tree, const ContactBody& body,
                      std::span<const Vec3> positions, double reach,
                      std::span<const std::uint32_t> sharp, std::span<const std::uint8_t> is_moved);
    bool are_near(const SurfaceTree& tree, const ContactBody& body, std::span<const Vec3> positions,
                  double reach, std::uint32_t sharp, std::uint32_t other);
    Edges in_order(std::uint32_t sharp, std::uint32_t other) const;
    const Touching* continued(const Edges& edges) const;
    void take_found(std::span<const Vec3> positions);
    bool find_touch(Pair& pair, const Touching* known, const physics::Model& model,
                    const Surface& surface, double reach, Touch& touch) const;

    SurfaceEdges edges_;
    std::vector<std::uint32_t> sharp_;  // edges that are sharp and take part
    std::vector<Pair> pairs_;           // in ascending order
    std::vector<Touching> touching_;    // likewise: points of the last step
    std::vector<VertexId> nodes_;       // of the pairs
    std::vector<Vec3> last_positions_;  // of nodes_, by id, m
    double max_penetration_ = 0.0;
    std::size_t first_point_ = 0;            // in the solver, that of the first in touching_
    std::vector<double> moves_;              // scratch, by vertex id: in the last step, m
    std::vector<Pair> found_;                // scratch
    std::vector<Touching> did_touch_;        // scratch
    std::vector<std::uint32_t> near_;        // scratch
    std::vector<Box> boxes_;                 // scratch, by edge of near_
    std::vector<NodeId> around_;             // scratch
    std::vector<CellId> star_;               // scratch
    std::vector<std::uint8_t> is_followed_;  // scratch, by vertex id
    std::array<std::vector<std::uint32_t>, 2> sharp_again_;  // scratch of find_again()
    std::size_t num_tested_ = 0;
};

}  // namespace incise::contact
