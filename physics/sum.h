// Sums whose error does not grow with the number of terms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

namespace incise::physics {

/// Compensated sum (Neumaier's variant of Kahan's): the error stays at a few units in the last
/// place of the sum of absolute values, however many terms. The result depends on their order only
/// in that error.
class Sum {
  public:
    Sum& operator+=(double term) {
        const double next = sum_ + term;
        lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
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

}  // namespace incise::physics
