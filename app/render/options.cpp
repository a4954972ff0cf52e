// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "incise/app/help_formatter.h"
#include "incise/io/files/number_text.h"

namespace incise::render {

namespace {

constexpr int exit_usage = 2;

[[noreturn]] void refuse(const char* option, std::string_view text, const std::string& why) {
    throw CLI::ValidationError(std::string(option) + " " + std::string(text) + ": " + why);
}

/// Parses `count` finite numbers with separators between them.
template <class T>
std::vector<T> parse_list(const char* option, std::string_view text, char separator,
                          std::size_t count, const char* form) {
    std::vector<T> values;
    for (std::string_view rest = text; !rest.empty();) {
        const auto end = std::min(rest.find(separator), rest.size());
        const auto value = io::parse_number<T>(rest.substr(0, end));
        if (!value || (std::is_floating_point_v<T> && !std::isfinite(static_cast<double>(*value))))
            break;
        values.push_back(*value);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (rest.empty() && values.size() == count) return values;
    }
    refuse(option, text, std::string("is not of the form ") + form);
}

/// The options whose values are lists of numbers.
void add_list_options(CLI::App& app, Options& options) {
    app.add_option_function<std::string>(
           "--range",
           [&options](const std::string& text) {
               const auto values =
                   parse_list<double>("--range", text, ',', 2, "LOW,HIGH, such as 0,0.05");
               if (!(values[0] < values[1])) refuse("--range", text, "LOW must be below HIGH");
               options.range.emplace(values[0], values[1]);
           },
           "values of the first and the last colour (default: all that occur, without a "
           "thousandth at the ends that is far beyond the others)")
        ->type_name("LOW,HIGH");
    app.add_option_function<std::string>(
           "--size",
           [&options](const std::string& text) {
               constexpr int least = 64, most = 8192;
               const auto values = parse_list<int>("--size", text, 'x', 2, "WxH, such as 1280x960");
               if (std::min(values[0], values[1]) < least || std::max(values[0], values[1]) > most)
                   refuse("--size", text, "width and height are from 64 to 8192 pixels");
               options.size = {values[0], values[1]};
           },
           "pixels (default: 1280x960)")
        ->type_name("WxH");
    app.add_option_function<std::string>(
           "--view",
           [&options](const std::string& text) {
               const auto values =
                   parse_list<double>("--view", text, ',', 3, "X,Y,Z, such as -0.5,-1,0.5");
               const Vec3 view(values[0], values[1], values[2]);
               if (!(view.stableNorm() > 0)) refuse("--view", text, "is no direction");
               options.view = view.stableNormalized();
           },
           "from where one looks, seen from the body (default: -0.55,-1,0.55)")
        ->type_name("X,Y,Z");
}

}  // namespace

std::variant<Options, int> parse_options(int argc, char** argv) {
    Options options;
    CLI::App app(
        "Pictures of a finished run, drawn off screen.\n"
        "Without --frame and --all: the last frame. The paths written go to stdout.",
        "incise-render");
    app.formatter(std::make_shared<incise::app::HelpFormatter>());
    app.set_version_flag("--version", "incise-render " INCISE_VERSION);

    std::string input, out, film;
    std::vector<std::int64_t> frames;
    constexpr std::int64_t most_frames = 1'000'000'000;
    app.add_option("DIR", input, "folder of a run, its .pvd file, or a .vtu file")->required();
    app.add_option("--out", out,
                   "FILE.png, or a folder (default: DIR/pictures, or beside the .vtu file)");
    auto* frame_option =
        app.add_option("--frame", frames,
                       "number of the frame, from 0; or of several, such as 0,10,20: pictures with "
                       "one camera and one range of colours")
            ->delimiter(',')
            ->allow_extra_args(false)  // a word after them is the folder
            ->check(CLI::Range(std::int64_t{0}, most_frames).description(""))
            ->type_name("K[,K...]");
    app.add_flag("--all", options.is_all,
                 "every frame, with one camera and one range of colours: the frames of a film")
        ->excludes(frame_option);
    app.add_option("--video", film,
                   "also a film of every frame, in the time of the run; needs the program ffmpeg")
        ->excludes(frame_option)
        ->type_name("FILE.mp4");
    app.add_option("--color", options.color,
                   "field of points or cells; vectors by length, or displacement_z for a "
                   "component; stress by von Mises; none: tissue, with cut faces in red (default)")
        ->type_name("FIELD");
    add_list_options(app, options);
    app.add_option_function<std::string>(
           "--section",
           [&options](const std::string& text) {
               options.section = parse_section(text);
               if (!options.section)
                   refuse("--section", text,
                          "is not x, y or z, nor of the form x=0.02 or PX,PY,PZ,NX,NY,NZ");
           },
           "cut the body open in the picture: across an axis in the middle (x) or at a "
           "coordinate in m (x=0.02), or through a point across a direction "
           "(PX,PY,PZ,NX,NY,NZ); what is in front of the plane is left out")
        ->type_name("PLANE");
    app.add_flag("--edges", options.has_edges, "draw the lines of the mesh");

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::Error& error) {
        std::cerr << "incise-render: " << error.what() << "; see incise-render --help\n";
        return exit_usage;
    }
    options.input = input;
    options.out = out;
    options.film = film;
    options.is_all = options.is_all || !film.empty();
    for (const std::int64_t frame : frames)
        options.frames.push_back(static_cast<std::size_t>(frame));
    return options;
}

}  // namespace incise::render
