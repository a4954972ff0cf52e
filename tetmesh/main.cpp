// incise-tetmesh: makes tetrahedra of closed surfaces and of label images. It is a separate program
// because CGAL's Mesh_3 is under the GPL.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <csignal>
#include <exception>
#include <iostream>
#include <limits>
#include <new>

#include "incise/app/progress.h"
#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/image/label_image.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/topology/mesh_check.h"
#include "tetmesh/label_shape.h"
#include "tetmesh/mesh_report.h"
#include "tetmesh/options.h"
#include "tetmesh/shape_check.h"
#include "tetmesh/surface_shape.h"
#include "tetmesh/tetrahedral_mesher.h"

namespace incise::tetmesh {
namespace {

// As of incise: app/verbs.h.
enum Exit { done = 0, bad_input = 2, output_failed = 4, out_of_memory = 5, program_at_fault = 70 };

void print_lines(const std::string& prefix, const std::string& text) {
    std::cerr << "incise: " << prefix;
    for (const char c : text) {
        std::cerr << c;
        if (c == '\n') std::cerr << "incise: " << prefix;
    }
    std::cerr << '\n';
}

void print_warnings(const std::string& name, const std::vector<std::string>& warnings) {
    for (const auto& warning : warnings) print_lines("warning: " + name + ": ", warning);
}

/// Throws InputError for coordinates that are too large, too small or too far away for a mesh.
void refuse_coordinates(const Box& box, const Options& options) {
    // Products of a few such lengths are still numbers, here and in what reads the mesh.
    constexpr double smallest = 1e-50, largest = 1e50;
    const double extent = box.sizes().maxCoeff();
    if (!(extent >= smallest && extent <= largest))
        throw InputError(
            "the longest side of the body is " + io::shown(extent) +
            (options.scale == 1.0 ? "" : " after --scale " + io::shown(options.scale)) +
            "; it must be from 1e-50 to 1e50: give another --scale");
    // Of an edge, to which nodes far from the origin are rounded.
    constexpr double most_rounding = 1e-6;
    const double furthest =
        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    if (furthest * std::numeric_limits<double>::epsilon() > most_rounding * options.sizes.surface)
        throw InputError(
            "the body has coordinates up to " + io::shown(furthest) +
            ", too far from the origin for edges of " + io::shown(options.sizes.surface) +
            ": numbers have 16 digits; move it to the origin, or give a larger --size");
}

BodyShape read_surfaces(const Options& options) {
    std::vector<NamedSurface> surfaces;
    Box box;
    for (const auto& path : options.in) {
        auto file = io::read_surface(path);
        print_warnings(path.string(), file.warnings);
        for (Vec3& x : file.surface.points) box.extend(x *= options.scale);
        surfaces.push_back({path.string(), std::move(file.surface)});
    }
    refuse_coordinates(box, options);
    return shape_of(surfaces, options.angle);
}

BodyShape read_image(const Options& options) {
    if (options.in.size() > 1)
        throw InputError(
            "is no surface (.stl, .ply, .off, .obj), and of several files all must be; mesh one "
            "label image alone");
    if (options.angle)
        throw InputError("--features: a label image has no sharp edges to keep; leave it out");
    auto image = io::read_label_image(
        options.in[0], {.has_labels = options.has_labels, .advice = "say so with --labels"});
    print_warnings(options.in[0].string(), image.warnings);
    image.spacing *= options.scale;
    image.origin *= options.scale;
    auto body = shape_of(std::move(image));
    refuse_coordinates(body.box, options);
    return body;
}

BodyShape read_body(const Options& options) {
    bool are_surfaces = true;
    for (const auto& path : options.in) are_surfaces &= io::has_surface_suffix(path);
    return are_surfaces ? read_surfaces(options) : read_image(options);
}

/// Throws InputError with a message that begins with the name of a file or of an option.
[[noreturn]] void rethrow_named(const Options& options, const InputError& error) {
    const std::string text = error.what();
    bool is_named = text.starts_with("--");
    for (const auto& path : options.in) is_named |= text.starts_with(path.string());
    throw InputError(is_named ? text : options.in[0].string() + ": " + text);
}

topology::MeshData make(const Options& options, std::vector<std::string>& warnings) {
    const std::string name = options.in[0].string();
    app::Progress progress(1.0, name, false);
    const auto body = read_body(options);
    // What is soon done needs no progress.
    const auto begin = std::chrono::steady_clock::now();
    const auto show = [&](double fraction, std::string_view note) {
        if (std::chrono::steady_clock::now() - begin < std::chrono::seconds(1)) return;
        progress.update(fraction, note);
    };
    auto mesh = tetrahedra_of(body, options.sizes, show);
    show(1.0, std::to_string(mesh.num_cells()) + " tetrahedra");
    // Only a fault of the program could leave errors, and no file is to hold them.
    if (const auto found = topology::check(mesh); !found.errors.empty())
        throw std::logic_error("the mesh that was made is not valid: " + found.errors.front());
    refuse_other_volume(mesh, body.volumes);
    warnings = losses_of(mesh, body.volumes);
    for (auto& warning : differences_of_shape(mesh, body, options.sizes.surface))
        warnings.push_back(std::move(warning));
    return mesh;
}

void run(const Options& options) {
    io::check_writable(options.out);
    std::vector<std::string> warnings;
    topology::MeshData mesh;
    try {
        mesh = make(options, warnings);
    } catch (const InputError& error) {
        rethrow_named(options, error);
    }
    print_warnings(options.in[0].string(), warnings);
    io::write_mesh(options.out, mesh);
    std::cout << report_of(options.out.string(), mesh) << std::flush;
    if (!std::cout) throw OutputError("standard output: cannot be written");
}

}  // namespace
}  // namespace incise::tetmesh

int main(int argc, char** argv) {
    using namespace incise;
    using namespace incise::tetmesh;
    // Makes a limit on file sizes and a closed pipe ordinary errors of writing.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    const auto fail = [](int status, const std::string& text) {
        print_lines("", text);
        return status;
    };
    try {
        const auto parsed = parse_options(argc, argv);
        if (const auto* status = std::get_if<int>(&parsed)) return *status;
        run(std::get<Options>(parsed));
        return done;
    } catch (const InputError& error) {
        return fail(bad_input, error.what());
    } catch (const OutputError& error) {
        return fail(output_failed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(out_of_memory, "out of memory: the mesh is too large for this machine");
    } catch (const std::exception& error) {
        return fail(program_at_fault,
                    std::string("a fault of the program, please report it: ") + error.what());
    }
}
