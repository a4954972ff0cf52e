// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/element_states.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

namespace incise::physics {

namespace {

/// Gives the lanes without an element a figure: those behind the last element.
void fill_up(std::span<double> figures, std::size_t num_elements, double figure) {
    const std::size_t num_groups = figures.size() / elements_together;
    for (std::size_t i = num_elements; i < figures.size(); ++i)
        figures[i % num_groups * elements_together + i / num_groups] = figure;
}

}  // namespace

std::span<double> room_for_figures(std::size_t num_groups) {
    thread_local std::vector<double> figures;
    figures.resize(num_groups * elements_together);
    return figures;
}

Sum sum_of_figures(std::span<double> figures, std::size_t num_elements) {
    fill_up(figures, num_elements, 0.0);
    Sums<elements_together> lanes;
    for (std::size_t i = 0; i < figures.size(); i += elements_together) {
        Sums<elements_together>::Terms group;
        std::memcpy(&group, &figures[i], sizeof group);
        lanes += group;
    }
    Sum sum;
    for (std::size_t lane = 0; lane < elements_together; ++lane) sum += lanes[lane];
    return sum;
}

double least_of_figures(std::span<double> figures, std::size_t num_elements) {
    constexpr double none = std::numeric_limits<double>::infinity();
    fill_up(figures, num_elements, none);
    return figures.empty() ? none : *std::min_element(figures.begin(), figures.end());
}

std::span<ElementStates> room_for_states(std::size_t num_groups) {
    thread_local std::vector<ElementStates> states;
    states.resize(num_groups);
    return states;
}

void set_results(std::span<const ElementStates> groups, std::span<ElementResult> results) {
    for (std::size_t i = 0; i < results.size(); ++i) {
        const ElementStates& group = groups[i % groups.size()];
        const std::size_t lane = i / groups.size();
        results[i].energy = group.energy[lane];
        results[i].volume_ratio = group.volume_ratio[lane];
        Eigen::Matrix3d virial;
        for (std::size_t k = 0; k < 9; ++k)
            virial(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)) =
                group.virial[k][lane];
        results[i].set_stress(virial);
    }
}

}  // namespace incise::physics
