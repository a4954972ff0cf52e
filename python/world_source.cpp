// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/world_source.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "incise/base/error.h"
#include "incise/python/mesh.h"
#include "incise/python/values.h"
#include "incise/scenario/body.h"
#include "incise/scenario/body_problems.h"
#include "incise/scenario/scenario_reader.h"

namespace incise::python {

namespace {

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text.append(text.empty() ? "" : "\n").append(line);
    return text;
}

/// Returns the scenario of a report with its warnings. Throws InputError with all its problems and
/// those of the body, as the command line does.
scenario::Scenario sound(scenario::ScenarioReport report, std::vector<std::string>& warnings) {
    if (!report.errors.empty()) {
        try {
            const auto body = scenario::check_body(report.scenario);
            report.errors.insert(report.errors.end(), body.errors.begin(), body.errors.end());
        } catch (const MemoryError& error) {
            report.errors.emplace_back(error.what());
        }
        throw InputError(joined(report.errors));
    }
    warnings = std::move(report.warnings);
    return std::move(report.scenario);
}

/// What a world is made from.
struct Source {
    std::optional<scenario::Value> document;  ///< if not set, `file` is read
    std::filesystem::path file;
    std::vector<std::string> overrides;
    scenario::ForProgram program;
};

std::vector<std::string> texts_from(const py::object& overrides) {
    std::vector<std::string> texts;
    const bool is_list = py::isinstance<py::sequence>(overrides) &&
                         !py::isinstance<py::str>(overrides) &&
                         !py::isinstance<py::bytes>(overrides);
    if (is_list)
        for (const py::handle text : overrides)
            if (py::isinstance<py::str>(text)) texts.push_back(text.cast<std::string>());
    if (!is_list || texts.size() != py::len(overrides))
        throw py::type_error("overrides must be a list of texts, such as [\"dynamics.damping=3\"]");
    return texts;
}

scenario::Entry* find_entry(scenario::Table& table, std::string_view key) {
    const auto found = std::ranges::find(table, key, &scenario::Entry::key);
    return found == table.end() ? nullptr : &*found;
}

void set_entry(scenario::Table& table, const std::string& key, scenario::Value value) {
    if (scenario::Entry* entry = find_entry(table, key))
        entry->value = std::move(value);
    else
        table.push_back({key, {}, std::move(value)});
}

/// Puts the mesh of a scenario into its document: a dict, the name of a file, or an incise.Mesh.
void set_mesh(Source& source, const py::object& mesh) {
    auto& root = std::get<scenario::Table>(source.document->data);
    if (py::isinstance<PyMesh>(mesh)) {
        source.program.mesh = mesh.cast<std::shared_ptr<PyMesh>>()->data;
    } else if (py::isinstance<py::dict>(mesh)) {
        set_entry(root, "mesh", value_from(mesh, "mesh"));
    } else {
        set_entry(root, "mesh",
                  {scenario::Table{{"file", {}, {path_from(mesh).string(), {}}}}, {}});
    }
}

World make(Source source, int num_threads) {
    std::vector<std::string> warnings;
    World world;
    {
        const Unlocked unlocked;
        scenario::Scenario scenario = sound(
            source.document ? scenario::read_scenario(std::move(*source.document), source.file,
                                                      source.overrides, &source.program)
                            : scenario::read_scenario(source.file, source.overrides),
            warnings);
        try {
            world = std::make_shared<Handle>(std::move(scenario));
        } catch (const scenario::BodyError&) {
            throw;
        } catch (const InputError& error) {
            throw InputError(
                joined(scenario::prefixed_lines(source.file.string() + ": ", error.what())));
        }
        world->driver.world().set_num_threads(num_threads);
    }
    world->num_threads = num_threads;
    for (const std::string& warning : warnings) pass_warning(warning);
    pass_warnings(world);
    return world;
}

}  // namespace

World make_world(const py::object& scenario, const py::object& mesh, const py::object& materials,
                 const py::object& constraints, const py::object& loads, const py::object& tools,
                 const py::object& obstacles, const py::object& dynamics, const py::object& contact,
                 const py::object& output, const py::object& gravity, const py::object& damping,
                 const py::object& overrides, const py::object& folder, int num_threads,
                 const py::kwargs& unknown) {
    refuse_unknown(
        unknown, "World",
        {"scenario", "mesh", "materials", "constraints", "loads", "tools", "obstacles", "dynamics",
         "contact", "output", "gravity", "damping", "overrides", "folder", "num_threads"});
    Source source;
    source.overrides = texts_from(overrides);
    const std::pair<const char*, const py::object*> sections[] = {
        {"material", &materials}, {"constraint", &constraints}, {"load", &loads},
        {"tool", &tools},         {"obstacle", &obstacles},     {"dynamics", &dynamics},
        {"contact", &contact},    {"output", &output}};
    if (!scenario.is_none()) {
        bool has_sections = !mesh.is_none() || !gravity.is_none() || !damping.is_none();
        for (const auto& [key, value] : sections) has_sections |= !value->is_none();
        if (has_sections)
            throw InputError(
                "a world is made from a scenario or from sections such as mesh=... and "
                "materials=..., not from both; change single values by overrides=[...]");
    }
    const bool is_file = !scenario.is_none() && !py::isinstance<py::dict>(scenario);
    if (is_file) {
        if (!folder.is_none()) throw InputError("folder belongs to a scenario from dicts");
        source.file = file_from(scenario, "scenario", "scenario file");
        return make(std::move(source), num_threads);
    }
    source.file = (folder.is_none() ? std::filesystem::path() : path_from(folder)) / "world";
    if (py::isinstance<py::dict>(scenario)) {
        py::dict rest(py::reinterpret_borrow<py::dict>(scenario).attr("copy")());
        const py::object given = rest.contains("mesh") ? py::object(rest["mesh"]) : py::none();
        if (py::isinstance<PyMesh>(given)) rest.attr("pop")("mesh");
        source.document = value_from(rest, "");
        if (py::isinstance<PyMesh>(given)) set_mesh(source, given);
    } else {
        source.document = scenario::Value{scenario::Table(), {}};
        if (!mesh.is_none()) set_mesh(source, mesh);
        auto& root = std::get<scenario::Table>(source.document->data);
        for (const auto& [key, value] : sections)
            if (!value->is_none()) set_entry(root, key, value_from(*value, key));
        for (const auto& [key, value] : {std::pair{"gravity", &gravity}, {"damping", &damping}}) {
            if (value->is_none()) continue;
            if (!find_entry(root, "dynamics")) set_entry(root, "dynamics", {scenario::Table(), {}});
            auto* table = std::get_if<scenario::Table>(&find_entry(root, "dynamics")->value.data);
            if (!table) continue;  // the reader refuses it
            if (find_entry(*table, key))
                throw InputError(std::string(key) + " is given twice: also in dynamics");
            set_entry(*table, key, value_from(*value, key));
        }
    }
    return make(std::move(source), num_threads);
}

}  // namespace incise::python
