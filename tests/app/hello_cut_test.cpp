// What an example of the library prints is what the program says of the same scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iomanip>
#include <tuple>

#include "run_process.h"

namespace incise::test {
namespace {

std::string output_of(const std::string& command) {
    std::string output;
    FILE* pipe = popen(command.c_str(), "r");
    for (int c; (c = std::fgetc(pipe)) != EOF;) output += static_cast<char>(c);
    EXPECT_EQ(pclose(pipe), 0) << command;
    return output;
}

TEST_F(Run, OfHelloCutHasTheExamplesNumbers) {
    const auto outcome = run({INCISE_EXAMPLES "/hello_cut.toml", "--quiet", "--out", "scene.out"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json summary = json::parse(read_text(folder_ / "scene.out/summary.json"));
    std::ostringstream expected;
    for (const auto& [label, quantity, digits] :
         {std::tuple("elements", "elements", 5), std::tuple("components", "components", 5),
          std::tuple("cut area, m2", "cut_area", 5),
          std::tuple("kinetic energy, J", "kinetic_energy", 2)})
        expected << std::setprecision(digits) << label << ": " << summary.at(quantity).get<double>()
                 << '\n';
    EXPECT_EQ(output_of("cd '" + folder_.path().string() + "' && " HELLO_CUT), expected.str());
}

}  // namespace
}  // namespace incise::test
