// A film of pictures, by the program ffmpeg.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace incise::render {

/// Numbered pictures: FOLDER/NAME_000000.png and so on.
struct PictureSeries {
    std::filesystem::path folder;
    std::string name;
    double pictures_a_second = 25.0;
};

/// Makes a film of the pictures, in H.264. Replaces the file. Throws InputError if there is no
/// ffmpeg, OutputError if it fails.
void make_film(const PictureSeries& pictures, const std::filesystem::path& film);

}  // namespace incise::render
