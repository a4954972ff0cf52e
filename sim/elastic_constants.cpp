// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/elastic_constants.h"

#include <algorithm>

#include "io/number_format.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

using io::format_number;

void check_parameter_set(const MaterialModel& model, const ElasticParameters& given) {
    ParameterSet keys;
    std::string listed;
    for (const auto& row : parameters())
        if (given[row.parameter]) {
            keys.push_back(row.parameter);
            listed += (listed.empty() ? "" : " + ") + std::string(row.key);
        }
    const auto equals_given = [&](const ParameterSet& set) {
        return std::is_permutation(set.begin(), set.end(), keys.begin(), keys.end());
    };
    if (std::none_of(model.parameter_sets.begin(), model.parameter_sets.end(), equals_given))
        throw InputError(std::string(model.key) + " takes " + list_of_sets(model.parameter_sets) +
                         "; given: " + (listed.empty() ? "none of them" : listed));
}

double shear_modulus(const ElasticParameters& p) {
    using enum Parameter;
    if (p[young]) return *p[young] / (2.0 * (1.0 + *p[poisson]));
    if (p[shear_modulus]) return *p[shear_modulus];
    if (p[lame_mu]) return *p[lame_mu];
    return 2.0 * (*p[c1] + p[c2].value_or(0.0));
}

double rest_lambda(const ElasticParameters& p, double mu) {
    using enum Parameter;
    if (p[lame_lambda]) return *p[lame_lambda];
    if (p[bulk_modulus]) return *p[bulk_modulus] - 2.0 * mu / 3.0;
    return 2.0 * mu * *p[poisson] / (1.0 - 2.0 * *p[poisson]);
}

void check_admissible(const MaterialModel& model, bool is_linear, const ElasticConstants& k) {
    const auto refuse = [&](const std::string& what) {
        throw InputError(std::string(model.key) + ": " + what);
    };
    if (!(k.bulk_modulus() > 0.0))
        refuse("the bulk modulus lambda + 2 mu / 3 is " + format_number(k.bulk_modulus()) +
               ", but must be above 0: raise lame_lambda, which must be above " +
               format_number(-2.0 * k.mu / 3.0));
    if (is_linear) return;
    if (!(k.lambda >= 0.0))
        refuse("Lame's lambda is " + format_number(k.lambda) +
               " at rest, but this law needs at least 0: Poisson's ratio must not be negative");
    if (!(k.law_lambda >= 0.0))
        refuse("c2 is " + format_number(k.c2) +
               ", but must be at most a quarter of Lame's lambda (" +
               format_number(k.lambda / 4.0) +
               "): lower it, or raise bulk_modulus, lame_lambda or poisson");
}

}  // namespace

ElasticConstants resolve(Method method, Law law, const ElasticParameters& given) {
    const MaterialModel& model = sim::model(method, law);
    check_parameter_set(model, given);
    ElasticConstants constants;
    if (method == Method::mass_spring) {
        constants.lambda = constants.mu = 0.4 * *given[Parameter::young];
        return constants;
    }
    constants.mu = shear_modulus(given);
    constants.lambda = rest_lambda(given, constants.mu);
    const bool is_linear = method == Method::hybmss || law == Law::saint_venant_kirchhoff;
    if (!is_linear) {
        constants.c2 = given[Parameter::c2].value_or(0.0);
        constants.c1 = constants.mu / 2.0 - constants.c2;
        if (given[Parameter::c1]) constants.c1 = *given[Parameter::c1];  // to the last bit
        constants.law_lambda = constants.lambda - 4.0 * constants.c2;
    }
    check_admissible(model, is_linear, constants);
    return constants;
}

}  // namespace incise::sim
