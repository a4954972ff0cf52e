// incise check: reports every problem of scenarios, meshes and surfaces without changing anything.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iostream>
#include <new>
#include <set>

#include "incise/app/image_info.h"
#include "incise/app/messages.h"
#include "incise/app/progress.h"
#include "incise/app/surface_info.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/image/label_image.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/scenario/distorted_cells.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/scenario_reader.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"

namespace incise::app {

namespace {

struct Findings {
    std::vector<std::string> errors, warnings;
    std::string summary;                  ///< meaningful only without errors
    std::string effort;                   ///< of the run, as far as it is known
    std::vector<std::string> joins = {};  ///< see topology::BuiltMesh
    std::size_t num_printed = 0;          ///< of the errors, the first
};

std::string count_of(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

Findings check_mesh(const std::filesystem::path& path, const MeshInput& input) {
    const std::string prefix = path.string() + ": ";
    Findings findings;
    try {
        auto file = read_input(path, input);
        weld_input(file, input);
        for (const auto& warning : file.warnings) findings.warnings.push_back(prefix + warning);
        auto found = topology::check(file.mesh, scenario::weld_advice());
        // Warnings about connections exist only after the mesh is built.
        if (found.errors.empty()) {
            found.errors = scenario::distorted_cells(file.mesh, found);
            auto built = topology::Mesh::build(file.mesh, scenario::weld_advice());
            found.warnings = std::move(built.warnings);
            findings.joins = std::move(built.joins);
        }
        for (const auto& warning : found.warnings) findings.warnings.push_back(prefix + warning);
        for (const auto& error : found.errors) findings.errors.push_back(prefix + error);
        const std::set<int> regions(file.mesh.regions.begin(), file.mesh.regions.end());
        findings.summary = "mesh with " + count_of(num_points(file.mesh), "point") + ", " +
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

/// Tells that it takes a while to build a body, if it does.
void announce_body(const std::filesystem::path& path, const scenario::Scenario& scenario) {
    constexpr double many = 1e6;  // elements: some seconds
    const auto* box = std::get_if<scenario::BoxMeshSpec>(&scenario.mesh.source);
    if (!box) return;
    const double elements = (box->element == topology::CellKind::tetrahedron ? 6.0 : 1.0) *
                            box->cells[0] * box->cells[1] * box->cells[2];
    if (elements > many)
        std::cerr << path.string() << ": builds the body of " << format_number(elements)
                  << " elements, to check it\n";
}

/// Checks the scenario, and its body as far as the scenario can be read. What the scenario alone
/// tells is printed at once, as it takes long to build a large body.
Findings check_scenario(const std::filesystem::path& path) {
    auto [scenario, errors, warnings] = scenario::read_scenario(path);
    for (const auto& warning : warnings) print_warning(warning);
    for (const auto& error : errors) print_error(error);
    announce_body(path, scenario);
    const std::size_t num_printed = errors.size();
    Findings findings;
    findings.errors = std::move(errors);
    auto body = add_body_findings(scenario, findings.errors, findings.warnings);
    const auto& effort = body.effort;
    findings.joins = std::move(body.joins);
    findings.num_printed = num_printed;
    const auto num_obstacles = static_cast<std::size_t>(
        std::ranges::count_if(scenario.tools, [](const auto& tool) { return tool.is_obstacle; }));
    findings.summary = "scenario of " + format_number(scenario.dynamics.end_time) + " s with " +
                       count_of(scenario.materials.size(), "material") + ", " +
                       count_of(scenario.constraints.size(), "constraint") + ", " +
                       count_of(scenario.loads.size(), "load") + ", " +
                       count_of(scenario.tools.size() - num_obstacles, "tool");
    if (num_obstacles > 0) findings.summary += ", " + count_of(num_obstacles, "obstacle");
    constexpr double many_steps = 1e4;  // a shorter run needs no plan
    if (effort && (effort->num_steps >= many_steps || effort->seconds_of_forces >= 1.0))
        findings.effort =
            "some " + format_number(std::ceil(effort->num_steps)) +
            " steps at rest, more as tissue stretches; their forces take " +
            (effort->seconds_of_forces < 1.0 ? "less than a second"
                                             : duration_text(effort->seconds_of_forces)) +
            " on one core, and cuts and contact come on top";
    return findings;
}

/// Checks whether a body can be made of the surface. A surface that is not closed is no problem of
/// its own, as a cut may follow it.
Findings check_surface(const std::filesystem::path& path) {
    const std::string prefix = path.string() + ": ";
    Findings findings;
    try {
        const auto surface = surface_info(path);
        for (const auto& warning : surface.warnings) findings.warnings.push_back(prefix + warning);
        if (!surface.fault.empty())
            findings.warnings.push_back(prefix + surface.fault + ", to make a body of it");
        findings.summary = summary_of(surface);
    } catch (const InputError& error) {
        findings.errors.emplace_back(error.what());
    }
    return findings;
}

Findings check_image(const std::filesystem::path& path) {
    Findings findings;
    try {
        const auto image = image_info(path);
        for (const auto& warning : image.image.warnings)
            findings.warnings.push_back(path.string() + ": " + warning);
        findings.summary = summary_of(image);
    } catch (const InputError& error) {
        findings.errors.emplace_back(error.what());
    }
    return findings;
}

Findings check_file(const std::filesystem::path& file, const MeshInput& input) {
    if (io::has_surface_suffix(file)) return check_surface(file);
    if (io::has_image_suffix(file)) return check_image(file);
    return file.extension() == ".toml" ? check_scenario(file) : check_mesh(file, input);
}

int print(const std::filesystem::path& file, const Findings& findings) {
    for (const auto& warning : findings.warnings) print_warning(warning);
    for (std::size_t i = findings.num_printed; i < findings.errors.size(); ++i)
        print_error(findings.errors[i]);
    if (findings.errors.empty()) {
        std::cout << file.string() << ": OK, " << findings.summary << std::endl;
        for (const auto& line : findings.joins) std::cout << file.string() << ": " << line << '\n';
        if (!findings.effort.empty()) std::cerr << file.string() << ": " << findings.effort << '\n';
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

int check(const std::filesystem::path& file, const MeshInput& input) {
    try {
        return print(file, check_file(file, input));
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
    for (const auto& file : options.files) status = std::max(status, check(file, options.input));
    return status;
}

}  // namespace incise::app
