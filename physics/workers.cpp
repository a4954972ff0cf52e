// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/workers.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace incise::physics {

struct Workers::Arena {
    explicit Arena(int num_threads) : arena(num_threads) {}
    tbb::task_arena arena;
};

Workers::Workers(int num_threads)
    : num_threads_(num_threads),
      arena_(num_threads > 1 ? std::make_unique<Arena>(num_threads) : nullptr) {}

Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::num_cores() { return tbb::info::default_concurrency(); }

void Workers::for_each(std::size_t n, const std::function<void(std::size_t)>& work) const {
    constexpr std::size_t few = 4;  // done sooner than other threads are woken
    if (!arena_ || n < few) {
        for (std::size_t i = 0; i < n; ++i) work(i);
        return;
    }
    arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, n, work); });
}

}  // namespace incise::physics
