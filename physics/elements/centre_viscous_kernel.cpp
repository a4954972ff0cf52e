// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/centre_viscous_kernel.h"

#include <algorithm>
#include <utility>

#include "incise/physics/elements/centre_state.h"
#include "incise/physics/elements/symmetric_tensor.h"

namespace incise::physics {

using topology::CellKind;

namespace {

/// Returns a stress of tetrahedron t in the memory of a cell: of the law in row 0, and of term i -
/// 1 in row i.
template <CellKind kind>
auto stress_in(auto memory, std::size_t row, std::size_t t) {
    return tensor(memory, row * CentreViscousKernel<kind>::num_parts + t);
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
        SymmetricTensor relaxed = -(1.0 - long_time_share) * stress_in<kind>(memory, 0, t);
        for (std::size_t i = 0; i < terms.size(); ++i) relaxed += stress_in<kind>(memory, i + 1, t);
        stresses[t] = state.of_part[t].mean.F * matrix_of(relaxed);
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
            end.stresses[t] += matrix_of(rule.decay * stress_in<kind>(memory, i + 1, t) -
                                         rule.gain * stress_in<kind>(memory, 0, t));
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
        const SymmetricTensor S =
            symmetric_tensor(second_piola_kirchhoff(r, d.twice_strain, d.strain.J, J0, e.fibre));
        SymmetricTensor twice_mean = SymmetricTensor::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto H = stress_in<kind>(memory, i + 1, t);
            twice_mean += H;
            H = (steps[i].decay * H + steps[i].gain * (S - stress_in<kind>(memory, 0, t))).eval();
            twice_mean += H;
        }
        stress_in<kind>(memory, 0, t) = S;
        work += 0.25 * e.volumes[t] *
                matrix_of(twice_mean)
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
