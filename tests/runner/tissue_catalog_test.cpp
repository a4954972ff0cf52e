// Tissues: sound rows, the published values, and what a scenario makes of a preset.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tissue_catalog.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <sstream>

#include "incise/scenario/elastic_constants.h"
#include "run_folder.h"
#include "support/num_cases.h"
#include "tests/scenario/scenario_file.h"

namespace incise::runner {
namespace {

using enum Parameter;

ElasticConstants constants_of(std::string_view key) {
    const Tissue* tissue = find_tissue(key);
    EXPECT_NE(tissue, nullptr) << key;
    return resolve(Method::heml, tissue->law, tissue->parameters);
}

std::string material_with(const std::string& lines) {
    return "[[material]]\n" + lines +
           "\n[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\n[dynamics]\nend_time = 1\n";
}

MaterialSpec read(const std::string& lines) {
    const auto report = ScenarioFile(material_with(lines)).read();
    EXPECT_EQ(report.errors, std::vector<std::string>{}) << lines;
    return report.scenario.materials.at(0);
}

std::string error_of(const std::string& lines) {
    std::string all;
    for (const auto& error : ScenarioFile(material_with(lines)).errors())
        all += (all.empty() ? "" : " | ") + error;
    return all;
}

std::string preset(std::string_view key) { return "preset = \"" + std::string(key) + "\"\n"; }

void expect_equal(const MaterialSpec& a, const MaterialSpec& b) {
    EXPECT_EQ(a.method, b.method);
    EXPECT_EQ(a.law, b.law);
    EXPECT_EQ(a.density, b.density);
    EXPECT_EQ(a.parameters.values, b.parameters.values);
    ASSERT_EQ(a.parameters.terms.size(), b.parameters.terms.size());
    for (std::size_t i = 0; i < a.parameters.terms.size(); ++i) {
        EXPECT_EQ(a.parameters.terms[i].mu, b.parameters.terms[i].mu);
        EXPECT_EQ(a.parameters.terms[i].alpha, b.parameters.terms[i].alpha);
    }
    EXPECT_EQ(a.prony, b.prony);
}

TEST(TissueCatalog, HasSoundRowsWithSources) {
    EXPECT_GE(tissues().size(), 10u);
    std::set<std::string_view> names;
    for (const auto& law : laws()) names.insert(law.key);
    names.insert(mass_spring_model().key);
    names.insert(hybmss_model().key);
    for (const auto& tissue : tissues()) {
        SCOPED_TRACE(tissue.key);
        EXPECT_TRUE(names.insert(tissue.key).second);
        EXPECT_EQ(find_tissue(tissue.key), &tissue);
        for (const auto text :
             {tissue.title, tissue.source, tissue.density_source, tissue.validity})
            EXPECT_FALSE(text.empty());
        EXPECT_NO_THROW(make_law(tissue.law, tissue.parameters));
        EXPECT_GT(constants_of(tissue.key).bulk_modulus(), 0.0);
        // Densities of bodies, in kg/m3, and moduli of soft ones: a slip of units shows here.
        EXPECT_GE(tissue.density, 900.0);
        EXPECT_LE(tissue.density, 2500.0);
        EXPECT_GE(constants_of(tissue.key).mu, 10.0);
        EXPECT_LE(constants_of(tissue.key).mu, 1e6);
        double sum = 0.0;
        for (const auto& term : tissue.prony) {
            EXPECT_GT(term.alpha, 0.0);
            EXPECT_GT(term.tau, 0.0);
            sum += term.alpha;
        }
        EXPECT_LT(sum, 1.0);
        if (tissue.toughness) {
            EXPECT_LE(tissue.toughness->low, tissue.toughness->high);
        }
    }
    EXPECT_EQ(find_tissue("spleen"), nullptr);
}

/// By hand: mu = E / (2 (1 + nu)), lambda = 2 mu nu / (1 - 2 nu), mu = 2 (c1 + c2).
TEST(TissueCatalog, HasThePublishedModuli) {
    EXPECT_EQ(find_tissue("liver")->law, "neo-hookean");
    EXPECT_NEAR(constants_of("liver").mu, 1600.0 / 2.96, 1e-9);  // 540.5
    EXPECT_NEAR(constants_of("liver").lambda, 12973.0, 0.03);
    EXPECT_NEAR(constants_of("brain").mu, 1034.5, 0.02);
    EXPECT_NEAR(constants_of("brain-tumour").young(), 30e3, 1e-6);
    EXPECT_NEAR(constants_of("kidney").young(), 15e3, 1e-6);
    EXPECT_NEAR(constants_of("kidney").poisson(), 0.49, 1e-12);
    EXPECT_EQ(constants_of("fat").mu, 530.0);
    EXPECT_EQ(constants_of("skeletal-muscle").mu, 7350.0);
    EXPECT_EQ(constants_of("parturient-abdomen").mu, 10e3);
    EXPECT_EQ(constants_of("fetus").mu, 140e3);
    EXPECT_EQ(constants_of("skin").mu, 10.0);
    EXPECT_NEAR(constants_of("uterus").young(), 480e3, 1e-6);
    EXPECT_NEAR(constants_of("breast").young(), 3200.0, 1e-9);
    EXPECT_NEAR(constants_of("breast-fibroadenoma").young(), 2.0 * 3200.0, 1e-9);
    EXPECT_NEAR(constants_of("breast-carcinoma").young(), 13.0 * 3200.0, 1e-8);

    EXPECT_EQ(find_tissue("parturient-abdomen")->density, 2500.0);
    EXPECT_EQ(find_tissue("fetus")->density, 950.0);
    EXPECT_EQ(find_tissue("skin")->toughness->high, 30400.0);
    EXPECT_EQ(find_tissue("fat")->prony, (std::vector<physics::PronyTerm>{{0.39, 700.0}}));
    EXPECT_EQ(find_tissue("skeletal-muscle")->prony,
              (std::vector<physics::PronyTerm>{{0.549, 6.01}}));
}

/// "10 times the shear modulus" and "Poisson's ratio 0.452", as `assumed` says.
TEST(TissueCatalog, KeepsTheCompressibilityThatItStates) {
    for (const auto* key : {"fat", "skeletal-muscle", "parturient-abdomen", "fetus"}) {
        const auto constants = constants_of(key);
        EXPECT_NEAR(constants.bulk_modulus(), 10.0 * constants.mu, 1e-9 * constants.mu) << key;
        EXPECT_NEAR(constants.poisson(), 14.0 / 31.0, 1e-12) << key;
    }
}

/// As the documentation prints numbers: whole ones without exponent.
std::string plain(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", value);
    return text;
}

TEST(TissueCatalog, IsWhatTheDocumentationLists) {
    std::istringstream document(support::read_text(
        std::filesystem::path(INCISE_DATA_DIR).parent_path() / "docs/scenario.md"));
    for (std::string line; line != "### Tissues" && std::getline(document, line);) continue;
    std::vector<std::string> rows;
    for (std::string line; std::getline(document, line) && line != "## [dynamics]";)
        if (line.starts_with("| `")) rows.push_back(line);
    ASSERT_EQ(rows.size(), tissues().size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Tissue& tissue = tissues()[i];
        SCOPED_TRACE(tissue.key);
        std::vector<std::string> wanted = {
            "| `" + std::string(tissue.key) + "` ",
            "| `" + std::string(tissue.law) + "` | " + plain(tissue.density) + " |"};
        for (const auto& row : parameters())
            if (tissue.parameters[row.parameter] && row.parameter != terms)
                wanted.push_back("`" + std::string(row.key) + "` " +
                                 plain(*tissue.parameters[row.parameter]));
        for (const auto& term : tissue.parameters.terms)
            wanted.push_back("`mu` " + plain(term.mu) + " and `alpha` " + plain(term.alpha));
        for (const auto& term : tissue.prony)
            wanted.push_back("`alpha` " + plain(term.alpha) + ", `tau` " + plain(term.tau));
        for (const auto& text : wanted) EXPECT_NE(rows[i].find(text), std::string::npos) << text;
    }
}

TEST(Preset, StandsForItsScenarioLines) {
    for (const auto& tissue : tissues()) {
        SCOPED_TRACE(tissue.key);
        std::string lines;
        for (const auto& line : scenario_lines(tissue)) lines += line + "\n";
        expect_equal(read(preset(tissue.key)), read(lines));
    }
}

TEST(Preset, YieldsToWhatTheScenarioGives) {
    const auto denser = read(preset("liver") + "density = 1100");
    EXPECT_EQ(denser.density, 1100.0);
    EXPECT_EQ(denser.law, "neo-hookean");
    EXPECT_EQ(denser.parameters[young], 1600.0);

    const auto stiffer = read(preset("liver") + "young = 8000");
    EXPECT_EQ(stiffer.density, 1060.0);
    EXPECT_EQ(stiffer.parameters[young], 8000.0);
    EXPECT_EQ(stiffer.parameters[poisson], 0.48);

    const auto other_law = read(preset("liver") + "law = \"saint-venant-kirchhoff\"");
    EXPECT_EQ(other_law.law, "saint-venant-kirchhoff");
    EXPECT_EQ(other_law.parameters[young], 1600.0);

    const auto own_set = read(preset("liver") + "shear_modulus = 600\nbulk_modulus = 6000");
    EXPECT_EQ(own_set.parameters[shear_modulus], 600.0);
    EXPECT_FALSE(own_set.parameters[young].has_value());

    const auto own_law =
        read(preset("fat") + "law = \"mooney-rivlin\"\nc1 = 100\nc2 = 20\npoisson = 0.45");
    EXPECT_EQ(own_law.law, "mooney-rivlin");
    EXPECT_FALSE(own_law.parameters[bulk_modulus].has_value());

    // Together with the preset's c1 and bulk_modulus a set of the other law.
    const auto joined = read(preset("fetus") + "law = \"mooney-rivlin\"\nc2 = 20e3");
    EXPECT_EQ(joined.parameters[c1], 70e3);

    const auto terms = read(preset("skin") + "terms = [{ mu = 200, alpha = 30 }]");
    ASSERT_EQ(terms.parameters.terms.size(), 1u);
    EXPECT_EQ(terms.parameters.terms[0].mu, 200.0);
    EXPECT_EQ(terms.parameters[bulk_modulus], 100e3);
    const auto no_terms =
        read(preset("skin") + "law = \"neo-hookean\"\nyoung = 4e4\npoisson = 0.45");
    EXPECT_TRUE(no_terms.parameters.terms.empty());

    EXPECT_EQ(read(preset("fat") + "prony = [{ alpha = 0.2, tau = 1 }]").prony,
              (std::vector<physics::PronyTerm>{{0.2, 1.0}}));
    EXPECT_TRUE(read(preset("fat") + "prony = []").prony.empty());
}

TEST(Preset, OfOtherMethodsGivesWhatTheyTake) {
    const auto springs = read(preset("liver") + "method = \"mass-spring\"");
    EXPECT_EQ(springs.density, 1060.0);
    EXPECT_EQ(springs.parameters[young], 1600.0);
    EXPECT_FALSE(springs.parameters[poisson].has_value());
    EXPECT_EQ(read(preset("fetus") + "method = \"mass-spring\"\nyoung = 4e5").density, 950.0);
    const auto hybrid = read(preset("kidney") + "method = \"hybmss\"");
    EXPECT_EQ(hybrid.parameters[young], 15e3);
    EXPECT_EQ(hybrid.parameters[poisson], 0.49);
    EXPECT_TRUE(read(preset("fat") + "method = \"hybmss\"").prony.empty());
}

TEST(Preset, RefusesWhatMakesNoWholeSet) {
    EXPECT_EQ(error_of(preset("fetus") + "young = 1000"),
              "scene.toml:2:10: key 'material[0].preset': 'fetus' has bulk_modulus + c1, the "
              "scenario gives young; but neo-hookean takes young + poisson, or shear_modulus + "
              "bulk_modulus, or lame_lambda + lame_mu, or c1 + bulk_modulus, or c1 + lame_lambda: "
              "give values for what the preset has, or one whole set");
    EXPECT_EQ(error_of(preset("liver") + "law = \"mooney-rivlin\""),
              "scene.toml:2:10: key 'material[0].preset': 'liver' has young + poisson; but "
              "mooney-rivlin takes c1 + c2 + bulk_modulus, or c1 + c2 + lame_lambda, or c1 + c2 + "
              "poisson: give values for what the preset has, or one whole set");
    for (const auto* method : {"mass-spring", "hybmss"})
        EXPECT_NE(
            error_of(preset("fetus") + "method = \"" + method + "\"")
                .find("'fetus' has bulk_modulus + c1; but " + std::string(method) + " takes young"),
            std::string::npos);
    EXPECT_NE(error_of(preset("liver") + "young = 1000\nc1 = 3").find("gives young + c1"),
              std::string::npos);
    // Admissibility is that of the completed set.
    EXPECT_NE(error_of(preset("skeletal-muscle") + "c2 = 20e3").find("at most a quarter"),
              std::string::npos);
    EXPECT_NE(error_of(preset("liver") + "method = \"mass-spring\"\npoisson = 0.3")
                  .find("'material[0].poisson': is not used by the mass-spring method"),
              std::string::npos);
}

TEST(Preset, NamesTheNearestTissue) {
    const auto error = error_of(preset("livr"));
    EXPECT_EQ(error.find("scene.toml:2:10: key 'material[0].preset': 'livr': is not known; did you "
                         "mean 'liver'? Known here: liver, kidney, "),
              0u)
        << error;
    EXPECT_EQ(error.find(" | "), std::string::npos);  // nothing about density besides
    EXPECT_NE(error_of("preset = 3").find("must be text in quotes"), std::string::npos);
}

/// A small cube under its weight, pressed and let go.
TEST(Preset, RunsStably) {
    for (const auto& tissue : tissues()) {
        SCOPED_TRACE(tissue.key);
        const double pressure = 0.05 * constants_of(tissue.key).young();
        auto text =
            "[mesh]\nbox = { size = [0.02, 0.02, 0.02], cells = [3, 3, 3] }\n[[material]]\n" +
            preset(tissue.key) + dynamics(1e3, "gravity = [0, 0, -9.81]\n") +
            "[[constraint]]\nwhere = { half_space = { point = [0, 0, 0], normal = [0, 0, "
            "-1] } }\nfix = \"xyz\"\n[[load]]\nwhere = { half_space = { point = [0, 0, "
            "0.02], normal = [0, 0, 1] } }\npressure = " +
            std::to_string(pressure) + "\n";
        Simulation simulation(scenario_of(text));
        simulation.start();
        for (int i = 0; i < test::num_cases(300); ++i) simulation.step();
        // NaN fails both.
        EXPECT_GT(simulation.model().energetics().min_volume_ratio(), 0.3);
        EXPECT_LT(simulation.model().max_displacement(), 0.02);
        // The error oscillates with the motion, as it is of first order in the step.
        EXPECT_LT(simulation.ledger().energy_error(), 0.1);
    }
}

}  // namespace
}  // namespace incise::runner
