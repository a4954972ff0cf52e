// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/measured_quantities.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/input_file.h"
#include "incise/scenario/quantities.h"

namespace incise::runner {

using Json = nlohmann::ordered_json;

namespace {

/// Appends quantities. The common `size` makes the compiler check that the arrays fit each other.
template <class Name, std::size_t size>
void append(std::vector<std::pair<std::string, double>>& quantities,
            const std::array<Name, size>& names, const std::array<double, size>& values) {
    for (std::size_t i = 0; i < size; ++i) quantities.emplace_back(names[i], values[i]);
}

}  // namespace

Quantities history_row(const sim::World& world, double time_step,
                       const sim::BodyTotals& body_totals, const sim::ToolForces& forces) {
    const physics::Model& model = world.model();
    const physics::Totals& t = body_totals.totals;
    const sim::ContactState& contact = world.report().contact;
    Quantities row;
    append(row, scenario::history_quantities,
           std::array{world.time(),
                      static_cast<double>(world.num_steps()),
                      static_cast<double>(body_totals.nodes),
                      static_cast<double>(body_totals.elements),
                      static_cast<double>(body_totals.components),
                      t.mass,
                      t.rest_volume,
                      t.kinetic_energy,
                      t.elastic_energy,
                      body_totals.external_work,
                      body_totals.dissipated_energy,
                      t.momentum.x(),
                      t.momentum.y(),
                      t.momentum.z(),
                      t.angular_momentum.x(),
                      t.angular_momentum.y(),
                      t.angular_momentum.z(),
                      body_totals.min_volume_ratio,
                      time_step,
                      world.stable_step(),
                      static_cast<double>(contact.num_points),
                      contact.max_penetration,
                      contact.dissipation,
                      contact.fracture_energy});
    for (std::size_t s = 0; s < model.boundary().constraints().size(); ++s) {
        const auto& [reaction, torque] = body_totals.reactions[s];
        append(row, scenario::reaction_quantities(model.boundary().constraints().name(s)),
               std::array{reaction.x(), reaction.y(), reaction.z(), torque.x(), torque.y(),
                          torque.z()});
    }
    for (const sim::ToolId id : world.tools()) {
        if (!cutting::feels_force(world.tool(id).shape)) continue;
        const auto [force, torque] = forces.of(id);
        append(row, scenario::force_quantities(world.tool(id).name),
               std::array{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z()});
    }
    return row;
}

Quantities summary_quantities(const sim::World& world, double time_step,
                              const sim::ToolForces& forces,
                              std::span<const sim::EditRecord> edits) {
    auto quantities = history_row(world, time_step, world.ledger().body_totals(), forces);
    std::size_t removed = 0, split = 0, added = 0, opened = 0;
    double cut_area = 0.0, mass_removed = 0.0;
    for (const sim::EditRecord& edit : edits) {
        removed += edit.elements_removed;
        split += edit.elements_split;
        added += edit.elements_added;
        opened += edit.faces_opened;
        cut_area += edit.cut_area;
        mass_removed += edit.mass_removed;
    }
    const sim::Ledger& ledger = world.ledger();
    append(quantities, scenario::run_quantities,
           std::array{world.model().energetics().totals().gravity_energy,
                      static_cast<double>(edits.size()), static_cast<double>(removed),
                      static_cast<double>(split), static_cast<double>(added),
                      static_cast<double>(opened), cut_area, mass_removed, ledger.mass_error(),
                      ledger.energy_error(), world.model().energetics().volume_change(),
                      world.model().max_displacement()});
    return quantities;
}

std::vector<std::string> failed_expectations(const scenario::Scenario& scenario,
                                             const Quantities& quantities) {
    std::vector<std::string> failures;
    for (const scenario::Expectation& expected : scenario.expect) {
        const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const auto& q) {
            return q.first == expected.quantity;
        });
        if (found == quantities.end())  // the scenario reader has checked the names
            throw std::logic_error("no quantity '" + expected.quantity + "'");
        const double value = found->second;
        const auto fail = [&](const char* side, double limit) {
            failures.push_back("expected " + expected.quantity + " " + side + " " +
                               format_number(limit) + ", it is " + format_number(value));
        };
        // With `!`, a value that is not a number fails.
        if (expected.min && !(value >= *expected.min)) fail("of at least", *expected.min);
        if (expected.max && !(value <= *expected.max)) fail("of at most", *expected.max);
    }
    return failures;
}

std::optional<Quantities> finished_quantities(const std::filesystem::path& folder,
                                              const scenario::Scenario& scenario) {
    const auto path = folder / "summary.json";
    if (!std::filesystem::exists(path)) return std::nullopt;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError(path.string() +
                         ": is a directory in the place of the summary of a run; remove it, and "
                         "resume then");
    const std::string remedy =
        "; remove the file to go on from the last checkpoint, or begin anew without --resume";
    const auto refuse = [&](const std::string& why) {
        throw InputError(path.string() + ": " + why + remedy);
    };
    const std::string bytes = [&] {
        try {
            return io::load_input_file(path).bytes;
        } catch (const InputError& error) {
            throw InputError(error.what() + remedy);
        }
    }();
    const Json summary = Json::parse(bytes, nullptr, false);
    if (!summary.is_object()) refuse("is not the summary of a run, which is a JSON object");
    const auto entry = [&](const std::string& name) -> const Json& {
        if (!summary.contains(name)) refuse("has no entry '" + name + "'");
        return summary[name];
    };
    const auto text = [&](const std::string& name) -> const std::string& {
        const Json& value = entry(name);
        if (!value.is_string())
            refuse("'" + name + "' is " + io::in_quotes(value.dump()) + ", and should be a text");
        return value.get_ref<const std::string&>();
    };
    if (text("status") != "finished" || text("scenario_hash") != scenario.hash) return std::nullopt;
    Quantities quantities;
    for (const auto& [name, value] : summary.items())
        // JSON has null for values that are not finite.
        if (value.is_number() || value.is_null())
            quantities.emplace_back(name, value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                                          : value.get<double>());
    for (const scenario::Expectation& expected : scenario.expect)
        if (const Json& value = entry(expected.quantity); !value.is_number() && !value.is_null())
            refuse("'" + expected.quantity + "' is " + io::in_quotes(value.dump()) +
                   ", and should be a number");
    return quantities;
}

}  // namespace incise::runner
