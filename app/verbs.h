// The verbs of the program: each has a function and a file. command_line.cpp fills in the options.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "incise/app/mesh_input.h"

namespace incise::app {

/// Exit statuses. Errors that verbs throw become statuses in main.cpp. Verbs return done,
/// missed_expectation (run), input_at_fault and out_of_memory (check). run() returns 128 + signal
/// if a signal stops it.
enum Status {
    done = 0,
    missed_expectation = 1,
    input_at_fault = 2,
    physics_went_wrong = 3,
    output_failed = 4,
    out_of_memory = 5,
    program_at_fault = 70
};

struct RunOptions {
    std::filesystem::path scenario;
    std::optional<std::filesystem::path> out;
    std::optional<double> end_time;
    std::vector<std::string> overrides;           ///< KEY.PATH=VALUE; see scenario::read_scenario()
    int num_threads = 0;                          ///< 0: one for each core
    std::optional<std::filesystem::path> replay;  ///< a recording of incise live, to play again
    bool resume = false;
    bool force = false;  ///< replace another run in the folder
    bool dry_run = false;
    bool quiet = false;
};
int run(const RunOptions& options);

struct LiveOptions {
    std::filesystem::path scenario;
    std::string host = "127.0.0.1";
    std::uint16_t port = 8080;  ///< 0: any that is free
    std::optional<std::filesystem::path> record;
    std::vector<std::string> overrides;  ///< KEY.PATH=VALUE; see scenario::read_scenario()
    int num_threads = 0;                 ///< 0: one for each core
    double tick = 1.0 / 60.0;            ///< s
    std::optional<std::uint16_t> igtl;   ///< port for OpenIGTLink
    std::vector<std::string> tools;      ///< NAME={...}, the tools that OpenIGTLink leads
    bool open = true;                    ///< open the page in the browser of the desktop
    bool force = false;                  ///< replace the recording if it is there
};
/// Runs until a signal. Returns 128 + signal.
int live(const LiveOptions& options);

struct BenchOptions {
    std::optional<std::filesystem::path> json;  ///< "-" for standard output
};
int bench(const BenchOptions& options);

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    MeshInput input;  ///< of the mesh files; scenarios have keys of their own
};
/// Checks all files. Returns the highest status of a file: input_at_fault if it has a problem,
/// out_of_memory if it is too large for the machine.
int check(const CheckOptions& options);

struct InfoOptions {
    std::filesystem::path mesh;  ///< or a surface
    MeshInput input;
    bool json = false;
};
int info(const InfoOptions& options);

struct ConvertOptions {
    std::filesystem::path in, out;
    MeshInput input;
    std::string cells;  ///< "tetrahedra" to divide all others; if empty or "polyhedra", none is
};
int convert(const ConvertOptions& options);

struct MeshOptions {
    std::vector<std::string> files;  ///< those to read, then the one to write
    bool hex = false;
    bool labels = false;  ///< the image has labels, also if it looks like a scan
    std::string size;     ///< edge of the cells; with `hex` and if empty, one cell for each voxel
    std::string size_surface;  ///< edge on the surface; if empty, that of `size`
    std::string features;      ///< angle of edges to keep; if empty, none is kept
    std::string scale;         ///< factor of all coordinates; if empty, 1
};
/// Makes hexahedra, or lets incise-tetmesh make tetrahedra. Returns the exit status of that
/// program.
int mesh(const MeshOptions& options);

/// An option that adds a tool, with its value as given.
struct CutToolArgument {
    std::string option, text;
};
struct CutOptions {
    std::filesystem::path mesh, out;
    std::vector<CutToolArgument> tools;         ///< in the order of the command line
    std::optional<std::filesystem::path> json;  ///< "-" for standard output
    std::string mode;                           ///< if empty, "split"
    std::string snap;                           ///< if empty, cutting::default_snap
    std::string region_array = "region";
};
int cut(const CutOptions& options);

struct MaterialsOptions {
    std::string name;  ///< a law, a method or a tissue; if empty, all
    bool json = false;
};
int materials(const MaterialsOptions& options);

struct ReportOptions {
    std::filesystem::path folder;              ///< of a run
    std::optional<std::filesystem::path> out;  ///< if not set, report.html in the folder
    int num_pictures = 6;
    std::string color;  ///< --color of incise-render; if empty, its default
    std::string view;   ///< --view of incise-render; if empty, its default
};
int report(const ReportOptions& options);

struct RenderOptions {
    std::vector<std::string> arguments;  ///< passed to incise-render without change
};
/// Replaces the process by incise-render. Throws InputError if that fails, and never returns.
int render(const RenderOptions& options);

}  // namespace incise::app
