// What a model's nodes and elements add up to. Sums are those of ranges and blocks, in order: the
// same bits for any number of threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "physics/model.h"
#include "physics/sum.h"

namespace incise::physics {

namespace {

/// What nodes add up to.
struct NodeSums {
    Sum mass, kinetic_energy, gravity_energy;
    std::array<Sum, 3> momentum, angular_momentum, moment_of_mass;

    NodeSums& operator+=(const NodeSums& o) {
        mass += o.mass;
        kinetic_energy += o.kinetic_energy;
        gravity_energy += o.gravity_energy;
        for (std::size_t c = 0; c < 3; ++c) {
            momentum[c] += o.momentum[c];
            angular_momentum[c] += o.angular_momentum[c];
            moment_of_mass[c] += o.moment_of_mass[c];
        }
        return *this;
    }
};

Vec3 value_of(const std::array<Sum, 3>& sums) {
    return {sums[0].value(), sums[1].value(), sums[2].value()};
}

}  // namespace

Totals Model::totals() const {
    std::vector<NodeSums> ranges(num_node_ranges(masses_.size()));
    workers_.for_each(ranges.size(), [&](std::size_t r) {
        NodeSums& sums = ranges[r];
        const std::size_t end = std::min((r + 1) * nodes_per_range, masses_.size());
        for (std::size_t n = r * nodes_per_range; n < end; ++n) {
            const double m = masses_[n];
            if (m == 0.0) continue;
            const Vec3 p = m * velocities_[n];
            const Vec3 l = positions_[n].cross(p);
            sums.mass += m;
            sums.kinetic_energy += 0.5 * p.dot(velocities_[n]);
            sums.gravity_energy += -m * gravity_.dot(positions_[n]);
            for (int c = 0; c < 3; ++c) {
                const auto i = static_cast<std::size_t>(c);
                sums.momentum[i] += p[c];
                sums.angular_momentum[i] += l[c];
                sums.moment_of_mass[i] += m * positions_[n][c];
            }
        }
    });
    NodeSums sums;
    for (const NodeSums& range : ranges) sums += range;

    Totals t;
    t.mass = sums.mass.value();
    Sum rest_volume;
    elements_.add_up_blocks(
        workers_, [](const ElementBlock& block) { return block.rest_volume(); },
        [&](const Sum& of_block) { rest_volume += of_block; });
    t.rest_volume = rest_volume.value();
    t.kinetic_energy = sums.kinetic_energy.value();
    t.elastic_energy = elastic_energy();
    t.gravity_energy = sums.gravity_energy.value();
    t.momentum = value_of(sums.momentum);
    t.angular_momentum = value_of(sums.angular_momentum);
    if (t.mass > 0.0) t.centre_of_mass = value_of(sums.moment_of_mass) / t.mass;
    return t;
}

double Model::elastic_energy() const {
    return elements_.elastic_energy(positions_, workers_).value();
}

double Model::stiffness_energy() const {
    double sum = 0.0;
    elements_.for_each_block([&](const ElementBlock& block) { sum += block.stiffness_energy(); });
    return sum;
}

double Model::min_volume_ratio() const {
    double lowest = std::numeric_limits<double>::infinity();
    elements_.add_up_blocks(
        workers_, [&](const ElementBlock& block) { return block.min_volume_ratio(positions_); },
        [&](double of_block) { lowest = std::min(lowest, of_block); });
    return lowest;
}

double Model::volume_change() const {
    double now = 0.0, at_rest = 0.0;
    elements_.for_each_block([&](const ElementBlock& block) {
        for (const ElementId e : block.elements()) {
            const ElementResult result = block.result(e, positions_, history_);
            now += result.volume * result.volume_ratio;
            at_rest += result.volume;
        }
    });
    return now / at_rest - 1.0;
}

double Model::max_displacement() const {
    double largest = 0.0;
    for (std::size_t n = 0; n < masses_.size(); ++n)
        if (masses_[n] > 0.0)  // alive
            largest = std::max(largest, (positions_[n] - mesh_.rest_positions()[n]).norm());
    return largest;
}

}  // namespace incise::physics
