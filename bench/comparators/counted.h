// A number that counts the operations on it, to count the operations of formulas.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <cstdint>
#include <utility>

namespace incise::bench {

/// Numbers of operations. Changes of sign and comparisons do not count.
struct Operations {
    std::int64_t additions = 0;  ///< with subtractions
    std::int64_t multiplications = 0;
    std::int64_t divisions = 0;
    std::int64_t functions = 0;  ///< square roots, logarithms

    /// Returns the sum over all kinds.
    std::int64_t total() const { return additions + multiplications + divisions + functions; }
    bool operator==(const Operations&) const = default;
};

/// A double that counts its operations. Conversions do not count.
class Counted {
  public:
    Counted() = default;
    Counted(double value) : value_(value) {}  // NOLINT: constants in formulas, as for double

    double value() const { return value_; }

    /// Returns the operations in this thread since the last call. All numbers of a thread share one
    /// count.
    /// @thread Each thread has its own count.
    static Operations take() { return std::exchange(recorded_, {}); }

    friend Counted operator+(Counted a, Counted b) {
        ++recorded_.additions;
        return a.value_ + b.value_;
    }
    friend Counted operator-(Counted a, Counted b) {
        ++recorded_.additions;
        return a.value_ - b.value_;
    }
    friend Counted operator*(Counted a, Counted b) {
        ++recorded_.multiplications;
        return a.value_ * b.value_;
    }
    friend Counted operator/(Counted a, Counted b) {
        ++recorded_.divisions;
        return a.value_ / b.value_;
    }
    friend Counted operator-(Counted a) { return -a.value_; }
    Counted& operator+=(Counted b) { return *this = *this + b; }
    Counted& operator-=(Counted b) { return *this = *this - b; }
    Counted& operator*=(Counted b) { return *this = *this * b; }
    Counted& operator/=(Counted b) { return *this = *this / b; }
    friend auto operator<=>(const Counted&, const Counted&) = default;

    friend Counted sqrt(Counted a) {
        ++recorded_.functions;
        return std::sqrt(a.value_);
    }
    friend Counted log(Counted a) {
        ++recorded_.functions;
        return std::log(a.value_);
    }

  private:
    static inline thread_local Operations recorded_;
    double value_ = 0.0;
};

}  // namespace incise::bench

template <>
struct Eigen::NumTraits<incise::bench::Counted> : Eigen::GenericNumTraits<double> {
    using Real = incise::bench::Counted;
    using NonInteger = incise::bench::Counted;
    using Nested = incise::bench::Counted;
    using Literal = incise::bench::Counted;
    enum { RequireInitialization = 1 };
};
