// incise check: reports every problem of scenarios and meshes without changing anything.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <iostream>
#include <new>
#include <set>

#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/io/files/number_format.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/scenario_reader.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"

namespace incise::app {

namespace {

struct Findings {
    std::vector<std::string> errors, warnings;
    std::string summary;  ///< meaningful only without errors
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
        auto found = topology::check(file.mesh, scenario::weld_advice());
        // Warnings about connections exist only after the mesh is built.
        if (found.errors.empty())
            found.warnings = topology::Mesh::build(file.mesh, scenario::weld_advice()).warnings;
        for (const auto& warning : found.warnings) findings.warnings.push_back(prefix + warning);
        for (const auto& error : found.errors) findings.errors.push_back(prefix + error);
        const std::set<int> regions(file.mesh.regions.begin(), file.mesh.regions.end());
        findings.summary = "mesh with " + count_of(file.mesh.points.size(), "point") + ", " +
                           count_of(file.mesh.num_cells(), "cell") + ", " +
                           count_of(regions.size(), "region");
    } catch (const io::UnknownFormat& error) {
        findings.errors.push_back(std::string(error.what()) +
                                  "; if it is a scenario, let its name end in .toml");
    } catch (const InputError& error) {
        findings.errors.emplace_back(error.what());
    }
    return findings;
}

/// Checks the scenario, and its body as far as the scenario can be read.
Findings check_scenario(const std::filesystem::path& path) {
    auto [scenario, errors, warnings] = scenario::read_scenario(path);
    Findings findings{std::move(errors), std::move(warnings), {}};
    add_body_findings(scenario, findings.errors, findings.warnings);
    findings.summary = "scenario of " + io::format_number(scenario.dynamics.end_time) + " s with " +
                       count_of(scenario.materials.size(), "material") + ", " +
                       count_of(scenario.constraints.size(), "constraint") + ", " +
                       count_of(scenario.loads.size(), "load") + ", " +
                       count_of(scenario.tools.size(), "tool");
    return findings;
}

Findings check_file(const std::filesystem::path& file) {
    return file.extension() == ".toml" ? check_scenario(file) : check_mesh(file, "region");
}

int print(const std::filesystem::path& file, const Findings& findings) {
    for (const auto& warning : findings.warnings) print_warning(warning);
    for (const auto& error : findings.errors) print_error(error);
    if (findings.errors.empty()) {
        std::cout << file.string() << ": OK, " << findings.summary << std::endl;
        return done;
    }
    std::cout << file.string() << ": " << count_of(findings.errors.size(), "problem") << std::endl;
    return input_at_fault;
}

int print_lack_of_memory(const std::filesystem::path& file, const std::string& text) {
    print_error(text);
    std::cout << file.string() << ": too large for this machine" << std::endl;
    return out_of_memory;
}

int check(const std::filesystem::path& file) {
    try {
        return print(file, check_file(file));
    } catch (const MemoryError& error) {
        return print_lack_of_memory(file, error.what());
    } catch (const std::bad_alloc&) {
        return print_lack_of_memory(
            file, file.string() + ": out of memory: the mesh is too large for this machine");
    }
}

}  // namespace

int check(const CheckOptions& options) {
    int status = done;
    for (const auto& file : options.files) status = std::max(status, check(file));
    return status;
}

}  // namespace incise::app
