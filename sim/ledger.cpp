// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/ledger.h"

#include <algorithm>
#include <cmath>

#include "topology/geometry.h"

namespace incise::sim {

Ledger::Ledger(const physics::Model& model) : model_(model), initial_(account()) {}

Account Ledger::account() const {
    const topology::Mesh& mesh = model_.mesh();
    return {mesh.num_nodes(), mesh.num_elements(), topology::components(mesh).count,
            model_.totals(), model_.stable_step()};
}

const EditRecord& Ledger::record(double time, std::uint64_t step, const std::string& tool,
                                 const topology::ChangeSet& changes, const Account& before,
                                 double mass_removed) {
    EditRecord edit;
    edit.time = time;
    edit.step = step;
    edit.tool = tool;
    edit.elements_removed = changes.elements_removed.size();
    edit.elements_added = changes.elements_added.size();
    const topology::Mesh& mesh = model_.mesh();
    for (const topology::FacePair& pair : changes.faces_opened)
        edit.faces_opened += mesh.is_alive(pair.a.element) && mesh.is_alive(pair.b.element);
    edit.nodes_added = changes.nodes_added.size();
    edit.nodes_removed = changes.nodes_removed.size();
    edit.mass_removed = mass_removed;
    edit.before = before;
    edit.after = account();
    mass_removed_ += mass_removed;
    const auto energy = [](const Account& a) {
        return a.totals.kinetic_energy + a.totals.elastic_energy;
    };
    energy_removed_ += energy(edit.before) - energy(edit.after);
    edits_.push_back(std::move(edit));
    return edits_.back();
}

double Ledger::mass_error() const {
    return std::abs(model_.totals().mass + mass_removed_ - initial_.totals.mass) /
           initial_.totals.mass;
}

double Ledger::energy_error() const {
    const physics::Totals now = model_.totals();
    const double at_start = initial_.totals.kinetic_energy + initial_.totals.elastic_energy;
    const double at_end = now.kinetic_energy + now.elastic_energy;
    // Near rest nothing but rounding is left: it is measured against the energy of a strain of
    // 1e-4, a hundredth of a percent.
    const double floor = 1e-8 * model_.stiffness_energy();
    const double scale = std::abs(at_start) + std::abs(at_end) + std::abs(model_.external_work()) +
                         model_.dissipated_energy() + std::abs(energy_removed_);
    const double missing =
        at_start + model_.external_work() - model_.dissipated_energy() - energy_removed_ - at_end;
    return scale + floor == 0.0 ? 0.0 : std::abs(missing) / std::max(scale, floor);
}

double removed_mass(const physics::Model& model, const topology::ChangeSet& changes) {
    double mass = 0.0;
    std::vector<Vec3> x;
    for (const topology::ElementRecord& record : changes.elements_removed) {
        x.clear();
        for (const topology::NodeId n : record.corners)
            x.push_back(model.mesh().rest_positions()[n.index()]);
        mass += model.density(record.region) * topology::signed_volume(record.kind, x);
    }
    return mass;
}

}  // namespace incise::sim
