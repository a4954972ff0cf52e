// The catalog of laws. The function with the table is long, since it is data.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/material_catalog.h"

#include <algorithm>
#include <stdexcept>

#include "incise/base/error.h"
#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

using enum Parameter;

constexpr std::array<ParameterInfo, num_parameters> parameter_table = {{
    {young, "young", "Pa", "Young's modulus E", limits::positive},
    {poisson, "poisson", "1", "Poisson's ratio nu", {.low = -1.0, .high = 0.5}},
    {shear_modulus, "shear_modulus", "Pa", "shear modulus G = mu", limits::positive},
    {bulk_modulus, "bulk_modulus", "Pa", "bulk modulus K = lambda + 2 mu / 3", limits::positive},
    {lame_lambda, "lame_lambda", "Pa", "Lame's first parameter lambda at rest", limits::any},
    {lame_mu, "lame_mu", "Pa", "Lame's second parameter mu, the shear modulus", limits::positive},
    {c1, "c1", "Pa", "constant of I1: mu / 2, or mu / 2 - c2 (Mooney-Rivlin)", limits::positive},
    {c2, "c2", "Pa", "constant of I2 (Mooney-Rivlin) or of the square of I1 - 3 (Yeoh)",
     limits::non_negative},
    {gamma, "gamma", "1", "how fast the tissue stiffens (Fung-Demiray)", limits::positive},
    {terms, "terms", "Pa, 1", "list of { mu, alpha } (Ogden); the mu add up to the shear modulus",
     limits::any},
    {c3, "c3", "Pa", "constant of the cube of I1 - 3 (Yeoh)", limits::non_negative},
    {k1, "k1", "Pa", "stiffness of the fibres (Holzapfel-Gasser-Ogden)", limits::positive},
    {k2, "k2", "1", "how fast the fibres stiffen (Holzapfel-Gasser-Ogden)", limits::positive},
    {dispersion,
     "dispersion",
     "1",
     "kappa: 0 for parallel fibres, which is the default, 1/3 for fibres in all directions",
     {.low = 0.0, .high = 1.0 / 3.0, .includes_low = true, .includes_high = true}},
}};

double twice_c1(const ElasticParameters& p) { return 2.0 * *p[c1]; }
double twice_c1_and_c2(const ElasticParameters& p) { return 2.0 * (*p[c1] + *p[c2]); }

double lambda_of_logarithm(const ElasticConstants& k) {
    if (!(k.lambda >= 0.0))
        throw InputError("Lame's lambda is " + format_number(k.lambda) +
                         " at rest, but this law needs at least 0: Poisson's ratio must not be "
                         "negative");
    return k.lambda;
}

physics::Law make_mooney_rivlin(const ElasticConstants& k, const ElasticParameters& p) {
    const double lambda = lambda_of_logarithm(k);
    if (!(lambda >= 4.0 * *p[c2]))
        throw InputError("c2 is " + format_number(*p[c2]) +
                         ", but must be at most a quarter of Lame's lambda (" +
                         format_number(lambda / 4.0) +
                         "): lower it, or raise bulk_modulus, lame_lambda or poisson");
    return physics::MooneyRivlin{*p[c1], *p[c2], lambda - 4.0 * *p[c2]};
}

physics::Law make_fung_demiray(const ElasticConstants& k, const ElasticParameters& p) {
    const double lambda = lambda_of_logarithm(k);
    if (!(lambda >= 2.0 * k.mu * *p[gamma]))
        throw InputError("gamma is " + format_number(*p[gamma]) +
                         ", but must be at most Lame's lambda over twice the shear modulus (" +
                         format_number(lambda / (2.0 * k.mu)) +
                         "): lower it, raise poisson, or use fung-demiray-isochoric");
    return physics::FungDemiray{k.mu, *p[gamma], lambda - 2.0 * k.mu * *p[gamma]};
}

double sum_of_terms(const ElasticParameters& p) {
    double sum = 0.0;
    for (const auto& term : p.terms) sum += term.mu;
    return sum;
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

/// Makes the isochoric laws of Mooney-Rivlin and, without c2, neo-Hookean.
physics::Law make_isochoric_mooney_rivlin(const ElasticConstants& k, const ElasticParameters& p) {
    const double second = p[c2].value_or(0.0);
    return physics::IsochoricMooneyRivlin{p[c1].value_or(k.mu / 2.0), second, k.bulk_modulus()};
}

const std::vector<MaterialModel>& law_table() {
    static const std::vector<MaterialModel> table = {
        {.key = "saint-venant-kirchhoff",
         .title = "Saint Venant-Kirchhoff: Hooke's law in Green's strain",
         .energy = "w = lambda/2 (tr E)^2 + mu tr(E^2),  E = (F^T F - 1) / 2",
         .parameter_sets = {{young, poisson},
                            {shear_modulus, bulk_modulus},
                            {lame_lambda, lame_mu}},
         .admissible = "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
         .use = "Large rotations with small strains (some 10 %). The cheapest law.",
         .limits = "Softens in compression and collapses below a stretch of 0.577; its energy at "
                   "zero volume is finite, so it does not resist inversion; at Poisson's ratios "
                   "near 0.5 it does not keep the volume at large strain. Prefer neo-hookean where "
                   "tissue is compressed strongly.",
         .make = [](const ElasticConstants& k, const ElasticParameters&) -> physics::Law {
             return physics::SaintVenantKirchhoff{k.lambda, k.mu};
         }},
        {.key = "neo-hookean",
         .title = "Neo-Hookean, compressible, with logarithmic volume term",
         .energy = "w = c1 (I1 - 3) - 2 c1 ln J + lambda/2 ln^2 J,  c1 = mu / 2",
         .parameter_sets = {{young, poisson},
                            {shear_modulus, bulk_modulus},
                            {lame_lambda, lame_mu},
                            {c1, bulk_modulus},
                            {c1, lame_lambda}},
         .admissible = "mu > 0, lambda >= 0 (Poisson's ratio from 0 to below 0.5)",
         .use = "Soft tissue at moderate strains (some 50 %); the sensible first choice.",
         .limits = "ln^2 J turns concave when a volume grows beyond ln J = 1 + mu/lambda. For J "
                   "below inversion_threshold the volume term goes on as a parabola, which pushes "
                   "flat or inverted elements back; an element that collapsed to a point or a line "
                   "is not pushed back.",
         .shear_modulus = twice_c1,
         .make = [](const ElasticConstants& k, const ElasticParameters& p) -> physics::Law {
             return physics::NeoHookean{p[c1].value_or(k.mu / 2.0), lambda_of_logarithm(k)};
         }},
        {.key = "mooney-rivlin",
         .title = "Mooney-Rivlin, compressible, with logarithmic volume term",
         .energy = "w = c1 (I1 - 3) + c2 (I2 - 3) - (2 c1 + 4 c2) ln J + (lambda - 4 c2)/2 ln^2 J, "
                   " mu = 2 (c1 + c2)",
         .parameter_sets = {{c1, c2, bulk_modulus}, {c1, c2, lame_lambda}, {c1, c2, poisson}},
         .admissible =
             "c1 > 0, c2 >= 0, c2 <= lambda/4, where lambda and mu are the moduli at rest",
         .use = "Tissue for which both constants were measured; strains up to some 100 %.",
         .limits = "As neo-hookean. Moduli alone do not determine it: c1 and c2 must be given.",
         .shear_modulus = twice_c1_and_c2,
         .make = make_mooney_rivlin},
        {.key = "fung-demiray",
         .title = "Fung-Demiray: stiffens exponentially, with logarithmic volume term",
         .energy = "w = mu/(2 gamma) (exp(gamma (I1 - 3)) - 1) - mu ln J + (lambda - 2 mu gamma)/2 "
                   "ln^2 J",
         .parameter_sets = {{young, poisson, gamma},
                            {shear_modulus, bulk_modulus, gamma},
                            {lame_lambda, lame_mu, gamma}},
         .admissible = "mu > 0, gamma > 0, gamma <= lambda / (2 mu), where lambda and mu are the "
                       "moduli at rest",
         .use = "Tissue with collagen: skin, vessels, membranes, at strains up to some 50 %.",
         .limits = "As neo-hookean. The stable step is that at rest, and stiffness grows by "
                   "exp(gamma (I1 - 3)): lower dynamics.safety where gamma (I1 - 3) exceeds 1.",
         .make = make_fung_demiray},
        {.key = "ogden",
         .title = "Ogden: powers of the isochoric principal stretches, up to six terms",
         .energy = "w = sum 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + K/2 (J "
                   "- 1)^2,  l_k = J^(-1/3) times the principal stretches",
         .parameter_sets = {{bulk_modulus, terms}, {poisson, terms}, {lame_lambda, terms}},
         .admissible = "sum of the mu_i > 0, K > 0, alpha_i not 0",
         .use = "Tissue that was measured so: brain, fat, skin; stretches between a half and two.",
         .limits = "The mu_i add up to the shear modulus: many papers print mu_i alpha_i / 2 in "
                   "their place. Some ten times as costly as neo-hookean. Squared stretches below "
                   "the square of inversion_threshold follow a parabola.",
         .shear_modulus = sum_of_terms,
         .make = make_ogden},
        {.key = "neo-hookean-ciarlet",
         .title = "Neo-Hookean with Ciarlet's volume term, convex in J",
         .energy = "w = mu/2 (I1 - 3) - (mu + lambda/2) ln J + lambda/4 (J^2 - 1)",
         .parameter_sets = {{young, poisson},
                            {shear_modulus, bulk_modulus},
                            {lame_lambda, lame_mu}},
         .admissible = "mu > 0, lambda >= 0 (Poisson's ratio from 0 to below 0.5)",
         .use = "As neo-hookean, where volumes grow much.",
         .limits = "As neo-hookean, but for the growth of volume.",
         .make = [](const ElasticConstants& k, const ElasticParameters&) -> physics::Law {
             return physics::CiarletNeoHookean{k.mu, lambda_of_logarithm(k)};
         }},
        {.key = "neo-hookean-isochoric",
         .title = "Neo-Hookean in the isochoric strain: change of shape and of volume have "
                  "energies of their own",
         .energy = "w = c1 (I1 J^(-2/3) - 3) + K/2 (J - 1)^2,  c1 = mu / 2",
         .parameter_sets = {{young, poisson},
                            {shear_modulus, bulk_modulus},
                            {lame_lambda, lame_mu},
                            {c1, bulk_modulus}},
         .admissible = "mu > 0, K > 0",
         .use = "Nearly incompressible tissue; to compare with programs that use this form.",
         .limits = "The energy at zero volume is finite. Below inversion_threshold the powers of J "
                   "go on as parabolas.",
         .shear_modulus = twice_c1,
         .make = make_isochoric_mooney_rivlin},
        {.key = "mooney-rivlin-isochoric",
         .title = "Mooney-Rivlin in the isochoric strain",
         .energy =
             "w = c1 (I1 J^(-2/3) - 3) + c2 (I2 J^(-4/3) - 3) + K/2 (J - 1)^2,  mu = 2 (c1 + c2)",
         .parameter_sets = {{c1, c2, bulk_modulus}, {c1, c2, lame_lambda}, {c1, c2, poisson}},
         .admissible = "c1 > 0, c2 >= 0, K > 0",
         .use = "As mooney-rivlin, nearly incompressible tissue.",
         .limits = "As neo-hookean-isochoric.",
         .shear_modulus = twice_c1_and_c2,
         .make = make_isochoric_mooney_rivlin},
        {.key = "fung-demiray-isochoric",
         .title = "Fung-Demiray in the isochoric strain: any gamma",
         .energy = "w = mu/(2 gamma) (exp(gamma (I1 J^(-2/3) - 3)) - 1) + K/2 (J - 1)^2",
         .parameter_sets = {{young, poisson, gamma},
                            {shear_modulus, bulk_modulus, gamma},
                            {lame_lambda, lame_mu, gamma}},
         .admissible = "mu > 0, gamma > 0, K > 0",
         .use = "As fung-demiray, nearly incompressible tissue.",
         .limits = "As fung-demiray and neo-hookean-isochoric.",
         .make = [](const ElasticConstants& k, const ElasticParameters& p) -> physics::Law {
             return physics::IsochoricFungDemiray{k.mu, *p[gamma], k.bulk_modulus()};
         }},
        {.key = "stable-neo-hookean",
         .title = "Neo-Hookean without a trap: elements come back from flat, inverted and "
                  "collapsed states",
         .energy = "w = mu'/2 (I1 - 3 - ln((I1 + 1)/4)) - 3/4 mu' (J - 1) + lambda'/2 (J - 1)^2,  "
                   "mu' = 4/3 mu, lambda' = lambda + 5/6 mu",
         .parameter_sets = {{young, poisson},
                            {shear_modulus, bulk_modulus},
                            {lame_lambda, lame_mu}},
         .admissible = "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
         .use = "Tissue that tools crush or turn inside out. Near rest it is neo-hookean.",
         .limits =
             "The energy at zero volume is finite: strong compression inverts elements, which "
             "then come back. A body can be wound up so that no element is inverted, say "
             "twice round an edge: that no law undoes; the nearer Poisson's ratio is to 0.5, "
             "the more often it happens. inversion_threshold matters to viscosity only.",
         .make = [](const ElasticConstants& k, const ElasticParameters&) -> physics::Law {
             return physics::StableNeoHookean::of_rest_moduli(k.lambda, k.mu);
         }},
        {.key = "yeoh",
         .title = "Yeoh: a polynomial of the isochoric I1, which stiffens with strain",
         .energy = "w = c1 (I1 J^(-2/3) - 3) + c2 (I1 J^(-2/3) - 3)^2 + c3 (I1 J^(-2/3) - 3)^3 + "
                   "K/2 (J - 1)^2,  c1 = mu / 2",
         .parameter_sets = {{c1, c2, c3, bulk_modulus}, {c1, c2, c3, poisson}},
         .admissible = "c1 > 0, c2 >= 0, c3 >= 0, K > 0",
         .use = "Tissue that stiffens, less abruptly than by an exponential.",
         .limits = "As neo-hookean-isochoric.",
         .shear_modulus = twice_c1,
         .make = [](const ElasticConstants& k, const ElasticParameters& p) -> physics::Law {
             return physics::Yeoh{*p[c1], *p[c2], *p[c3], k.bulk_modulus()};
         }},
        {.key = "holzapfel-gasser-ogden",
         .title = "Holzapfel-Gasser-Ogden: neo-Hookean ground substance, one family of fibres",
         .energy = "w = mu/2 (I1 J^(-2/3) - 3) + K/2 (J - 1)^2 + k1/(2 k2) (exp(k2 E^2) - 1), the "
                   "last for E > 0 only,  E = kappa (I1 - 3) + (1 - 3 kappa) (I4 - 1)",
         .parameter_sets = {{young, poisson, k1, k2},
                            {shear_modulus, bulk_modulus, k1, k2},
                            {lame_lambda, lame_mu, k1, k2},
                            {c1, bulk_modulus, k1, k2}},
         .optional = {dispersion},
         .admissible =
             "mu > 0, K > 0 (both of the ground substance), k1 > 0, k2 > 0, 0 <= kappa <= 1/3",
         .use = "Tissue with collagen fibres in one direction: skin along its lines, tendon, "
                "muscle, one layer of a vessel. Needs fibre or fibre_array.",
         .limits = "Fibres carry tension only. The stable step is that at rest with the fibres "
                   "taut; they stiffen by exp(k2 E^2): lower dynamics.safety where k2 E^2 exceeds "
                   "0.1. Below inversion_threshold the power of J goes on as a parabola.",
         .has_fibres = true,
         .shear_modulus = twice_c1,
         .make = [](const ElasticConstants& k, const ElasticParameters& p) -> physics::Law {
             return physics::HolzapfelGasserOgden{k.mu, k.bulk_modulus(), *p[k1], *p[k2],
                                                  p[dispersion].value_or(0.0)};
         }},
    };
    return table;
}

constexpr std::array<std::string_view, 3> method_table = {"heml", "mass-spring", "hybmss"};

}  // namespace

std::span<const ParameterInfo> parameters() { return parameter_table; }

const ParameterInfo& info(Parameter parameter) {
    return parameter_table[static_cast<std::size_t>(parameter)];
}

std::span<const MaterialModel> laws() { return law_table(); }

const MaterialModel& law_named(std::string_view key) {
    const auto& table = law_table();
    const auto row = std::find_if(table.begin(), table.end(),
                                  [&](const MaterialModel& law) { return law.key == key; });
    if (row == table.end()) throw std::invalid_argument("no law '" + std::string(key) + "'");
    return *row;
}

const MaterialModel& mass_spring_model() {
    static const MaterialModel table = {
        .key = "mass-spring",
        .title = "Springs along the edges: the classical baseline",
        .energy =
            "W = sum over edges of k/2 (l - L)^2, k the sum of young V / L^2 over the elements "
            "there",
        .parameter_sets = {{young}},
        .admissible = "young > 0",
        .use = "Comparison with the classical method, not for predictions.",
        .limits =
            "Springs that pull along their own direction fix Poisson's ratio near 1/4 and the "
            "volume is not kept; stiffness depends on the mesh. So a law, poisson and the other "
            "moduli are refused."};
    return table;
}

const MaterialModel& hybmss_model() {
    static const MaterialModel table = {
        .key = "hybmss",
        .title = "Hybrid mass-spring system on hexahedra: springs and a term of volume",
        .energy =
            "W = sum over springs of k/2 (l - L)^2 + kappa V/2 (V'/V - 1)^2 a cell, kappa = K - 5 "
            "G / 3",
        .parameter_sets = {{young, poisson}, {shear_modulus, bulk_modulus}, {lame_lambda, lame_mu}},
        .admissible = "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
        .use =
            "Voxels and grids: hexahedra that are cubes, or boxes with edges of at most 1.4 to 1; "
            "strains of some 10 %, nearly incompressible tissue too. stiffness_ratio = inf for "
            "bodies that are cut.",
        .limits =
            "Below a Poisson's ratio of 1/4 kappa is negative and tension is lost at large strain: "
            "at a stretch of 1.2 for 0, 1.37 for 0.1, 1.6 for 0.15, 2.3 for 0.2 along one axis, of "
            "1.1, 1.16, 1.22 and 1.37 all round, sooner for negative ratios. Without face "
            "diagonals (stiffness_ratio = 0) bodies wrinkle under any load. Inverted cells may "
            "stay inverted."};
    return table;
}

const MaterialModel& model(Method method, std::string_view law) {
    switch (method) {
        case Method::mass_spring:
            return mass_spring_model();
        case Method::hybmss:
            return hybmss_model();
        case Method::heml:
            break;
    }
    return law_named(law);
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

std::string list_of_parameters(const MaterialModel& model) {
    std::string text = list_of_sets(model.parameter_sets);
    if (!model.optional.empty())
        text += "; " + list_of_sets({&model.optional, 1}) + " may be added";
    return text;
}

}  // namespace incise::scenario
