// What a body gets, changes and loses while it moves: constraints, loads, force terms, materials.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/physics/body/model.h"

namespace incise::physics {

void Model::add_constraint(Constraint constraint) {
    constraints_.add(view(), std::move(constraint));
    constrain_fragments();
    reactions_.emplace_back();
    ++structure_version_;
}

void Model::set_constraint(std::size_t i, Constraint constraint) {
    std::vector<Constraint> all(constraints_.all().begin(), constraints_.all().end());
    all[i] = std::move(constraint);
    constraints_ = Constraints(view(), std::move(all));
    constrain_fragments();
    ++structure_version_;
}

void Model::remove_constraint(std::size_t i) {
    constraints_.remove(view(), i);
    constrain_fragments();
    reactions_.erase(reactions_.begin() + static_cast<std::ptrdiff_t>(i));
    ++structure_version_;
}

void Model::add_load(Load load) {
    loads_.add(std::move(load), view());
    ++structure_version_;
}

void Model::set_load(std::size_t i, Load load) {
    loads_.set(i, std::move(load), view());
    ++structure_version_;
}

void Model::remove_load(std::size_t i) {
    loads_.remove(i);
    ++structure_version_;
}

void Model::add_force_term(std::unique_ptr<ForceTerm> term) {
    term->update(view());
    for (const NodeId n : fragments_.nodes())
        if (const double bound = term->stiffness_bound(n);
            !(bound >= 0.0 && std::isfinite(bound))) {
            std::ostringstream text;
            text << "a force term bounds its stiffness at the node that is at rest at "
                 << fragments_.rest_position(n).transpose() << " by " << bound
                 << " N/m: it must be finite, and 0 or more";
            throw InputError(text.str());
        }
    added_terms_.push_back(std::move(term));
    for (const NodeId n : fragments_.nodes()) gather(n);
    ++structure_version_;
}

bool Model::remove_force_term(const ForceTerm* term) {
    if (std::erase_if(added_terms_, [&](const auto& t) { return t.get() == term; }) == 0)
        return false;
    for (const NodeId n : fragments_.nodes()) gather(n);
    ++structure_version_;
    return true;
}

namespace {

/// Returns by how many values the history of an element begins: those of the stress of its law.
std::size_t size_of_stress(const Material& material) {
    const auto* links = std::get_if<HyperElasticLinks>(&material.method);
    return links ? history_size(material) / (links->prony.size() + 1) : 0;
}

bool have_like_histories(const Material& a, const Material& b) {
    const auto* first = std::get_if<HyperElasticLinks>(&a.method);
    const auto* second = std::get_if<HyperElasticLinks>(&b.method);
    return first && second && first->prony.size() == second->prony.size() &&
           first->prony_rule == second->prony_rule;
}

}  // namespace

void Model::set_materials(MaterialTable table, double time) {
    const MaterialTable before = elements_.materials();
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
    ElementStore replaced(fragments_, mesh_, table);
    const double energy = elastic_energy();
    const ViscousHistory history = state_.history();
    elements_ = std::move(replaced);
    ViscousHistory& now = state_.change().history;
    now = ViscousHistory(elements_.history_size(), fragments_.element_capacity());
    if (!now.is_empty()) {
        // The stress of the law jumps without time: terms of a series keep theirs, or begin at
        // zero.
        elements_.advance(positions(), positions(), 0.0, workers_, now);
        for (const ElementId e : fragments_.elements()) {
            const int region = fragments_.region(e);
            const Material& material = material_in(elements_.materials(), region);
            const bool is_kept = have_like_histories(material_in(before, region), material);
            for (std::size_t i = size_of_stress(material); i < now.of(e).size(); ++i)
                now.of(e)[i] = is_kept && i < history.of(e).size() ? history.of(e)[i] : 0.0;
        }
    }
    for (const NodeId n : fragments_.nodes()) gather(n);
    external_work_ += elastic_energy() - energy;
    compute_forces(time);
    ++structure_version_;
}

}  // namespace incise::physics
