// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/film.h"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/base/number_format.h"

extern char** environ;

namespace incise::render {

namespace {

/// Returns a name in which ffmpeg sees no pattern of its own: it takes % for the number.
std::string without_patterns(std::string text) {
    for (std::size_t at = 0; (at = text.find('%', at)) != text.npos; at += 2)
        text.insert(at, 1, '%');
    return text;
}

}  // namespace

void make_film(const PictureSeries& pictures, const std::filesystem::path& film) {
    const std::string input =
        without_patterns((pictures.folder / (pictures.name + "_")).string()) + "%06d.png";
    // Players want an even number of pixels, and colours at half the resolution.
    std::vector<std::string> words = {"ffmpeg",
                                      "-y",
                                      "-nostdin",
                                      "-loglevel",
                                      "error",
                                      "-framerate",
                                      format_number(pictures.pictures_a_second),
                                      "-i",
                                      input,
                                      "-vf",
                                      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                      "-pix_fmt",
                                      "yuv420p",
                                      film.string()};
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, "ffmpeg", nullptr, nullptr, arguments.data(), environ);
    if (error != 0)
        throw InputError("--video: ffmpeg cannot be started (" + std::string(std::strerror(error)) +
                         "); install it with apt-get install ffmpeg. The pictures are in " +
                         pictures.folder.string());
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw OutputError(film.string() + ": ffmpeg could not write it; the pictures are in " +
                          pictures.folder.string());
}

}  // namespace incise::render
