// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "incise/app/help_formatter.h"
#include "incise/base/error.h"
#include "incise/io/files/number_text.h"

namespace incise::tetmesh {

namespace {

double parse_number(const std::string& option, const std::string& text, double limit,
                    const std::string& range) {
    const auto value = io::parse_number<double>(text);
    if (value && *value > 0.0 && *value < limit) return *value;
    throw InputError(option + ": '" + text + "' is not allowed; it must be a number " + range);
}

double parse_length(const std::string& option, const std::string& text) {
    return parse_number(option, text, HUGE_VAL, "above 0");
}

}  // namespace

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
    Options options;
    CLI::App app("Tetrahedra of closed surfaces, or of a label image; see incise mesh --help.",
                 "incise-tetmesh");
    app.formatter(std::make_shared<app::HelpFormatter>());
    app.set_version_flag("--version", "incise-tetmesh " INCISE_VERSION);

    std::vector<std::string> files;
    std::string size, size_surface, features, scale;
    app.add_option("FILES", files, "Surfaces or one label image, and the mesh file to write")
        ->required();
    app.add_option("--size", size, "Length of edges inside")->required();
    app.add_option("--size-surface", size_surface,
                   "Length of edges on the surface (default: that of --size)");
    app.add_option("--features", features,
                   "Keep edges at which a surface turns by at least this angle, degrees");
    app.add_option("--scale", scale, "Multiply all coordinates (default: 1)");
    app.add_flag("--labels", options.has_labels,
                 "Take the values as labels, also where the image looks like a scan");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::Error& error) {
        throw InputError(std::string(error.what()) + "; see incise mesh --help");
    }
    if (files.size() < 2)
        throw InputError("OUT is required: name the files to read, then the file to write");
    options.in.assign(files.begin(), files.end() - 1);
    options.out = files.back();
    options.sizes.inside = options.sizes.surface = parse_length("--size", size);
    if (!size_surface.empty()) options.sizes.surface = parse_length("--size-surface", size_surface);
    if (options.sizes.surface > options.sizes.inside)
        throw InputError("--size-surface: " + size_surface + " is more than the " + size +
                         " of --size; edges grow inwards, so give a smaller one");
    if (!features.empty())
        options.angle =
            parse_number("--features", features, 180.0, "of degrees between 0 and 180") *
            std::numbers::pi / 180.0;
    if (!scale.empty()) options.scale = parse_length("--scale", scale);
    return options;
}

}  // namespace incise::tetmesh
