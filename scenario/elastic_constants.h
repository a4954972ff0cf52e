// From the elastic parameters of a scenario to the moduli and the law of a material.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/scenario/material_catalog.h"

namespace incise::scenario {

/// All given moduli are those at rest, also where a law adds to its own lambda there.
/// For mass-spring the constants are those of springs in all directions alike: Poisson's ratio is
/// 1/4, lambda = mu = 2/5 young; a given mesh deviates from them.
/// Throws InputError if the parameters are not exactly one of the sets that the model takes, or
/// the constants are not admissible.
ElasticConstants resolve(Method method, std::string_view law, const ElasticParameters& given);

/// Whether the parameters are exactly one of the sets that the model takes, besides optional ones.
bool is_complete(const MaterialModel& model, const ElasticParameters& given);

/// Throws InputError that says what is given and what the model takes, if that is not so.
void require_complete(const MaterialModel& model, const ElasticParameters& given);

/// Such as "young + poisson"; empty if there are none.
std::string list_of(const ElasticParameters& given);

/// The law of HEML itself. Throws as resolve().
physics::Law make_law(std::string_view law, const ElasticParameters& given);

}  // namespace incise::scenario
