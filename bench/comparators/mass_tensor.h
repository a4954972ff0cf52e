// The mass-tensor model for large deformation of Saint Venant-Kirchhoff tissue. Forces are a cubic
// polynomial of displacements, with coefficients summed at nodes, pairs and triples of nodes.
// Source: G. Picinbono, H. Delingette, N. Ayache, Non-linear and anisotropic elastic soft tissue
// models for medical simulation, ICRA 2001; HEML 2015, eq. (42), where F is the energy's gradient.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cassert>

#include "bench/comparators/element_loop.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// The coefficients of (42) that are not zero. These belong to nodes, pairs and triples of nodes
/// that share an element with the node of the force. Factors and signs are included.
class MassTensor {
  public:
    /// The force on p by the displacement of j: -B_pj, N/m.
    struct Linear {
        std::uint32_t j;
        Matrix<double> B;
    };
    /// The force by the displacements of j and k: -2 C_jkp and -C_pjk, N/m2.
    struct Quadratic {
        std::uint32_t j, k;
        Vector<double> C_jkp, C_pjk;
    };
    /// The force by the displacements of j, k and l: -4 D_jklp, N/m3.
    struct Cubic {
        std::uint32_t j, k, l;
        double D;
    };
    struct Node {
        std::vector<Linear> linear;
        std::vector<Quadratic> quadratic;
        std::vector<Cubic> cubic;
    };

    MassTensor(const physics::SaintVenantKirchhoff& law, std::span<const Nodes> tetrahedra,
               std::span<const Vec3> rest_positions);

    /// Returns the coefficients by node id.
    std::span<const Node> nodes() const { return nodes_; }

    /// Adds the forces at `positions` (m) to `forces` (N), both by node id. Sets `displacements`
    /// (m) to those from the rest positions.
    template <class Scalar>
    void add_forces(std::span<const Vector<Scalar>> positions, std::span<Vector<Scalar>> forces,
                    std::vector<Vector<Scalar>>& displacements) const {
        displacements.resize(positions.size());
        for (std::size_t n = 0; n < positions.size(); ++n)
            displacements[n] = positions[n] - rest_positions_[n].template cast<Scalar>();
        const auto& u = displacements;
        for (std::size_t p = 0; p < nodes_.size(); ++p) {
            Vector<Scalar>& f = forces[p];
            for (const Linear& t : nodes_[p].linear) f += t.B.template cast<Scalar>() * u[t.j];
            for (const Quadratic& t : nodes_[p].quadratic)
                f += u[t.j].dot(t.C_jkp.template cast<Scalar>()) * u[t.k] +
                     u[t.j].dot(u[t.k]) * t.C_pjk.template cast<Scalar>();
            for (const Cubic& t : nodes_[p].cubic) f += (Scalar(t.D) * u[t.k].dot(u[t.j])) * u[t.l];
        }
    }

    /// Returns the count of stored numbers, of eight bytes each.
    std::size_t num_coefficients() const;

  private:
    std::vector<Vec3> rest_positions_;
    std::vector<Node> nodes_;
};

}  // namespace incise::bench
