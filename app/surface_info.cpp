// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/surface_info.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "incise/app/shell_word.h"
#include "incise/base/number_format.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::app {

namespace {

template <class... Values>
std::string line_of(const char* format, Values... values) {
    std::array<char, 512> line;
    std::snprintf(line.data(), line.size(), format, values...);
    return line.data();
}

/// A twentieth of the longest side, with one digit: some thousand tetrahedra.
double first_size(const Box& box) {
    const double size = box.sizes().maxCoeff() / 20.0;
    return size > 0.0 ? std::stod(line_of("%.1g", size)) : 1.0;
}

std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

std::string command_for_mesh(const std::filesystem::path& path, const Box& box) {
    // Longer than any body in metres: in millimetres, as scanners write them.
    constexpr double longest_body = 10.0;
    const bool is_in_millimetres = box.sizes().maxCoeff() > longest_body;
    const double size = first_size(box);
    auto stem = path.stem();  // two suffixes: .nii.gz
    if (path.extension() == ".gz") stem = stem.stem();
    return "incise mesh " + shell_word(path.string()) + " " + shell_word(stem.string() + ".vtu") +
           " --size " +
           (is_in_millimetres ? format_number(size / 1000.0) + " --scale 0.001"
                              : format_number(size));
}

SurfaceInfo surface_info(const std::filesystem::path& path) {
    auto file = io::read_surface(path);
    SurfaceInfo info;
    info.parts = topology::parts_of(file.surface);
    info.fault = fault_of(info.parts);
    info.warnings = std::move(file.warnings);
    info.command = command_for_mesh(path, info.parts.box);
    return info;
}

double enclosed_volume(const SurfaceInfo& info) {
    double sum = 0.0;
    for (const auto& part : info.parts.parts) sum += part.is_closed ? part.signed_volume : 0.0;
    return sum;
}

std::string text_of(const SurfaceInfo& info) {
    const auto& parts = info.parts;
    const Vec3 &low = parts.box.min(), &high = parts.box.max();
    std::string text = line_of("triangles        %zu\n", parts.surface.triangles.size());
    text += line_of("points           %zu\n", parts.surface.points.size());
    text += "closed           " + (info.fault.empty() ? "yes" : "no: " + info.fault) + "\n";
    text += line_of("components       %zu\n", parts.parts.size());
    text += line_of("bounding box     %.6g %.6g %.6g to %.6g %.6g %.6g\n", low.x(), low.y(),
                    low.z(), high.x(), high.y(), high.z());
    if (info.fault.empty()) text += line_of("volume           %.6g\n", enclosed_volume(info));
    text += line_of("surface area     %.6g\n", parts.area);
    return text + "a surface is no body; to make one: " + info.command + "\n";
}

std::string json_of(const SurfaceInfo& info) {
    const auto& parts = info.parts;
    const Vec3 &low = parts.box.min(), &high = parts.box.max();
    nlohmann::ordered_json json;
    json["triangles"] = parts.surface.triangles.size();
    json["points"] = parts.surface.points.size();
    json["closed"] = info.fault.empty();
    json["open_edges"] = parts.open_edges.count;
    json["branching_edges"] = parts.branching_edges.count;
    json["components"] = parts.parts.size();
    json["volume"] = nullptr;
    if (info.fault.empty()) json["volume"] = enclosed_volume(info);
    json["surface_area"] = parts.area;
    json["bounding_box"] = {{"min", {low.x(), low.y(), low.z()}},
                            {"max", {high.x(), high.y(), high.z()}}};
    json["command"] = info.command;
    json["warnings"] = info.warnings;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string summary_of(const SurfaceInfo& info) {
    const auto& parts = info.parts;
    std::string text = "surface with " + counted(parts.surface.triangles.size(), "triangle") +
                       ", " + counted(parts.parts.size(), "component");
    text += info.fault.empty() ? line_of(", closed, volume %.6g", enclosed_volume(info))
                               : std::string(", not closed");
    const Vec3 sides = parts.box.sizes();
    return text + line_of(", extent %.6g x %.6g x %.6g", sides.x(), sides.y(), sides.z()) +
           "; to make a body of it: " + info.command;
}

}  // namespace incise::app
