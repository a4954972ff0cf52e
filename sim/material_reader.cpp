// The [[material]] sections.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/number_format.h"
#include "sim/elastic_constants.h"
#include "sim/scenario_sections.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

constexpr std::string_view common_keys[] = {"regions", "method", "density"};
constexpr std::string_view heml_keys[] = {"law", "inversion_threshold"};
constexpr std::string_view hybmss_keys[] = {"face_diagonals", "stiffness_ratio",
                                            "correction_forces"};
constexpr std::string_view planned_keys[] = {"preset", "prony", "gamma", "terms"};
constexpr std::string_view planned_laws[] = {"fung-demiray", "ogden"};

constexpr IntegerLimits region_limits{std::numeric_limits<int>::min(),
                                      std::numeric_limits<int>::max()};

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

/// Where HybMSS is on shaky ground: it runs all the same.
void warn_of_limits(const TableReader& material, const MaterialSpec& spec,
                    const ElasticConstants& constants) {
    if (spec.stiffness_ratio == 0.0)
        material.warning("face_diagonals",
                         in_quotes(material.path_of("face_diagonals")) +
                             " = false gives a model that is singular: a lattice without face "
                             "diagonals wrinkles under any compression or tension; use it for "
                             "comparison only");
    constexpr double rounding = 1e-9;
    const double poisson = constants.poisson();
    if (!spec.correction_forces) {
        if (std::abs(poisson - 0.25) > rounding)
            material.warning("correction_forces",
                             in_quotes(material.path_of("correction_forces")) +
                                 " = false leaves the springs alone, whose Poisson's ratio is 1/4 "
                                 "and not " +
                                 io::format_number(poisson));
    } else if (poisson < 0.25 - rounding) {
        material.warning("poisson", "Poisson's ratio is " + io::format_number(poisson) +
                                        "; below 1/4 the method hybmss loses its resistance to "
                                        "large tension: at a stretch of 1.2 for a ratio of 0, 1.37 "
                                        "for 0.1, 1.6 for 0.15, 2.3 for 0.2");
    }
}

/// Reports what of the method, law and parameters does not go together.
void check_elasticity(const TableReader& material, const MaterialSpec& spec) {
    ElasticParameters parameters = spec.parameters;
    refuse_keys_of_others(material, spec.method);
    if (spec.method == Method::mass_spring) {
        parameters = {};
        parameters[Parameter::young] = spec.parameters[Parameter::young];
    } else if (spec.method == Method::heml && spec.law == Law::saint_venant_kirchhoff &&
               material.has("inversion_threshold")) {
        material.warning("inversion_threshold",
                         in_quotes(material.path_of("inversion_threshold")) +
                             " has no effect: saint-venant-kirchhoff has no volume term");
    }
    try {
        const ElasticConstants constants = resolve(spec.method, spec.law, parameters);
        if (spec.method == Method::hybmss) warn_of_limits(material, spec, constants);
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
    if (const auto index = material.choice("method", {method_names()}))
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
    spec.correction_forces = material.flag("correction_forces", true);
    spec.stiffness_ratio = material.number("stiffness_ratio", spec.stiffness_ratio,
                                           {.low = 0.0, .includes_high = true});
    if (!material.flag("face_diagonals", true)) {
        spec.stiffness_ratio = 0.0;
        if (material.has("stiffness_ratio"))
            material.error("stiffness_ratio",
                           "has no meaning without face diagonals: leave it out");
    }
    if (is_readable) check_elasticity(material, spec);
    return spec;
}

}  // namespace

std::vector<MaterialSpec> read_materials(const TableReader& root) {
    std::vector<std::string_view> keys;
    for (const std::span<const std::string_view> some :
         {std::span<const std::string_view>(common_keys),
          std::span<const std::string_view>(heml_keys),
          std::span<const std::string_view>(hybmss_keys)})
        keys.insert(keys.end(), some.begin(), some.end());
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
