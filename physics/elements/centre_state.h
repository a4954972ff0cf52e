// The deformation of a hexahedron, wedge or pyramid, and what follows from it: for the kernels of
// these cells. Equations: docs/theory.md, Hexahedra, wedges and pyramids.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>

#include "incise/physics/elements/virtual_centre_kernel.h"

namespace incise::physics {

/// The function g of VirtualCentreKernel as g'/g, and its derivative.
struct GrowthRate {
    double rate, slope;
};
inline GrowthRate growth_rate(double J, double threshold) {
    if (J >= threshold) return {1.0 / J, -1.0 / (J * J)};
    return {1.0 / threshold, 0.0};
}
inline double grown(double J, double threshold) {
    return J >= threshold ? J : threshold * std::exp((J - threshold) / threshold);
}

/// The deformation of one tetrahedron of a cell.
struct PartState {
    Mat3 H;            ///< F - 1
    double J;          ///< its own volume ratio
    double scale;      ///< (g(Jm)/g(J))^(1/3)
    Deformation mean;  ///< of scale F
};

inline Deformation deformation_of(const Mat3& H, const Vec3& fibre) {
    Deformation d;
    d.F = Mat3::Identity() + H;
    d.twice_strain = H + H.transpose() + H.transpose() * H;
    d.strain = {d.twice_strain.trace(), d.twice_strain.squaredNorm(), d.F.determinant(),
                fibre.dot(d.twice_strain * fibre)};
    return d;
}

/// The deformation of a cell.
template <topology::CellKind kind>
struct CellState {
    using Kernel = VirtualCentreKernel<kind>;
    using Division = CentreDivision<kind>;
    static constexpr auto parts = Division::parts();

    std::array<PartState, Kernel::num_parts> of_part;
    double mean_J = 0.0;

    CellState(const Kernel& kernel, const typename Kernel::Element& e,
              const typename Kernel::Corners& x) {
        typename Kernel::Corners u;
        for (std::size_t k = 0; k < u.size(); ++k) u[k] = x[k] - e.rest[k];
        const auto at = Division::points(u, e.diagonals);
        for (std::size_t t = 0; t < parts.size(); ++t) {
            const auto& p = parts[t];
            Mat3 edges;
            edges << at[p[1]] - at[p[0]], at[p[2]] - at[p[0]], at[p[3]] - at[p[0]];
            of_part[t].H = edges * e.inverse_edges[t];
            of_part[t].J = (Mat3::Identity() + of_part[t].H).determinant();
            mean_J += e.volumes[t] * of_part[t].J;
        }
        mean_J /= e.volume;
        const double of_mean = grown(mean_J, kernel.inversion_threshold);
        for (PartState& part : of_part) {
            part.scale = std::cbrt(of_mean / grown(part.J, kernel.inversion_threshold));
            Mat3 H = part.scale * part.H;
            H.diagonal().array() += part.scale - 1.0;
            part.mean = deformation_of(H, e.fibre);
        }
    }
};

/// The first Piola-Kirchhoff stress of a law, and a third of its product with F.
struct PartStress {
    Mat3 P;
    double pressure;
};
inline PartStress stress_of(const LawResponse<double>& r, const Deformation& d, const Vec3& fibre) {
    PartStress s;
    s.P = d.F * second_stress_without_volume(r, d.twice_strain, fibre) + r.w_J * cofactors(d.F);
    s.pressure = s.P.cwiseProduct(d.F).sum() / 3.0;
    return s;
}

inline Mat3 cofactor_change(const Mat3& F, const Mat3& by) {
    Mat3 change;
    change << by.col(1).cross(F.col(2)) + F.col(1).cross(by.col(2)),
        by.col(2).cross(F.col(0)) + F.col(2).cross(by.col(0)),
        by.col(0).cross(F.col(1)) + F.col(0).cross(by.col(1));
    return change;
}

/// What the tangent of a cell needs of one of its tetrahedra.
struct PartTangent {
    LawResponse<double> r;
    Eigen::Matrix4d by_strain;  ///< derivatives of w_a, w_b, w_J and w_f by a, b, J and f
    PartStress stress;
    Mat3 F, cof_F, second_stress;
    GrowthRate growth;
};

/// Adds the forces of a stress in one tetrahedron to those at its points.
template <class Points>
void add_forces(const Mat3& P, double volume, const Mat3& inverse_edges,
                const std::array<std::size_t, 4>& part, Points& f) {
    const Mat3 of_corners = -volume * (P * inverse_edges.transpose());
    f[part[0]] -= of_corners.rowwise().sum();
    for (std::size_t k = 1; k < 4; ++k)
        f[part[k]] += of_corners.col(static_cast<Eigen::Index>(k - 1));
}

/// Returns the forces of stresses dw/dF' of the tetrahedra of a cell, N: those on the corners that
/// the chain rule through scale and mean volume gives.
template <topology::CellKind kind>
typename CentreDivision<kind>::Corners forces_of_stresses(
    const VirtualCentreKernel<kind>& kernel, const typename VirtualCentreKernel<kind>::Element& e,
    const CellState<kind>& state,
    const std::array<Mat3, CentreDivision<kind>::num_parts>& stresses) {
    using Division = CentreDivision<kind>;
    std::array<double, Division::num_parts> pressures;
    double of_mean = 0.0;
    for (std::size_t t = 0; t < Division::num_parts; ++t) {
        pressures[t] = stresses[t].cwiseProduct(state.of_part[t].mean.F).sum() / 3.0;
        of_mean += e.volumes[t] * pressures[t];
    }
    of_mean *= growth_rate(state.mean_J, kernel.inversion_threshold).rate / e.volume;
    typename Division::Points f;
    f.fill(Vec3::Zero());
    for (std::size_t t = 0; t < Division::num_parts; ++t) {
        const PartState& part = state.of_part[t];
        const double volumetric =
            of_mean - growth_rate(part.J, kernel.inversion_threshold).rate * pressures[t];
        const Mat3 P = part.scale * stresses[t] + volumetric * cofactors(Mat3::Identity() + part.H);
        add_forces(P, e.volumes[t], e.inverse_edges[t], CellState<kind>::parts[t], f);
    }
    return Division::gathered(f, e.diagonals);
}

}  // namespace incise::physics
