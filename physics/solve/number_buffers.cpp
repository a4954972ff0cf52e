// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/number_buffers.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace incise::physics {

NumberBuffer::NumberBuffer(std::size_t capacity) : capacity_(capacity) {
    constexpr std::size_t cache_line = 64, large_page = std::size_t{1} << 21;
    std::size_t size = capacity * sizeof(double);
    const bool is_large = size >= 2 * large_page;
    const std::size_t alignment = is_large ? large_page : cache_line;
    size = (size + alignment - 1) / alignment * alignment;
    values_.reset(static_cast<double*>(std::aligned_alloc(alignment, size)));
    if (!values_) throw std::bad_alloc();
#ifdef __linux__
    // With pages of 4 kB the system takes longer to give the memory than the work on it takes.
    if (is_large) madvise(values_.get(), size, MADV_HUGEPAGE);
#endif
}

NumberBuffer NumberBuffers::take(std::size_t capacity) {
    constexpr std::size_t smallest = 1024;
    const std::size_t whole = std::bit_ceil(std::max(capacity, smallest));
    {
        const std::lock_guard lock(*mutex_);
        auto& same = in_store_[static_cast<std::size_t>(std::countr_zero(whole))];
        if (!same.empty()) {
            NumberBuffer buffer = std::move(same.back());
            same.pop_back();
            return buffer;
        }
    }
    return NumberBuffer(whole);
}

void NumberBuffers::give(NumberBuffer buffer) {
    if (buffer.capacity() == 0) return;
    const std::lock_guard lock(*mutex_);
    const int place = std::countr_zero(buffer.capacity());
    in_store_.at(static_cast<std::size_t>(place)).push_back(std::move(buffer));
}

}  // namespace incise::physics
