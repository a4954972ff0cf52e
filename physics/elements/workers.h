// The threads that a model computes with. What they do is divided in the same way for any number
// of them, so that results are the same to the bit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>

#include "incise/base/function_ref.h"

namespace incise::physics {

/// Nodes are worked on in ranges of so many ids: sums over them are those over ranges, in order.
inline constexpr std::size_t nodes_per_range = 512;

inline std::size_t num_node_ranges(std::size_t num_nodes) {
    return (num_nodes + nodes_per_range - 1) / nodes_per_range;
}

/// Ids from `begin` to before `end`.
struct NodeRange {
    std::size_t number, begin, end;
};

class Workers {
  public:
    /// More threads than this are refused where users ask for them.
    static constexpr int max_threads = 256;

    /// Throws std::system_error if the system has no memory for so many threads, or allows fewer.
    /// @param num_threads at least 1, the caller's own among them; more than num_cores() come only
    /// if no other Workers with fewer of them live
    explicit Workers(int num_threads);
    ~Workers();
    Workers(Workers&&) noexcept;
    Workers& operator=(Workers&&) noexcept;

    int num_threads() const { return num_threads_; }

    /// How many the process may run at the same time.
    static int num_cores();

    /// Whether TBB threw it since the system gives no further thread. It makes its threads from one
    /// another, where nobody can catch it: the handler of std::terminate asks this.
    static bool is_refused_thread(const std::exception& error);

    /// Calls work(i) for i from 0 to n - 1, in any order and at the same time if there are enough
    /// to be worth it; returns when all are done. The first exception thrown comes out.
    /// Takes no memory but what TBB keeps of its tasks.
    void for_each(std::size_t n, FunctionRef<void(std::size_t)> work) const;

    /// Likewise work(range) for each range of so many nodes.
    template <class Work>
    void for_each_range(std::size_t num_nodes, Work work) const {
        for_each(num_node_ranges(num_nodes), [&](std::size_t r) {
            const std::size_t begin = r * nodes_per_range;
            work(NodeRange{r, begin, std::min(begin + nodes_per_range, num_nodes)});
        });
    }

  private:
    struct Arena;
    int num_threads_;
    std::unique_ptr<Arena> arena_;  // none for one thread
};

}  // namespace incise::physics
