// incise check: every problem of scenarios and meshes, without changing anything.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iostream>
#include <set>

#include "app/messages.h"
#include "app/verbs.h"
#include "io/mesh_reader.h"
#include "io/number_format.h"
#include "sim/scenario_reader.h"
#include "topology/error.h"
#include "topology/mesh.h"
#include "topology/mesh_check.h"

namespace incise::app {

namespace {

struct Findings {
    std::vector<std::string> errors, warnings;
    std::string summary;  ///< meaningful without errors
};

std::string count_of(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

Findings check_mesh(const std::filesystem::path& path, const std::string& region_array) {
    const std::string prefix = path.string() + ": ";
    Findings findings;
    try {
        const auto file = io::read_mesh(path, {region_array});
        for (const auto& warning : file.warnings) findings.warnings.push_back(prefix + warning);
        auto found = topology::check(file.mesh);
        // What is odd about the connections is known only once they are made.
        if (found.errors.empty()) found.warnings = topology::Mesh::build(file.mesh).warnings;
        for (const auto& warning : found.warnings) findings.warnings.push_back(prefix + warning);
        for (const auto& error : found.errors) findings.errors.push_back(prefix + error);
        const std::set<int> regions(file.mesh.regions.begin(), file.mesh.regions.end());
        findings.summary = "mesh with " + count_of(file.mesh.points.size(), "point") + ", " +
                           count_of(file.mesh.num_cells(), "cell") + ", " +
                           count_of(regions.size(), "region");
    } catch (const InputError& error) {
        findings.errors.emplace_back(error.what());
    }
    return findings;
}

/// The scenario and what it describes, as far as it can be read.
Findings check_scenario(const std::filesystem::path& path) {
    auto [scenario, errors, warnings] = sim::read_scenario(path);
    Findings findings{std::move(errors), std::move(warnings), {}};
    add_body_findings(scenario, findings.errors, findings.warnings);
    findings.summary = "scenario of " + io::format_number(scenario.dynamics.end_time) + " s with " +
                       count_of(scenario.materials.size(), "material") + ", " +
                       count_of(scenario.constraints.size(), "constraint") + ", " +
                       count_of(scenario.loads.size(), "load") + ", " +
                       count_of(scenario.tools.size(), "tool");
    return findings;
}

}  // namespace

int check(const CheckOptions& options) {
    int status = done;
    for (const auto& file : options.files) {
        const auto findings =
            file.extension() == ".toml" ? check_scenario(file) : check_mesh(file, "region");
        for (const auto& warning : findings.warnings) print_warning(warning);
        for (const auto& error : findings.errors) print_error(error);
        if (!findings.errors.empty()) {
            status = input_at_fault;
            std::cout << file.string() << ": " << count_of(findings.errors.size(), "problem")
                      << std::endl;
        } else {
            std::cout << file.string() << ": OK, " << findings.summary << std::endl;
        }
    }
    return status;
}

}  // namespace incise::app
