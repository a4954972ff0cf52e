// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/stable_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::physics {

void StableStep::set(std::size_t node, double stiffness, double mass) {
    if (node >= quotients_.size()) quotients_.resize(node + 1, 0.0);
    block_max_.resize((quotients_.size() + block_size - 1) / block_size, -1.0);
    quotients_[node] = mass > 0.0 ? stiffness / mass : 0.0;
    block_max_[node / block_size] = -1.0;
}

void StableStep::truncate(std::size_t num_nodes) {
    if (num_nodes >= quotients_.size()) return;
    quotients_.resize(num_nodes);
    block_max_.resize((num_nodes + block_size - 1) / block_size);
    if (!block_max_.empty()) block_max_.back() = -1.0;
}

double StableStep::highest() const {
    double highest = 0.0;
    for (std::size_t b = 0; b < block_max_.size(); ++b) {
        if (block_max_[b] < 0.0) {
            const auto begin = quotients_.begin() + static_cast<std::ptrdiff_t>(b * block_size);
            const auto end = quotients_.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                      (b + 1) * block_size, quotients_.size()));
            block_max_[b] = *std::max_element(begin, end);
        }
        highest = std::max(highest, block_max_[b]);
    }
    return highest;
}

double StableStep::step_of(double highest) {
    return highest > 0.0 ? 2.0 / std::sqrt(highest) : std::numeric_limits<double>::infinity();
}

std::size_t StableStep::limiting_node() const {
    const auto highest = std::max_element(quotients_.begin(), quotients_.end());
    return static_cast<std::size_t>(highest - quotients_.begin());
}

}  // namespace incise::physics
