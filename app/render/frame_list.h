// The frames of a finished run, found by the index that the run left.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::render {

struct FrameFile {
    std::filesystem::path path;
    std::optional<double> time;  ///< seconds
};

struct FrameList {
    std::string name;               ///< of the run, or of the single file
    std::filesystem::path folder;   ///< where the index or the file lies
    bool is_run = false;            ///< false: a single mesh
    std::vector<FrameFile> frames;  ///< at least one
};

/// Takes a folder with one .pvd file, a .pvd file, or a .vtu file.
/// Throws InputError if it is none of these or holds no frame.
FrameList list_frames(const std::filesystem::path& path);

}  // namespace incise::render
