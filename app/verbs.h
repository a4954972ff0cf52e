// The verbs of the command: one function and one file each. command_line.h fills in the options.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::app {

/// Exit statuses; the verbs return done or missed_expectation, everything else comes from
/// exceptions (see main.cpp).
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
    std::vector<std::string> overrides;  ///< "key.path=value", for scenario::read_scenario
    int num_threads = 0;                 ///< 0: as many as the machine has cores
    bool resume = false;
    bool dry_run = false;
    bool quiet = false;
};
int run(const RunOptions& options);

struct BenchOptions {
    std::optional<std::filesystem::path> json;  ///< "-": standard output
};
int bench(const BenchOptions& options);

struct CheckOptions {
    std::vector<std::filesystem::path> files;
};
/// input_at_fault if any file has a problem; all are looked at.
int check(const CheckOptions& options);

struct InfoOptions {
    std::filesystem::path mesh;
    std::string region_array = "region";
    bool json = false;
};
int info(const InfoOptions& options);

struct ConvertOptions {
    std::filesystem::path in, out;
    std::string region_array = "region";
    bool weld = false;
};
int convert(const ConvertOptions& options);

struct MeshOptions {
    std::filesystem::path in, out;
    bool hex = false;
    std::string size;   ///< empty: one cell a voxel
    std::string scale;  ///< empty: 1
};
int mesh(const MeshOptions& options);

/// An option that adds a tool, as it was given.
struct CutToolArgument {
    std::string option, text;
};
struct CutOptions {
    std::filesystem::path mesh, out;
    std::vector<CutToolArgument> tools;         ///< in the order of the command line
    std::optional<std::filesystem::path> json;  ///< "-": standard output
    std::string mode;                           ///< empty: the mesh's usual one
    std::string snap;                           ///< empty: cutting::default_snap
    std::string region_array = "region";
};
int cut(const CutOptions& options);

struct MaterialsOptions {
    std::string name;  ///< empty: all
    bool json = false;
};
int materials(const MaterialsOptions& options);

struct RenderOptions {
    std::vector<std::string> arguments;  ///< for incise-render, as they are
};
/// Becomes incise-render; returns only by an exception.
int render(const RenderOptions& options);

}  // namespace incise::app
