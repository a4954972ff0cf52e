// The threads of a model. The work is divided in the same way for any number of threads, so that
// results are the same bit for bit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>

#include "incise/base/function_ref.h"

namespace incise::physics {

/// The number of node ids in a range, the unit of work on nodes. Sums over nodes are formed by
/// range, and the ranges are added in ascending order.
inline constexpr std::size_t nodes_per_range = 512;

inline std::size_t num_node_ranges(std::size_t num_nodes) {
    return (num_nodes + nodes_per_range - 1) / nodes_per_range;
}

/// Range `number` of nodes: the ids from `begin` to before `end`.
struct NodeRange {
    std::size_t number, begin, end;
};

/// A group of threads, made by TBB, that share work.
class Workers {
  public:
    /// The largest number of threads that a user can ask for.
    static constexpr int max_threads = 256;

    /// Creates `num_threads` threads, at least 1; the thread of the caller is one of them. More
    /// than num_cores() threads are used only while no other Workers with fewer threads exist.
    /// Throws std::system_error if the system has no memory for the threads or allows fewer.
    explicit Workers(int num_threads);
    ~Workers();
    Workers(Workers&&) noexcept;
    Workers& operator=(Workers&&) noexcept;

    int num_threads() const { return num_threads_; }

    /// Returns how many threads of the process can run at the same time.
    static int num_cores();

    /// True if the error is that of TBB when the system refuses a further thread. TBB throws it on
    /// its own threads, where it cannot be caught. The handler of std::terminate needs this test.
    static bool is_refused_thread(const std::exception& error);

    /// Calls work(i) for i from 0 to n - 1, in any order, and returns when all calls have returned.
    /// The calls are made by several threads at the same time, unless n is small. Throws the first
    /// exception that a call throws. Allocates no memory except for the tasks of TBB.
    void for_each(std::size_t n, FunctionRef<void(std::size_t)> work) const;

    /// Calls work(range) for each range of `num_nodes` nodes, as for_each() does.
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
