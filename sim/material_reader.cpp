// The [[material]] sections.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "sim/elastic_constants.h"
#include "sim/scenario_sections.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

constexpr std::string_view other_keys[] = {"regions", "method", "law", "density",
                                           "inversion_threshold"};
constexpr std::string_view planned_keys[] = {"preset",          "prony", "face_diagonals",
                                             "stiffness_ratio", "gamma", "terms"};
constexpr std::string_view planned_methods[] = {"hybmss"};
constexpr std::string_view planned_laws[] = {"fung-demiray", "ogden"};

constexpr IntegerLimits region_limits{std::numeric_limits<int>::min(),
                                      std::numeric_limits<int>::max()};

void refuse_for_mass_spring(const TableReader& material) {
    const std::string reason =
        "is not used by the mass-spring method, whose springs take young and density only and "
        "fix Poisson's ratio near 1/4: leave it out";
    for (const auto key : {"law", "inversion_threshold"})
        if (material.has(key)) material.error(key, reason);
    for (const auto& row : parameters())
        if (row.parameter != Parameter::young && material.has(row.key))
            material.error(row.key, reason);
}

/// Reports what of the method, law and parameters does not go together.
void check_elasticity(const TableReader& material, const MaterialSpec& spec) {
    ElasticParameters parameters = spec.parameters;
    if (spec.method == Method::mass_spring) {
        refuse_for_mass_spring(material);
        parameters = {};
        parameters[Parameter::young] = spec.parameters[Parameter::young];
    } else if (spec.law == Law::saint_venant_kirchhoff && material.has("inversion_threshold")) {
        material.warning("inversion_threshold",
                         in_quotes(material.path_of("inversion_threshold")) +
                             " has no effect: saint-venant-kirchhoff has no volume term");
    }
    try {
        resolve(spec.method, spec.law, parameters);
    } catch (const InputError& failure) {
        material.error({}, failure.what());
    }
}

MaterialSpec read_material(const TableReader& material) {
    MaterialSpec spec;
    if (material.has("regions")) {
        const auto regions = material.integers("regions", region_limits);
        spec.regions.emplace(regions.begin(), regions.end());
    }
    bool is_readable = true;
    if (const auto index = material.choice("method", {method_names(), planned_methods}))
        spec.method = static_cast<Method>(*index);
    else
        is_readable = !material.has("method");
    std::vector<std::string_view> law_names;
    for (const auto& law : laws()) law_names.push_back(law.key);
    if (const auto index = material.choice("law", {law_names, planned_laws}))
        spec.law = static_cast<Law>(*index);
    else
        is_readable = is_readable && !material.has("law");
    material.require("density", "kilograms a cubic metre, as in density = 1060");
    spec.density = material.number("density", 1.0, limits::positive);
    for (const auto& row : parameters()) {
        spec.parameters[row.parameter] = material.number_if_given(row.key, row.limits);
        if (material.has(row.key) && !spec.parameters[row.parameter]) is_readable = false;
    }
    spec.inversion_threshold =
        material.number("inversion_threshold", spec.inversion_threshold, {.low = 0.0, .high = 1.0});
    if (is_readable) check_elasticity(material, spec);
    return spec;
}

}  // namespace

std::vector<MaterialSpec> read_materials(const TableReader& root) {
    std::vector<std::string_view> keys(std::begin(other_keys), std::end(other_keys));
    for (const auto& row : parameters()) keys.push_back(row.key);

    std::vector<MaterialSpec> specs;
    std::vector<int> claimed;
    bool rest_is_claimed = false;
    const std::string remedy = "add a section [[material]] with density, young and poisson";
    if (root.require("material", remedy) && root.is_empty_array("material"))
        root.error("material", "is empty: " + remedy);
    for (const auto& material : root.tables("material", {keys, planned_keys})) {
        specs.push_back(read_material(material));
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
    return specs;
}

}  // namespace incise::sim
