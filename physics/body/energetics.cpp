// The sums over a body. Ranges of nodes and blocks of elements are summed in a fixed order, so that
// the results are the same bit for bit with any number of threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/energetics.h"

#include "incise/base/sum.h"

namespace incise::physics {

namespace {

/// Returns the vector whose first component has the index `first`.
Vec3 vector_of(const NodeSums& sums, std::size_t first) {
    return {sums[first].value(), sums[first + 1].value(), sums[first + 2].value()};
}

}  // namespace

NodeSums Energetics::sums_of(NodeRange range) const {
    const auto masses = structure_.masses();
    const auto positions = state_.positions(), velocities = state_.velocities();
    const Vec3& gravity = boundary_.loads().gravity();
    NodeSums sums;
    for (std::size_t n = range.begin; n < range.end; ++n) {
        const double m = masses[n];
        if (m == 0.0) continue;  // dead
        const Vec3 &x = positions[n], &v = velocities[n];
        const Vec3 p = m * v, l = x.cross(p);
        using Pair = NodeSums::Pair;  // in the order of NodeSum
        sums += NodeSums::Terms{Pair{m, 0.5 * p.dot(v)}, Pair{-m * gravity.dot(x), p[0]},
                                Pair{p[1], p[2]},        Pair{l[0], l[1]},
                                Pair{l[2], m * x[0]},    Pair{m * x[1], m * x[2]}};
    }
    return sums;
}

Totals Energetics::totals() const {
    const NodeSums sums =
        node_sums_.value(state_.version() + boundary_.gravity_version(), structure_.masses().size(),
                         workers_, [&](NodeRange range) { return sums_of(range); });
    Totals t;
    t.mass = sums[NodeSum::mass].value();
    Sum rest_volume;
    structure_.elements().add_up_blocks(
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

double Energetics::elastic_energy() const {
    return structure_.elements().totals(state_, workers_).elastic_energy.value();
}

double Energetics::min_volume_ratio() const {
    return structure_.elements().totals(state_, workers_).min_volume_ratio;
}

double Energetics::volume_change() const {
    double now = 0.0, at_rest = 0.0;
    structure_.elements().for_each_block([&](const ElementBlock& block) {
        for (const ElementId e : block.elements()) {
            const ElementResult result = block.result(e, state_.positions(), state_.history());
            now += result.volume * result.volume_ratio;
            at_rest += result.volume;
        }
    });
    return now / at_rest - 1.0;
}

void Energetics::forget(std::span<const NodeId> nodes) {
    node_sums_.resize(structure_.masses().size());
    for (const NodeId n : nodes) node_sums_.forget(n.index());
}

}  // namespace incise::physics
