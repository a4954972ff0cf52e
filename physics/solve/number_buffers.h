// Memory for numbers that is used again.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace incise::physics {

/// An array of numbers without initial values, aligned for all kernels.
class NumberBuffer {
  public:
    NumberBuffer() = default;
    explicit NumberBuffer(std::size_t capacity);
    NumberBuffer(NumberBuffer&& other) noexcept
        : capacity_(std::exchange(other.capacity_, 0)), values_(std::move(other.values_)) {}
    NumberBuffer& operator=(NumberBuffer&& other) noexcept {
        capacity_ = std::exchange(other.capacity_, 0);
        values_ = std::move(other.values_);
        return *this;
    }

    std::size_t capacity() const { return capacity_; }
    double* data() { return values_.get(); }
    const double* data() const { return values_.get(); }

  private:
    struct Free {
        void operator()(double* values) const { std::free(values); }
    };
    std::size_t capacity_ = 0;
    std::unique_ptr<double[], Free> values_;
};

/// A store of buffers that are not in use. The system may take longer to give memory than a
/// factorisation takes to work on it.
class NumberBuffers {
  public:
    /// Returns a buffer of at least this capacity, and less than twice of it.
    /// @thread Several threads may call take() and give() at the same time.
    NumberBuffer take(std::size_t capacity);
    /// Takes back a buffer that take() returned.
    void give(NumberBuffer buffer);

  private:
    std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
    std::array<std::vector<NumberBuffer>, 64> in_store_;  // by the logarithm of the capacity
};

}  // namespace incise::physics
