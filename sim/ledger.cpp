// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/ledger.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "incise/topology/geometry.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::sim {

namespace {

/// The elements that an edit divided, and the least altitude of them and of their parts.
struct Divided {
    std::size_t num_parents = 0;
    double least_altitude = std::numeric_limits<double>::infinity();
};

Divided divided_elements(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    std::vector<CellId> parents;
    Divided divided;
    for (const topology::CellRecord& record : changes.elements_added) {
        if (!record.parent.is_valid()) continue;
        divided.least_altitude =
            std::min(divided.least_altitude, topology::min_altitude(mesh, record.id));
        if (record.parent.index() < changes.element_capacity_before)
            parents.push_back(record.parent);
    }
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    for (const CellId e : parents)
        if (mesh.is_alive(e))
            divided.least_altitude =
                std::min(divided.least_altitude, topology::min_altitude(mesh, e));
    divided.num_parents = parents.size();
    return divided;
}

double least_altitude(const topology::Mesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (const CellId e : mesh.elements()) least = std::min(least, topology::min_altitude(mesh, e));
    return least;
}

}  // namespace

Ledger::Ledger(const physics::Model& model)
    : model_(model),
      counts_(count()),
      components_(model.mesh()),
      initial_min_altitude_(least_altitude(model.mesh())),
      initial_(body_totals()),
      last_(initial_) {}

Ledger::Counts Ledger::count() const {
    const topology::Mesh& mesh = model_.mesh();
    return {mesh.num_nodes(), mesh.num_elements()};
}

BodyTotals Ledger::body_totals() const {
    const auto reactions = model_.boundary().reactions();
    return {counts_.nodes,
            counts_.elements,
            components_.value(),
            model_.energetics().totals(),
            model_.structure().rest_stable_step(),
            model_.energetics().external_work(),
            model_.energetics().dissipated_energy(),
            model_.energetics().min_volume_ratio(),
            {reactions.begin(), reactions.end()}};
}

EditRecord Ledger::record(double time, std::uint64_t step, const std::string& tool,
                          const cutting::Split& done, const fragments::FragmentChanges& fragments,
                          const BodyTotals& before, double mass_removed) {
    const topology::ChangeSet& changes = done.changes;
    const Divided divided = divided_elements(model_.mesh(), changes);
    EditRecord edit;
    edit.time = time;
    edit.step = step;
    edit.tool = tool;
    edit.elements_removed = changes.elements_removed.size();
    edit.elements_added = changes.elements_added.size();
    edit.elements_crossed = done.report.elements_crossed;
    edit.elements_split = divided.num_parents;
    edit.faces_opened = done.report.faces_opened;
    edit.nodes_added = changes.nodes_added.size();
    edit.nodes_duplicated = edit.nodes_added - done.report.edges_divided;
    edit.nodes_removed = changes.nodes_removed.size();
    edit.nodes_snapped = done.report.nodes_snapped;
    edit.cut_area = done.report.cut_area;
    if (divided.num_parents > 0)
        edit.min_altitude_ratio = divided.least_altitude / initial_min_altitude_;
    edit.mass_removed = mass_removed;
    edit.fragments_copied = fragments.mesh.elements_added.size();
    edit.fragment_nodes_copied = fragments.mesh.nodes_added.size();
    for (const fragments::CarriedCell& cell : fragments.cells) {
        if (!cell.to.is_valid()) continue;  // removed
        const double volume = topology::rest_volume(model_.mesh(), cell.cell);
        if (cell.is_joined) edit.volume_joined += volume;
        if (cell.is_released) edit.volume_released += volume;
    }
    edit.before = before;
    counts_ = count();
    components_.apply(model_.mesh(), changes);
    assert(components_.value() == topology::components(model_.mesh()).count);
    edit.after = last_ = body_totals();
    const auto energy = [](const BodyTotals& a) {
        return a.totals.kinetic_energy + a.totals.elastic_energy;
    };
    ++num_edits_;
    mass_removed_ += mass_removed;
    energy_removed_ += energy(edit.before) - energy(edit.after);
    return edit;
}

void Ledger::restore(ArchiveReader& ar) {
    list(ar, *this);
    counts_ = count();
    components_.restore(model_.mesh(), last_.components);
}

double Ledger::mass_error() const {
    return std::abs(model_.energetics().totals().mass + mass_removed_ - initial_.totals.mass) /
           initial_.totals.mass;
}

double Ledger::energy_error() const {
    const physics::Totals now = model_.energetics().totals();
    const double at_start = initial_.totals.kinetic_energy + initial_.totals.elastic_energy;
    const double at_end = now.kinetic_energy + now.elastic_energy;
    // Near rest all energies are small and the error is only rounding. The floor is the energy of a
    // strain of 1e-4.
    const double floor = 1e-8 * model_.structure().stiffness_energy();
    const double scale =
        std::abs(at_start) + std::abs(at_end) + std::abs(model_.energetics().external_work()) +
        std::abs(model_.energetics().dissipated_energy()) + std::abs(energy_removed_);
    const double missing = at_start + model_.energetics().external_work() -
                           model_.energetics().dissipated_energy() - energy_removed_ - at_end;
    return scale + floor == 0.0 ? 0.0 : std::abs(missing) / std::max(scale, floor);
}

double removed_mass(const physics::Model& model, const topology::ChangeSet& changes) {
    double mass = 0.0;
    for (const topology::CellRecord& record : changes.elements_removed)
        mass += model.structure().density(record.region) *
                topology::rest_volume(model.mesh(), changes, record);
    return mass;
}

}  // namespace incise::sim
