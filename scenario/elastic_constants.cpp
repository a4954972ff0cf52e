// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/elastic_constants.h"

#include <algorithm>

#include "incise/base/error.h"
#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

ParameterSet keys_of(const ElasticParameters& given) {
    ParameterSet keys;
    for (const auto& row : parameters())
        if (given[row.parameter]) keys.push_back(row.parameter);
    return keys;
}

double shear_modulus_of(const MaterialModel& model, const ElasticParameters& p) {
    using enum Parameter;
    if (p[young]) return *p[young] / (2.0 * (1.0 + *p[poisson]));
    if (p[shear_modulus]) return *p[shear_modulus];
    if (p[lame_mu]) return *p[lame_mu];
    return model.shear_modulus(p);
}

double rest_lambda(const ElasticParameters& p, double mu) {
    using enum Parameter;
    if (p[lame_lambda]) return *p[lame_lambda];
    if (p[bulk_modulus]) return *p[bulk_modulus] - 2.0 * mu / 3.0;
    return 2.0 * mu * *p[poisson] / (1.0 - 2.0 * *p[poisson]);
}

[[noreturn]] void refuse(const MaterialModel& model, const std::string& what) {
    throw InputError(std::string(model.key) + ": " + what);
}

physics::Law make(const MaterialModel& model, const ElasticConstants& constants,
                  const ElasticParameters& given) {
    try {
        return model.make(constants, given);
    } catch (const InputError& error) {
        refuse(model, error.what());
    }
}

}  // namespace

bool is_complete(const MaterialModel& model, const ElasticParameters& given) {
    ParameterSet keys = keys_of(given);
    for (const Parameter optional : model.optional) std::erase(keys, optional);
    return std::any_of(
        model.parameter_sets.begin(), model.parameter_sets.end(), [&](const ParameterSet& set) {
            return std::is_permutation(set.begin(), set.end(), keys.begin(), keys.end());
        });
}

void require_complete(const MaterialModel& model, const ElasticParameters& given) {
    const std::string listed = list_of(given);
    if (!is_complete(model, given))
        throw InputError(std::string(model.key) + " takes " + list_of_parameters(model) +
                         "; given: " + (listed.empty() ? "none of them" : listed));
}

std::string list_of(const ElasticParameters& given) {
    const ParameterSet keys = keys_of(given);
    return list_of_sets({&keys, 1});
}

ElasticConstants resolve(Method method, std::string_view law, const ElasticParameters& given) {
    const MaterialModel& model = scenario::model(method, law);
    require_complete(model, given);
    ElasticConstants constants;
    if (method == Method::mass_spring) {
        constants.lambda = constants.mu = 0.4 * *given[Parameter::young];
        return constants;
    }
    constants.mu = shear_modulus_of(model, given);
    constants.lambda = rest_lambda(given, constants.mu);
    if (!(constants.mu > 0.0))
        refuse(model, "the shear modulus is " + format_number(constants.mu) +
                          ", but must be above 0: the mu of all terms add up to it");
    if (!(constants.bulk_modulus() > 0.0))
        refuse(model, "the bulk modulus lambda + 2 mu / 3 is " +
                          format_number(constants.bulk_modulus()) +
                          ", but must be above 0: raise lame_lambda, which must be above " +
                          format_number(-2.0 * constants.mu / 3.0));
    if (model.make != nullptr) make(model, constants, given);
    return constants;
}

physics::Law make_law(std::string_view law, const ElasticParameters& given) {
    return make(law_named(law), resolve(Method::heml, law, given), given);
}

}  // namespace incise::scenario
