// Sums whose error does not grow with the number of terms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace incise {

/// Compensated sum: the rounding errors are added up in a second number. The method is Neumaier's;
/// the error of each addition is found by Knuth's TwoSum, which has no branch. For any number of
/// terms, the error is a few units in the last place of the sum of their absolute values. The order
/// of the terms changes the result only within this error.
class Sum {
  public:
    Sum() = default;
    /// @param sum   the rounded sum
    /// @param lost  the sum of the rounding errors
    Sum(double sum, double lost) : sum_(sum), lost_(lost) {}

    Sum& operator+=(double term) {
        const double next = sum_ + term, added = next - sum_;
        lost_ += (sum_ - (next - added)) + (term - added);
        sum_ = next;
        return *this;
    }
    Sum& operator+=(const Sum& other) {
        *this += other.sum_;
        lost_ += other.lost_;
        return *this;
    }
    friend Sum operator*(double factor, Sum sum) {
        sum.sum_ *= factor;
        sum.lost_ *= factor;
        return sum;
    }
    double value() const { return sum_ + lost_; }

  private:
    double sum_ = 0.0, lost_ = 0.0;
};

/// `n` compensated sums side by side, where `n` is even. Two of them are computed at a time, since
/// every processor has instructions for pairs of doubles.
template <std::size_t n>
class Sums {
  public:
    using Pair = double __attribute__((vector_size(2 * sizeof(double))));
    using Terms = std::array<Pair, n / 2>;

    Sums& operator+=(const Terms& terms) {
#pragma GCC unroll 8
        for (std::size_t i = 0; i < n / 2; ++i) {
            const Pair next = sums_[i] + terms[i], added = next - sums_[i];
            lost_[i] += (sums_[i] - (next - added)) + (terms[i] - added);
            sums_[i] = next;
        }
        return *this;
    }
    Sums& operator+=(const Sums& other) {
        *this += other.sums_;
        for (std::size_t i = 0; i < n / 2; ++i) lost_[i] += other.lost_[i];
        return *this;
    }
    Sum operator[](std::size_t i) const { return {sums_[i / 2][i % 2], lost_[i / 2][i % 2]}; }

  private:
    Terms sums_{}, lost_{};
};

}  // namespace incise
