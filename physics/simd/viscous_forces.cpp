// The functions of ViscousKernel on lanes: the update of the viscous history, and its forces.
// Equations: docs/theory.md, Viscosity. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_viscous_elements.h"
#include "incise/physics/simd/gather_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Scalar = Lanes<double>;
using Vector = Lanes3<double>;
using Edges = std::array<Vector, 3>;
using Matrix = std::array<std::array<Scalar, 3>, 3>;
/// A symmetric tensor in the order of the viscous history: 11, 22, 33, 12, 23, 31.
using Tensor = std::array<Scalar, 6>;
constexpr std::size_t num_together = num_lanes<double>;

/// For each lane, the address of the history of its element.
template <class Number>
using Rows = std::array<Number*, num_together>;

template <class Number>
[[gnu::always_inline]] inline Rows<Number> rows_of(const MemoryRows<Number>& memory,
                                                   const ViscousGroup& group, std::size_t first) {
    Rows<Number> rows;
    for (std::size_t l = 0; l < num_together; ++l)
        rows[l] = memory.first + group.elements[first + l] * memory.length;
    return rows;
}

// Rows have the alignment of a double only.
using LooseQuad = double __attribute__((vector_size(32), aligned(8), may_alias));

/// One tensor of each element, in the order of rows and not by lanes. Entry p has four numbers of
/// element p and, with eight lanes, of element p + 4. Two of the six numbers are stored twice. Sums
/// and multiples can be computed in this form, and cost less than a conversion to lanes.
struct Quads {
    Scalar first[4], last[4];  ///< numbers 0 to 3, and 2 to 5

    explicit Quads(Scalar all) {
        std::fill(first, first + 4, all);
        std::fill(last, last + 4, all);
    }
    explicit Quads(const Tensor& t) : first{t[0], t[1], t[2], t[3]}, last{t[2], t[3], t[4], t[5]} {
        transpose(first[0], first[1], first[2], first[3]);
        transpose(last[0], last[1], last[2], last[3]);
    }
    Tensor tensor() const {
        Quads t = *this;
        transpose(t.first[0], t.first[1], t.first[2], t.first[3]);
        transpose(t.last[0], t.last[1], t.last[2], t.last[3]);
        return {t.first[0], t.first[1], t.first[2], t.first[3], t.last[2], t.last[3]};
    }

    /// Calls change(a, b...) for each vector of this and the corresponding vectors of `others`.
    template <class Change, class... Others>
    [[gnu::always_inline]] void change(Change change, const Others&... others) {
#pragma GCC unroll 4
        for (std::size_t p = 0; p < 4; ++p) {
            change(first[p], others.first[p]...);
            change(last[p], others.last[p]...);
        }
    }
};

/// Returns tensor i of the history of the elements.
template <class Number>
[[gnu::always_inline]] inline Quads load(const Rows<Number>& rows, std::size_t i) {
    const auto quads = [&](std::size_t p, std::size_t place) -> Scalar {
        const auto quad = [&](std::size_t l) -> Quad {
            return *reinterpret_cast<const LooseQuad*>(rows[l] + place);
        };
#ifdef __AVX512F__
        return __builtin_shufflevector(quad(p), quad(p + 4), 0, 1, 2, 3, 4, 5, 6, 7);
#else
        return quad(p);
#endif
    };
    Quads t(0.0);
#pragma GCC unroll 4
    for (std::size_t p = 0; p < 4; ++p) {
        t.first[p] = quads(p, 6 * i);
        t.last[p] = quads(p, 6 * i + 2);
    }
    return t;
}

/// A set of lanes: bit l for lane l.
using LaneSet = unsigned;
constexpr LaneSet all_lanes = (1u << num_together) - 1;

[[gnu::always_inline]] inline LaneSet where_less(Scalar a, Scalar b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ);
#elif defined(__AVX2__)
    return static_cast<LaneSet>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)));
#else
    LaneSet set = 0;
    for (std::size_t l = 0; l < num_together; ++l) set |= (a.v[l] < b.v[l] ? 1u : 0u) << l;
    return set;
#endif
}

/// Stores tensor i of the history, for the elements of the given lanes.
[[gnu::always_inline]] inline void store(const Quads& t, const Rows<double>& rows, std::size_t i,
                                         LaneSet lanes) {
    const auto store_half = [&]<std::size_t q>(std::integral_constant<std::size_t, q>) {
#pragma GCC unroll 4
        for (std::size_t p = 0; p < 4; ++p) {
            if ((lanes >> (4 * q + p) & 1) == 0) continue;
            double* const row = rows[4 * q + p] + 6 * i;
            *reinterpret_cast<LooseQuad*>(row) = quad_of<q>(t.first[p]);
            *reinterpret_cast<LooseQuad*>(row + 2) = quad_of<q>(t.last[p]);
        }
    };
    [&]<std::size_t... q>(std::index_sequence<q...>) {
        (store_half(std::integral_constant<std::size_t, q>()), ...);
    }
    (std::make_index_sequence<num_together / 4>());
}

/// Returns A T A^T.
[[gnu::always_inline]] inline Tensor congruent(const Matrix& A, const Tensor& T) {
    Matrix B;  // A T
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [a, b, c] = A[i];
        B[i] = {a * T[0] + b * T[3] + c * T[5], a * T[3] + b * T[1] + c * T[4],
                a * T[5] + b * T[4] + c * T[2]};
    }
    const auto entry = [&](std::size_t i, std::size_t j) -> Scalar {
        return B[i][0] * A[j][0] + B[i][1] * A[j][1] + B[i][2] * A[j][2];
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}

/// Returns A : B.
[[gnu::always_inline]] inline Scalar contracted(const Tensor& A, const Tensor& B) {
    return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] +
           2.0 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}

[[gnu::always_inline]] inline Matrix inverse_edges(const ViscousGroup& group, std::size_t first) {
    Matrix W;
    for (std::size_t k = 0; k < 9; ++k)
        W[k / 3][k % 3] = Scalar::load(group.inverse_edges[k] + first);
    return W;
}

[[gnu::always_inline]] inline Matrix transposed(const Matrix& A) {
    Matrix B;
    for (std::size_t k = 0; k < 9; ++k) B[k / 3][k % 3] = A[k % 3][k / 3];
    return B;
}

/// Returns the squared edge lengths in the order of the paper: 01, 02, 03, 12, 23, 31.
[[gnu::always_inline]] inline Tensor squared_links(const Edges& v) {
    const Vector sides[] = {v[0], v[1], v[2], v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    Tensor links;
    for (std::size_t k = 0; k < 6; ++k) links[k] = rounded_dot(sides[k], sides[k]);
    return links;
}

/// Returns V^T (C - C') V with the rest edges V, if `links` are the squared edge lengths for C and
/// `others` those for C'.
[[gnu::always_inline]] inline Tensor change_of_metric(const Tensor& links, const Tensor& others) {
    Tensor dl;
    for (std::size_t k = 0; k < 6; ++k) dl[k] = links[k] - others[k];
    return {dl[0],
            dl[1],
            dl[2],
            0.5 * (dl[0] + dl[1] - dl[3]),
            0.5 * (dl[1] + dl[2] - dl[4]),
            0.5 * (dl[2] + dl[0] - dl[5])};
}

[[gnu::always_inline]] inline Scalar six_volumes(const Edges& v) {
    return rounded_dot(rounded_cross(v[0], v[1]), v[2]);
}

/// Returns ViscousKernel::stress of elements above the inversion threshold. D is C - 1.
template <class Law>
[[gnu::always_inline]] inline Tensor stress(const Law& law, double J0, const Tensor& D, Scalar J,
                                            [[maybe_unused]] const FibreDirections* fibres,
                                            std::size_t first) {
    [[maybe_unused]] Tensor fibre;  // a0 x a0
    LinkStrain<Scalar> strain{D[0] + D[1] + D[2], contracted(D, D), J, 0.0};
    if constexpr (HasFibres<Law>) {
        const auto a0 = [&](int k) { return Scalar::load(fibres->a0[k] + first); };
        const Scalar x = a0(0), y = a0(1), z = a0(2);
        fibre = {x * x, y * y, z * z, x * y, y * z, z * x};
        strain.f = contracted(fibre, D);
    }
    const LawResponse<Scalar> r = law.response(strain, J0);
    const Scalar pressure = 2.0 * r.w_a;
    Tensor S{pressure, pressure, pressure, 0.0, 0.0, 0.0};
    if constexpr (NeedsB<Law>) {
        const Scalar w_b = 4.0 * r.w_b;
        for (std::size_t k = 0; k < 6; ++k) S[k] += w_b * D[k];
    }
    if constexpr (NeedsJ<Law>) {
        // The same quotient as in the laws, so that the compiler computes it only once.
        const Scalar per_J = 1.0 / max(J, Scalar(J0)), factor = r.w_J * per_J;
        const Scalar C1 = 1.0 + D[0], C2 = 1.0 + D[1], C3 = 1.0 + D[2];
        S[0] += factor * (C2 * C3 - D[4] * D[4]);
        S[1] += factor * (C3 * C1 - D[5] * D[5]);
        S[2] += factor * (C1 * C2 - D[3] * D[3]);
        S[3] += factor * (D[4] * D[5] - C3 * D[3]);
        S[4] += factor * (D[5] * D[3] - C1 * D[4]);
        S[5] += factor * (D[3] * D[4] - C2 * D[5]);
    }
    if constexpr (HasFibres<Law>) {
        const Scalar w_f = 2.0 * r.w_f;
        for (std::size_t k = 0; k < 6; ++k) S[k] += w_f * fibre[k];
    }
    return S;
}

/// Advances the history of the elements of the given lanes to the stress S, by the rule of the
/// Prony series. Returns the sum of the terms before and after the step.
[[gnu::always_inline]] inline Tensor follow(const Tensor& S, std::span<const PronyStep> steps,
                                            const Rows<double>& rows, LaneSet lanes) {
    const Quads next(S);
    Quads change = next, twice_mean(0.0);
    change.change([](Scalar& x, Scalar old) { x -= old; }, load(rows, 0));
    store(next, rows, 0, lanes);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Scalar decay = steps[i].decay, gain = steps[i].gain;
        Quads H = load(rows, i + 1);
        twice_mean.change([](Scalar& sum, Scalar x) { sum += x; }, H);
        H.change([&](Scalar& x, Scalar dS) { x = decay * x + gain * dS; }, change);
        twice_mean.change([](Scalar& sum, Scalar x) { sum += x; }, H);
        store(H, rows, i + 1, lanes);
    }
    return twice_mean.tensor();
}

/// A sum for each lane of a group. The order of the total does not depend on the number of lanes of
/// the processor.
class LaneSums {
  public:
    LaneSums() { std::fill(std::begin(sums_), std::end(sums_), 0.0); }
    void add(Scalar x, std::size_t first, LaneSet lanes) {
        if (lanes != all_lanes)
            for (std::size_t l = 0; l < num_together; ++l)
                if ((lanes >> l & 1) == 0) x.v[l] = 0.0;
        (Scalar::load(sums_ + first) + x).store(sums_ + first);
    }
    double total() const {
        double sum = 0.0;
        for (const double x : sums_) sum += x;
        return sum;
    }

  private:
    alignas(64) double sums_[ViscousGroup::size];
};

template <class Law>
double advance(const Law& law, const ViscousRule& rule, const ViscousGroups& groups,
               const MemoryRows<double>& memory, const LocalVector* before,
               const LocalVector* positions, FunctionRef<double(std::size_t)> advance_one) {
    const double J0 = rule.inversion_threshold;
    const std::size_t num_groups = groups.elements.size();
    LaneSums sums;
    double others = 0.0;
    const FetchAhead fetch_ahead(std::span<const ViscousGroup>(groups.elements), {});
    for (std::size_t g = 0; g < num_groups; ++g) {
        fetch_ahead(g);
        const ViscousGroup& group = groups.elements[g];
        for (std::size_t first = 0; first < ViscousGroup::size; first += num_together) {
            const Edges v = gather_edges<double>(positions, group.offsets, first),
                        old_v = gather_edges<double>(before, group.offsets, first);
            Tensor rest_links;
            for (std::size_t k = 0; k < 6; ++k)
                rest_links[k] = Scalar::load(group.rest_links[k] + first);
            const Tensor links = squared_links(v);
            const Matrix to_rest = transposed(inverse_edges(group, first));  // V^-T
            const Tensor D = congruent(to_rest, change_of_metric(links, rest_links)),
                         change = congruent(to_rest, change_of_metric(links, squared_links(old_v)));
            const Scalar volume = Scalar::load(group.volume + first);
            const Scalar now = six_volumes(v), rest = 6.0 * volume, J = now / rest;

            const LaneSet used = ((1u << group.num_used) - 1) >> first & all_lanes,
                          low = where_less(min(now, six_volumes(old_v)), J0 * rest) & used,
                          lanes = used & ~low;
            const Tensor S =
                stress(law, J0, D, J, groups.fibres.empty() ? nullptr : &groups.fibres[g], first);
            const Tensor twice_mean = follow(S, rule.steps, rows_of(memory, group, first), lanes);
            Scalar work = 0.25 * volume * contracted(twice_mean, change);
            if (!groups.shares.empty()) work = Scalar::load(groups.shares[g].share + first) * work;
            sums.add(work, first, lanes);
            if (low != 0) [[unlikely]]
                for (std::size_t l = 0; l < num_together; ++l)
                    if ((low >> l & 1) != 0) others += advance_one((first + l) * num_groups + g);
        }
    }
    return sums.total() + others;
}

}  // namespace

double advance_memory(const ViscousRule& rule, const ViscousGroups& groups,
                      MemoryRows<double> memory, const LocalVector* before,
                      const LocalVector* positions, FunctionRef<double(std::size_t)> advance_one) {
    return std::visit(
        [&](const auto& law) {
            return advance(law, rule, groups, memory, before, positions, advance_one);
        },
        rule.law);
}

void add_forces_of_memory(const ViscousRule& rule, const ViscousGroups& groups,
                          MemoryRows<const double> memory, const LocalVector* positions,
                          LocalVector* forces, std::span<const std::byte> next) {
    const Scalar share = rule.relaxing_share;
    const FetchAhead fetch_ahead(std::span<const ViscousGroup>(groups.elements), next);
    for (std::size_t g = 0; g < groups.elements.size(); ++g) {
        fetch_ahead(g);
        const ViscousGroup& group = groups.elements[g];
        for (std::size_t first = 0; first < ViscousGroup::size; first += num_together) {
            const auto rows = rows_of(memory, group, first);
            Quads relaxed = load(rows, 0);
            relaxed.change([share](Scalar& x) { x = -share * x; });
            for (std::size_t i = 1; i <= rule.steps.size(); ++i)
                relaxed.change([](Scalar& sum, Scalar x) { sum += x; }, load(rows, i));
            // Forces as in forces_of_stress().
            Tensor t = congruent(inverse_edges(group, first), relaxed.tensor());
            Scalar volume = Scalar::load(group.volume + first);
            if (!groups.shares.empty())
                volume = Scalar::load(groups.shares[g].share + first) * volume;
            for (Scalar& x : t) x = -volume * x;
            const auto [v1, v2, v3] = gather_edges<double>(positions, group.offsets, first);
            const Edges f{t[0] * v1 + t[3] * v2 + t[5] * v3, t[3] * v1 + t[1] * v2 + t[4] * v3,
                          t[5] * v1 + t[4] * v2 + t[2] * v3};
            scatter_add<double>(f, forces, group.offsets, first);
        }
    }
}

}  // namespace incise::physics::INCISE_PROCESSOR
