// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/centre_viscous_kernel.h"

#include <algorithm>
#include <utility>

#include "incise/physics/elements/centre_state.h"

namespace incise::physics {

using topology::CellKind;

namespace {

using Components = Eigen::Matrix<double, 6, 1>;  // 11, 22, 33, 12, 23, 31

Mat3 tensor_of(const Components& t) {
    Mat3 matrix;
    matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    return matrix;
}
Components components_of(const Mat3& matrix) {
    Components t;
    t << matrix(0, 0), matrix(1, 1), matrix(2, 2), matrix(0, 1), matrix(1, 2), matrix(2, 0);
    return t;
}

/// The memory of a cell: row 0 has the stresses of the law, row i those of term i - 1.
template <class Number>
auto components(std::span<Number> memory, std::size_t num_parts, std::size_t row, std::size_t t) {
    using Map = std::conditional_t<std::is_const_v<Number>, const Components, Components>;
    return Eigen::Map<Map>(memory.data() + 6 * (row * num_parts + t));
}

}  // namespace

template <CellKind kind>
CentreViscousKernel<kind>::CentreViscousKernel(const Elastic& elastic, std::vector<PronyTerm> prony)
    : Elastic(elastic), terms(std::move(prony)), steps(terms.size()) {
    for (const PronyTerm& term : terms) long_time_share -= term.alpha;
}

template <CellKind kind>
double CentreViscousKernel<kind>::energy(const Element& e, const Corners& x) const {
    return long_time_share * Elastic::energy(e, x);
}

template <CellKind kind>
typename CentreViscousKernel<kind>::Corners CentreViscousKernel<kind>::forces_of_memory(
    const Element& e, const Corners& x, std::span<const double> memory) const {
    const CellState<kind> state(*this, e, x);
    Stresses stresses;
    for (std::size_t t = 0; t < num_parts; ++t) {
        Components relaxed = -(1.0 - long_time_share) * components(memory, num_parts, 0, t);
        for (std::size_t i = 0; i < terms.size(); ++i)
            relaxed += components(memory, num_parts, i + 1, t);
        stresses[t] = state.of_part[t].mean.F * tensor_of(relaxed);
    }
    return forces_of_stresses(*this, e, state, stresses);
}

template <CellKind kind>
typename CentreViscousKernel<kind>::Corners CentreViscousKernel<kind>::forces(
    const Element& e, const Corners& x, std::span<const double> memory) const {
    Corners f = Elastic::forces(e, x);
    const Corners of_memory = forces_of_memory(e, x, memory);
    for (std::size_t k = 0; k < f.size(); ++k) f[k] += of_memory[k];
    return f;
}

template <CellKind kind>
typename CentreViscousKernel<kind>::EndOfStep CentreViscousKernel<kind>::end_of_step(
    std::span<const double> memory, double dt) const {
    EndOfStep end{long_time_share, {}};
    end.stresses.fill(Mat3::Zero());
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const PronyStep rule = prony_step(terms[i], dt);
        end.share += rule.gain;
        for (std::size_t t = 0; t < num_parts; ++t)
            end.stresses[t] += tensor_of(rule.decay * components(memory, num_parts, i + 1, t) -
                                         rule.gain * components(memory, num_parts, 0, t));
    }
    return end;
}

template <CellKind kind>
double CentreViscousKernel<kind>::potential(const Element& e, const Corners& x,
                                            const EndOfStep& end) const {
    const CellState<kind> state(*this, e, x);
    double sum = end.share * Elastic::energy(e, x);
    for (std::size_t t = 0; t < num_parts; ++t)
        sum += 0.5 * e.volumes[t] *
               end.stresses[t].cwiseProduct(state.of_part[t].mean.twice_strain).sum();
    return sum;
}

template <CellKind kind>
typename CentreViscousKernel<kind>::Corners CentreViscousKernel<kind>::forces(
    const Element& e, const Corners& x, const EndOfStep& end) const {
    const CellState<kind> state(*this, e, x);
    Stresses stresses;
    for (std::size_t t = 0; t < num_parts; ++t)
        stresses[t] = state.of_part[t].mean.F * end.stresses[t];
    Corners f = forces_of_stresses(*this, e, state, stresses);
    const Corners elastic = Elastic::forces(e, x);
    for (std::size_t k = 0; k < f.size(); ++k) f[k] += end.share * elastic[k];
    return f;
}

template <CellKind kind>
void CentreViscousKernel<kind>::begin_step(double dt) {
    for (std::size_t i = 0; i < terms.size(); ++i) steps[i] = prony_step(terms[i], dt);
}

// As ViscousKernel::advance, for each tetrahedron with its F'_t.
template <CellKind kind>
double CentreViscousKernel<kind>::advance(const Element& e, const Corners& before, const Corners& x,
                                          std::span<double> memory) const {
    const CellState<kind> from(*this, e, before), to(*this, e, x);
    const double J0 = this->inversion_threshold;
    // Below the threshold, the stored stress is not the full stress of the law.
    bool is_crushed = false;
    for (const CellState<kind>* state : {&from, &to})
        for (const PartState& part : state->of_part) is_crushed |= part.mean.strain.J < J0;
    Corners forces_before;
    if (is_crushed) forces_before = forces(e, before, memory);
    double work = 0.0;
    for (std::size_t t = 0; t < num_parts; ++t) {
        const Deformation& d = to.of_part[t].mean;
        const LawResponse<double> r = response(this->law, d.strain, J0);
        const Components S =
            components_of(second_piola_kirchhoff(r, d.twice_strain, d.strain.J, J0, e.fibre));
        Components twice_mean = Components::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto H = components(memory, num_parts, i + 1, t);
            twice_mean += H;
            H = (steps[i].decay * H + steps[i].gain * (S - components(memory, num_parts, 0, t)))
                    .eval();
            twice_mean += H;
        }
        components(memory, num_parts, 0, t) = S;
        work += 0.25 * e.volumes[t] *
                tensor_of(twice_mean)
                    .cwiseProduct(d.twice_strain - from.of_part[t].mean.twice_strain)
                    .sum();
    }
    if (!is_crushed) return work;
    const Corners forces_after = forces(e, x, memory);
    work = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k)
        work -= 0.5 * (forces_before[k] + forces_after[k]).dot(x[k] - before[k]);
    return work - (energy(e, x) - energy(e, before));
}

template struct CentreViscousKernel<CellKind::hexahedron>;
template struct CentreViscousKernel<CellKind::wedge>;
template struct CentreViscousKernel<CellKind::pyramid>;

}  // namespace incise::physics
