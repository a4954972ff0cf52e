// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/bench/machine_speed.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <future>
#include <limits>
#include <vector>

#include "incise/bench/peak_loops.h"
#include "incise/physics/elements/heml_kernel.h"

namespace incise::bench {

using namespace physics;

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

/// Returns the shortest time of ten calls, s.
template <class Work>
double best_of_ten(Work work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 10; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(
            best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// Returns the rate, in 1e9 per second, at which all threads together do `amount`. Thread i calls
/// work(i). A call should take some milliseconds, so that starting the threads does not matter.
template <class Work>
double best_rate(double amount, int num_threads, Work work) {
    return amount * 1e-9 / best_of_ten([&] {
               std::vector<std::future<double>> others;
               for (int i = 1; i < num_threads; ++i)
                   others.push_back(std::async(std::launch::async, work, i));
               volatile double result = work(0);  // so that the work is done
               for (auto& other : others) result = result + other.get();
           });
}

}  // namespace

MachinePeak measure_peak(int num_threads) {
    const Loops loops = loops_for(processor());
    constexpr std::size_t num_operations = 512'000'000, num_numbers = std::size_t{1} << 25;
    constexpr int num_passes = 4;
    const std::vector<double> numbers(num_numbers, 1.0);
    const std::size_t part = num_numbers / static_cast<std::size_t>(num_threads);
    MachinePeak peak;
    peak.gigaflops = best_rate(static_cast<double>(num_operations) * num_threads, num_threads,
                               [&](int) { return loops.arithmetic(num_operations); });
    const double bytes_of_one = static_cast<double>(num_passes * part * sizeof(double));
    peak.gigabytes_per_second = best_rate(bytes_of_one * num_threads, num_threads, [&](int i) {
        const double* const own = &numbers[static_cast<std::size_t>(i) * part];
        double sum = 0.0;
        for (int pass = 0; pass < num_passes; ++pass) sum += loops.reading(own, part);
        return sum;
    });
    return peak;
}

double measure_arithmetic(const Law& law) {
    constexpr std::size_t num_groups = 8, num_passes = 20'000;
    constexpr std::size_t num_elements = num_groups * LinkGroup<double>::size;
    const HemlKernel kernel{law, 0.4};
    SimdHemlElements lanes;
    lanes.assign(num_elements, kernel);
    std::vector<LinkGroupVectors> vectors(num_groups);
    for (std::size_t i = 0; i < num_elements; ++i) {
        // Each element is a corner of a cube, with a stretch of its own.
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
        best_of_ten([&] { work_out(law, lanes.groups<double>().links, vectors, num_passes); });
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

}  // namespace incise::bench
