// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/material_catalog.h"

#include <algorithm>

#include "io/number_format.h"
#include "topology/error.h"

namespace incise::sim {

namespace {

using enum Parameter;

constexpr std::array<ParameterInfo, num_parameters> parameter_table = {{
    {young, "young", "Pa", "Young's modulus E", limits::positive},
    {poisson, "poisson", "1", "Poisson's ratio nu", {.low = -1.0, .high = 0.5}},
    {shear_modulus, "shear_modulus", "Pa", "shear modulus G = mu", limits::positive},
    {bulk_modulus, "bulk_modulus", "Pa", "bulk modulus K = lambda + 2 mu / 3", limits::positive},
    {lame_lambda, "lame_lambda", "Pa", "Lame's first parameter lambda at rest", limits::any},
    {lame_mu, "lame_mu", "Pa", "Lame's second parameter mu, the shear modulus", limits::positive},
    {c1, "c1", "Pa", "constant of I1: mu / 2 (neo-Hookean), mu / 2 - c2 (Mooney-Rivlin)",
     limits::positive},
    {c2, "c2", "Pa", "constant of I2 (Mooney-Rivlin)", limits::non_negative},
    {gamma, "gamma", "1", "how fast the tissue stiffens (Fung-Demiray)", limits::positive},
    {terms, "terms", "Pa, 1", "list of { mu, alpha } (Ogden); the mu add up to the shear modulus",
     limits::any},
}};

double lambda_of_logarithm(const ElasticConstants& k) {
    if (!(k.lambda >= 0.0))
        throw InputError("Lame's lambda is " + io::format_number(k.lambda) +
                         " at rest, but this law needs at least 0: Poisson's ratio must not be "
                         "negative");
    return k.lambda;
}

physics::Law make_saint_venant_kirchhoff(const ElasticConstants& k, const ElasticParameters&) {
    return physics::SaintVenantKirchhoff{k.lambda, k.mu};
}

physics::Law make_neo_hookean(const ElasticConstants& k, const ElasticParameters& p) {
    return physics::NeoHookean{p[c1].value_or(k.mu / 2.0), lambda_of_logarithm(k)};
}

physics::Law make_mooney_rivlin(const ElasticConstants& k, const ElasticParameters& p) {
    const double lambda = lambda_of_logarithm(k);
    if (!(lambda >= 4.0 * *p[c2]))
        throw InputError("c2 is " + io::format_number(*p[c2]) +
                         ", but must be at most a quarter of Lame's lambda (" +
                         io::format_number(lambda / 4.0) +
                         "): lower it, or raise bulk_modulus, lame_lambda or poisson");
    return physics::MooneyRivlin{*p[c1], *p[c2], lambda - 4.0 * *p[c2]};
}

physics::Law make_fung_demiray(const ElasticConstants& k, const ElasticParameters& p) {
    const double lambda = lambda_of_logarithm(k);
    if (!(lambda >= 2.0 * k.mu * *p[gamma]))
        throw InputError("gamma is " + io::format_number(*p[gamma]) +
                         ", but must be at most Lame's lambda over twice the shear modulus (" +
                         io::format_number(lambda / (2.0 * k.mu)) +
                         "): lower it, raise poisson, or use fung-demiray-isochoric");
    return physics::FungDemiray{k.mu, *p[gamma], lambda - 2.0 * k.mu * *p[gamma]};
}

physics::Law make_ogden(const ElasticConstants& k, const ElasticParameters& p) {
    if (p.terms.size() > physics::Ogden::max_terms)
        throw InputError("has " + std::to_string(p.terms.size()) + " terms, but may have at most " +
                         std::to_string(physics::Ogden::max_terms));
    physics::Ogden law;
    law.num_terms = p.terms.size();
    std::copy(p.terms.begin(), p.terms.end(), law.terms.begin());
    law.bulk_modulus = k.bulk_modulus();
    return law;
}

physics::Law make_ciarlet_neo_hookean(const ElasticConstants& k, const ElasticParameters&) {
    return physics::CiarletNeoHookean{k.mu, lambda_of_logarithm(k)};
}

/// Also neo-Hookean: c2 is 0 then.
physics::Law make_isochoric_mooney_rivlin(const ElasticConstants& k, const ElasticParameters& p) {
    const double second = p[c2].value_or(0.0);
    return physics::IsochoricMooneyRivlin{p[c1].value_or(k.mu / 2.0), second, k.bulk_modulus()};
}

physics::Law make_isochoric_fung_demiray(const ElasticConstants& k, const ElasticParameters& p) {
    return physics::IsochoricFungDemiray{k.mu, *p[gamma], k.bulk_modulus()};
}

const std::array<MaterialModel, 9>& law_table() {
    static const std::array<MaterialModel, 9> table = {{
        {"saint-venant-kirchhoff",
         "Saint Venant-Kirchhoff: Hooke's law in Green's strain",
         "w = lambda/2 (tr E)^2 + mu tr(E^2),  E = (F^T F - 1) / 2",
         {{young, poisson}, {shear_modulus, bulk_modulus}, {lame_lambda, lame_mu}},
         "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
         "Large rotations with small strains (some 10 %). The cheapest law.",
         "Softens in compression and collapses below a stretch of 0.577; its energy at zero "
         "volume is finite, so it does not resist inversion; at Poisson's ratios near 0.5 it "
         "does not keep the volume at large strain. Prefer neo-hookean where tissue is "
         "compressed strongly.",
         make_saint_venant_kirchhoff},
        {"neo-hookean",
         "Neo-Hookean, compressible, with logarithmic volume term",
         "w = c1 (I1 - 3) - 2 c1 ln J + lambda/2 ln^2 J,  c1 = mu / 2",
         {{young, poisson},
          {shear_modulus, bulk_modulus},
          {lame_lambda, lame_mu},
          {c1, bulk_modulus},
          {c1, lame_lambda}},
         "mu > 0, lambda >= 0 (Poisson's ratio from 0 to below 0.5)",
         "Soft tissue at moderate strains (some 50 %); the sensible first choice.",
         "ln^2 J turns concave when a volume grows beyond ln J = 1 + mu/lambda. For J below "
         "inversion_threshold the volume term goes on as a parabola, which pushes flat or "
         "inverted elements back; an element that collapsed to a point or a line is not "
         "pushed back.",
         make_neo_hookean},
        {"mooney-rivlin",
         "Mooney-Rivlin, compressible, with logarithmic volume term",
         "w = c1 (I1 - 3) + c2 (I2 - 3) - (2 c1 + 4 c2) ln J + (lambda - 4 c2)/2 ln^2 J,  mu "
         "= 2 (c1 + c2)",
         {{c1, c2, bulk_modulus}, {c1, c2, lame_lambda}, {c1, c2, poisson}},
         "c1 > 0, c2 >= 0, c2 <= lambda/4, where lambda and mu are the moduli at rest",
         "Tissue for which both constants were measured; strains up to some 100 %.",
         "As neo-hookean. Moduli alone do not determine it: c1 and c2 must be given.",
         make_mooney_rivlin},
        {"fung-demiray",
         "Fung-Demiray: stiffens exponentially, with logarithmic volume term",
         "w = mu/(2 gamma) (exp(gamma (I1 - 3)) - 1) - mu ln J + (lambda - 2 mu gamma)/2 ln^2 J",
         {{young, poisson, gamma},
          {shear_modulus, bulk_modulus, gamma},
          {lame_lambda, lame_mu, gamma}},
         "mu > 0, gamma > 0, gamma <= lambda / (2 mu), where lambda and mu are the moduli at rest",
         "Tissue with collagen: skin, vessels, membranes, at strains up to some 50 %.",
         "As neo-hookean. The stable step is that at rest, and stiffness grows by exp(gamma (I1 - "
         "3)): lower dynamics.safety where gamma (I1 - 3) exceeds 1.",
         make_fung_demiray},
        {"ogden",
         "Ogden: powers of the isochoric principal stretches, up to six terms",
         "w = sum 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + K/2 (J - 1)^2, "
         " l_k = J^(-1/3) times the principal stretches",
         {{bulk_modulus, terms}, {poisson, terms}, {lame_lambda, terms}},
         "sum of the mu_i > 0, K > 0, alpha_i not 0",
         "Tissue that was measured so: brain, fat, skin; stretches between a half and two.",
         "The mu_i add up to the shear modulus: many papers print mu_i alpha_i / 2 in their place. "
         "Some ten times as costly as neo-hookean. Squared stretches below the square of "
         "inversion_threshold follow a parabola.",
         make_ogden},
        {"neo-hookean-ciarlet",
         "Neo-Hookean with Ciarlet's volume term, convex in J",
         "w = mu/2 (I1 - 3) - (mu + lambda/2) ln J + lambda/4 (J^2 - 1)",
         {{young, poisson}, {shear_modulus, bulk_modulus}, {lame_lambda, lame_mu}},
         "mu > 0, lambda >= 0 (Poisson's ratio from 0 to below 0.5)",
         "As neo-hookean, where volumes grow much.",
         "As neo-hookean, but for the growth of volume.",
         make_ciarlet_neo_hookean},
        {"neo-hookean-isochoric",
         "Neo-Hookean in the isochoric strain: change of shape and of volume have energies of "
         "their own",
         "w = c1 (I1 J^(-2/3) - 3) + K/2 (J - 1)^2,  c1 = mu / 2",
         {{young, poisson},
          {shear_modulus, bulk_modulus},
          {lame_lambda, lame_mu},
          {c1, bulk_modulus}},
         "mu > 0, K > 0",
         "Nearly incompressible tissue; to compare with programs that use this form.",
         "The energy at zero volume is finite. Below inversion_threshold the powers of J go on as "
         "parabolas.",
         make_isochoric_mooney_rivlin},
        {"mooney-rivlin-isochoric",
         "Mooney-Rivlin in the isochoric strain",
         "w = c1 (I1 J^(-2/3) - 3) + c2 (I2 J^(-4/3) - 3) + K/2 (J - 1)^2,  mu = 2 (c1 + c2)",
         {{c1, c2, bulk_modulus}, {c1, c2, lame_lambda}, {c1, c2, poisson}},
         "c1 > 0, c2 >= 0, K > 0",
         "As mooney-rivlin, nearly incompressible tissue.",
         "As neo-hookean-isochoric.",
         make_isochoric_mooney_rivlin},
        {"fung-demiray-isochoric",
         "Fung-Demiray in the isochoric strain: any gamma",
         "w = mu/(2 gamma) (exp(gamma (I1 J^(-2/3) - 3)) - 1) + K/2 (J - 1)^2",
         {{young, poisson, gamma},
          {shear_modulus, bulk_modulus, gamma},
          {lame_lambda, lame_mu, gamma}},
         "mu > 0, gamma > 0, K > 0",
         "As fung-demiray, nearly incompressible tissue.",
         "As fung-demiray and neo-hookean-isochoric.",
         make_isochoric_fung_demiray},
    }};
    return table;
}

constexpr std::array<std::string_view, 3> method_table = {"heml", "mass-spring", "hybmss"};

}  // namespace

std::span<const ParameterInfo> parameters() { return parameter_table; }

const ParameterInfo& info(Parameter parameter) {
    return parameter_table[static_cast<std::size_t>(parameter)];
}

std::span<const MaterialModel> laws() { return law_table(); }

const MaterialModel& model(Law law) { return law_table()[static_cast<std::size_t>(law)]; }

const MaterialModel& mass_spring_model() {
    static const MaterialModel table = {
        "mass-spring",
        "Springs along the edges: the classical baseline",
        "W = sum over edges of k/2 (l - L)^2, k the sum of young V / L^2 over the elements there",
        {{young}},
        "young > 0",
        "Comparison with the classical method, not for predictions.",
        "Springs that pull along their own direction fix Poisson's ratio near 1/4 and the "
        "volume is not kept; stiffness depends on the mesh. So a law, poisson and the other "
        "moduli are refused."};
    return table;
}

const MaterialModel& hybmss_model() {
    static const MaterialModel table = {
        "hybmss",
        "Hybrid mass-spring system on hexahedra: springs and a term of volume",
        "W = sum over springs of k/2 (l - L)^2 + kappa V/2 (V'/V - 1)^2 a cell, kappa = K - 5 G / "
        "3",
        {{young, poisson}, {shear_modulus, bulk_modulus}, {lame_lambda, lame_mu}},
        "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
        "Voxels and grids: hexahedra that are cubes, or boxes with edges of at most 1.4 to 1; "
        "strains of some 10 %, nearly incompressible tissue too. stiffness_ratio = inf for bodies "
        "that are cut or stand beside other elements.",
        "Below a Poisson's ratio of 1/4 kappa is negative and tension is lost at large strain: at "
        "a "
        "stretch of 1.2 for 0, 1.37 for 0.1, 1.6 for 0.15, 2.3 for 0.2 along one axis, of 1.1, "
        "1.16, "
        "1.22 and 1.37 all round, sooner for negative ratios. Without face diagonals "
        "(stiffness_ratio = 0) bodies wrinkle under any load. Inverted cells may stay inverted."};
    return table;
}

const MaterialModel& model(Method method, Law law) {
    switch (method) {
        case Method::mass_spring:
            return mass_spring_model();
        case Method::hybmss:
            return hybmss_model();
        case Method::heml:
            break;
    }
    return model(law);
}

std::span<const std::string_view> method_names() { return method_table; }

std::string list_of_sets(std::span<const ParameterSet> sets) {
    std::string text;
    for (const auto& set : sets) {
        if (!text.empty()) text += ", or ";
        for (std::size_t i = 0; i < set.size(); ++i)
            text += (i > 0 ? " + " : "") + std::string(info(set[i]).key);
    }
    return text;
}

}  // namespace incise::sim
