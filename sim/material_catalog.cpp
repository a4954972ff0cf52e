// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/material_catalog.h"

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
}};

const std::array<MaterialModel, 3>& law_table() {
    static const std::array<MaterialModel, 3> table = {{
        {"saint-venant-kirchhoff",
         "Saint Venant-Kirchhoff: Hooke's law in Green's strain",
         "w = lambda/2 (tr E)^2 + mu tr(E^2),  E = (F^T F - 1) / 2",
         {{young, poisson}, {shear_modulus, bulk_modulus}, {lame_lambda, lame_mu}},
         "mu > 0, K > 0 (any Poisson's ratio between -1 and 0.5)",
         "Large rotations with small strains (some 10 %). The cheapest law.",
         "Softens in compression and collapses below a stretch of 0.577; its energy at zero "
         "volume is finite, so it does not resist inversion; at Poisson's ratios near 0.5 it "
         "does not keep the volume at large strain. Prefer neo-hookean where tissue is "
         "compressed strongly."},
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
         "pushed back."},
        {"mooney-rivlin",
         "Mooney-Rivlin, compressible, with logarithmic volume term",
         "w = c1 (I1 - 3) + c2 (I2 - 3) - (2 c1 + 4 c2) ln J + (lambda - 4 c2)/2 ln^2 J,  mu "
         "= 2 (c1 + c2)",
         {{c1, c2, bulk_modulus}, {c1, c2, lame_lambda}, {c1, c2, poisson}},
         "c1 > 0, c2 >= 0, c2 <= lambda/4, where lambda and mu are the moduli at rest",
         "Tissue for which both constants were measured; strains up to some 100 %.",
         "As neo-hookean. Moduli alone do not determine it: c1 and c2 must be given."},
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
        "Voxels and grids: hexahedra that are cubes, or boxes with edges of at most 1.7 to 1; "
        "strains of some 10 %, nearly incompressible tissue too. stiffness_ratio = inf for bodies "
        "that are cut or stand beside other elements.",
        "Below a Poisson's ratio of 1/4 kappa is negative and tension is lost at large strain: at "
        "a "
        "stretch of 1.2 for 0, 1.37 for 0.1, 1.6 for 0.15, 2.3 for 0.2. Without face diagonals "
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
