// incise materials: lists laws with parameters and limits, and tissues with their sources.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/scenario/material_catalog.h"
#include "incise/scenario/table_reader.h"
#include "incise/scenario/tissue_catalog.h"

namespace incise::app {

namespace {

using scenario::MaterialModel;
using scenario::Tissue;

std::vector<const MaterialModel*> all_models() {
    std::vector<const MaterialModel*> models;
    for (const auto& law : scenario::laws()) models.push_back(&law);
    models.push_back(&scenario::mass_spring_model());
    models.push_back(&scenario::hybmss_model());
    return models;
}

/// Returns each parameter of the model once, in the order of the table.
std::vector<const scenario::ParameterInfo*> parameters_of(const MaterialModel& model) {
    std::vector<const scenario::ParameterInfo*> rows;
    for (const auto& row : scenario::parameters()) {
        const auto takes = [&](const scenario::ParameterSet& set) {
            return std::find(set.begin(), set.end(), row.parameter) != set.end();
        };
        if (takes(model.optional) ||
            std::any_of(model.parameter_sets.begin(), model.parameter_sets.end(), takes))
            rows.push_back(&row);
    }
    return rows;
}

bool is_law(const MaterialModel& model) {
    return &model != &scenario::mass_spring_model() && &model != &scenario::hybmss_model();
}

std::string scenario_line(const MaterialModel& model) {
    return (is_law(model) ? "law = \"" : "method = \"") + std::string(model.key) + "\"";
}

nlohmann::ordered_json as_json(const MaterialModel& model) {
    nlohmann::ordered_json json;
    json["name"] = model.key;
    json["kind"] = is_law(model) ? "law" : "method";
    json["title"] = model.title;
    json["energy"] = model.energy;
    json["parameter_sets"] = nlohmann::ordered_json::array();
    for (const auto& set : model.parameter_sets) {
        auto keys = nlohmann::ordered_json::array();
        for (const auto parameter : set) keys.push_back(scenario::info(parameter).key);
        json["parameter_sets"].push_back(keys);
    }
    json["parameters"] = nlohmann::ordered_json::array();
    for (const auto* row : parameters_of(model))
        json["parameters"].push_back({{"key", row->key},
                                      {"unit", row->unit},
                                      {"meaning", row->meaning},
                                      {"allowed", row->limits.text()}});
    json["optional"] = nlohmann::ordered_json::array();
    for (const auto parameter : model.optional)
        json["optional"].push_back(scenario::info(parameter).key);
    json["fibres"] = model.has_fibres;
    json["admissible"] = model.admissible;
    json["use"] = model.use;
    json["limits"] = model.limits;
    return json;
}

nlohmann::ordered_json as_json(const Tissue& tissue) {
    nlohmann::ordered_json json;
    json["name"] = tissue.key;
    json["kind"] = "tissue";
    json["title"] = tissue.title;
    json["law"] = tissue.law;
    json["density"] = tissue.density;
    auto& parameters = json["parameters"] = nlohmann::ordered_json::object();
    for (const auto& row : scenario::parameters())
        if (row.parameter != scenario::Parameter::terms && tissue.parameters[row.parameter])
            parameters[row.key] = *tissue.parameters[row.parameter];
    for (const auto& term : tissue.parameters.terms)
        parameters["terms"].push_back({{"mu", term.mu}, {"alpha", term.alpha}});
    json["prony"] = nlohmann::ordered_json::array();
    for (const auto& term : tissue.prony)
        json["prony"].push_back({{"alpha", term.alpha}, {"tau", term.tau}});
    json["toughness"] = nullptr;
    if (tissue.toughness)
        json["toughness"] = {{"min", tissue.toughness->low}, {"max", tissue.toughness->high}};
    json["source"] = tissue.source;
    json["density_source"] = tissue.density_source;
    json["validity"] = tissue.validity;
    json["assumed"] = tissue.assumed;
    json["scenario"] = scenario::scenario_lines(tissue);
    return json;
}

/// Prints the text in lines of at most 80 columns, with an indentation.
void print_wrapped(std::string_view text, std::string_view indent) {
    constexpr std::size_t width = 80;
    std::size_t column = 0;
    while (!text.empty()) {
        const auto end = std::min(text.find(' '), text.size());
        const auto word = text.substr(0, end);
        if (column > 0 && column + 1 + word.size() > width) {
            std::cout << '\n';
            column = 0;
        }
        std::cout << (column == 0 ? indent : " ") << word;
        column += word.size() + (column == 0 ? indent.size() : 1);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    std::cout << '\n';
}

void print_summary(const MaterialModel& model) {
    std::cout << model.key << "\n";
    print_wrapped(model.title, "    ");
    print_wrapped(model.use, "    ");
    print_wrapped("takes " + scenario::list_of_parameters(model), "    ");
}

void print_summary(const Tissue& tissue) {
    std::cout << tissue.key << "\n";
    print_wrapped(tissue.title, "    ");
    std::string line;
    for (const auto& part : scenario::scenario_lines(tissue))
        line += (line.empty() ? "" : ", ") + part;
    print_wrapped(line, "    ");
}

void section(std::string_view title, std::string_view text) {
    std::cout << '\n' << title << '\n';
    print_wrapped(text, "    ");
}

void print_detail(const MaterialModel& model) {
    std::cout << model.key << ": " << model.title << '\n';
    section("In a scenario", scenario_line(model));
    section("Energy", model.energy);
    section("Takes exactly one of these sets, besides density",
            scenario::list_of_parameters(model));
    if (model.has_fibres)
        section("Direction of the fibres at rest, one of",
                "fibre = [x, y, z], or fibre_array = \"NAME\", a cell array of the mesh file");
    std::cout << "\nParameters\n";
    for (const auto* row : parameters_of(model))
        std::cout << "    " << row->key << std::string(16 - row->key.size(), ' ') << row->meaning
                  << (row->unit == "1" ? "" : ", in " + std::string(row->unit)) << "; "
                  << row->limits.text() << '\n';
    section("Admissible", model.admissible);
    section("For", model.use);
    section("Limits", model.limits);
}

void print_detail(const Tissue& tissue) {
    std::cout << tissue.key << ": " << tissue.title << '\n';
    section("In a scenario", "preset = \"" + std::string(tissue.key) + "\"");
    std::cout << "\nIt stands for\n";
    for (const auto& line : scenario::scenario_lines(tissue)) std::cout << "    " << line << '\n';
    section("Source", tissue.source);
    section("Density", tissue.density_source);
    section("Validity", tissue.validity);
    if (!tissue.assumed.empty()) section("Assumed", tissue.assumed);
    if (const auto& toughness = tissue.toughness)
        section("Toughness, for information",
                (toughness->low < toughness->high ? format_number(toughness->low) + " to " : "") +
                    format_number(toughness->high) + " J/m2 (" +
                    std::string(scenario::toughness_source) + ")");
}

/// The materials to print: all, or the one with the given name.
struct Choice {
    std::vector<const MaterialModel*> models;
    std::vector<const Tissue*> tissues;
};

Choice choose(const std::string& name) {
    Choice choice{all_models(), {}};
    for (const auto& tissue : scenario::tissues()) choice.tissues.push_back(&tissue);
    if (name.empty()) return choice;
    std::vector<std::string_view> names;
    for (const auto* model : choice.models) {
        if (model->key == name) return {{model}, {}};
        names.push_back(model->key);
    }
    for (const auto* tissue : choice.tissues) {
        if (tissue->key == name) return {{}, {tissue}};
        names.push_back(tissue->key);
    }
    throw InputError("material " + scenario::in_quotes(name) + " " +
                     *scenario::complaint(name, {names}));
}

}  // namespace

int materials(const MaterialsOptions& options) {
    const auto [models, tissues] = choose(options.name);
    if (options.json) {
        nlohmann::ordered_json json;
        json["materials"] = nlohmann::ordered_json::array();
        for (const auto* model : models) json["materials"].push_back(as_json(*model));
        for (const auto* tissue : tissues) json["materials"].push_back(as_json(*tissue));
        std::cout << json.dump(2) << '\n';
    } else if (options.name.empty()) {
        std::cout << "Laws and methods\n\n";
        for (const auto* model : models) print_summary(*model);
        std::cout << "\nTissues: preset = \"NAME\"\n\n";
        for (const auto* tissue : tissues) print_summary(*tissue);
        std::cout << "\nMore about one, with its limits or sources: incise materials NAME\n";
    } else {
        for (const auto* model : models) print_detail(*model);
        for (const auto* tissue : tissues) print_detail(*tissue);
    }
    return done;
}

}  // namespace incise::app
