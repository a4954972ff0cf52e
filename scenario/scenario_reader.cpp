// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/scenario_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/vtk/series.h"
#include "incise/scenario/document_text.h"
#include "incise/scenario/hand_tool.h"
#include "incise/scenario/quantities.h"
#include "incise/scenario/scenario_sections.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys root_keys[] = {"title", "mesh", "material", "dynamics", "contact", "constraint",
                              "load",  "tool", "obstacle", "output",   "expect"};
constexpr Keys mesh_keys[] = {"file", "box", "scale", "region_array", "weld", "linear"};
constexpr Keys mesh_box_keys[] = {"size", "cells", "element", "origin"};
constexpr Keys element_names[] = {"tet", "hex"};
constexpr topology::CellKind element_kinds[] = {topology::CellKind::tetrahedron,
                                                topology::CellKind::hexahedron};
constexpr Keys dynamics_keys[] = {"mode",   "integrator", "end_time", "time_step", "steps",
                                  "safety", "damping",    "gravity",  "precision"};
constexpr Keys contact_keys[] = {"enabled", "friction", "self"};
constexpr Keys mode_names[] = {"dynamic", "static"};
constexpr Keys integrator_names[] = {"semi-implicit-euler", "implicit-euler"};
constexpr Keys precision_names[] = {"double", "single"};
constexpr Keys output_keys[] = {"interval", "fields",      "physics",
                                "cells",    "compression", "checkpoint_interval"};
constexpr Keys frame_cell_names[] = {"polyhedra", "tetrahedra"};
constexpr Keys expectation_keys[] = {"min", "max"};
constexpr Keys given_fields[] = {"contact_force", "contact_pressure", "rest_position", "region",
                                 "fibre",         "node_id",          "element_id"};

/// Boxes with more elements do not fit into the memory of usual machines.
constexpr double max_box_elements = 1e8;
/// More load steps would take days on any mesh.
constexpr int most_load_steps = 1000000;
/// More frames give a warning, because they are likely a mistake.
constexpr double many_frames = 1e5;
/// More frames are refused: the names of so many files alone take a gigabyte.
constexpr double max_frames = 1e7;

BoxMeshSpec read_box_mesh(const TableReader& box) {
    BoxMeshSpec spec;
    box.require("size", "edge lengths, as in size = [0.1, 0.1, 0.4]");
    spec.size = box.vector("size", Vec3::Ones());
    if (!(spec.size.minCoeff() > 0.0))
        box.error("size", "is not allowed: all three lengths must be above 0");
    box.require("cells", "numbers of bricks along the axes, as in cells = [4, 4, 16]");
    const Vec3 cells = box.vector("cells", Vec3::Ones());
    const bool is_whole = cells == cells.array().floor().matrix() && cells.minCoeff() >= 1.0;
    if (const auto kind = box.choice("element", {element_names}))
        spec.element = element_kinds[*kind];
    const double elements =
        cells.prod() *
        (spec.element == topology::CellKind::tetrahedron && box.is_sound("element") ? 6.0 : 1.0);
    if (!is_whole)
        box.error("cells", "is not allowed: must be three whole numbers, each at least 1");
    else if (elements > max_box_elements)
        box.error("cells", "makes " + format_number(elements) + " elements, more than the " +
                               format_number(max_box_elements) + " allowed: lower the numbers");
    else
        for (std::size_t i = 0; i < 3; ++i)
            spec.cells[i] = static_cast<int>(cells[static_cast<Eigen::Index>(i)]);
    spec.origin = box.vector("origin");
    return spec;
}

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
}

/// Reports keys that do not suit the mode or the integrator.
void check_solver(const TableReader& dynamics, const DynamicsSpec& spec) {
    if (!dynamics.is_sound("mode")) return;
    if (spec.mode == Mode::statics) {
        for (const Keys key : {"integrator", "time_step", "safety", "damping"})
            if (dynamics.has(key))
                dynamics.warning(key, in_quotes(dynamics.path_of(key)) +
                                          " has no effect with mode = \"static\", whose load "
                                          "steps are set by 'steps', or one for each frame");
        return;
    }
    if (dynamics.has("steps"))
        dynamics.error("steps", "is for mode = \"static\"; motion in time has a time_step");
    if (spec.integrator != TimeIntegrator::implicit_euler) return;
    if (!spec.time_step && !dynamics.has("time_step"))
        dynamics.error({},
                       "needs a 'time_step' in seconds with integrator = \"implicit-euler\": "
                       "no bound of stability sets it, only what motion is to be resolved");
    else if (dynamics.is_text("time_step") && dynamics.text("time_step") == "auto")
        dynamics.error("time_step",
                       "must be a number of seconds with integrator = "
                       "\"implicit-euler\": no bound of stability sets it, only what "
                       "motion is to be resolved");
    if (dynamics.has("safety"))
        dynamics.warning("safety",
                         "'dynamics.safety' has no effect with integrator = \"implicit-euler\"");
}

/// Reports single precision where it does not exist: it is for the forces of explicit steps with
/// HEML and HybMSS.
void check_precision(const TableReader& dynamics, const DynamicsSpec& spec,
                     std::span<const MaterialSpec> materials) {
    if (spec.precision != physics::Precision::single_precision) return;
    if (spec.mode == Mode::statics)
        dynamics.error("precision",
                       "\"single\" is not for mode = \"static\", which computes in double "
                       "precision throughout: leave it out");
    else if (spec.integrator == TimeIntegrator::implicit_euler)
        dynamics.error("precision",
                       "\"single\" is not for integrator = \"implicit-euler\", which computes in "
                       "double precision throughout: leave it out");
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i].method == Method::mass_spring)
            dynamics.error("precision",
                           "\"single\" is not for method = \"mass-spring\" of "
                           "material[" +
                               std::to_string(i) +
                               "], which has forces in double precision only: leave it "
                               "out, or use method = \"heml\"");
}

/// Reports at `key` that there are too many frames, or warns of many. Times are in s.
void check_number_of_frames(const TableReader& table, std::string_view key, double interval,
                            double end_time) {
    const double frames = interval > 0.0 ? std::floor(end_time / interval) : 0.0;
    if (frames > max_frames)
        table.error(key, "an output interval of " + format_number(interval) + " s makes " +
                             format_number(frames) + " frames of a run of " +
                             format_number(end_time) + " s, more than the " +
                             format_number(max_frames) +
                             " allowed: use a longer one, or 0 for no frames");
    else if (frames > many_frames)
        table.warning(key, "the output interval of " + format_number(interval) + " s makes " +
                               format_number(frames) + " frames");
}

/// Keeps only those parts of faulty dynamics that can be checked further. Without end time the
/// number of steps is not checked, and without time step their stability is not.
void keep_sound(const TableReader& root, DynamicsSpec& spec) {
    if (root.is_sound("dynamics")) return;
    const auto is_sound = [&](std::string_view key) {
        return root.is_sound(std::string("dynamics.").append(key));
    };
    if (!is_sound("mode") || !is_sound("integrator") || !is_sound("time_step")) spec = {};
    const bool is_explicit = spec.integrator == TimeIntegrator::semi_implicit_euler;
    if (!spec.time_step && !(is_explicit && is_sound("safety"))) spec.end_time = 0.0;
    if (!is_sound("precision")) spec.precision = physics::Precision::double_precision;
}

/// Returns why a run has no contact; empty if it has, or if that is not known.
std::string known_why_no_contact(const TableReader& root, const Scenario& scenario) {
    if (!root.is_sound("dynamics") || !root.is_sound("contact")) return {};
    return why_no_contact(scenario.dynamics, scenario.contact);
}

Scenario read_all(const TableReader& root, const std::filesystem::path& file,
                  const ForProgram* program) {
    Scenario scenario;
    scenario.name = file.stem().string();
    scenario.folder = file.parent_path();
    scenario.title = root.text("title", scenario.name);
    if (program && program->mesh) {
        scenario.mesh.source = program->mesh;
        scenario.mesh.location = file.string() + ": mesh";
    } else {
        scenario.mesh = read_mesh_spec(root, scenario.folder);
    }
    scenario.materials = read_materials(root, scenario.mesh);
    scenario.dynamics = read_dynamics(root, scenario.materials, program == nullptr);
    const double end_time = scenario.dynamics.is_endless ? 0.0 : scenario.dynamics.end_time;
    scenario.contact = read_contact(root, scenario.dynamics);
    std::vector<std::string> held;
    scenario.constraints = read_constraints(root, end_time, held);
    scenario.loads = read_loads(root, end_time);
    scenario.tools =
        read_tools(root, scenario.folder, end_time, known_why_no_contact(root, scenario));
    scenario.output = read_output(root, end_time, program == nullptr);
    std::vector<std::string> probes;
    for (const ToolSpec& tool : scenario.tools)
        if (cutting::feels_force(tool.shape)) probes.push_back(tool.name);
    scenario.expect = read_expectations(root, held, probes);
    if (!root.is_sound("mesh")) scenario.mesh = {};
    if (!root.is_sound("material")) scenario.materials.clear();
    keep_sound(root, scenario.dynamics);
    for (const char* const key : {"constraint", "load", "obstacle", "tool"})
        if (!root.is_sound(key)) scenario.knows_what_holds = false;
    return scenario;
}

}  // namespace

std::filesystem::path read_file_name(const TableReader& table, std::string_view key,
                                     const std::filesystem::path& folder, const std::string& kind) {
    const std::string name = table.text(key);
    std::filesystem::path file = folder / name;
    std::error_code error;
    if (name.empty()) {
        if (table.is_text(key)) table.error(key, "is empty: name a " + kind);
    } else if (!std::filesystem::exists(file, error)) {
        table.error(key, "there is no file " + file.string() +
                             " (paths are relative to the scenario's folder)");
    } else if (std::filesystem::is_directory(file, error)) {
        table.error(key, file.string() + " is a folder, not a " + kind);
    } else if (!std::ifstream(file)) {
        table.error(key, file.string() + " cannot be read; check its permissions");
    }
    return file;
}

MeshSpec read_mesh_spec(const TableReader& root, const std::filesystem::path& folder) {
    MeshSpec spec;
    root.require("mesh", "add a section [mesh] with file = \"...\" or box = { ... }");
    const auto mesh = root.table("mesh", {mesh_keys});
    if (!mesh) return spec;
    mesh->one_of({"file", "box"});
    if (const auto box = mesh->table("box", {mesh_box_keys})) spec.source = read_box_mesh(*box);
    if (mesh->has("file")) spec.source = read_file_name(*mesh, "file", folder, "mesh file");
    spec.location = mesh->location_text(mesh->has("file") ? "file" : "box");
    spec.scale_location = mesh->location_text("scale");
    spec.region_array_location = mesh->location_text("region_array");
    spec.scale = mesh->number("scale", spec.scale, limits::positive);
    spec.region_array = mesh->text("region_array", spec.region_array);
    if (mesh->has("weld")) spec.weld = mesh->flag("weld", false);
    spec.linear = mesh->flag("linear", spec.linear);
    if (mesh->has("linear") && mesh->has("box"))
        mesh->warning("linear", "'mesh.linear' has no effect on a box, whose elements are linear");
    if (mesh->has("weld") && mesh->has("box"))
        mesh->warning("weld", "'mesh.weld' has no effect on a box, whose elements are joined");
    return spec;
}

DynamicsSpec read_dynamics(const TableReader& root, std::span<const MaterialSpec> materials,
                           bool needs_end) {
    constexpr double never = std::numeric_limits<double>::infinity();
    DynamicsSpec spec;
    if (needs_end) root.require("dynamics", "add a section [dynamics] with an end_time");
    const auto dynamics = root.table("dynamics", {dynamics_keys});
    spec.is_endless = !needs_end && !(dynamics ? dynamics->has("end_time") : root.has("dynamics"));
    if (spec.is_endless) spec.end_time = never;
    if (!dynamics) return spec;
    if (needs_end) dynamics->require("end_time", "simulated seconds, as in end_time = 1.0");
    spec.end_time_location = dynamics->location_text("end_time");
    spec.time_step_location = dynamics->location_text("time_step");
    spec.precision_location = dynamics->location_text("precision");
    spec.end_time = dynamics->number("end_time", spec.end_time, limits::positive);
    if (dynamics->is_text("time_step")) {
        if (const auto text = dynamics->text("time_step"); text != "auto")
            dynamics->error("time_step", in_quotes(text) +
                                             " is not allowed: must be \"auto\" or a "
                                             "number of seconds");
    } else {
        spec.time_step = dynamics->number_if_given("time_step", limits::positive);
    }
    spec.safety =
        dynamics->number("safety", spec.safety, {.low = 0.0, .high = 1.0, .includes_high = true});
    spec.damping = dynamics->number("damping", spec.damping, limits::non_negative);
    spec.gravity = dynamics->vector("gravity");
    if (const auto mode = dynamics->choice("mode", {mode_names}))
        spec.mode = static_cast<Mode>(*mode);
    if (spec.is_endless && spec.mode == Mode::statics) spec.end_time = 1.0;
    if (const auto integrator = dynamics->choice("integrator", {integrator_names}))
        spec.integrator = static_cast<TimeIntegrator>(*integrator);
    if (dynamics->has("steps"))
        spec.steps =
            static_cast<int>(dynamics->integer("steps", 1, {.low = 1, .high = most_load_steps}));
    if (const auto precision = dynamics->choice("precision", {precision_names}))
        spec.precision = static_cast<physics::Precision>(*precision);
    check_solver(*dynamics, spec);
    check_precision(*dynamics, spec, materials);
    return spec;
}

contact::ContactSettings read_contact(const TableReader& root, const DynamicsSpec& dynamics) {
    contact::ContactSettings settings;
    const auto contact = root.table("contact", {contact_keys});
    if (!contact) return settings;
    settings.enabled = contact->flag("enabled", settings.enabled);
    settings.friction = contact->number("friction", settings.friction, limits::non_negative);
    settings.self = contact->flag("self", settings.self);
    if (!dynamics.is_explicit() && settings.enabled && root.is_sound("dynamics"))
        contact->error({},
                       "is for explicit dynamics: implicit steps and statics have no contact; "
                       "write enabled = false, or use integrator = \"semi-implicit-euler\"");
    return settings;
}

OutputSpec read_output(const TableReader& root, double end_time, bool has_frames) {
    OutputSpec spec;
    // A short run has ten. In a long run an interruption loses at most 0.5 s of simulated time.
    spec.checkpoint_interval = std::min(0.5, end_time / 10.0);
    const auto all_fields = [&] {
        for (std::size_t i = 0; i < field_names.size(); ++i)
            spec.fields.push_back(static_cast<Field>(i));
    };
    const auto output = root.table("output", {output_keys});
    if (!output) {
        if (!has_frames && !root.has("output")) spec.interval = 0.0;
        check_number_of_frames(root, "dynamics", spec.interval, end_time);
        all_fields();
        return spec;
    }
    spec.interval = output->number("interval", spec.interval, limits::non_negative);
    const bool knows_interval = output->is_sound("interval");
    if (knows_interval) check_number_of_frames(*output, "interval", spec.interval, end_time);
    if (knows_interval && end_time > 0.0 && spec.interval > end_time)
        output->warning("interval", "the output interval of " + format_number(spec.interval) +
                                        " s is longer than the run of " + format_number(end_time) +
                                        " s: only the first and last state are written");
    if (output->has("fields"))
        for (const auto index : output->choices("fields", {field_names, given_fields}))
            spec.fields.push_back(static_cast<Field>(index));
    else
        all_fields();
    if (output->flag("physics", false)) spec.fields.push_back(Field::physics);
    if (output->choice("cells", {frame_cell_names}) == 1) spec.fields.push_back(Field::tetrahedra);
    if (const auto index = output->choice("compression", {compression_names}))
        spec.compression = static_cast<io::Compression>(*index);
    spec.checkpoint_interval =
        output->number("checkpoint_interval", spec.checkpoint_interval, limits::non_negative);
    return spec;
}

std::vector<Expectation> read_expectations(const TableReader& root,
                                           const std::vector<std::string>& constraints,
                                           const std::vector<std::string>& probes) {
    std::vector<Expectation> expectations;
    const std::vector<std::string> quantities = all_quantities(constraints, probes);
    const std::vector<std::string_view> names(quantities.begin(), quantities.end());
    const auto expect = root.table("expect", {names});
    if (!expect) return expectations;
    for (const auto& [quantity, value, location] : expect->entries()) {
        const auto range = expect->table(quantity, {expectation_keys});
        if (!range) continue;
        Expectation expectation{quantity, range->number_if_given("min"),
                                range->number_if_given("max")};
        if (!range->has("min") && !range->has("max"))
            range->error({}, "must have min, max or both, as in { max = 1e-9 }");
        if (expectation.min && expectation.max && *expectation.min > *expectation.max)
            range->error({}, "min " + format_number(*expectation.min) + " is above max " +
                                 format_number(*expectation.max));
        expectations.push_back(std::move(expectation));
    }
    return expectations;
}

std::string read_name(const TableReader& table, const std::string& fallback,
                      std::vector<std::string>& used) {
    std::string name = table.text("name", fallback);
    if (name.empty() || !std::all_of(name.begin(), name.end(), is_name_character))
        table.error("name", in_quotes(name) + " is not allowed: use letters, digits, _ and -");
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
    else if (table.is_sound("name"))
        table.error("name", in_quotes(name) + " is taken already: names must differ");
    return name;
}

void check_times(const TableReader& table, std::string_view key, std::span<const TableReader> rows,
                 std::span<const double> times, double end_time) {
    if (table.is_empty_array(key)) table.error(key, "is empty: give at least one time");
    for (std::size_t i = 1; i < times.size(); ++i)
        if (times[i] <= times[i - 1])
            rows[i].error("time", format_number(times[i]) + " is not allowed: must be above " +
                                      format_number(times[i - 1]) + ", the time before it");
    if (end_time > 0.0 && !times.empty() && times.back() > end_time)
        rows.back().warning("time", in_quotes(table.path_of(key)) + " goes on until " +
                                        format_number(times.back()) + " s, but the run ends at " +
                                        format_number(end_time) + " s");
}

namespace {

void check_series_name(const std::filesystem::path& file, Diagnostics& diagnostics) {
    try {
        io::require_series_name(file.stem().string());
    } catch (const InputError& failure) {
        diagnostics.error(SourceLocation{}, failure.what());
    }
}

}  // namespace

ScenarioReport read_scenario(Value document, const std::filesystem::path& file,
                             std::span<const std::string> overrides, const ForProgram* program) {
    ScenarioReport report;
    Diagnostics diagnostics(file.string(), overrides);
    check_series_name(file, diagnostics);
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        try {
            apply_override(document, overrides[i], static_cast<int>(i));
        } catch (const DocumentError& failure) {
            diagnostics.error(failure.location, failure.text);
        }
    }
    const TableReader root(*document.get<Table>(), SourceLocation{}, "", {root_keys}, diagnostics);
    report.scenario = read_all(root, file, program);
    report.scenario.hash = content_hash(document);
    report.scenario.contents = contents_of(document);
    make_files_absolute(document, file.parent_path());
    report.scenario.text = toml_text(document);
    report.errors = diagnostics.errors();
    report.warnings = diagnostics.warnings();
    return report;
}

ScenarioReport read_scenario(const std::filesystem::path& file,
                             std::span<const std::string> overrides) {
    try {
        return read_scenario(read_document(file), file, overrides);
    } catch (const DocumentError& failure) {
        Diagnostics diagnostics(file.string(), overrides);
        check_series_name(file, diagnostics);
        diagnostics.error(failure.location, failure.text);
        return {.scenario = {}, .errors = diagnostics.errors(), .warnings = {}};
    } catch (const InputError& failure) {
        return {.scenario = {}, .errors = {failure.what()}, .warnings = {}};
    }
}

}  // namespace incise::scenario
