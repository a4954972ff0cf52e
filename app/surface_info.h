// What incise info and incise check say about a surface.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "incise/topology/surface_parts.h"

namespace incise::app {

/// A surface file and its parts.
struct SurfaceInfo {
    topology::SurfaceParts parts;
    std::string fault;                  ///< why it is not closed; empty if it is
    std::vector<std::string> warnings;  ///< of the reader
    std::string command;                ///< that makes a mesh of it, with a size for a first try
};

/// Returns the command that makes a mesh of a surface or an image in a box, with a size for a first
/// try. What is longer than any body in metres is taken for millimetres.
std::string command_for_mesh(const std::filesystem::path& path, const Box& box);

/// Reads a surface. Throws InputError as io::read_surface() does.
SurfaceInfo surface_info(const std::filesystem::path& path);

/// Returns the volume that the closed parts enclose; cavities face inwards and count below 0.
double enclosed_volume(const SurfaceInfo& info);

/// Returns lines about the surface, for people.
std::string text_of(const SurfaceInfo& info);
/// Returns the same as one JSON object.
std::string json_of(const SurfaceInfo& info);
/// Returns the same in short: "surface with 1280 triangles, ...".
std::string summary_of(const SurfaceInfo& info);

}  // namespace incise::app
