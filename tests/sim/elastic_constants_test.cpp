// Every set of parameters leads to the same constants, and inadmissible ones are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/elastic_constants.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

#include "topology/error.h"

namespace incise::sim {
namespace {

using enum Parameter;
constexpr double round_off = 1e-14;  // relative; a handful of operations

ElasticParameters given(std::initializer_list<std::pair<Parameter, double>> values) {
    ElasticParameters parameters;
    for (const auto& [parameter, value] : values) parameters[parameter] = value;
    return parameters;
}

std::string refusal(Law law, const ElasticParameters& parameters, Method method = Method::heml) {
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
    const auto check = [&](Law law, const ElasticParameters& parameters) {
        const auto constants = resolve(Method::heml, law, parameters);
        EXPECT_NEAR(constants.mu, mu, mu * round_off);
        EXPECT_NEAR(constants.lambda, lambda, lambda * 100.0 * round_off);  // 1 - 2 nu = 0.04
        EXPECT_NEAR(constants.young(), 1600.0, 1600.0 * 100.0 * round_off);
        EXPECT_NEAR(constants.poisson(), 0.48, round_off * 100.0);
    };
    for (const Law law : {Law::saint_venant_kirchhoff, Law::neo_hookean}) {
        check(law, given({{young, 1600.0}, {poisson, 0.48}}));
        check(law, given({{shear_modulus, mu}, {bulk_modulus, bulk}}));
        check(law, given({{lame_lambda, lambda}, {lame_mu, mu}}));
    }
    check(Law::neo_hookean, given({{c1, mu / 2.0}, {bulk_modulus, bulk}}));
    check(Law::neo_hookean, given({{c1, mu / 2.0}, {lame_lambda, lambda}}));
    const double second = 100.0, first = mu / 2.0 - second;
    check(Law::mooney_rivlin, given({{c1, first}, {c2, second}, {bulk_modulus, bulk}}));
    check(Law::mooney_rivlin, given({{c1, first}, {c2, second}, {lame_lambda, lambda}}));
    check(Law::mooney_rivlin, given({{c1, first}, {c2, second}, {poisson, 0.48}}));
}

TEST(ElasticConstants, OfTheLawsFollowFromThoseAtRest) {
    const auto neo =
        resolve(Method::heml, Law::neo_hookean, given({{lame_mu, 3.0}, {lame_lambda, 5.0}}));
    EXPECT_EQ(neo.c1, 1.5);
    EXPECT_EQ(neo.c2, 0.0);
    EXPECT_EQ(neo.law_lambda, 5.0);
    const auto mooney = resolve(Method::heml, Law::mooney_rivlin,
                                given({{c1, 0.1}, {c2, 0.25}, {lame_lambda, 5.0}}));
    EXPECT_EQ(mooney.c1, 0.1);
    EXPECT_EQ(mooney.c2, 0.25);
    EXPECT_EQ(mooney.mu, 0.7);
    EXPECT_EQ(mooney.law_lambda, 4.0);
}

TEST(ElasticConstants, OfSpringsHaveThePoissonsRatioOfSprings) {
    const auto constants = resolve(Method::mass_spring, Law::neo_hookean, given({{young, 1000.0}}));
    EXPECT_NEAR(constants.poisson(), 0.25, round_off);
    EXPECT_NEAR(constants.young(), 1000.0, 1000.0 * round_off);
}

TEST(ElasticConstants, NeedExactlyOneSetOfParameters) {
    EXPECT_EQ(refusal(Law::saint_venant_kirchhoff, given({{young, 1.0}})),
              "saint-venant-kirchhoff takes young + poisson, or shear_modulus + bulk_modulus, or "
              "lame_lambda + lame_mu; given: young");
    EXPECT_EQ(refusal(Law::mooney_rivlin, given({{young, 1.0}, {poisson, 0.3}})),
              "mooney-rivlin takes c1 + c2 + bulk_modulus, or c1 + c2 + lame_lambda, or c1 + c2 + "
              "poisson; given: young + poisson");
    EXPECT_EQ(refusal(Law::neo_hookean, given({}), Method::mass_spring),
              "mass-spring takes young; given: none of them");
    EXPECT_NE(refusal(Law::neo_hookean, given({{young, 1.0}, {poisson, 0.3}, {lame_mu, 1.0}})),
              "accepted");
    EXPECT_NE(refusal(Law::neo_hookean, given({{young, 1.0}, {bulk_modulus, 0.3}})), "accepted");
}

TEST(ElasticConstants, MustBeAdmissible) {
    const auto lame = [](double lambda, double mu) {
        return given({{lame_lambda, lambda}, {lame_mu, mu}});
    };
    // K > 0 for every law; lambda >= 0 besides where a logarithm holds the volume.
    EXPECT_EQ(refusal(Law::saint_venant_kirchhoff, lame(-1.9, 3.0)), "accepted");
    EXPECT_NE(refusal(Law::saint_venant_kirchhoff, lame(-2.1, 3.0)).find("must be above -2"),
              std::string::npos);
    EXPECT_EQ(refusal(Law::neo_hookean, lame(0.0, 3.0)), "accepted");
    EXPECT_NE(refusal(Law::neo_hookean, lame(-0.1, 3.0)).find("Poisson's ratio must not"),
              std::string::npos);
    const auto mooney = [](double second) {
        return given({{c1, 1.0}, {c2, second}, {lame_lambda, 4.0}});
    };
    EXPECT_EQ(refusal(Law::mooney_rivlin, mooney(1.0)), "accepted");
    EXPECT_NE(refusal(Law::mooney_rivlin, mooney(1.1)).find("at most a quarter"),
              std::string::npos);
}

TEST(MaterialCatalog, RowsStandAtTheirIndex) {
    for (std::size_t i = 0; i < parameters().size(); ++i)
        EXPECT_EQ(parameters()[i].parameter, static_cast<Parameter>(i));
    EXPECT_EQ(model(Law::saint_venant_kirchhoff).key, "saint-venant-kirchhoff");
    EXPECT_EQ(model(Law::neo_hookean).key, "neo-hookean");
    EXPECT_EQ(model(Law::mooney_rivlin).key, "mooney-rivlin");
    EXPECT_EQ(method_names()[static_cast<std::size_t>(Method::mass_spring)], "mass-spring");
}

}  // namespace
}  // namespace incise::sim
