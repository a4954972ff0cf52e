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

/// Makes as many threads as TBB will make, all at once, and ends them: what is refused here can be
/// caught. TBB's own may still be refused where memory is short, as each of them takes some.
void require_threads(int count) {
    std::mutex gate;
    std::vector<std::jthread> threads;  // joined when the gate is open
    const std::lock_guard closed(gate);
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&gate] { const std::lock_guard opened(gate); });
}

/// Tells the thread sanitizer what it cannot see, as TBB is not built for it: all work begins after
/// what came before, and what comes after begins when all has ended.
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

/// Work for so many threads, each of which waits for the others; not for ever, as fewer may come.
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
        // TBB makes its threads when there is work for them: now, not when memory is taken.
        try {
            arena.execute([&] { meet(num_threads); });
        } catch (const std::exception& error) {
            if (!is_refused_thread(error)) throw;
            throw std::system_error(EAGAIN, std::generic_category(), error.what());
        }
    }
    tbb::global_control limit;  // else there are no more threads than cores, and a complaint
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
    return std::string_view(error.what()).starts_with("pthread_create has failed");  // TBB's words
}

void Workers::for_each(std::size_t n, FunctionRef<void(std::size_t)> work) const {
    constexpr std::size_t few = 4;  // done sooner than other threads are woken
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
