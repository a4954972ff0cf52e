// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/structure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace incise::physics {

namespace {

double diagonal(const topology::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const VertexId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    return box.diagonal().norm();
}

}  // namespace

Structure::Structure(const topology::Mesh& mesh, fragments::FragmentMesh fragments,
                     const MaterialTable& table)
    : mesh_(mesh),
      fragments_(std::move(fragments)),
      elements_(fragments_, mesh, table),
      embedding_(mesh, fragments_),
      size_(diagonal(mesh)) {
    resize(fragments_.node_capacity());
    for (std::size_t n = 0; n < masses_.size(); ++n) gather(NodeId(n), 0.0);
}

void Structure::resize(std::size_t num_nodes) {
    masses_.resize(num_nodes, 0.0);
    stable_step_.truncate(num_nodes);
}

// Mass and stiffness of a node are summed over its star in ascending order of elements. This is the
// order of a new body, so that the result is the same bit for bit.
void Structure::gather(NodeId n, double outer_stiffness) {
    double mass = 0.0, stiffness = 0.0;
    fragments_.star(n, star_);
    for (const ElementId e : star_) {
        const NodalContributions of_element = elements_.block_of(fragments_, e).contributions(e);
        const auto corner = static_cast<std::size_t>(fragments_.corner_of(e, n));
        mass += of_element.mass[corner];
        stiffness += of_element.stiffness[corner];
    }
    masses_[n.index()] = mass;
    stable_step_.set(n.index(), stiffness + outer_stiffness, mass);
}

void Structure::follow(const fragments::FragmentChanges& changes) {
    ++version_;
    resize(std::max(changes.mesh.node_capacity_before, changes.mesh.node_capacity_after));
    elements_.apply(fragments_, changes.mesh);
    for (const auto& record : changes.mesh.elements_removed)
        elements_.erase(record.id, record.region, record.kind);
    for (const auto& record : changes.mesh.elements_added) elements_.insert(fragments_, record.id);
    std::vector<ElementId> changed;
    for (const fragments::ElementRewiring& rewiring : changes.mesh.rewired)
        changed.push_back(rewiring.element);
    for (const fragments::ShareChange& change : changes.shares) changed.push_back(change.fragment);
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const ElementId e : changed) elements_.replace(fragments_, e);
    resize(changes.mesh.node_capacity_after);
    elements_.number_nodes(fragments_.rest_positions());
}

std::vector<double> Structure::mesh_masses() const {
    const BodyView view{mesh_, fragments_, elements_, masses_, {}};
    std::vector<double> masses(mesh_.node_capacity(), 0.0);
    for (const CellId e : mesh_.elements()) {
        const auto corners = mesh_.corners(e);
        for (std::size_t k = 0; k < corners.size(); ++k)
            masses[corners[k].index()] += view.mass_at_corner(e, k);
    }
    return masses;
}

double Structure::stiffness_energy() const {
    double sum = 0.0;
    elements_.for_each_block([&](const ElementBlock& block) { sum += block.stiffness_energy(); });
    return sum;
}

double Structure::stable_step(const State& state, const Workers& workers) const {
    double highest = stable_step_.highest();
    if (!elements_.compute_excess_stiffness(state, workers)) return StableStep::step_of(highest);
    std::vector<double>& of_ranges = highest_of_ranges_;
    of_ranges.assign(num_node_ranges(masses_.size()), 0.0);
    workers.for_each_range(masses_.size(), [&](NodeRange range) {
        std::array<double, nodes_per_range> excess{};
        elements_.gather_excess_stiffness(range, excess);
        for (std::size_t n = range.begin; n < range.end; ++n)
            if (const double more = excess[n - range.begin]; more > 0.0)
                of_ranges[range.number] =
                    std::max(of_ranges[range.number], stable_step_.quotient(n) + more / masses_[n]);
    });
    for (const double of_range : of_ranges) highest = std::max(highest, of_range);
    return StableStep::step_of(highest);
}

double Structure::stable_step(const State& state, std::span<const NodeId> nodes) const {
    std::map<ElementId, double> factors;
    std::vector<ElementId> star;
    double highest = 0.0;
    for (const NodeId n : nodes) {
        if (n.index() >= masses_.size() || masses_[n.index()] == 0.0) continue;
        double excess = 0.0;
        fragments_.star(n, star);
        for (const ElementId e : star) {
            const ElementBlock& block = elements_.block_of(fragments_, e);
            const auto [it, is_new] = factors.try_emplace(e, 1.0);
            if (is_new) it->second = block.stiffening(e, state.positions());
            excess += (it->second - 1.0) *
                      block.contributions(e)
                          .stiffness[static_cast<std::size_t>(fragments_.corner_of(e, n))];
        }
        highest = std::max(highest, stable_step_.quotient(n.index()) + excess / masses_[n.index()]);
    }
    return StableStep::step_of(highest);
}

double Structure::element_stable_step(ElementId e) const {
    const NodalContributions of_element = elements_.block_of(fragments_, e).contributions(e);
    double highest = 0.0;
    for (std::size_t k = 0; k < fragments_.corners(e).size(); ++k)
        highest = std::max(highest, of_element.stiffness[k] / of_element.mass[k]);
    return 2.0 / std::sqrt(highest);
}

}  // namespace incise::physics
