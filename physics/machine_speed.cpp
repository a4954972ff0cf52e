// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/machine_speed.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace incise::physics {

using MultiplyAndAdd = double(std::size_t);
using SumUp = double(const double*, std::size_t);
namespace plain {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
}  // namespace plain
#ifdef INCISE_HAS_AVX
namespace avx2 {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
}  // namespace avx2
namespace avx512 {
MultiplyAndAdd multiply_and_add;
SumUp sum_up;
}  // namespace avx512
#endif

namespace {

struct Loops {
    MultiplyAndAdd* arithmetic;
    SumUp* reading;
};

Loops loops_for([[maybe_unused]] Processor processor) {
#ifdef INCISE_HAS_AVX
    if (processor == Processor::avx512) return {avx512::multiply_and_add, avx512::sum_up};
    if (processor == Processor::avx2) return {avx2::multiply_and_add, avx2::sum_up};
#endif
    return {plain::multiply_and_add, plain::sum_up};
}

/// Billions a second, the best of several times.
template <class Work>
double best_rate(double amount, Work work) {
    volatile double result = 0.0;  // so that the work is done
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 10; ++i) {
        const auto start = std::chrono::steady_clock::now();
        result = result + work();
        best = std::min(
            best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return amount / best * 1e-9;
}

}  // namespace

MachinePeak measure_peak() {
    const Loops loops = loops_for(processor());
    constexpr std::size_t num_operations = 64'000'000, num_numbers = std::size_t{1} << 25;
    MachinePeak peak;
    peak.gigaflops = best_rate(static_cast<double>(num_operations),
                               [&] { return loops.arithmetic(num_operations); });
    const std::vector<double> numbers(num_numbers, 1.0);
    peak.gigabytes_per_second = best_rate(static_cast<double>(num_numbers * sizeof(double)), [&] {
        return loops.reading(numbers.data(), num_numbers);
    });
    return peak;
}

std::string_view name_of(Processor processor) {
    switch (processor) {
        case Processor::avx512:
            return "avx512";
        case Processor::avx2:
            return "avx2";
        case Processor::plain:
            break;
    }
    return "plain";
}

}  // namespace incise::physics
