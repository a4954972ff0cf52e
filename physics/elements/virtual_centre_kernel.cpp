// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/virtual_centre_kernel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "incise/base/error.h"
#include "incise/physics/elements/centre_state.h"
#include "incise/physics/elements/spectrum.h"
#include "incise/physics/laws/stiffening.h"
#include "incise/topology/geometry.h"

namespace incise::physics {

using topology::CellKind;

template <CellKind kind>
std::optional<std::string> VirtualCentreKernel<kind>::why_no_cell(const Corners& X,
                                                                  topology::Diagonals diagonals) {
    const auto at = Division::points(X, diagonals);
    for (const auto& p : Division::parts())
        if (!(topology::tetrahedron_volume(at[p[0]], at[p[1]], at[p[2]], at[p[3]]) > 0.0))
            return "is so distorted that a part between its centre and one of its faces has no "
                   "volume; move its nodes, or divide it into tetrahedra";
    return {};
}

template <CellKind kind>
typename VirtualCentreKernel<kind>::Element VirtualCentreKernel<kind>::precompute(
    const Corners& X, const Vec3& fibre, std::span<const double> part_shares,
    topology::Diagonals diagonals) const {
    assert(part_shares.empty() || part_shares.size() == num_parts);
    const auto at = Division::points(X, diagonals);
    Element e;
    e.diagonals = diagonals;
    e.rest = X;
    e.volume = 0.0;
    e.is_whole = std::ranges::all_of(part_shares, [](double share) { return share == 1.0; });
    if (has_fibres(law)) e.fibre = fibre;
    for (std::size_t t = 0; t < num_parts; ++t) {
        const auto p = Division::parts()[t];
        const LinkElement part = link_element({at[p[0]], at[p[1]], at[p[2]], at[p[3]]});
        e.volumes[t] = part_shares.empty() ? part.volume : part_shares[t] * part.volume;
        e.inverse_edges[t] = part.inverse_edges;
        e.volume += e.volumes[t];
    }
    return e;
}

template <CellKind kind>
std::array<double, VirtualCentreKernel<kind>::num_corners>
VirtualCentreKernel<kind>::mass_fractions(const Element& e) const {
    std::array<double, Division::num_points> of_points{};
    for (std::size_t t = 0; t < num_parts; ++t)
        for (const std::size_t p : CellState<kind>::parts[t])
            of_points[p] += 0.25 * e.volumes[t] / e.volume;
    return Division::gathered(of_points, e.diagonals);
}

namespace {

/// Returns current over rest volume of tetrahedron `t` of a cell with these points.
template <CellKind kind>
double ratio_of_part(const typename VirtualCentreKernel<kind>::Element& e,
                     const typename CentreDivision<kind>::Points& at, std::size_t t) {
    const auto& p = CellState<kind>::parts[t];
    return 6.0 * topology::tetrahedron_volume(at[p[0]], at[p[1]], at[p[2]], at[p[3]]) *
           e.inverse_edges[t].determinant();
}

}  // namespace

template <CellKind kind>
double VirtualCentreKernel<kind>::volume_ratio(const Element& e, const Corners& x) const {
    const auto at = Division::points(x, e.diagonals);
    double volume = 0.0;
    for (std::size_t t = 0; t < num_parts; ++t)
        if (e.volumes[t] > 0.0) volume += e.volumes[t] * ratio_of_part<kind>(e, at, t);
    return volume / e.volume;
}

template <CellKind kind>
double VirtualCentreKernel<kind>::least_volume_ratio(const Element& e, const Corners& x) const {
    double least = std::numeric_limits<double>::infinity();
    std::array<bool, Division::num_points> has_gap{};
    const auto at = Division::points(x, e.diagonals);
    for (std::size_t t = 0; t < num_parts; ++t)
        if (e.volumes[t] > 0.0)
            least = std::min(least, ratio_of_part<kind>(e, at, t));
        else
            for (const std::size_t p : CellState<kind>::parts[t]) has_gap[p] = true;
    constexpr double flat = 1e-6;  // of the volume of the cell
    static constexpr auto corner_parts = Division::corner_parts();
    for (const auto& c : corner_parts) {
        const auto volume_in = [&](const Corners& of) {
            return topology::tetrahedron_volume(of[c[0]], of[c[1]], of[c[2]], of[c[3]]);
        };
        const double at_rest = volume_in(e.rest);
        if (!has_gap[c[0]] && at_rest > flat * e.volume)
            least = std::min(least, volume_in(x) / at_rest);
    }
    return least;
}

template <CellKind kind>
double VirtualCentreKernel<kind>::stiffness_energy(const Element& e) const {
    const HemlKernel of_parts{law, inversion_threshold};
    LinkElement whole;
    whole.volume = e.volume;
    return of_parts.stiffness_energy(whole);
}

template <CellKind kind>
double VirtualCentreKernel<kind>::energy(const Element& e, const Corners& x) const {
    const CellState<kind> state(*this, e, x);
    double sum = 0.0;
    for (std::size_t t = 0; t < num_parts; ++t)
        sum += e.volumes[t] * response(law, state.of_part[t].mean.strain, inversion_threshold).w;
    return sum;
}

// With q the third of P : F of each tetrahedron, and r = g'/g, the stress on F is
// s P + (r(Jm) q_mean - r(J) q) cof F.
template <CellKind kind>
typename VirtualCentreKernel<kind>::Corners VirtualCentreKernel<kind>::forces(
    const Element& e, const Corners& x) const {
    const CellState<kind> state(*this, e, x);
    std::array<Mat3, num_parts> stresses;
    for (std::size_t t = 0; t < num_parts; ++t) {
        const Deformation& d = state.of_part[t].mean;
        stresses[t] = stress_of(response(law, d.strain, inversion_threshold), d, e.fibre).P;
    }
    return forces_of_stresses(*this, e, state, stresses);
}

// Each column is the change of the forces by a motion of one corner along one axis.
template <CellKind kind>
typename VirtualCentreKernel<kind>::Tangent VirtualCentreKernel<kind>::tangent(
    const Element& e, const Corners& x, double share,
    const std::array<Mat3, num_parts>* constant) const {
    const CellState<kind> state(*this, e, x);
    const auto& parts = CellState<kind>::parts;
    std::array<PartTangent, num_parts> of_part;
    double mean_q = 0.0;
    for (std::size_t t = 0; t < num_parts; ++t) {
        PartTangent& p = of_part[t];
        const Deformation& d = state.of_part[t].mean;
        const LawResponse<Dual> r = response(law, with_derivatives(d.strain), inversion_threshold);
        p.r = {share * r.w.value, share * r.w_a.value, share * r.w_b.value, share * r.w_J.value,
               share * r.w_f.value};
        p.by_strain.col(0) = r.w_a.gradient;
        p.by_strain.col(1) = r.w_b.gradient;
        p.by_strain.col(2) = r.w_J.gradient;
        p.by_strain.col(3) = r.w_f.gradient;
        p.by_strain = (0.5 * share * (p.by_strain + p.by_strain.transpose())).eval();
        p.stress = stress_of(p.r, d, e.fibre);
        p.second_stress = second_stress_without_volume(p.r, d.twice_strain, e.fibre);
        if (constant) {
            p.second_stress += (*constant)[t];
            p.stress.P += d.F * (*constant)[t];
            p.stress.pressure = p.stress.P.cwiseProduct(d.F).sum() / 3.0;
        }
        p.F = Mat3::Identity() + state.of_part[t].H;
        p.cof_F = cofactors(p.F);
        p.growth = growth_rate(state.of_part[t].J, inversion_threshold);
        mean_q += e.volumes[t] * p.stress.pressure / e.volume;
    }
    const GrowthRate of_mean = growth_rate(state.mean_J, inversion_threshold);

    Tangent K;
    for (std::size_t corner = 0; corner < num_corners; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
            Corners motion;
            motion.fill(Vec3::Zero());
            motion[corner][axis] = 1.0;
            const auto at = Division::points(motion, e.diagonals);
            std::array<Mat3, num_parts> dF, dP;
            std::array<double, num_parts> dJ, ds, dq;
            double d_mean_J = 0.0, d_mean_q = 0.0;
            for (std::size_t t = 0; t < num_parts; ++t) {
                const auto& p = parts[t];
                Mat3 edges;
                edges << at[p[1]] - at[p[0]], at[p[2]] - at[p[0]], at[p[3]] - at[p[0]];
                dF[t] = edges * e.inverse_edges[t];
                dJ[t] = of_part[t].cof_F.cwiseProduct(dF[t]).sum();
                d_mean_J += e.volumes[t] * dJ[t] / e.volume;
            }
            for (std::size_t t = 0; t < num_parts; ++t) {
                const PartTangent& p = of_part[t];
                const Deformation& d = state.of_part[t].mean;
                const double s = state.of_part[t].scale;
                ds[t] = s / 3.0 * (of_mean.rate * d_mean_J - p.growth.rate * dJ[t]);
                const Mat3 dF_mean = s * dF[t] + ds[t] * p.F;
                const Mat3 half = d.F.transpose() * dF_mean;
                const Mat3 d_strain = half + half.transpose();
                const Mat3 cof = cofactors(d.F);
                const Eigen::Vector4d invariants(
                    d_strain.trace(), 2.0 * d.twice_strain.cwiseProduct(d_strain).sum(),
                    cof.cwiseProduct(dF_mean).sum(), e.fibre.dot(d_strain * e.fibre));
                const Eigen::Vector4d dw = p.by_strain * invariants;
                Mat3 dS = 4.0 * dw[1] * d.twice_strain + 4.0 * p.r.w_b * d_strain +
                          2.0 * dw[3] * (e.fibre * e.fibre.transpose());
                dS.diagonal().array() += 2.0 * dw[0];
                dP[t] = dF_mean * p.second_stress + d.F * dS + dw[2] * cof +
                        p.r.w_J * cofactor_change(d.F, dF_mean);
                dq[t] =
                    (dP[t].cwiseProduct(d.F).sum() + p.stress.P.cwiseProduct(dF_mean).sum()) / 3.0;
                d_mean_q += e.volumes[t] * dq[t] / e.volume;
            }
            const double d_volumetric_mean =
                of_mean.slope * d_mean_J * mean_q + of_mean.rate * d_mean_q;
            typename Division::Points f;
            f.fill(Vec3::Zero());
            for (std::size_t t = 0; t < num_parts; ++t) {
                const PartTangent& p = of_part[t];
                const double volumetric = of_mean.rate * mean_q - p.growth.rate * p.stress.pressure;
                const double d_volumetric = d_volumetric_mean -
                                            p.growth.slope * dJ[t] * p.stress.pressure -
                                            p.growth.rate * dq[t];
                const Mat3 of_stress = ds[t] * p.stress.P + state.of_part[t].scale * dP[t] +
                                       d_volumetric * p.cof_F +
                                       volumetric * cofactor_change(p.F, dF[t]);
                add_forces(of_stress, e.volumes[t], e.inverse_edges[t], parts[t], f);
            }
            const Corners change = Division::gathered(f, e.diagonals);
            const auto column = static_cast<Eigen::Index>(3 * corner) + axis;
            for (std::size_t k = 0; k < num_corners; ++k)
                K.col(column).template segment<3>(static_cast<Eigen::Index>(3 * k)) = -change[k];
        }
    return 0.5 * (K + K.transpose());
}

// Of the strains e_t, the shape counts in each tetrahedron, and the volume as a mean. Fibres feel
// H : e, with e of the tetrahedron's shape and the mean volume.
template <CellKind kind>
typename VirtualCentreKernel<kind>::Tangent VirtualCentreKernel<kind>::rest_tangent(
    const Element& e) const {
    using Gradients = Eigen::Matrix<double, 3, static_cast<int>(num_corners)>;
    std::array<Gradients, num_parts> of_part;  // of the shape functions of the corners, 1/m
    Gradients mean = Gradients::Zero();
    for (std::size_t t = 0; t < num_parts; ++t) {
        const auto& p = CellState<kind>::parts[t];
        typename Division::Points at_points;
        at_points.fill(Vec3::Zero());
        for (std::size_t k = 1; k < 4; ++k) {
            const Vec3 gradient =
                e.inverse_edges[t].row(static_cast<Eigen::Index>(k - 1)).transpose();
            at_points[p[k]] += gradient;
            at_points[p[0]] -= gradient;
        }
        const Corners at_corners = Division::gathered(at_points, e.diagonals);
        for (std::size_t k = 0; k < num_corners; ++k)
            of_part[t].col(static_cast<Eigen::Index>(k)) = at_corners[k];
        mean += e.volumes[t] / e.volume * of_part[t];
    }
    const double mu = rest_mu(law), bulk = rest_lambda(law) + 2.0 / 3.0 * mu;
    const RestFibres fibres = rest_fibres(law);
    const auto flat = [](const Gradients& g) {
        return Eigen::Map<const Eigen::Matrix<double, 3 * static_cast<int>(num_corners), 1>>(
            g.data());
    };
    Tangent K = bulk * e.volume * flat(mean) * flat(mean).transpose();
    for (std::size_t t = 0; t < num_parts; ++t) {
        const Gradients& g = of_part[t];
        const double stiffness = mu * e.volumes[t];
        for (Eigen::Index j = 0; j < g.cols(); ++j)
            for (Eigen::Index i = 0; i <= j; ++i) {
                Mat3 block = stiffness * (g.col(j) * g.col(i).transpose() -
                                          2.0 / 3.0 * g.col(i) * g.col(j).transpose());
                block.diagonal().array() += stiffness * g.col(i).dot(g.col(j));
                K.template block<3, 3>(3 * i, 3 * j) += block;
                if (i != j) K.template block<3, 3>(3 * j, 3 * i) += block.transpose();
            }
        if (fibres.modulus == 0.0) continue;
        const double along = 1.0 - 3.0 * fibres.dispersion, third = 1.0 / 3.0;
        const Mat3 H = fibres.dispersion * Mat3::Identity() + along * e.fibre * e.fibre.transpose();
        const Gradients h = H * g + third * H.trace() * (mean - g);
        K += fibres.modulus * e.volumes[t] * flat(h) * flat(h).transpose();
    }
    return K;
}

template <CellKind kind>
std::array<double, VirtualCentreKernel<kind>::num_corners>
VirtualCentreKernel<kind>::stiffness_bounds(const Element& e, const Corners&) const {
    // The eigenvalue can grow by more than stiffening(), which bounds moduli: by up to 1.17 of it
    // in 200 random states of each law and kind, at strains of up to 30 %. With nu below 0 the
    // highest modulus is that of shear, which grows by itself.
    constexpr double growth_margin = 1.2;
    const double mu = rest_mu(law), of_shear = 2.0 * mu / (rest_lambda(law) + 2.0 * mu);
    const auto masses = mass_fractions(e);
    Tangent scaled = rest_tangent(e);
    for (std::size_t k = 0; k < num_corners; ++k) {
        const double by = 1.0 / std::sqrt(masses[k]);
        scaled.template middleRows<3>(static_cast<Eigen::Index>(3 * k)) *= by;
        scaled.template middleCols<3>(static_cast<Eigen::Index>(3 * k)) *= by;
    }
    const double highest =
        growth_margin * std::max(1.0, of_shear) * spectrum(scaled).values.maxCoeff();
    std::array<double, num_corners> s;
    for (std::size_t k = 0; k < num_corners; ++k) s[k] = highest * masses[k];
    return s;
}

template <CellKind kind>
double VirtualCentreKernel<kind>::stiffening(const Element& e, const Corners& x) const {
    const CellState<kind> state(*this, e, x);
    double largest = 0.0;
    for (std::size_t t = 0; t < num_parts; ++t) {
        if (e.volumes[t] == 0.0) continue;
        const PartState& part = state.of_part[t];
        for (const auto& strain : {part.mean.strain, deformation_of(part.H, e.fibre).strain})
            largest = std::max(largest, physics::stiffening(law, strain, inversion_threshold));
    }
    return largest;
}

template struct VirtualCentreKernel<CellKind::hexahedron>;
template struct VirtualCentreKernel<CellKind::wedge>;
template struct VirtualCentreKernel<CellKind::pyramid>;

}  // namespace incise::physics
