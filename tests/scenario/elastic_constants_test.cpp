// Every set of parameters leads to the same constants, and inadmissible ones are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/elastic_constants.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

#include "incise/base/error.h"

namespace incise::scenario {
namespace {

using enum Parameter;
constexpr double round_off = 1e-14;  // relative; a handful of operations

ElasticParameters given(std::initializer_list<std::pair<Parameter, double>> values) {
    ElasticParameters parameters;
    for (const auto& [parameter, value] : values) parameters[parameter] = value;
    return parameters;
}

std::string refusal(std::string_view law, const ElasticParameters& parameters,
                    Method method = Method::heml) {
    try {
        resolve(method, law, parameters);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ElasticConstants, AreTheSameFromEverySetOfParameters) {
    // E = 1600 Pa, nu = 0.48: mu = 20000/37, lambda = 24 mu, K = lambda + 2 mu / 3.
    const double mu = 20000.0 / 37.0, lambda = 24.0 * mu, bulk = lambda + 2.0 * mu / 3.0;
    const auto check = [&](std::string_view law, const ElasticParameters& parameters) {
        const auto constants = resolve(Method::heml, law, parameters);
        EXPECT_NEAR(constants.mu, mu, mu * round_off);
        EXPECT_NEAR(constants.lambda, lambda, lambda * 100.0 * round_off);  // 1 - 2 nu = 0.04
        EXPECT_NEAR(constants.young(), 1600.0, 1600.0 * 100.0 * round_off);
        EXPECT_NEAR(constants.poisson(), 0.48, round_off * 100.0);
    };
    for (const std::string_view law : {"saint-venant-kirchhoff", "neo-hookean"}) {
        check(law, given({{young, 1600.0}, {poisson, 0.48}}));
        check(law, given({{shear_modulus, mu}, {bulk_modulus, bulk}}));
        check(law, given({{lame_lambda, lambda}, {lame_mu, mu}}));
    }
    check("neo-hookean", given({{c1, mu / 2.0}, {bulk_modulus, bulk}}));
    check("neo-hookean", given({{c1, mu / 2.0}, {lame_lambda, lambda}}));
    const double second = 100.0, first = mu / 2.0 - second;
    check("mooney-rivlin", given({{c1, first}, {c2, second}, {bulk_modulus, bulk}}));
    check("mooney-rivlin", given({{c1, first}, {c2, second}, {lame_lambda, lambda}}));
    check("mooney-rivlin", given({{c1, first}, {c2, second}, {poisson, 0.48}}));
}

TEST(ElasticConstants, OfTheLawsFollowFromThoseAtRest) {
    const auto neo = std::get<physics::NeoHookean>(
        make_law("neo-hookean", given({{lame_mu, 3.0}, {lame_lambda, 5.0}})));
    EXPECT_EQ(neo.c1, 1.5);
    EXPECT_EQ(neo.lambda, 5.0);
    const auto mooney = std::get<physics::MooneyRivlin>(
        make_law("mooney-rivlin", given({{c1, 0.1}, {c2, 0.25}, {lame_lambda, 5.0}})));
    EXPECT_EQ(mooney.c1, 0.1);
    EXPECT_EQ(mooney.c2, 0.25);
    EXPECT_EQ(mooney.lambda, 4.0);
    const auto isochoric = std::get<physics::IsochoricMooneyRivlin>(
        make_law("mooney-rivlin-isochoric", given({{c1, 0.1}, {c2, 0.25}, {bulk_modulus, 5.0}})));
    EXPECT_EQ(isochoric.c2, 0.25);
    EXPECT_NEAR(isochoric.bulk_modulus, 5.0, 5.0 * round_off);
}

// Whatever a law adds to lambda and mu on its own account, at rest it has those that were given.
TEST(ElasticConstants, OfAnyLawAreItsModuliAtRest) {
    for (std::size_t i = 0; i < laws().size(); ++i)
        for (const ParameterSet& set : laws()[i].parameter_sets) {
            SCOPED_TRACE(std::string(laws()[i].key) + ": " + list_of_sets(std::span(&set, 1)));
            ElasticParameters parameters;
            parameters.terms = {{700.0, 1.5}, {300.0, -2.0}};
            for (const Parameter p : set) {
                const double value = p == young              ? 2900.0
                                     : p == poisson          ? 0.45
                                     : p == lame_lambda      ? 9000.0
                                     : p == bulk_modulus     ? 10000.0
                                     : p == c1               ? 450.0
                                     : p == c2               ? 50.0
                                     : p == gamma            ? 0.8
                                     : p == Parameter::terms ? 2.0
                                                             : 1000.0;
                parameters[p] = value;
            }
            const auto law = laws()[i].key;
            const auto constants = resolve(Method::heml, law, parameters);
            std::visit(
                [&](const auto& made) {
                    EXPECT_NEAR(made.rest_mu(), constants.mu, 1e-12 * constants.mu);
                    EXPECT_NEAR(made.rest_lambda(), constants.lambda, 1e-12 * constants.lambda);
                },
                make_law(law, parameters));
        }
}

TEST(ElasticConstants, OfSpringsHaveThePoissonsRatioOfSprings) {
    const auto constants = resolve(Method::mass_spring, "neo-hookean", given({{young, 1000.0}}));
    EXPECT_NEAR(constants.poisson(), 0.25, round_off);
    EXPECT_NEAR(constants.young(), 1000.0, 1000.0 * round_off);
}

TEST(ElasticConstants, NeedExactlyOneSetOfParameters) {
    EXPECT_EQ(refusal("saint-venant-kirchhoff", given({{young, 1.0}})),
              "saint-venant-kirchhoff takes young + poisson, or shear_modulus + bulk_modulus, or "
              "lame_lambda + lame_mu; given: young");
    EXPECT_EQ(refusal("mooney-rivlin", given({{young, 1.0}, {poisson, 0.3}})),
              "mooney-rivlin takes c1 + c2 + bulk_modulus, or c1 + c2 + lame_lambda, or c1 + c2 + "
              "poisson; given: young + poisson");
    EXPECT_EQ(refusal("neo-hookean", given({}), Method::mass_spring),
              "mass-spring takes young; given: none of them");
    EXPECT_NE(refusal("neo-hookean", given({{young, 1.0}, {poisson, 0.3}, {lame_mu, 1.0}})),
              "accepted");
    EXPECT_NE(refusal("neo-hookean", given({{young, 1.0}, {bulk_modulus, 0.3}})), "accepted");
}

TEST(ElasticConstants, MustBeAdmissible) {
    const auto lame = [](double lambda, double mu) {
        return given({{lame_lambda, lambda}, {lame_mu, mu}});
    };
    // K > 0 for every law; lambda >= 0 besides where a logarithm holds the volume.
    EXPECT_EQ(refusal("saint-venant-kirchhoff", lame(-1.9, 3.0)), "accepted");
    EXPECT_NE(refusal("saint-venant-kirchhoff", lame(-2.1, 3.0)).find("must be above -2"),
              std::string::npos);
    EXPECT_EQ(refusal("neo-hookean", lame(0.0, 3.0)), "accepted");
    EXPECT_NE(refusal("neo-hookean", lame(-0.1, 3.0)).find("Poisson's ratio must not"),
              std::string::npos);
    const auto mooney = [](double second) {
        return given({{c1, 1.0}, {c2, second}, {lame_lambda, 4.0}});
    };
    EXPECT_EQ(refusal("mooney-rivlin", mooney(1.0)), "accepted");
    EXPECT_NE(refusal("mooney-rivlin", mooney(1.1)).find("at most a quarter"), std::string::npos);
    const auto fung = [](double factor) {
        return given({{lame_mu, 2.0}, {lame_lambda, 4.0}, {Parameter::gamma, factor}});
    };
    EXPECT_EQ(refusal("fung-demiray", fung(1.0)), "accepted");
    EXPECT_EQ(refusal("fung-demiray", fung(1.1)),
              "fung-demiray: gamma is 1.1, but must be at most Lame's lambda over twice the shear "
              "modulus (1): lower it, raise poisson, or use fung-demiray-isochoric");
    EXPECT_EQ(refusal("fung-demiray-isochoric", fung(1.1)), "accepted");
    auto ogden = given({{Parameter::terms, 2.0}, {bulk_modulus, 10.0}});
    ogden.terms = {{3.0, 2.0}, {-4.0, 3.0}};
    EXPECT_NE(refusal("ogden", ogden).find("the shear modulus is -1, but must be above 0"),
              std::string::npos);
}

TEST(MaterialCatalog, RowsStandAtTheirIndex) {
    for (std::size_t i = 0; i < parameters().size(); ++i)
        EXPECT_EQ(parameters()[i].parameter, static_cast<Parameter>(i));
    EXPECT_EQ(method_names()[static_cast<std::size_t>(Method::mass_spring)], "mass-spring");
}

}  // namespace
}  // namespace incise::scenario
