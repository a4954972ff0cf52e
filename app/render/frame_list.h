// The frames of a finished run, as listed in the index of the run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::render {

/// A frame in a file.
struct FrameFile {
    std::filesystem::path path;
    std::optional<double> time;  ///< s
};

/// The frames of a run, or a single frame.
struct FrameList {
    std::string name;               ///< of the run, or of the single file
    std::filesystem::path folder;   ///< folder of the index or of the file
    bool is_run = false;            ///< false for a single mesh
    std::vector<FrameFile> frames;  ///< at least one
};

/// Lists the frames of a folder with one .pvd file, of a .pvd file, or of a .vtu file.
/// Throws InputError if the path is none of these or if there is no frame.
FrameList list_frames(const std::filesystem::path& path);

}  // namespace incise::render
