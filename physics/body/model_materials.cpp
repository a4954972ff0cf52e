// How the materials of a body change while it moves.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/physics/body/model.h"

namespace incise::physics {

namespace {

/// Returns by how many values the history of an element begins: those of the stress of its law.
std::size_t size_of_stress(const Material& material, topology::CellKind kind) {
    const auto* links = std::get_if<HyperElasticLinks>(&material.method);
    return links ? history_size(material, kind) / (links->prony.size() + 1) : 0;
}

bool have_like_histories(const Material& a, const Material& b) {
    const auto* first = std::get_if<HyperElasticLinks>(&a.method);
    const auto* second = std::get_if<HyperElasticLinks>(&b.method);
    return first && second && first->prony.size() == second->prony.size() &&
           first->prony_rule == second->prony_rule;
}

}  // namespace

void Model::set_materials(MaterialTable table, double time) {
    const MaterialTable before = structure_.elements_.materials();
    const auto material_in = [](const MaterialTable& in, int region) -> const Material& {
        return in.materials[in.of_region.at(region)];
    };
    for (const auto& [region, index] : before.of_region) {
        const double density = before.materials[index].density;
        if (const auto found = table.of_region.find(region);
            found != table.of_region.end() && table.materials[found->second].density != density)
            throw InputError("the material of region " + std::to_string(region) +
                             " would have a density of " +
                             format_number(table.materials[found->second].density) +
                             " kg/m3: tissue keeps its mass, so that it must stay " +
                             format_number(density) + " kg/m3");
    }
    ElementStore replaced(fragments(), mesh(), table);
    const double energy = energetics_.elastic_energy();
    const ViscousHistory history = state_.history();
    structure_.elements_ = std::move(replaced);
    ViscousHistory& now = state_.change().history;
    now = ViscousHistory(structure_.elements().history_size(), fragments().element_capacity());
    if (!now.is_empty()) {
        // The stress of the law jumps without time: terms of a series keep theirs, or begin at
        // zero.
        structure_.elements_.advance(positions(), positions(), 0.0, workers_, now);
        for (const ElementId e : fragments().elements()) {
            const int region = fragments().region(e);
            const Material& material = material_in(structure_.elements_.materials(), region);
            const bool is_kept = have_like_histories(material_in(before, region), material);
            for (std::size_t i = size_of_stress(material, fragments().kind(e));
                 i < now.of(e).size(); ++i)
                now.of(e)[i] = is_kept && i < history.of(e).size() ? history.of(e)[i] : 0.0;
        }
    }
    boundary_.sum_stiffness();
    energetics_.record_work(energetics_.elastic_energy() - energy, 0.0);
    compute_forces(time);
    ++structure_.version_;
}

}  // namespace incise::physics
