// Several numbers that the processor computes with at once, one of each of as many elements.
// Only for files that are compiled once for each kind of processor (CMakeLists.txt: incise_lanes):
// all of this stands in a namespace of its own for each, so that the linker cannot mix them up.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "physics/law_response.h"
#include "physics/local_nodes.h"

#ifndef INCISE_PROCESSOR
#error "include this only in files that are compiled for each kind of processor"
#endif

namespace incise::physics::INCISE_PROCESSOR {

#ifdef __AVX512F__
inline constexpr int num_lanes = 8;
#else
inline constexpr int num_lanes = 4;
#endif

/// Arithmetic is that of doubles, lane by lane, to the bit, whatever the processor: nothing is
/// fused, so results do not depend on how many lanes it has.
struct Lanes {
    using Vector = double __attribute__((vector_size(8 * num_lanes)));
    using Bits = std::int64_t __attribute__((vector_size(8 * num_lanes)));
    Vector v;

    Lanes() = default;
    Lanes(Vector vector) : v(vector) {}
    Lanes(double constant) : v(constant - Vector{}) {}  // implicit: formulas mix both kinds

    /// From numbers that follow one another, aligned to their whole size.
    static Lanes load(const double* from) { return *reinterpret_cast<const Aliasing*>(from); }

    Lanes& operator+=(Lanes o) { return v += o.v, *this; }
    Lanes& operator-=(Lanes o) { return v -= o.v, *this; }
    Lanes& operator*=(Lanes o) { return v *= o.v, *this; }
    Lanes& operator/=(Lanes o) { return v /= o.v, *this; }
    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
    friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
    friend Lanes operator-(Lanes a) { return -a.v; }

    // As std::max(a, b) and std::min(a, b), also of what is not a number.
    friend Lanes max(Lanes a, Lanes b) { return a.v < b.v ? b.v : a.v; }
    friend Lanes min(Lanes a, Lanes b) { return b.v < a.v ? b.v : a.v; }

    /// 1/sqrt(a) of normal numbers above zero within 4e-16 of it; something finite for zero. By
    /// Newton's method from a guess by halving the exponent: several times faster than to divide
    /// by a root, and the same everywhere.
    friend Lanes reciprocal_sqrt(Lanes a) {
        const Bits guess = 0x5fe6eb50c7b537a9 - (std::bit_cast<Bits>(a.v) >> 1);
        Lanes r = std::bit_cast<Vector>(guess);
        const Lanes half = 0.5 * a;
        for (int i = 0; i < 4; ++i) r *= 1.5 - half * r * r;
        return r;
    }
    friend Lanes expm1(Lanes a) {
        return a.each([](double x) { return std::expm1(x); });
    }
    friend Lanes log1p(Lanes a) {
        return a.each([](double x) { return std::log1p(x); });
    }
    friend Lanes abs(Lanes a) {
        return a.each([](double x) { return std::abs(x); });
    }

    /// For normal numbers above zero within 1e-15 of the value or of one, whichever is more; else
    /// not a number. Argument reduction to [sqrt(1/2), sqrt(2)) and the series of
    /// ln((1 + s)/(1 - s)) in s.
    friend Lanes log(Lanes a) {
        constexpr std::int64_t unit = std::int64_t{1} << 52, mantissa = unit - 1;
        // Bits of sqrt(1/2): what lies above has the exponent of the power of two that is nearest.
        constexpr std::int64_t low = 0x3fe6a09e667f3bcd;
        const Bits bits = std::bit_cast<Bits>(a.v);
        const Bits from_low = bits - low;
        const Bits exponent = from_low >> 52;
        const Bits scaled = (from_low & mantissa) + low;
        const Lanes m = std::bit_cast<Vector>(scaled);
        // An integer as a double without an instruction for it: in the low bits of 1.5 * 2^52.
        constexpr double shift = 6755399441055744.0;
        const Bits shifted = exponent + std::bit_cast<std::int64_t>(shift);
        const Lanes k = Lanes(std::bit_cast<Vector>(shifted)) - shift;
        const Lanes s = (m - 1.0) / (m + 1.0), z = s * s;
        Lanes tail = 1.0 / 21.0;
        for (const double odd : {19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0})
            tail = tail * z + 1.0 / odd;
        constexpr double ln2_high = 0.693147180369123816490, ln2_low = 1.90821492927058770002e-10;
        const Lanes result = k * ln2_high + (2.0 * s + (2.0 * s * z * tail + k * ln2_low));
        const Bits is_normal = (bits >= unit) & (bits < 2047 * unit);
        return is_normal ? result.v : Lanes(std::nan("")).v;
    }

    /// Within 1e-15 of the value, between -700 and 700; what is not a number stays so. By the
    /// series of e^r, |r| < ln(2)/2.
    friend Lanes exp(Lanes a) {
        constexpr double shift = 6755399441055744.0, ln2_high = 0.693147180369123816490,
                         ln2_low = 1.90821492927058770002e-10, per_ln2 = 1.4426950408889634;
        const Lanes bounded = max(min(a, 700.0), -700.0);
        const Lanes shifted = bounded * per_ln2 + shift, k = shifted - shift;
        const Lanes r = (bounded - k * ln2_high) - k * ln2_low;
        Lanes sum = 1.0 / 6227020800.0;  // 13!
        for (const double factorial : {479001600.0, 39916800.0, 3628800.0, 362880.0, 40320.0,
                                       5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0})
            sum = sum * r + 1.0 / factorial;
        const Bits power = (std::bit_cast<Bits>(shifted.v) + 1023) << 52;
        return sum * Lanes(std::bit_cast<Vector>(power));
    }

    friend Lanes pow(Lanes a, double p) { return exp(p * log(a)); }

    template <class Function>
    Lanes each(Function f) const {
        Vector result;
        for (int l = 0; l < num_lanes; ++l) result[l] = f(v[l]);
        return result;
    }

  private:
    using Aliasing = Vector __attribute__((may_alias));
};

/// The law's response: by its formulas if these are templates, else lane by lane.
template <class Law>
LawResponse<Lanes> response_of_lanes(const Law& law, const LinkStrain<Lanes>& s, double J0) {
    if constexpr (requires { law.response(s, J0); }) {
        return law.response(s, J0);
    } else {
        LawResponse<Lanes> r;
        for (int l = 0; l < num_lanes; ++l) {
            const LawResponse<double> one =
                law.response(LinkStrain<double>{s.a.v[l], s.b.v[l], s.J.v[l], s.f.v[l]}, J0);
            r.w.v[l] = one.w;
            r.w_a.v[l] = one.w_a;
            r.w_b.v[l] = one.w_b;
            r.w_J.v[l] = one.w_J;
            r.w_f.v[l] = one.w_f;
        }
        return r;
    }
}

/// Vectors in space, one a lane.
struct Lanes3 {
    Lanes x, y, z;

    friend Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Lanes3 operator*(Lanes s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
    // Sums in the order in which Eigen has them, so that an element at rest is so to the bit.
    friend Lanes dot(const Lanes3& a, const Lanes3& b) {
        return a.x * b.x + (a.y * b.y + a.z * b.z);
    }
    friend Lanes3 cross(const Lanes3& a, const Lanes3& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};

using Quad = double __attribute__((vector_size(32)));

/// Rows of a 4 x 4 matrix become its columns.
inline void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
    const Quad ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6),
               ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7),
               cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6),
               cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// What `nodes` has at the places of one corner of the elements, a lane each.
inline Lanes3 gather(const LocalVector* nodes, const std::uint16_t* places) {
    const auto quads = [&](int first) {
        std::array<Quad, 4> q;
        for (int l = 0; l < 4; ++l)
            q[static_cast<std::size_t>(l)] =
                *reinterpret_cast<const Quad*>(nodes[places[first + l]].data());
        transpose(q[0], q[1], q[2], q[3]);
        return q;
    };
    const auto a = quads(0);
#ifdef __AVX512F__
    const auto b = quads(4);
    const auto join = [](Quad low, Quad high) {
        return Lanes(__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7));
    };
    return {join(a[0], b[0]), join(a[1], b[1]), join(a[2], b[2])};
#else
    return {a[0], a[1], a[2]};
#endif
}

/// Adds the elements' vectors, by corner, to what `nodes` has at their places, element by element
/// in fours, corner by corner within: elements may share nodes, and sums must not depend on how
/// many lanes there are.
template <std::size_t num_corners>
[[gnu::always_inline]] inline void scatter_add(const std::array<Lanes3, num_corners>& f,
                                               LocalVector* nodes,
                                               const std::uint16_t (&places)[num_corners][8],
                                               std::size_t first) {
    const auto add_four = [&](Quad x, Quad y, Quad z, const std::uint16_t* at) {
        Quad w{};
        transpose(x, y, z, w);
        const Quad all[] = {x, y, z, w};
        for (int l = 0; l < 4; ++l) *reinterpret_cast<Quad*>(nodes[at[l]].data()) += all[l];
    };
#ifdef __AVX512F__
    const auto low = [](Lanes a) { return __builtin_shufflevector(a.v, a.v, 0, 1, 2, 3); };
    const auto high = [](Lanes a) { return __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7); };
    for (std::size_t k = 0; k < num_corners; ++k)
        add_four(low(f[k].x), low(f[k].y), low(f[k].z), places[k] + first);
    for (std::size_t k = 0; k < num_corners; ++k)
        add_four(high(f[k].x), high(f[k].y), high(f[k].z), places[k] + first + 4);
#else
    for (std::size_t k = 0; k < num_corners; ++k)
        add_four(f[k].x.v, f[k].y.v, f[k].z.v, places[k] + first);
#endif
}

}  // namespace incise::physics::INCISE_PROCESSOR
