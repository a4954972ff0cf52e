// Tissues that a scenario can name as a preset: law, density and parameters with their source and
// what they hold for. Reported moduli of one tissue differ by factors of 10 to 1000 with strain,
// rate and species: a preset is a starting point with a known origin, not the truth.
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

/// From the lowest to the highest reported value.
struct Range {
    double low, high;
};

struct Tissue {
    std::string_view key;
    std::string_view title;
    std::string_view law;  ///< the key of its row in laws()
    double density;        ///< kg/m3
    std::string_view density_source;
    ElasticParameters parameters;  ///< a set of `law`; before any relaxation
    std::vector<physics::PronyTerm> prony;
    std::optional<Range> toughness;  ///< J/m2; for information, nothing uses it
    std::string_view source;         ///< of the elastic parameters and the relaxation
    std::string_view validity;       ///< strain, rate, species, spread, caveats
    std::string_view assumed;        ///< what the source leaves open and was chosen here
};

/// Their keys differ from each other and from those of laws and methods.
std::span<const Tissue> tissues();

/// Nothing if there is no such tissue.
const Tissue* find_tissue(std::string_view key);

/// Of all toughnesses.
extern const std::string_view toughness_source;

/// The lines of a [[material]] section that say what the preset stands for.
std::vector<std::string> scenario_lines(const Tissue& tissue);

}  // namespace incise::scenario
