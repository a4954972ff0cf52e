// Numbers with derivatives by the invariants of strain. The response of a law to these numbers has
// the second derivatives of its energy, from the same formulas and with the same accuracy.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace incise::physics {

/// A value with its first derivatives by a, b, J and f, in the order of LinkStrain. Plain numbers
/// are constants. Comparisons compare the values, so a branch differentiates the side that it
/// takes.
struct Dual {
    double value = 0.0;
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();

    Dual() = default;
    Dual(double constant) : value(constant) {}  // implicit: formulas mix numbers and duals
    Dual(double v, const Eigen::Vector4d& g) : value(v), gradient(g) {}
    /// Returns an invariant as a variable. `place` is 0 for a, 1 for b, 2 for J, 3 for f.
    static Dual variable(double v, int place) { return {v, Eigen::Vector4d::Unit(place)}; }

    Dual& operator+=(const Dual& o) { return *this = {value + o.value, gradient + o.gradient}; }
    Dual& operator-=(const Dual& o) { return *this = {value - o.value, gradient - o.gradient}; }
    Dual& operator*=(const Dual& o) {
        return *this = {value * o.value, value * o.gradient + o.value * gradient};
    }
    Dual& operator/=(const Dual& o) {
        const double quotient = value / o.value;
        return *this = {quotient, (gradient - quotient * o.gradient) / o.value};
    }
    friend Dual operator+(Dual x, const Dual& y) { return x += y; }
    friend Dual operator-(Dual x, const Dual& y) { return x -= y; }
    friend Dual operator*(Dual x, const Dual& y) { return x *= y; }
    friend Dual operator/(Dual x, const Dual& y) { return x /= y; }
    friend Dual operator+(const Dual& x) { return x; }
    friend Dual operator-(const Dual& x) { return {-x.value, -x.gradient}; }

    friend bool operator<(const Dual& x, const Dual& y) { return x.value < y.value; }
    friend bool operator>(const Dual& x, const Dual& y) { return x.value > y.value; }
    friend bool operator<=(const Dual& x, const Dual& y) { return x.value <= y.value; }
    friend bool operator>=(const Dual& x, const Dual& y) { return x.value >= y.value; }
    friend bool operator==(const Dual& x, const Dual& y) { return x.value == y.value; }

    friend Dual log(const Dual& x) { return {std::log(x.value), x.gradient / x.value}; }
    friend Dual exp(const Dual& x) {
        const double e = std::exp(x.value);
        return {e, e * x.gradient};
    }
    friend Dual expm1(const Dual& x) {
        return {std::expm1(x.value), std::exp(x.value) * x.gradient};
    }
    friend Dual log1p(const Dual& x) { return {std::log1p(x.value), x.gradient / (1.0 + x.value)}; }
    friend Dual sqrt(const Dual& x) {
        const double root = std::sqrt(x.value);
        return {root, x.gradient / (2.0 * root)};
    }
    friend Dual pow(const Dual& x, double p) {
        return {std::pow(x.value, p), p * std::pow(x.value, p - 1.0) * x.gradient};
    }
    friend Dual abs(const Dual& x) { return x.value < 0.0 ? -x : x; }
};

}  // namespace incise::physics
