// From the elastic parameters of a scenario to the moduli and the law of a material.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/scenario/material_catalog.h"

namespace incise::scenario {

/// Returns the moduli at rest of a material. All given moduli are moduli at rest, even if other
/// terms of the law contribute to lambda at rest.
///
/// For the mass-spring model the moduli are those of springs in all directions alike. Poisson's
/// ratio is then 1/4, and lambda = mu = 2/5 young. The moduli of a mesh differ from these.
///
/// Throws InputError if the parameters are not exactly one of the sets that the model takes, or if
/// the moduli are not admissible.
ElasticConstants resolve(Method method, std::string_view law, const ElasticParameters& given);

/// True if the parameters, without the optional ones, are exactly one of the sets of the model.
bool is_complete(const MaterialModel& model, const ElasticParameters& given);

/// Throws InputError unless is_complete(). The message lists what is given and what the model
/// takes.
void require_complete(const MaterialModel& model, const ElasticParameters& given);

/// Returns the names of the given parameters, such as "young + poisson". Empty if none is given.
std::string list_of(const ElasticParameters& given);

/// Returns a law of HEML with the given parameters. Throws as resolve().
physics::Law make_law(std::string_view law, const ElasticParameters& given);

}  // namespace incise::scenario
