// Tissues that a scenario can name as a preset: law, density and parameters, with sources and range
// of validity. Published moduli of one tissue differ by factors of 10 to 1000 with strain, rate and
// species. A preset is therefore only a starting point with a known source.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/physics/laws/material.h"
#include "incise/scenario/material_catalog.h"

namespace incise::scenario {

/// The lowest and the highest published value.
struct Range {
    double low, high;
};

/// A tissue and the sources of its data.
struct Tissue {
    std::string_view key;
    std::string_view title;
    std::string_view law;  ///< the key of the law in laws()
    double density;        ///< kg/m3
    std::string_view density_source;
    ElasticParameters parameters;  ///< a set of `law`: instantaneous moduli
    std::vector<physics::PronyTerm> prony;
    std::optional<Range> toughness;  ///< J/m2; for information only, not used in a simulation
    std::string_view source;         ///< source of `parameters` and `prony`
    std::string_view validity;       ///< strain, rate, species, spread, caveats
    std::string_view assumed;        ///< assumptions where the source gives no value
};

/// Returns all tissues. Their keys differ from each other and from the keys of laws and methods.
std::span<const Tissue> tissues();

/// Returns a tissue, or null if there is no such tissue.
const Tissue* find_tissue(std::string_view key);

/// The source of all toughness values.
extern const std::string_view toughness_source;

/// Returns the lines of a [[material]] section that are equivalent to the preset.
std::vector<std::string> scenario_lines(const Tissue& tissue);

}  // namespace incise::scenario
