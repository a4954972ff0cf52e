// The totals of a model. Ranges of nodes and blocks of elements are summed in a fixed order, so
// that the results are the same bit for bit with any number of threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "incise/base/sum.h"
#include "incise/physics/body/model.h"

namespace incise::physics {

namespace {

/// Returns the vector whose first component has the index `first`.
Vec3 vector_of(const NodeSums& sums, std::size_t first) {
    return {sums[first].value(), sums[first + 1].value(), sums[first + 2].value()};
}

}  // namespace

NodeSums Model::sums_of(NodeRange range) const {
    NodeSums sums;
    for (std::size_t n = range.begin; n < range.end; ++n) {
        const double m = masses_[n];
        if (m == 0.0) continue;  // dead
        const Vec3 &x = positions()[n], &v = velocities()[n];
        const Vec3 p = m * v, l = x.cross(p);
        using Pair = NodeSums::Pair;  // in the order of NodeSum
        sums += NodeSums::Terms{Pair{m, 0.5 * p.dot(v)}, Pair{-m * loads_.gravity().dot(x), p[0]},
                                Pair{p[1], p[2]},        Pair{l[0], l[1]},
                                Pair{l[2], m * x[0]},    Pair{m * x[1], m * x[2]}};
    }
    return sums;
}

Totals Model::totals() const {
    const NodeSums sums = node_sums_.value(state_.version(), masses_.size(), workers_,
                                           [&](NodeRange range) { return sums_of(range); });
    Totals t;
    t.mass = sums[NodeSum::mass].value();
    Sum rest_volume;
    elements_.add_up_blocks(
        workers_, [](const ElementBlock& block) { return block.rest_volume(); },
        [&](const Sum& of_block) { rest_volume += of_block; });
    t.rest_volume = rest_volume.value();
    t.kinetic_energy = sums[NodeSum::kinetic_energy].value();
    t.elastic_energy = elastic_energy();
    t.gravity_energy = sums[NodeSum::gravity_energy].value();
    t.momentum = vector_of(sums, NodeSum::momentum);
    t.angular_momentum = vector_of(sums, NodeSum::angular_momentum);
    if (t.mass > 0.0) t.centre_of_mass = vector_of(sums, NodeSum::moment_of_mass) / t.mass;
    return t;
}

double Model::elastic_energy() const {
    return elements_.totals(state_, workers_).elastic_energy.value();
}

double Model::stiffness_energy() const {
    double sum = 0.0;
    elements_.for_each_block([&](const ElementBlock& block) { sum += block.stiffness_energy(); });
    return sum;
}

double Model::min_volume_ratio() const {
    return elements_.totals(state_, workers_).min_volume_ratio;
}

double Model::volume_change() const {
    double now = 0.0, at_rest = 0.0;
    elements_.for_each_block([&](const ElementBlock& block) {
        for (const ElementId e : block.elements()) {
            const ElementResult result = block.result(e, positions(), history());
            now += result.volume * result.volume_ratio;
            at_rest += result.volume;
        }
    });
    return now / at_rest - 1.0;
}

double Model::max_displacement() const {
    double largest = 0.0;
    const auto x = mesh_positions();
    for (const VertexId n : mesh_.nodes())
        largest = std::max(largest, (x[n.index()] - mesh_.rest_position(n)).norm());
    return largest;
}

}  // namespace incise::physics
