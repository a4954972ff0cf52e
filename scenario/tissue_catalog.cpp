// The catalog of tissues. The function with the table is long, since it is data.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tissue_catalog.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

using enum Parameter;

ElasticParameters given(std::initializer_list<std::pair<Parameter, double>> values) {
    ElasticParameters parameters;
    for (const auto& [parameter, value] : values) parameters[parameter] = value;
    return parameters;
}

ElasticParameters ogden(std::initializer_list<physics::Ogden::Term> list, double bulk) {
    ElasticParameters parameters = given({{bulk_modulus, bulk}});
    parameters.terms = list;
    parameters[terms] = static_cast<double>(list.size());
    return parameters;
}

constexpr std::string_view kaye_and_laby =
    "Kaye and Laby, Tables of Physical and Chemical Constants";
constexpr std::string_view as_published = "As the parameters";
constexpr std::string_view assumed_compressibility =
    "The source takes the tissue as incompressible or does not say: bulk_modulus is 10 times the "
    "shear modulus (Poisson's ratio 0.452), a compromise between volume and time step.";
constexpr std::string_view assumed_poisson_and_law =
    "The source gives a modulus of small strain only: poisson, and the law that carries it to "
    "large strain, are chosen here.";

const std::vector<Tissue>& tissue_table() {
    static const std::vector<Tissue> table = {
        {"liver",
         "Liver, parenchyma",
         "neo-hookean",
         1060.0,
         kaye_and_laby,
         given({{young, 1600.0}, {poisson, 0.48}}),
         {},
         Range{76.0, 225.0},
         "Advanced Modeling and Simulation in Engineering Sciences 2015, "
         "doi:10.1186/s40323-015-0049-1",
         "Published model configuration of a surgical simulator; its authors call it a "
         "simplification that is to be validated. Elastic, no rate. It takes Saint "
         "Venant-Kirchhoff, whose elements turn inside out where the liver is compressed by its "
         "own weight; the neo-Hookean law has the same moduli at rest.",
         "The law."},
        {"kidney",
         "Kidney",
         "neo-hookean",
         1050.0,
         kaye_and_laby,
         given({{young, 15e3}, {poisson, 0.49}}),
         {},
         std::nullopt,
         "Linear limit of 0.2 % strain: Nasseri 2002; the modulus has no single source",
         "Provisional: a modulus of about 15 kPa. Kidney (pig) is linear up to some 0.2 % strain "
         "only; neither what comes beyond nor its dependence on rate is in this preset.",
         "The law."},
        {"brain",
         "Brain, white and grey matter as one",
         "neo-hookean",
         1036.0,
         kaye_and_laby,
         given({{young, 3e3}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Published model configurations of neurosurgical simulation",
         "Published model configuration, one modulus for the whole brain. Brain stiffens in "
         "compression and depends on rate; neither is in this preset. An Ogden model of the living "
         "human brain under "
         "gravity has a shear modulus of 670 Pa (PMC9748497), against 1034 Pa here.",
         "The law."},
        {"brain-tumour",
         "Brain tumour",
         "neo-hookean",
         1046.0,
         kaye_and_laby,
         given({{young, 30e3}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Published model configurations of neurosurgical simulation",
         "Published model configuration: ten times the modulus of the preset brain. Tumours "
         "differ widely.",
         "The law."},
        {"breast",
         "Breast, normal glandular or fatty tissue",
         "neo-hookean",
         1020.0,
         kaye_and_laby,
         given({{young, 3200.0}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Samani 2007; Teixeira 2023",
         "Human; small strain. Reported: 3.2 to 8.8 kPa; this is the lower end. "
         "Stiffens with strain, which is not in this preset.",
         assumed_poisson_and_law},
        {"breast-fibroadenoma",
         "Breast: fibroadenoma, a benign tumour",
         "neo-hookean",
         1020.0,
         kaye_and_laby,
         given({{young, 6400.0}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Samani 2007",
         "Human; small strain. Twice the modulus of the preset breast.",
         assumed_poisson_and_law},
        {"breast-carcinoma",
         "Breast: high-grade invasive carcinoma",
         "neo-hookean",
         1020.0,
         kaye_and_laby,
         given({{young, 41.6e3}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Samani 2007",
         "Human; small strain. 13 times the modulus of the preset breast, the "
         "stiffest tumours; others lie between this and breast-fibroadenoma.",
         assumed_poisson_and_law},
        {"fat",
         "Fat, subdermal",
         "neo-hookean",
         917.0,
         kaye_and_laby,
         given({{shear_modulus, 530.0}, {bulk_modulus, 5300.0}}),
         {{0.39, 700.0}},
         Range{4100.0, 4100.0},
         "Sims and others 2010, doi:10.1007/s10237-010-0207-9",
         "Pig; confined indentation seen by MRI, inverse finite elements. Shear modulus 530 +- "
         "310 Pa, alpha 0.39 +- 0.03, tau 700 +- 255 s: slow loading.",
         assumed_compressibility},
        {"skeletal-muscle",
         "Skeletal muscle, passive",
         "mooney-rivlin",
         1047.0,
         kaye_and_laby,
         given({{c1, 2500.0}, {c2, 1175.0}, {bulk_modulus, 73.5e3}}),
         {{0.549, 6.01}},
         Range{550.0, 8000.0},
         "Constants: model of facial muscles in the review PMC6305050 "
         "(doi:10.1155/2018/7631818, table 2). Relaxation: Bosboom and others 2001, "
         "doi:10.1016/S0021-9290(01)00083-5",
         "Human model, passive and isotropic: fibres and activation are not in it. Other models "
         "of the same review: c1 = 1650, c2 = 3350 (back); neo-Hookean with c1 of 1750 to 3750 Pa "
         "(thigh). The relaxation is of rat muscle in transverse compression and was fitted "
         "together with another law.",
         "That the two sources may be put together, and the moduli are those before relaxation. "
         "Neither gives a compressibility for this law: bulk_modulus is 10 times the shear "
         "modulus (Poisson's ratio 0.452)."},
        {"skin",
         "Skin",
         "ogden",
         1150.0,
         kaye_and_laby,
         ogden({{10.0, 40.0}}, 100e3),
         {},
         Range{1136.0, 30400.0},
         "Manan and others 2012",
         "Provisional. Human, in vivo, one subject, fitted with a model of two dimensions; "
         "isotropic. "
         "Very soft at rest: by this law the stiffness comes with tension and grows several "
         "thousandfold up to a stretch of 1.25. The time step is that of rest: lower "
         "dynamics.safety where skin is stretched further.",
         "That mu is the shear modulus at rest; in the other usual convention that would be mu "
         "alpha "
         "/ 2 = 200 Pa. No compressibility is given: bulk_modulus keeps the volume within some "
         "2 % up to a stretch of 1.25."},
        {"uterus",
         "Uterus: the muscle of its wall (myometrium)",
         "neo-hookean",
         1052.0,
         kaye_and_laby,
         given({{young, 480e3}, {poisson, 0.45}}),
         {},
         std::nullopt,
         "Pearsall and Roberts 1978",
         "Provisional. Excised tissue; tangent modulus under a tension of 69 kPa, reported: 0.48 "
         "to 1.38 "
         "MPa; this is the lower end. Tissue that is not under such tension is far softer.",
         assumed_poisson_and_law},
        {"parturient-abdomen",
         "Abdomen of a parturient woman",
         "neo-hookean",
         2500.0,
         as_published,
         given({{c1, 5e3}, {bulk_modulus, 100e3}}),
         {},
         std::nullopt,
         "HEML 2015 (doi:10.1016/j.cma.2015.06.015), section 5.2: model of the University of Lyon",
         "Published model configuration, all organs as one. The density is as published, two and "
         "a half times that of tissue.",
         assumed_compressibility},
        {"fetus",
         "Fetus",
         "neo-hookean",
         950.0,
         as_published,
         given({{c1, 70e3}, {bulk_modulus, 1.4e6}}),
         {},
         std::nullopt,
         "HEML 2015 (doi:10.1016/j.cma.2015.06.015), section 5.2: model of the University of Lyon",
         "Published model configuration: the whole fetus as one homogeneous body, bones included.",
         assumed_compressibility},
    };
    return table;
}

/// Returns rows as text, such as "{ a = 1, b = 2 }, { a = 3, b = 4 }".
template <class Row>
std::string inline_tables(const std::vector<Row>& rows, const std::string& first_key,
                          double Row::*first, const std::string& second_key, double Row::*second) {
    std::string text;
    for (const auto& row : rows) {
        text += text.empty() ? "{ " : ", { ";
        text += first_key + " = " + format_number(row.*first) + ", ";
        text += second_key + " = " + format_number(row.*second) + " }";
    }
    return text;
}

}  // namespace

const std::string_view toughness_source = "Chinese Journal of Mechanical Engineering 2022, table 2";

std::span<const Tissue> tissues() { return tissue_table(); }

const Tissue* find_tissue(std::string_view key) {
    const auto& table = tissue_table();
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Tissue& tissue) { return tissue.key == key; });
    return found != table.end() ? &*found : nullptr;
}

std::vector<std::string> scenario_lines(const Tissue& tissue) {
    std::vector<std::string> lines = {"law = \"" + std::string(tissue.law) + "\"",
                                      "density = " + format_number(tissue.density)};
    for (const auto& row : parameters())
        if (row.parameter == terms && !tissue.parameters.terms.empty())
            lines.push_back("terms = [" +
                            inline_tables(tissue.parameters.terms, "mu", &physics::Ogden::Term::mu,
                                          "alpha", &physics::Ogden::Term::alpha) +
                            "]");
        else if (const auto& value = tissue.parameters[row.parameter])
            lines.push_back(std::string(row.key) + " = " + format_number(*value));
    if (!tissue.prony.empty())
        lines.push_back("prony = [" +
                        inline_tables(tissue.prony, "alpha", &physics::PronyTerm::alpha, "tau",
                                      &physics::PronyTerm::tau) +
                        "]");
    return lines;
}

}  // namespace incise::scenario
