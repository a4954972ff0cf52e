// The mass-spring model with one spring for each edge of a mesh; and the same as degenerate HEML,
// element by element, with the energy of springs in place of that of a law.
// Source: HEML 2015, section 5.3: (34) to (41), with all six edges of a tetrahedron in (38).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

#include "bench/comparators/element_loop.h"
#include "bench/comparators/heml.h"
#include "incise/physics/elements/mass_spring_kernel.h"

namespace incise::bench {

/// (34) and (35) over the edges of a mesh. Each element of an edge adds E Vol / L^2 to its
/// stiffness, as in physics::MassSpringKernel.
class MassSprings {
  public:
    struct Spring {
        std::uint32_t a, b;
        double stiffness, rest_length;  ///< N/m, m
    };

    MassSprings(double young, std::span<const Nodes> tetrahedra,
                std::span<const Vec3> rest_positions);

    std::span<const Spring> springs() const { return springs_; }

    /// Adds the forces at `positions` (m) to `forces` (N), both by node id.
    /// @pre no edge has length 0
    template <class Scalar>
    void add_forces(std::span<const Vector<Scalar>> positions,
                    std::span<Vector<Scalar>> forces) const {
        using std::sqrt;
        for (const Spring& s : springs_) {
            const Vector<Scalar> v = positions[s.b] - positions[s.a];
            const Scalar length = sqrt(v.squaredNorm());
            const Vector<Scalar> pull =
                (Scalar(s.stiffness) * (length - s.rest_length) / length) * v;
            forces[s.a] += pull;
            forces[s.b] -= pull;
        }
    }

  private:
    std::vector<Spring> springs_;
};

/// W = sum of k/2 (l - L)^2 over the six links, as a function of their squared lengths. Then
/// dW/d(l^2) = k (l - L)/(2 l). With (12), (13) and (B.2), the force on corner i is
/// -dW/d(l^2) DLM_i v^T. This HEML is degenerate, since W is not a function of strain.
struct SpringLinks {
    using Element = physics::MassSpringKernel::Element;

    double young;

    Element precompute(const Corners<double>& X) const {
        return physics::MassSpringKernel{young}.precompute(X);
    }
    Corners<double> forces(const Element& e, const Corners<double>& x) const {
        Eigen::Matrix<double, 6, 1> W_l = squared_links(x);
        for (std::size_t k = 0; k < 6; ++k) {
            double& entry = W_l[static_cast<Eigen::Index>(k)];
            const double length = std::sqrt(entry);
            entry = 0.5 * e.stiffnesses[k] * (length - e.rest_lengths[k]) / length;
        }
        Matrix<double> v;
        v << x[1] - x[0], x[2] - x[0], x[3] - x[0];
        Corners<double> f;
        for (std::size_t i = 0; i < 3; ++i)
            f[i + 1] = -v * (link_derivatives()[i].transpose() * W_l);
        f[0] = -(f[1] + f[2] + f[3]);
        return f;
    }
};

}  // namespace incise::bench
