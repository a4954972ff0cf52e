// From the elastic parameters of a scenario to the constants of its law.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "sim/material_catalog.h"

namespace incise::sim {

/// Moduli of small strain about rest, and the constants in the law's energy; pascal.
struct ElasticConstants {
    double lambda = 0.0;  ///< Lame's first parameter at rest
    double mu = 0.0;      ///< shear modulus at rest
    /// Neo-Hookean: mu / 2 and 0. Mooney-Rivlin: as given. Without meaning elsewhere.
    double c1 = 0.0, c2 = 0.0;
    /// The factor of ln^2 J / 2 in the neo-Hookean and Mooney-Rivlin laws: lambda - 4 c2.
    double law_lambda = 0.0;

    double bulk_modulus() const { return lambda + 2.0 * mu / 3.0; }
    double young() const { return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu); }
    double poisson() const { return lambda / (2.0 * (lambda + mu)); }
};

/// All given moduli are those at rest, lame_lambda of Mooney-Rivlin too.
/// For mass-spring the constants are those of springs in all directions alike: Poisson's ratio is
/// 1/4, lambda = mu = 2/5 young; a given mesh deviates from them.
/// Throws InputError if the parameters are not exactly one of the sets that the model takes, or
/// the constants are not admissible.
ElasticConstants resolve(Method method, Law law, const ElasticParameters& given);

}  // namespace incise::sim
