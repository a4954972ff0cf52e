// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/image/grey_values.h"

#include <algorithm>
#include <unordered_set>

namespace incise::io {

std::optional<std::string> sign_of_grey_values(std::span<const int> values) {
    std::unordered_set<int> different;
    std::size_t num_changes = 0;
    for (std::size_t v = 0; v < values.size() && different.size() <= most_labels; ++v)
        if (v == 0 || values[v] != values[v - 1]) {
            different.insert(values[v]);
            ++num_changes;
        }
    if (values.empty()) return std::nullopt;
    const auto [low, high] = std::ranges::minmax_element(values);
    if (different.size() > most_labels)
        return "more than " + std::to_string(most_labels) + " different values, from " +
               std::to_string(*low) + " to " + std::to_string(*high);
    // Voxels of a label lie together, and those of a scan differ from their neighbours.
    constexpr double speckle = 0.4;
    if (different.size() > few_labels && values.size() >= least_voxels &&
        static_cast<double>(num_changes) > speckle * static_cast<double>(values.size()))
        return std::to_string(different.size()) +
               " different values, which change from voxel to voxel";
    if (*low < 0) return "values below 0, the lowest " + std::to_string(*low);
    return std::nullopt;
}

}  // namespace incise::io
