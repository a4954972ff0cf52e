// Numbers with derivatives over any type of number, for the largest modulus of a law. Unlike Dual
// they work on lanes, and have only as many derivatives as are needed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace incise::physics {

// physics/simd/lanes.h has both functions for lanes.
inline bool is_less(double a, double b) { return a < b; }
inline double choose(bool first, double a, double b) { return first ? a : b; }

/// A value with its first derivatives by n variables. Plain numbers are constants. Like the laws,
/// its functions have no branches.
template <class T, std::size_t n>
struct DualOf {
    T value = 0.0;
    std::array<T, n> gradient;

    DualOf() { gradient.fill(0.0); }
    DualOf(double constant) : value(constant) { gradient.fill(0.0); }  // implicit, as in Dual
    /// Returns variable number `i`.
    static DualOf variable(const T& value, std::size_t i) {
        DualOf x;
        x.value = value;
        x.gradient[i] = 1.0;
        return x;
    }
    /// Returns a function of x with this value and this derivative.
    [[gnu::always_inline]] static inline DualOf of(const T& value, const T& slope,
                                                   const DualOf& x) {
        DualOf f;
        f.value = value;
        for (std::size_t i = 0; i < n; ++i) f.gradient[i] = slope * x.gradient[i];
        return f;
    }

    DualOf& operator+=(const DualOf& o) {
        value += o.value;
        for (std::size_t i = 0; i < n; ++i) gradient[i] += o.gradient[i];
        return *this;
    }
    DualOf& operator-=(const DualOf& o) {
        value -= o.value;
        for (std::size_t i = 0; i < n; ++i) gradient[i] -= o.gradient[i];
        return *this;
    }
    DualOf& operator*=(const DualOf& o) {
        for (std::size_t i = 0; i < n; ++i)
            gradient[i] = value * o.gradient[i] + T(o.value * gradient[i]);
        value = value * o.value;
        return *this;
    }
    friend DualOf operator+(DualOf x, const DualOf& y) { return x += y; }
    friend DualOf operator-(DualOf x, const DualOf& y) { return x -= y; }
    friend DualOf operator*(DualOf x, const DualOf& y) { return x *= y; }
    friend DualOf operator/(const DualOf& x, const DualOf& y) {
        const T per_y = 1.0 / y.value;
        return x * of(per_y, T(-per_y) * per_y, y);
    }
    friend DualOf operator-(const DualOf& x) { return of(-x.value, -1.0, x); }

    friend DualOf max(const DualOf& x, const DualOf& y) {
        return choose(is_less(x.value, y.value), y, x);
    }
    friend DualOf min(const DualOf& x, const DualOf& y) {
        return choose(is_less(y.value, x.value), y, x);
    }
    friend DualOf log(const DualOf& x) {
        using std::log;
        return of(log(x.value), 1.0 / x.value, x);
    }
    friend DualOf exp(const DualOf& x) {
        using std::exp;
        const T e = exp(x.value);
        return of(e, e, x);
    }
    friend DualOf expm1(const DualOf& x) {
        using std::exp, std::expm1;
        return of(expm1(x.value), exp(x.value), x);
    }
    friend DualOf log1p(const DualOf& x) {
        using std::log1p;
        return of(log1p(x.value), 1.0 / (1.0 + x.value), x);
    }
    friend DualOf pow(const DualOf& x, double p) {
        using std::pow;
        const T power = pow(x.value, p);
        return of(power, T(p * power) / x.value, x);
    }

  private:
    template <class Condition>
    static DualOf choose(const Condition& first, const DualOf& x, const DualOf& y) {
        using physics::choose;
        DualOf chosen;
        chosen.value = choose(first, x.value, y.value);
        for (std::size_t i = 0; i < n; ++i)
            chosen.gradient[i] = choose(first, x.gradient[i], y.gradient[i]);
        return chosen;
    }
};

}  // namespace incise::physics
