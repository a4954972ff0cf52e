// Vectors of numbers on which the processor computes at once. A lane, one place of such a vector,
// has the number of one element.
// Only for files that are compiled once for each kind of processor (incise_kernels in
// physics/CMakeLists.txt). Each kind has its own namespace, so that the linker cannot mix them up.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#ifndef INCISE_PROCESSOR
#error "include this only in files that are compiled for each kind of processor"
#endif

namespace incise::physics::INCISE_PROCESSOR {

#ifdef __AVX512F__
inline constexpr int vector_bytes = 64;
#else
inline constexpr int vector_bytes = 32;
#endif
template <class Number>
inline constexpr int num_lanes = vector_bytes / static_cast<int>(sizeof(Number));

/// The vector types of a type of number, the layout of its bits, and the constants of the series in
/// the functions below.
template <class Number>
struct NumberFormat;

template <>
struct NumberFormat<double> {
    using Vector = double __attribute__((vector_size(vector_bytes)));
    using Aliasing = Vector __attribute__((may_alias));
    using Bit = std::int64_t;
    using Bits = std::int64_t __attribute__((vector_size(vector_bytes)));
    using UnsignedBits = std::uint64_t __attribute__((vector_size(vector_bytes)));
    static constexpr int mantissa_bits = 52;
    static constexpr Bit bias = 1023;
    static constexpr Bit root_guess = 0x5fe404e557a77960;
    static constexpr std::array root_terms{0.011360352377865241, 0.02632548909212647,
                                           0.06405451255469584, 0.1731733594556703};
    static constexpr Bit root_of_half = 0x3fe6a09e667f3bcd;
    static constexpr double ln2_high = 0.693147180369123816490,
                            ln2_low = 1.90821492927058770002e-10, largest_exponent = 700.0;
    static constexpr std::array log_terms{21.0, 19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0};
    static constexpr int exp_degree = 13;
};

template <>
struct NumberFormat<float> {
    using Vector = float __attribute__((vector_size(vector_bytes)));
    using Aliasing = Vector __attribute__((may_alias));
    using Bit = std::int32_t;
    using Bits = std::int32_t __attribute__((vector_size(vector_bytes)));
    using UnsignedBits = std::uint32_t __attribute__((vector_size(vector_bytes)));
    static constexpr int mantissa_bits = 23;
    static constexpr Bit bias = 127;
    static constexpr Bit root_guess = 0x5f20272b;
    static constexpr std::array root_terms{0.06405455207717746, 0.17317345104154103};
    static constexpr Bit root_of_half = 0x3f3504f3;
    // ln2_high has few bits, so that its product with a whole number is exact.
    static constexpr double ln2_high = 0.693359375, ln2_low = -2.1219444005469058e-4,
                            largest_exponent = 87.0;
    static constexpr std::array log_terms{9.0, 7.0, 5.0, 3.0};
    static constexpr int exp_degree = 7;
};

/// Returns a b + c, rounded once.
template <class Vector>
[[gnu::always_inline]] inline Vector multiply_add(Vector a, Vector b, Vector c) {
#if defined(__AVX512F__)
    if constexpr (sizeof(a[0]) == 8)
        return _mm512_fmadd_pd(a, b, c);
    else
        return _mm512_fmadd_ps(a, b, c);
#elif defined(__FMA__)
    if constexpr (sizeof(a[0]) == 8)
        return _mm256_fmadd_pd(a, b, c);
    else
        return _mm256_fmadd_ps(a, b, c);
#else
    for (std::size_t l = 0; l < sizeof(a) / sizeof(a[0]); ++l) c[l] = std::fma(a[l], b[l], c[l]);
    return c;
#endif
}

/// Returns c - a b, rounded once.
template <class Vector>
[[gnu::always_inline]] inline Vector subtract_product(Vector a, Vector b, Vector c) {
#if defined(__AVX512F__)
    if constexpr (sizeof(a[0]) == 8)
        return _mm512_fnmadd_pd(a, b, c);
    else
        return _mm512_fnmadd_ps(a, b, c);
#elif defined(__FMA__)
    if constexpr (sizeof(a[0]) == 8)
        return _mm256_fnmadd_pd(a, b, c);
    else
        return _mm256_fnmadd_ps(a, b, c);
#else
    return multiply_add(-a, b, c);
#endif
}

/// A product that is not computed yet, so that a sum with it is rounded only once. In a sum of two
/// products, the second product is rounded first.
template <class Scalar>
struct Product {
    Scalar a, b;

    friend Product operator-(Product p) { return {-p.a, p.b}; }
    friend Scalar operator+(Product p, Scalar c) { return multiply_add(p.a.v, p.b.v, c.v); }
    friend Scalar operator+(Scalar c, Product p) { return p + c; }
    friend Scalar operator+(Product p, Product q) { return p + Scalar(q); }
    friend Scalar operator-(Product p, Scalar c) { return p + -c; }
    friend Scalar operator-(Scalar c, Product p) { return subtract_product(p.a.v, p.b.v, c.v); }
    friend Scalar operator-(Product p, Product q) { return p - Scalar(q); }
};

/// A vector with one number in each lane.
///
/// Arithmetic gives the same bits in every lane as for single numbers, on every processor and with
/// any number of lanes. A product that is added to something is not rounded before (fused). The
/// form of a formula decides which products are fused, and not the compiler. Processors without
/// this operation (before 2013) use the C library for it, which is slow.
template <class Number>
struct Lanes {
    using Format = NumberFormat<Number>;
    using Vector = typename Format::Vector;
    using Bit = typename Format::Bit;
    using Bits = typename Format::Bits;
    using UnsignedBits = typename Format::UnsignedBits;
    static constexpr int size = num_lanes<Number>;
    Vector v;

    Lanes() = default;
    Lanes(Vector vector) : v(vector) {}
    // Implicit: formulas mix numbers and lanes.
    Lanes(double constant) : v(static_cast<Number>(constant) - Vector{}) {}

    /// Loads consecutive numbers.
    /// @pre `from` is aligned to vector_bytes
    static Lanes load(const Number* from) {
        return *reinterpret_cast<const typename Format::Aliasing*>(from);
    }
    void store(Number* to) const { *reinterpret_cast<typename Format::Aliasing*>(to) = v; }

    Lanes& operator+=(Lanes o) { return v += o.v, *this; }
    Lanes& operator-=(Lanes o) { return v -= o.v, *this; }
    Lanes& operator*=(Lanes o) { return v *= o.v, *this; }
    Lanes& operator/=(Lanes o) { return v /= o.v, *this; }
    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
    friend Lanes operator-(Lanes a) { return -a.v; }

    friend Product<Lanes> operator*(Lanes a, Lanes b) { return {a, b}; }
    Lanes(Product<Lanes> p) : v(p.a.v * p.b.v) {}  // rounded
    Lanes& operator+=(Product<Lanes> p) { return *this = p + *this; }
    Lanes& operator-=(Product<Lanes> p) { return *this = *this - p; }

    // As std::max(a, b) and std::min(a, b), also for NaN.
    friend Lanes max(Lanes a, Lanes b) { return a.v < b.v ? b.v : a.v; }
    friend Lanes min(Lanes a, Lanes b) { return b.v < a.v ? b.v : a.v; }
    friend Bits is_less(Lanes a, Lanes b) { return a.v < b.v; }
    /// Returns the numbers of a in the lanes where a comparison holds, and else those of b.
    friend Lanes choose(Bits holds, Lanes a, Lanes b) { return holds ? a.v : b.v; }

    /// Returns 1/sqrt(a) for normal numbers above zero, with a relative error below 4e-16 (floats
    /// 3e-7), and a finite number for zero. It is several times faster than a division by a root,
    /// and has the same bits on every processor.
    ///
    /// Halving the exponent gives a guess. One Newton step, scaled to need few constants, gives t
    /// with a t^2 within 0.0027 of `middle`. A polynomial in middle - a t^2 then corrects t. Its
    /// terms, the guess and the factor 2.39 minimise the largest error.
    friend Lanes reciprocal_sqrt(Lanes a) {
        constexpr double middle = 2.0276482391601203, per_root_of_middle = 0.7022693147395886;
        const Bits guess = Format::root_guess - (std::bit_cast<Bits>(a.v) >> 1);
        const Lanes y = std::bit_cast<Vector>(guess);
        const Lanes t = y * (2.3930599179668173 - Lanes(a * y) * y);
        const Lanes rest = middle - Lanes(a * t) * t;
        Lanes sum = Format::root_terms[0];
        for (std::size_t i = 1; i < Format::root_terms.size(); ++i)
            sum = sum * rest + Format::root_terms[i];
        return t * (sum * rest + per_root_of_middle);
    }
    friend Lanes sqrt(Lanes a) {
        return a.each([](Number x) { return std::sqrt(x); });
    }
    friend Lanes abs(Lanes a) {
        return a.each([](Number x) { return std::abs(x); });
    }

    /// Returns ln(a) for normal numbers above zero, else NaN. The error is below 1e-15 (floats
    /// 3e-7) times the larger of |ln(a)| and 1. Method: argument reduction to [sqrt(1/2), sqrt(2))
    /// and the series of ln((1 + s)/(1 - s)) in s.
    [[gnu::always_inline]] friend inline Lanes log(Lanes a) {
        constexpr Bit unit = Bit{1} << Format::mantissa_bits, mantissa = unit - 1;
        // With exponents counted from sqrt(1/2), [sqrt(1/2), sqrt(2)) 2^k has the exponent k.
        constexpr Bit low = Format::root_of_half;
        const Bits bits = std::bit_cast<Bits>(a.v);
        // Unsigned, since a signed difference would overflow for negative numbers.
        const UnsignedBits difference =
            std::bit_cast<UnsignedBits>(a.v) - std::make_unsigned_t<Bit>{low};
        const Bits from_low = std::bit_cast<Bits>(difference);
        const Bits exponent = from_low >> Format::mantissa_bits;
        const Bits scaled = (from_low & mantissa) + low;
        const Lanes m = std::bit_cast<Vector>(scaled);
        const Bits shifted = exponent + std::bit_cast<Bit>(whole_number_shift);
        const Lanes k = Lanes(std::bit_cast<Vector>(shifted)) - whole_number_shift;
        const Lanes s = (m - 1.0) / (m + 1.0), z = s * s;
        // Even and odd powers in separate chains, which the processor computes at the same time.
        static_assert(log_coefficients.size() % 2 == 0);
        const Lanes z2 = z * z;
        Lanes odd = log_coefficients[0], even = log_coefficients[1];
        for (std::size_t i = 2; i < log_coefficients.size(); i += 2) {
            odd = odd * z2 + log_coefficients[i];
            even = even * z2 + log_coefficients[i + 1];
        }
        const Lanes tail = odd * z + even;
        const Lanes result =
            k * Format::ln2_high + (2.0 * s + (2.0 * s * z * tail + k * Format::ln2_low));
        const Bits is_normal = (bits >= unit) & (bits < (2 * Format::bias + 1) * unit);
        return is_normal ? result.v : Lanes(std::nan("")).v;
    }

    /// Returns ln(1 + a) with a relative error below 2e-15 (floats 6e-7), also for small a. It is
    /// the logarithm of the rounded sum, corrected for the rounding. Returns NaN if the sum is not
    /// a normal number above zero.
    friend Lanes log1p(Lanes a) {
        const Lanes sum = 1.0 + a;
        return log(sum) + (a - (sum - 1.0)) / sum;
    }

    /// Returns exp(a) with a relative error below 1e-15 (floats 3e-7). Arguments are first limited
    /// to -700 to 700 (floats -87 to 87). NaN stays NaN. Method: the series of e^r, |r| < ln(2)/2.
    friend Lanes exp(Lanes a) {
        const PowerOfTwo two(a);
        return series_of_exp(two.rest, 0) * two.power;
    }
    /// Returns exp(a) - 1 with a relative error below 2e-15 (floats 6e-7), also for small a. Limits
    /// and NaN are as in exp().
    friend Lanes expm1(Lanes a) {
        const PowerOfTwo two(a);
        const Lanes of_rest = two.rest * series_of_exp(two.rest, 1);
        return of_rest * two.power + (two.power - 1.0);
    }

    friend Lanes pow(Lanes a, double p) { return exp(p * log(a)); }

    /// Returns cos(acos(|x|)/3) with the sign of x, for -1 <= x <= 1, with an error below 4e-16
    /// (floats 3e-7). Method: Newton's method for 4 y^3 - 3 y = |x|, from a cubic that is within
    /// 1e-4 of the root.
    friend Lanes cosine_of_third(Lanes x) {
        constexpr Bit sign = std::numeric_limits<Bit>::min();
        const Bits bits = std::bit_cast<Bits>(x.v), magnitude = bits & ~sign;
        const Lanes c = std::bit_cast<Vector>(magnitude);
        Lanes y = 0.8661 + c * (0.1653 + c * (-0.0407 + c * 0.0093));
        for (int i = 0; i < 2; ++i) {
            const Lanes square = y * y;
            y -= (y * (4.0 * square - 3.0) - c) / (12.0 * square - 3.0);
        }
        const Bits result = std::bit_cast<Bits>(y.v) | (bits & sign);
        return Lanes(std::bit_cast<Vector>(result));
    }

    template <class Function>
    Lanes each(Function f) const {
        Vector result;
        for (int l = 0; l < size; ++l) result[l] = f(v[l]);
        return result;
    }

  private:
    /// e^a as a power of two times e^rest.
    struct PowerOfTwo {
        Lanes power, rest;

        explicit PowerOfTwo(Lanes a) {
            constexpr double per_ln2 = 1.4426950408889634;
            const Lanes bounded = max(min(a, Format::largest_exponent), -Format::largest_exponent);
            const Lanes shifted = bounded * per_ln2 + whole_number_shift,
                        k = shifted - whole_number_shift;
            rest = (bounded - k * Format::ln2_high) - k * Format::ln2_low;
            const Bits bits = (std::bit_cast<Bits>(shifted.v) + Format::bias)
                              << Format::mantissa_bits;
            power = std::bit_cast<Vector>(bits);
        }
    };
    /// Returns 1/first! + r/(first + 1)! + ...
    static Lanes series_of_exp(Lanes r, std::size_t first) {
        Lanes sum = inverse_factorials[Format::exp_degree];
        for (std::size_t i = Format::exp_degree; i-- > first;)
            sum = sum * r + inverse_factorials[i];
        return sum;
    }

    /// The sum of this and a whole number has the whole number in its low bits. This converts
    /// between integers and floating-point numbers without a conversion instruction.
    static constexpr Number whole_number_shift =
        static_cast<Number>(std::int64_t{3} << (Format::mantissa_bits - 1));
    // Computed at compile time, since GCC would leave the divisions in the loop.
    static constexpr auto log_coefficients = [] {
        auto all = Format::log_terms;
        for (double& x : all) x = 1.0 / x;
        return all;
    }();
    static constexpr std::array<double, Format::exp_degree + 1> inverse_factorials = [] {
        std::array<double, Format::exp_degree + 1> all{1.0};
        double factorial = 1.0;
        for (std::size_t i = 1; i < all.size(); ++i) {
            factorial *= static_cast<double>(i);
            all[i] = 1.0 / factorial;
        }
        return all;
    }();
};

/// One vector in space in each lane.
template <class Number>
struct Lanes3 {
    using Scalar = Lanes<Number>;
    Scalar x, y, z;

    friend Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    /// A multiple that is not computed yet, like Product.
    struct Multiple {
        Scalar s;
        Lanes3 a;
        operator Lanes3() const { return {s * a.x, s * a.y, s * a.z}; }
        friend Multiple operator-(const Multiple& m) { return {-m.s, m.a}; }
        friend Lanes3 operator+(const Lanes3& b, const Multiple& m) {
            return {m.s * m.a.x + b.x, m.s * m.a.y + b.y, m.s * m.a.z + b.z};
        }
        friend Lanes3 operator+(const Multiple& m, const Multiple& n) { return Lanes3(n) + m; }
        friend Lanes3 operator-(const Lanes3& b, const Multiple& m) {
            return {b.x - m.s * m.a.x, b.y - m.s * m.a.y, b.z - m.s * m.a.z};
        }
    };
    friend Multiple operator*(Scalar s, const Lanes3& a) { return {s, a}; }

    friend Scalar dot(const Lanes3& a, const Lanes3& b) {
        return a.x * b.x + (a.y * b.y + a.z * b.z);
    }
    friend Lanes3 cross(const Lanes3& a, const Lanes3& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }

    // Every product is rounded, and the sum is (xx + yy) + zz, as in Eigen. So an element at rest
    // has exactly zero strain.
    friend Scalar rounded_dot(const Lanes3& a, const Lanes3& b) {
        return (Scalar(a.x * b.x) + Scalar(a.y * b.y)) + Scalar(a.z * b.z);
    }
    friend Lanes3 rounded_cross(const Lanes3& a, const Lanes3& b) {
        const auto difference = [](Scalar p, Scalar q) { return p - q; };
        return {difference(a.y * b.z, a.z * b.y), difference(a.z * b.x, a.x * b.z),
                difference(a.x * b.y, a.y * b.x)};
    }
};

/// Returns a vector whose lane l is lane pick(l) of the lanes of a followed by those of b.
template <auto pick, class Vector>
Vector shuffle(Vector a, Vector b) {
    return [&]<int... l>(std::integer_sequence<int, l...>) {
        return __builtin_shufflevector(a, b, pick(l)...);
    }
    (std::make_integer_sequence<int, sizeof(Vector) / sizeof(a[0])>());
}

/// Transposes 4 x 4 matrices that are side by side in the vectors: within each four lanes,
/// (a0 a1 a2 a3) becomes (a0 b0 c0 d0) and so on.
template <class Number>
[[gnu::always_inline]] inline void transpose(Lanes<Number>& a, Lanes<Number>& b, Lanes<Number>& c,
                                             Lanes<Number>& d) {
    constexpr int n = num_lanes<Number>;
    // Processors have one instruction for each of these shuffles.
    constexpr auto halves = [](int l) { return l % 4 < 2 ? l : n + l - 2; };
    constexpr auto other_halves = [](int l) { return l % 4 < 2 ? l + 2 : n + l; };
    if constexpr (sizeof(Number) == 8) {
        constexpr auto even = [](int l) { return l % 2 == 0 ? l : n + l - 1; };
        constexpr auto odd = [](int l) { return l % 2 == 0 ? l + 1 : n + l; };
        const auto ab_even = shuffle<even>(a.v, b.v), ab_odd = shuffle<odd>(a.v, b.v),
                   cd_even = shuffle<even>(c.v, d.v), cd_odd = shuffle<odd>(c.v, d.v);
        a = shuffle<halves>(ab_even, cd_even);
        b = shuffle<halves>(ab_odd, cd_odd);
        c = shuffle<other_halves>(ab_even, cd_even);
        d = shuffle<other_halves>(ab_odd, cd_odd);
    } else {
        constexpr auto low = [](int l) { return l - l % 4 + l % 4 / 2 + l % 2 * n; };
        constexpr auto high = [](int l) { return l - l % 4 + l % 4 / 2 + l % 2 * n + 2; };
        const auto ab_low = shuffle<low>(a.v, b.v), ab_high = shuffle<high>(a.v, b.v),
                   cd_low = shuffle<low>(c.v, d.v), cd_high = shuffle<high>(c.v, d.v);
        a = shuffle<halves>(ab_low, cd_low);
        b = shuffle<other_halves>(ab_low, cd_low);
        c = shuffle<halves>(ab_high, cd_high);
        d = shuffle<other_halves>(ab_high, cd_high);
    }
}

/// Prefetches the group that a loop reaches some rounds later, and near the end of the loop the
/// first groups of the next loop. Without this, a loop over a body larger than the caches waits for
/// memory, since the prefetch of the processor itself starts too late, and starts again in each
/// loop.
template <class Group>
class FetchAhead {
  public:
    /// @param groups  the groups of this loop
    /// @param next    the groups of the next loop; may be empty, then memory behind `groups` is
    ///                prefetched without use
    FetchAhead(std::span<const Group> groups, std::span<const std::byte> next)
        : size_(groups.size()),
          groups_(address(groups.data())),
          next_(next.empty() ? groups_ : address(next.data()) - groups.size_bytes()) {}

    /// Prefetches for round `now`. The loop calls it with the number of each group in turn.
    [[gnu::always_inline]] void operator()(std::size_t now) const {
        constexpr int for_reading = 0, to_second_cache = 2;  // the first is full of data in use
        const std::size_t then = now + num_rounds;
        // A selection of an address costs less than a branch. The address may be behind the end of
        // `next`; a prefetch from there has no effect.
        const std::uintptr_t group = (then < size_ ? groups_ : next_) + then * sizeof(Group);
        for (std::size_t i = 0; i < sizeof(Group); i += cache_line)
            // NOLINTNEXTLINE(performance-no-int-to-ptr): of no object, so no pointer may hold it
            __builtin_prefetch(reinterpret_cast<const void*>(group + i), for_reading,
                               to_second_cache);
    }

  private:
    static constexpr std::size_t num_rounds = 8, cache_line = 64;

    static std::uintptr_t address(const void* memory) {
        return reinterpret_cast<std::uintptr_t>(memory);
    }

    std::size_t size_;
    std::uintptr_t groups_, next_;
};

}  // namespace incise::physics::INCISE_PROCESSOR

template <class Number>
struct std::numeric_limits<incise::physics::INCISE_PROCESSOR::Lanes<Number>>
    : std::numeric_limits<Number> {};
