// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/machine_speed.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

#include "physics/heml_kernel.h"
#include "physics/peak_loops.h"

namespace incise::physics {

namespace {

struct Loops {
    MultiplyAndAdd* arithmetic;
    SumUp* reading;
    WorkOutLinks* links;
};

Loops loops_for(Processor processor) {
    return {INCISE_CHOOSE(processor, MultiplyAndAdd, multiply_and_add),
            INCISE_CHOOSE(processor, SumUp, sum_up),
            INCISE_CHOOSE(processor, WorkOutLinks, work_out_links)};
}

/// Seconds, the best of several times.
template <class Work>
double best_time(Work work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 10; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(
            best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// Billions a second.
template <class Work>
double best_rate(double amount, Work work) {
    volatile double result = 0.0;  // so that the work is done
    return amount / best_time([&] { result = result + work(); }) * 1e-9;
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

double measure_arithmetic(const Law& law) {
    constexpr std::size_t num_groups = 8, num_passes = 20'000;
    constexpr std::size_t num_elements = num_groups * LinkGroup<double>::size;
    const HemlKernel kernel{law, 0.4};
    HemlLanes lanes;
    lanes.assign(num_elements, kernel);
    std::vector<LinkGroupVectors> vectors(num_groups);
    for (std::size_t i = 0; i < num_elements; ++i) {
        // A corner of a cube, stretched in another way each.
        constexpr double edge = 0.01;
        const std::array<Vec3, 4> X{Vec3::Zero(), edge * Vec3::UnitX(), edge * Vec3::UnitY(),
                                    edge * Vec3::UnitZ()};
        lanes.set(i, kernel.precompute(X));
        const double stretch = 0.9 + 0.2 * static_cast<double>(i) / num_elements;
        for (std::size_t k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                vectors[i % num_groups].edges[k][c][i / num_groups] = stretch * X[k + 1][c];
    }
    WorkOutLinks* const work_out = loops_for(processor()).links;
    const double time =
        best_time([&] { work_out(law, lanes.groups<double>().links, vectors, num_passes); });
    return time / static_cast<double>(num_elements * num_passes);
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
