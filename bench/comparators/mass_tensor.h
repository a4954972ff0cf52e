// The mass-tensor model with large deformation: forces as a cubic polynomial of displacements, its
// coefficients summed up at nodes, edges, and triples of nodes. Saint Venant-Kirchhoff tissue only.
// Source: G. Picinbono, H. Delingette, N. Ayache, Non-linear and anisotropic elastic soft tissue
// models for medical simulation, ICRA 2001; HEML 2015, eq. (42), where F is the energy's gradient.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cassert>

#include "bench/comparators/element_loop.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Coefficients of (42), those of them that are not zero: of pairs and triples of nodes that have
/// an element in common with the node whose force it is. Factors and signs are in the coefficients.
class MassTensor {
  public:
    /// Force on p, of displacement j: -B_pj, N/m.
    struct Linear {
        std::uint32_t j;
        Matrix<double> B;
    };
    /// Of displacements j and k: -2 C_jkp and -C_pjk, N/m2.
    struct Quadratic {
        std::uint32_t j, k;
        Vector<double> C_jkp, C_pjk;
    };
    /// Of displacements j, k and l: -4 D_jklp, N/m3.
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

    /// By node id.
    std::span<const Node> nodes() const { return nodes_; }

    /// Adds the forces at `positions` (m) to `forces` (N), both by node id. The displacements from
    /// rest count, however far the body has gone.
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

    /// Numbers kept, of eight bytes.
    std::size_t num_coefficients() const;

  private:
    std::vector<Vec3> rest_positions_;
    std::vector<Node> nodes_;
};

}  // namespace incise::bench
