// Reads the [[material]] sections of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/scenario/elastic_constants.h"
#include "incise/scenario/plausibility.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/tissue_catalog.h"

namespace incise::scenario {

namespace {

constexpr std::string_view common_keys[] = {"regions", "method", "preset", "density"};
constexpr std::string_view heml_keys[] = {"law",   "inversion_threshold", "prony", "prony_rule",
                                          "fibre", "fibre_array"};
constexpr std::string_view hybmss_keys[] = {"face_diagonals", "stiffness_ratio",
                                            "correction_forces"};

/// Reports the keys that belong to other methods.
void refuse_keys_of_others(const TableReader& material, Method method) {
    const auto refuse = [&](std::span<const std::string_view> keys, Method owner) {
        for (const auto key : keys)
            if (method != owner && material.has(key))
                material.error(key,
                               "is a key of the method " +
                                   std::string(method_names()[static_cast<std::size_t>(owner)]) +
                                   ", not of " +
                                   std::string(method_names()[static_cast<std::size_t>(method)]) +
                                   ": leave it out");
    };
    refuse(heml_keys, Method::heml);
    refuse(hybmss_keys, Method::hybmss);
    if (method != Method::mass_spring) return;
    const std::string reason =
        "is not used by the mass-spring method, whose springs take young and density only and "
        "fix Poisson's ratio near 1/4: leave it out";
    for (const auto& row : parameters())
        if (row.parameter != Parameter::young && material.has(row.key))
            material.error(row.key, reason);
}

/// Warns of parameters for which HybMSS is unreliable. A run is possible.
void warn_of_limits(const TableReader& material, const MaterialSpec& spec,
                    const ElasticConstants& constants) {
    if (spec.stiffness_ratio == 0.0)
        material.warning("face_diagonals",
                         in_quotes(material.path_of("face_diagonals")) +
                             " = false gives a model that is singular: a lattice without face "
                             "diagonals wrinkles under any compression or tension; use it for "
                             "comparison only");
    if (spec.stiffness_ratio > 0.0 && spec.stiffness_ratio < 0.5)
        material.warning("stiffness_ratio",
                         in_quotes(material.path_of("stiffness_ratio")) + " = " +
                             format_number(spec.stiffness_ratio) +
                             " is nearly the singular model without face diagonals, which "
                             "wrinkles; from 0.5 on a body bears a compression of a quarter");
    constexpr double rounding = 1e-9;
    const double poisson = constants.poisson();
    if (!spec.correction_forces) {
        if (std::abs(poisson - 0.25) > rounding)
            material.warning("correction_forces",
                             in_quotes(material.path_of("correction_forces")) +
                                 " = false leaves the springs alone, whose Poisson's ratio is 1/4 "
                                 "and not " +
                                 format_number(poisson));
    } else if (poisson < 0.25 - rounding) {
        material.warning("poisson", "Poisson's ratio is " + format_number(poisson) +
                                        "; below 1/4 the method hybmss loses its resistance to "
                                        "large tension: along one axis at a stretch of 1.2 for a "
                                        "ratio of 0, 1.37 for 0.1, 1.6 for 0.15, 2.3 for 0.2 (and "
                                        "stiffness_ratio 1), all round at 1.1, 1.16, 1.22, 1.37, "
                                        "sooner for negative ratios");
    }
}

/// Returns only the parameter `young`, the only one that the mass-spring model takes.
ElasticParameters only_young(const ElasticParameters& parameters) {
    ElasticParameters young;
    young[Parameter::young] = parameters[Parameter::young];
    return young;
}

/// Reports method, law and parameters that do not suit each other. If `values_are_sound` is false,
/// checks only which parameters are given.
void check_elasticity(const TableReader& material, const MaterialSpec& spec,
                      bool values_are_sound) {
    ElasticParameters parameters = spec.parameters;
    if (spec.method == Method::mass_spring) {
        parameters = only_young(parameters);
    } else if (spec.method == Method::heml && spec.law == "saint-venant-kirchhoff" &&
               material.has("inversion_threshold")) {
        material.warning("inversion_threshold",
                         in_quotes(material.path_of("inversion_threshold")) +
                             " has no effect: saint-venant-kirchhoff has no volume term");
    }
    try {
        if (!values_are_sound) {
            require_complete(model(spec.method, spec.law), parameters);
            return;
        }
        const ElasticConstants constants = resolve(spec.method, spec.law, parameters);
        if (spec.method == Method::hybmss) warn_of_limits(material, spec, constants);
    } catch (const InputError& failure) {
        material.error({}, failure.what());
    }
}

/// Reads the terms of the law of Ogden. Returns true if they are sound or missing. Faulty terms
/// count as one term, so that no error about missing terms follows.
bool read_terms(const TableReader& material, ElasticParameters& parameters) {
    if (!material.has("terms")) return true;
    bool is_readable = !material.is_empty_array("terms");
    if (!is_readable)
        material.error("terms", "is empty: give at least one, as in [{ mu = 500, alpha = 4 }]");
    static constexpr std::string_view keys[] = {"mu", "alpha"};
    const auto rows = material.tables("terms", {keys});
    for (const auto& row : rows) {
        row.require("mu", "its part of the shear modulus in Pa, as in mu = 500");
        row.require("alpha", "the power of the stretches, as in alpha = 4");
        const auto mu = row.number_if_given("mu"), alpha = row.number_if_given("alpha");
        is_readable = is_readable && mu && alpha && *alpha != 0.0;
        if (alpha && *alpha == 0.0)
            row.error("alpha", "0 is not allowed: a power of 0 is no strain");
        parameters.terms.push_back({mu.value_or(1.0), alpha.value_or(1.0)});
    }
    parameters[Parameter::terms] = std::max(1.0, static_cast<double>(rows.size()));
    return is_readable && !rows.empty();
}

/// Adds the elastic parameters of the preset that the scenario does not give. If the scenario gives
/// a complete set of its own, none are added. Returns true if there is a complete set then.
bool complete_parameters(const TableReader& material, const Tissue& preset, MaterialSpec& spec) {
    const MaterialModel& model = scenario::model(spec.method, spec.law);
    ElasticParameters both = preset.parameters;
    if (spec.method == Method::mass_spring) {  // other keys than young are refused elsewhere
        both = only_young(both);
        spec.parameters = only_young(spec.parameters);
    }
    for (const auto& row : parameters())
        if (spec.parameters[row.parameter]) both[row.parameter] = spec.parameters[row.parameter];
    if (!spec.parameters.terms.empty()) both.terms = spec.parameters.terms;
    if (is_complete(model, both)) {
        spec.parameters = both;
        return true;
    }
    if (is_complete(model, spec.parameters)) return true;
    const std::string given = list_of(spec.parameters);
    material.error("preset", in_quotes(preset.key) + " has " + list_of(preset.parameters) +
                                 (given.empty() ? "" : ", the scenario gives " + given) + "; but " +
                                 std::string(model.key) + " takes " + list_of_parameters(model) +
                                 ": give values for what the preset has, or one whole set");
    return false;
}

/// Reads the Prony series. Its errors do not prevent the checks of elasticity.
std::vector<physics::PronyTerm> read_prony(const TableReader& material) {
    if (material.is_empty_array("prony") && !material.has("preset"))  // there empty means elastic
        material.error("prony",
                       "is empty: give at least one term, as in [{ alpha = 0.3, tau = 0.5 }], or "
                       "leave it out");
    static constexpr std::string_view keys[] = {"alpha", "tau"};
    std::vector<physics::PronyTerm> terms;
    double sum = 0.0;
    for (const auto& row : material.tables("prony", {keys})) {
        row.require("alpha", "the share of the stress that relaxes, as in alpha = 0.3");
        row.require("tau", "the time in which it does, in seconds, as in tau = 0.5");
        const double alpha = row.number("alpha", 0.0, {.low = 0.0, .high = 1.0});
        terms.push_back({alpha, row.number("tau", 1.0, limits::positive)});
        sum += alpha;
    }
    if (sum >= 1.0)
        material.error("prony", "has shares alpha that add up to " + format_number(sum) +
                                    ": their sum must be below 1, or no stress would last");
    return terms;
}

/// Reads the direction of the fibres.
void read_fibre(const TableReader& material, MaterialSpec& spec) {
    if (material.has("fibre")) spec.fibre = material.direction("fibre", Vec3::UnitX());
    if (!material.has("fibre_array")) return;
    const std::string name = material.text("fibre_array");
    if (name.empty() && material.is_text("fibre_array"))
        material.error("fibre_array", "is empty: name a cell array of the mesh file");
    spec.fibre = name;
}

/// Reports a law with fibres that has no direction, a direction for a law without fibres, and a
/// cell array if the mesh is no file.
void check_fibre(const TableReader& material, const MeshSpec& mesh, const MaterialSpec& spec) {
    const bool given = material.has("fibre") || material.has("fibre_array");
    if (spec.method != Method::heml) return;  // reported as keys of another method
    if (!law_named(spec.law).has_fibres) {
        for (const std::string_view key : {"fibre", "fibre_array"})
            if (material.has(key))
                material.error(key,
                               "is a key of laws with fibres, as holzapfel-gasser-ogden, not of " +
                                   std::string(spec.law) + ": leave it out");
        return;
    }
    if (!given) {
        material.error({}, std::string(spec.law) +
                               " needs the direction of its fibres: give fibre = [x, y, z], or "
                               "fibre_array = \"NAME\", a cell array of the mesh file");
        return;
    }
    material.one_of({"fibre", "fibre_array"});
    if (material.has("fibre_array") && material.is_sound("fibre_array") &&
        std::holds_alternative<BoxMeshSpec>(mesh.source))
        material.error("fibre_array",
                       "needs a mesh file, and the mesh is a box: use fibre = [x, y, z]");
}

/// Indexed by physics::PronyRule.
constexpr std::string_view prony_rule_names[] = {"stress", "nodal"};

/// @returns false where a value is not sound; it then has a message and counts as given
bool read_parameters(const TableReader& material, ElasticParameters& given) {
    bool are_sound = read_terms(material, given);
    for (const auto& row : parameters()) {
        if (row.parameter == Parameter::terms || !material.has(row.key)) continue;
        const auto value = material.number_if_given(row.key, row.limits);
        are_sound = are_sound && value;
        given[row.parameter] = value.value_or(1.0);
    }
    return are_sound;
}

MaterialSpec read_material(const TableReader& material, const MeshSpec& mesh) {
    MaterialSpec spec;
    spec.location = material.location_text();
    spec.regions_location = material.location_text("regions");
    if (material.has("regions")) {
        const auto regions = material.integers("regions", region_limits, Repeats::refused);
        spec.regions.emplace(regions.begin(), regions.end());
    }
    if (const auto index = material.choice("method", {method_names()}))
        spec.method = static_cast<Method>(*index);
    const Tissue* preset = nullptr;
    std::vector<std::string_view> tissue_names;
    for (const auto& tissue : tissues()) tissue_names.push_back(tissue.key);
    if (const auto index = material.choice("preset", {tissue_names})) {
        preset = &tissues()[*index];
        spec.law = preset->law;
    }
    std::vector<std::string_view> law_names;
    for (const auto& law : laws()) law_names.push_back(law.key);
    if (const auto index = material.choice("law", {law_names})) spec.law = laws()[*index].key;
    if (!material.has("preset"))
        material.require("density", "kilograms a cubic metre, as in density = 1060");
    spec.density =
        material.number("density", preset != nullptr ? preset->density : 1.0, limits::positive);
    const bool values_are_sound = read_parameters(material, spec.parameters);
    spec.has_published_moduli = preset != nullptr && list_of(spec.parameters).empty();
    spec.inversion_threshold =
        material.number("inversion_threshold", spec.inversion_threshold, {.low = 0.0, .high = 1.0});
    spec.prony = read_prony(material);
    if (preset != nullptr && spec.method == Method::heml && !material.has("prony"))
        spec.prony = preset->prony;
    if (const auto index = material.choice("prony_rule", {prony_rule_names}))
        spec.prony_rule = static_cast<physics::PronyRule>(*index);
    read_fibre(material, spec);
    spec.correction_forces = material.flag("correction_forces", true);
    spec.stiffness_ratio = material.number("stiffness_ratio", spec.stiffness_ratio,
                                           {.low = 0.0, .includes_high = true});
    if (!material.flag("face_diagonals", true)) {
        spec.stiffness_ratio = 0.0;
        if (material.has("stiffness_ratio"))
            material.error("stiffness_ratio",
                           "has no meaning without face diagonals: leave it out");
    }
    if (!material.is_sound("method")) return spec;
    const bool knows_law = material.is_sound("law");
    refuse_keys_of_others(material, spec.method);
    if (!material.is_sound("preset")) return spec;
    if (spec.method == Method::heml && material.has("prony_rule") && spec.prony.empty() &&
        !material.has("prony"))
        material.error("prony_rule",
                       "has no meaning without viscosity: give prony = [{ alpha = 0.3, tau = 0.5 "
                       "}], or leave it out");
    if (!knows_law) return spec;
    check_fibre(material, mesh, spec);
    if (preset == nullptr || complete_parameters(material, *preset, spec))
        check_elasticity(material, spec, values_are_sound);
    return spec;
}

const std::vector<std::string_view>& all_material_keys() {
    static const std::vector<std::string_view> all = [] {
        std::vector<std::string_view> keys;
        for (const std::span<const std::string_view> some :
             {std::span<const std::string_view>(common_keys),
              std::span<const std::string_view>(heml_keys),
              std::span<const std::string_view>(hybmss_keys)})
            keys.insert(keys.end(), some.begin(), some.end());
        for (const auto& row : parameters()) keys.push_back(row.key);
        return keys;
    }();
    return all;
}

}  // namespace

MaterialSpec read_added_material(const Table& table, Diagnostics& diagnostics) {
    const TableReader material(table, SourceLocation{}, "", {all_material_keys()}, diagnostics);
    MaterialSpec spec = read_material(material, {});
    if (material.has("fibre_array"))
        material.error("fibre_array", "is read with the mesh: give fibre = [x, y, z]");
    return spec;
}

std::vector<MaterialSpec> read_materials(const TableReader& root, const MeshSpec& mesh) {
    std::vector<MaterialSpec> specs;
    std::vector<int> claimed;
    bool rest_is_claimed = false;
    const std::string remedy = "add a section [[material]] with density, young and poisson";
    if (root.require("material", remedy) && root.is_empty_array("material"))
        root.error("material", "is empty: " + remedy);
    const auto tables = root.tables("material", {all_material_keys()});
    for (const auto& material : tables) {
        specs.push_back(read_material(material, mesh));
        if (const auto& regions = specs.back().regions) {
            for (const int region : *regions)
                if (std::find(claimed.begin(), claimed.end(), region) != claimed.end())
                    material.error("regions", "region " + std::to_string(region) +
                                                  " belongs to another material already");
            claimed.insert(claimed.end(), regions->begin(), regions->end());
        } else {
            if (rest_is_claimed)
                material.error({},
                               "has no regions, like another material before it: only one "
                               "material can take all that is left");
            rest_is_claimed = true;
        }
    }
    if (root.is_sound("material")) return specs;  // implausible() looks at them
    for (std::size_t i = 0; i < specs.size(); ++i)
        if (tables[i].has("density") && tables[i].is_sound("density"))
            if (const auto doubt = doubt_of_density(i + 1, specs[i].density))
                tables[i].warning({}, *doubt);
    return specs;
}

}  // namespace incise::scenario
