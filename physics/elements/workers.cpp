// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/workers.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace incise::physics {

namespace {

/// Starts as many threads as TBB will start, at the same time, and ends them. If the system refuses
/// a thread here, the error can be caught. A later thread of TBB may still be refused when memory
/// is short.
void require_threads(int count) {
    std::mutex gate;
    std::vector<std::jthread> threads;  // joined after the gate is unlocked
    threads.reserve(static_cast<std::size_t>(count));
    const std::lock_guard closed(gate);
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&gate] { const std::lock_guard opened(gate); });
}

/// Tells the thread sanitizer the order of events, which it cannot see since TBB is not built for
/// it. All work begins after the events before it, and ends before the events after it.
class Order {
  public:
#ifdef __SANITIZE_THREAD__
    Order() { __tsan_release(&begin_); }
    ~Order() { __tsan_acquire(&end_); }
    void begin_work() { __tsan_acquire(&begin_); }
    void end_work() { __tsan_release(&end_); }

  private:
    char begin_, end_;
#else
    void begin_work() {}
    void end_work() {}
#endif
};

/// Runs one task for each thread, which waits until all threads run one. It waits 100 ms at most,
/// since there may be fewer threads.
void meet(int num_threads) {
    using Clock = std::chrono::steady_clock;
    const auto latest = Clock::now() + std::chrono::milliseconds(100);
    std::atomic<int> num_there = 0;
    Order order;
    const auto wait = [&](int) {
        order.begin_work();
        ++num_there;
        while (num_there < num_threads && Clock::now() < latest) std::this_thread::yield();
        order.end_work();
    };
    tbb::parallel_for(0, num_threads, wait, tbb::simple_partitioner());
}

}  // namespace

struct Workers::Arena {
    explicit Arena(int num_threads)
        : limit(tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(std::max(num_threads, num_cores()))),
          arena(num_threads) {
        require_threads(num_threads - 1);
        // TBB starts its threads when there is work for them. This work makes it start them now,
        // while there is still memory for them.
        try {
            arena.execute([&] { meet(num_threads); });
        } catch (const std::exception& error) {
            if (!is_refused_thread(error)) throw;
            throw std::system_error(EAGAIN, std::generic_category(), error.what());
        }
    }
    tbb::global_control limit;  // without it, TBB starts no more threads than cores, and warns
    tbb::task_arena arena;
};

Workers::Workers(int num_threads)
    : num_threads_(num_threads),
      arena_(num_threads > 1 ? std::make_unique<Arena>(num_threads) : nullptr) {}

Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::num_cores() { return tbb::info::default_concurrency(); }

bool Workers::is_refused_thread(const std::exception& error) {
    return std::string_view(error.what()).starts_with("pthread_create has failed");  // text of TBB
}

void Workers::for_each(std::size_t n, FunctionRef<void(std::size_t)> work) const {
    constexpr std::size_t few = 4;  // takes less time than to wake other threads
    if (!arena_ || n < few) {
        for (std::size_t i = 0; i < n; ++i) work(i);
        return;
    }
    Order order;
    arena_->arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            order.begin_work();
            work(i);
            order.end_work();
        });
    });
}

}  // namespace incise::physics
