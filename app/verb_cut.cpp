// incise cut: cuts a mesh at rest and reports what was done.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "incise/app/cut_tools.h"
#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/number_text.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/remedies.h"
#include "incise/scenario/table_reader.h"

namespace incise::app {

namespace {

using nlohmann::ordered_json;

constexpr std::string_view modes[] = {"split", "separate"};

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

struct Job {
    std::vector<cutting::RestTool> tools;
    std::optional<cutting::CutMode> mode;
    double snap = cutting::default_snap;
    std::vector<std::string> warnings;
};

double parse_snap(const std::string& text) {
    const auto snap = io::parse_number<double>(text);
    if (snap && *snap >= 0.0 && *snap <= 0.5) return *snap;
    throw InputError("--snap: " + scenario::in_quotes(text) +
                     " is not allowed; it must be a number from 0 to 0.5");
}

/// True if both paths name the same file, also through a link.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code is_missing;
    return a.lexically_normal() == b.lexically_normal() ||
           std::filesystem::equivalent(a, b, is_missing);
}

/// Throws InputError if the JSON file is also an input file or the mesh to write.
void check_json(const CutOptions& options) {
    const auto refuse = [&](const std::filesystem::path& file, const std::string& what) {
        if (is_same_file(*options.json, file))
            throw InputError("--json: " + file.string() + " is the " + what +
                             "; name another file, or - for standard output");
    };
    refuse(options.mesh, "mesh");
    refuse(options.out, "mesh");
    for (const CutToolArgument& tool : options.tools)
        if (tool.option == "--surface") refuse(tool.text, "surface");
}

Job parse(const CutOptions& options) {
    Job job;
    io::check_writable(options.out);
    if (options.json) check_json(options);
    if (options.json && *options.json != "-") io::require_writable(*options.json);
    if (!options.mode.empty()) {
        if (const auto complaint = scenario::complaint(options.mode, {modes}))
            throw InputError("--mode: " + scenario::in_quotes(options.mode) + " " + *complaint);
        job.mode = options.mode == "split" ? cutting::CutMode::split : cutting::CutMode::separate;
    }
    if (!options.snap.empty()) job.snap = parse_snap(options.snap);
    if (options.tools.empty()) {
        std::vector<std::string_view> names;
        for (const auto& option : cut_tool_options()) names.emplace_back(option.name);
        throw InputError("no tool is given; use one or more of " + scenario::list_of(names));
    }
    for (const auto& argument : options.tools) {
        auto parsed = parse_cut_tool(argument, job.snap);
        job.tools.push_back(std::move(parsed.tool));
        job.warnings.insert(job.warnings.end(), parsed.warnings.begin(), parsed.warnings.end());
    }
    return job;
}

struct Result {
    topology::MeshData mesh;
    cutting::CutMode mode;
    double snap;
    cutting::RestCutReport report;
    std::vector<std::string> warnings;
};

Result carry_out(const CutOptions& options) {
    Job job = parse(options);
    const std::string prefix = options.mesh.string() + ": ";
    auto file = read_input(options.mesh, {.region_array = options.region_array});
    try {
        auto built = topology::Mesh::build(file.mesh, scenario::weld_advice());
        const auto mode = job.mode.value_or(cutting::CutMode::split);
        auto report = cutting::cut_at_rest(built.mesh, job.tools, mode);
        for (const auto* warnings : {&file.warnings, &built.warnings, &report.warnings})
            for (const auto& warning : *warnings) job.warnings.push_back(prefixed(prefix, warning));
        topology::MeshData cut = std::move(report.mesh);
        if (const auto loss = io::loss_in_format(options.out, cut)) job.warnings.push_back(*loss);
        cut.points_may_coincide |= file.mesh.points_may_coincide;
        return {std::move(cut), mode, job.snap, std::move(report), std::move(job.warnings)};
    } catch (const InputError& error) {
        throw InputError(prefixed(prefix, error.what()));
    }
}

ordered_json before_and_after(double before, double after) {
    ordered_json json = {{"before", before}, {"after", after}, {"ratio", nullptr}};
    if (before > 0.0) json["ratio"] = after / before;
    return json;
}

ordered_json or_null(const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json distance_json(const std::optional<cutting::CutCounts::Distance>& distance,
                           double mean_edge_length) {
    if (!distance) return {{"max", nullptr}, {"relative", nullptr}, {"nodes", nullptr}};
    return {{"max", distance->faces},
            {"relative", distance->faces / mean_edge_length},
            {"nodes", distance->nodes}};
}

void put_counts(ordered_json& json, const cutting::CutCounts& counts, double mean_edge_length) {
    json["crossed"] = counts.elements_crossed;
    json["snapped"] = counts.nodes_snapped;
    json["elements_added"] = counts.elements_added;
    json["elements_removed"] = counts.elements_removed;
    json["nodes_added"] = counts.nodes_added;
    json["nodes_duplicated"] = counts.nodes_duplicated;
    json["faces_opened"] = counts.faces_opened;
    json["cut_area"] = counts.cut_area;
    json["mean_angle_deg"] =
        or_null(counts.mean_angle ? std::optional(degrees(*counts.mean_angle)) : std::nullopt);
    json["volume_removed"] = counts.volume_removed;
    json["surface_distance"] = distance_json(counts.surface_distance, mean_edge_length);
}

ordered_json as_json(const CutOptions& options, const Result& result) {
    const auto& report = result.report;
    const auto &before = report.before, &after = report.after;
    ordered_json json;
    json["mode"] = modes[static_cast<std::size_t>(result.mode)];
    json["snap"] = result.mode == cutting::CutMode::split ? ordered_json(result.snap) : nullptr;
    json["pieces"] = ordered_json::array();
    for (const auto& piece : report.pieces)
        json["pieces"].push_back({{"volume", piece.volume}, {"elements", piece.elements}});
    json["elements"] = {{"before", before.elements}, {"after", after.elements}};
    json["nodes"] = {{"before", before.nodes}, {"after", after.nodes}};
    json["volume"] = {{"before", before.volume}, {"after", after.volume}};
    json["fragments"] = {{"before", before.fragments}, {"after", after.fragments}};
    json["ghost_nodes"] = after.ghost_nodes;
    json["smallest_share"] = after.smallest_share;
    put_counts(json, report.total, before.mean_edge_length);
    json["volume_error"] = report.volume_error();
    json["growth"] = or_null(report.growth());
    json["min_dihedral_deg"] =
        before_and_after(degrees(before.min_dihedral_angle), degrees(after.min_dihedral_angle));
    json["min_altitude"] = before_and_after(before.min_altitude, after.min_altitude);
    json["mean_edge_length"] = before_and_after(before.mean_edge_length, after.mean_edge_length);
    json["stable_step_ratio"] = or_null(report.stable_step_ratio());
    json["microseconds_per_crossed_element"] = or_null(report.microseconds_per_crossed_element());
    json["tools"] = ordered_json::array();
    for (std::size_t t = 0; t < report.tools.size(); ++t) {
        ordered_json tool = {{"tool", options.tools[t].option}, {"value", options.tools[t].text}};
        put_counts(tool, report.tools[t].counts, before.mean_edge_length);
        tool["pieces"] = report.tools[t].pieces;
        json["tools"].push_back(tool);
    }
    json["warnings"] = result.warnings;
    return json;
}

void print_counts(const cutting::CutCounts& counts, double mean_edge_length) {
    std::printf("elements crossed  %zu\n", counts.elements_crossed);
    std::printf("elements added    %zu\n", counts.elements_added);
    std::printf("elements removed  %zu\n", counts.elements_removed);
    std::printf("nodes snapped     %zu\n", counts.nodes_snapped);
    std::printf("faces opened      %zu\n", counts.faces_opened);
    std::printf("cut area          %.6g\n", counts.cut_area);
    if (counts.surface_distance)
        std::printf("off the surface   %.4g, that is %.4g mean edge lengths; nodes %.4g\n",
                    counts.surface_distance->faces,
                    counts.surface_distance->faces / mean_edge_length,
                    counts.surface_distance->nodes);
    if (counts.mean_angle)
        std::printf("angle to plane    %.4g degrees on average\n", degrees(*counts.mean_angle));
}

void print_text(const Result& result) {
    constexpr std::size_t most_pieces = 10;
    const auto& report = result.report;
    const auto &before = report.before, &after = report.after;
    for (const auto& [name, counts, pieces] : report.tools) {
        std::printf("%s\n    %zu crossed, %zu added, %zu removed, %zu faces opened, area %.4g; ",
                    name.c_str(), counts.elements_crossed, counts.elements_added,
                    counts.elements_removed, counts.faces_opened, counts.cut_area);
        std::printf("%d %s\n", pieces, pieces == 1 ? "piece" : "pieces");
    }
    std::printf("mode              %s\n", modes[static_cast<std::size_t>(result.mode)].data());
    std::printf("pieces            %zu\n", report.pieces.size());
    for (std::size_t p = 0; p < std::min(report.pieces.size(), most_pieces); ++p)
        std::printf("  piece %-9zu volume %.6g, elements %zu\n", p + 1, report.pieces[p].volume,
                    report.pieces[p].elements);
    if (report.pieces.size() > most_pieces)
        std::printf("  and smaller ones %zu\n", report.pieces.size() - most_pieces);
    std::printf("elements          %zu to %zu\n", before.elements, after.elements);
    std::printf("nodes             %zu to %zu\n", before.nodes, after.nodes);
    std::printf("fragments         %zu to %zu, ghost nodes %zu, smallest share %.4g\n",
                before.fragments, after.fragments, after.ghost_nodes, after.smallest_share);
    print_counts(report.total, before.mean_edge_length);
    if (const auto growth = report.growth()) std::printf("growth            %.4g\n", *growth);
    std::printf("volume error      %.3g\n", report.volume_error());
    std::printf("least dihedral    %.4g to %.4g degrees\n", degrees(before.min_dihedral_angle),
                degrees(after.min_dihedral_angle));
    std::printf("least altitude    %.4g to %.4g\n", before.min_altitude, after.min_altitude);
    if (const auto ratio = report.stable_step_ratio())
        std::printf("stable step       %.4g of before, by shape\n", *ratio);
    if (const auto cost = report.microseconds_per_crossed_element())
        std::printf("time              %.4g us a crossed element\n", *cost);
}

}  // namespace

int cut(const CutOptions& options) {
    const Result result = carry_out(options);
    const bool is_json_on_stdout = options.json && *options.json == "-";
    if (!is_json_on_stdout)
        for (const auto& warning : result.warnings) print_warning(warning);
    io::write_mesh(options.out, result.mesh);
    if (!options.json) {
        print_text(result);
        return done;
    }
    // File names may have any encoding.
    const auto text =
        as_json(options, result).dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (is_json_on_stdout)
        std::cout << text;
    else
        io::write_file(*options.json, text);
    return done;
}

}  // namespace incise::app
