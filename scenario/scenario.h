// A scenario as plain data: what to simulate, how long, and what to write.
// docs/scenario.md describes the file that it is read from; scenario_reader.h reads it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/tools/tool.h"
#include "incise/io/vtk/frame.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/laws/material.h"
#include "incise/scenario/material_catalog.h"
#include "incise/scenario/time_key.h"
#include "incise/sim/selection.h"
#include "incise/topology/cell_kind.h"

namespace incise::scenario {

/// A box meshed by topology::box_mesh.
struct BoxMeshSpec {
    Vec3 size;
    std::array<int, 3> cells{1, 1, 1};
    topology::CellKind element = topology::CellKind::tetrahedron;
    Vec3 origin = Vec3::Zero();
};

struct MeshSpec {
    /// A file (already relative to the scenario's folder, or absolute), or a box. An empty path:
    /// not known.
    std::variant<std::filesystem::path, BoxMeshSpec> source;
    double scale = 1.0;  ///< all coordinates of the source are multiplied by it
    std::string region_array = "region";
    /// Of a file: whether its points at one position are joined. False says besides that they are
    /// meant to be apart; without, they are told of.
    std::optional<bool> weld = std::nullopt;
    /// For messages: those of the source and of the others.
    std::string location = {}, scale_location = {}, region_array_location = {};
};

struct MaterialSpec {
    /// Without: all regions that no other material names. At most one material is without.
    std::optional<std::vector<int>> regions;
    Method method = Method::heml;
    std::string_view law = "neo-hookean";  ///< of HEML: the key of its row in laws()
    double density = 0.0;
    ElasticParameters parameters;           ///< as given; resolve() makes constants of them
    double inversion_threshold = 0.4;       ///< J0, in (0, 1); of HEML
    std::vector<physics::PronyTerm> prony;  ///< of HEML; empty: elastic
    physics::PronyRule prony_rule = physics::PronyRule::stress;
    /// Of laws with fibres: their direction at rest, of unit length, or the cell array of the mesh
    /// file that has it.
    std::variant<std::monostate, Vec3, std::string> fibre;
    double stiffness_ratio = 1.0;   ///< A of HybMSS, 0 to infinity
    bool correction_forces = true;  ///< of HybMSS: without, Poisson's ratio is 1/4
    std::string location = {};      ///< for messages: FILE:line:column
    std::string regions_location = {};
};

enum class Mode { dynamic, statics };
enum class TimeIntegrator { semi_implicit_euler, implicit_euler };

struct DynamicsSpec {
    Mode mode = Mode::dynamic;
    TimeIntegrator integrator = TimeIntegrator::semi_implicit_euler;  ///< of dynamics
    double end_time = 0.0;
    /// Without: the stable step times `safety`. Implicit Euler has one.
    std::optional<double> time_step;
    /// Of statics: load steps to the end. Without: one for each frame.
    std::optional<int> steps;
    double safety = 0.8;   ///< in (0, 1]
    double damping = 0.0;  ///< mass-proportional, 1/s
    Vec3 gravity = Vec3::Zero();
    /// Of the forces of semi-implicit Euler's steps; single for heml and hybmss alone.
    physics::Precision precision = physics::Precision::double_precision;
    std::string end_time_location = {}, time_step_location = {},
                precision_location = {};  ///< for messages
};

/// Nodes that are held or led: their positions along the fixed axes are those of
/// x = about + R(angle) (X - about) + by, which without keys is the rest position X.
struct ConstraintSpec {
    std::string name;
    sim::Selection where;
    /// At least one, unless not known; of a led node all, unless some are named.
    std::array<bool, 3> fixed{};
    std::vector<TimeKey<Vec3>> move;
    std::vector<TimeKey<double>> rotate;  ///< radians
    Vec3 about_point = Vec3::Zero();
    Vec3 about_axis = Vec3::UnitZ();  ///< of unit length
    std::string location = {};        ///< for messages: FILE:line:column
};

struct NodalForce {
    Vec3 force;  ///< newtons, on each selected node
};
struct Traction {
    Vec3 stress;  ///< newtons a square metre of rest area, in a fixed direction
};
struct Pressure {
    double pressure = 0.0;  ///< pascal; follows the surface, positive pushes inwards
};
struct BodyForce {
    Vec3 density;  ///< newtons a cubic metre of rest volume
};

/// A force on the selected nodes, boundary faces or elements, times a factor of time.
struct LoadSpec {
    std::string name;
    sim::Selection where;
    std::variant<NodalForce, Traction, Pressure, BodyForce> load;
    std::vector<TimeKey<double>> factor;  ///< empty: 1
    std::string location = {};            ///< for messages: FILE:line:column
};

using cutting::Carver;
using cutting::CutMode;

/// Cuts along what its edge sweeps.
struct BladeSpec {
    std::vector<Vec3> edge;       ///< polyline in the tool's frame, at least two points
    std::optional<CutMode> mode;  ///< without: usual_mode of the mesh (tool_build.h)
    std::optional<double> snap;   ///< of splitting: see cutting::SplitOptions
};

/// The points x with (x - point) . normal = 0.
struct PlaneSpec {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
};

/// Splits all at once, when its time comes, along a plane or the triangulated surface of a file.
struct CutSpec {
    std::variant<PlaneSpec, std::filesystem::path> along;
    double scale = 1.0;  ///< all coordinates of the surface are multiplied by it
    std::optional<double> snap;
    std::string location = {};  ///< for messages, of the file's name
};

/// A tool is there from the first to the last key of its path; a cut has one key, its time.
struct ToolSpec {
    std::string name;
    std::variant<Carver, BladeSpec, CutSpec> kind;
    /// At least one key, for a blade two. Empty: not known.
    std::vector<TimeKey<Pose>> path;
    std::string location = {};  ///< for messages: FILE:line:column
};

/// What a frame can hold besides points, rest positions, ids and regions.
enum class Field { displacement, velocity, mass, force, stress, von_mises, J, energy_density };

struct OutputSpec {
    double interval = 0.01;            ///< simulated seconds between frames; 0: none
    std::vector<Field> fields;         ///< each once
    double checkpoint_interval = 0.0;  ///< simulated seconds; 0: only where a signal stops the run
    io::Compression compression = io::Compression::zlib;
};

/// A quantity of the finished run, and what it must be.
struct Expectation {
    std::string quantity;
    std::optional<double> min, max;  ///< at least one; both allowed values themselves
};

struct Scenario {
    std::string name;              ///< the file's name without folder and ending
    std::filesystem::path folder;  ///< where the file lies
    std::string title;
    MeshSpec mesh;
    std::vector<MaterialSpec> materials;
    DynamicsSpec dynamics;
    std::vector<ConstraintSpec> constraints;
    std::vector<LoadSpec> loads;
    std::vector<ToolSpec> tools;
    OutputSpec output;
    std::vector<Expectation> expect;
    /// 16 hexadecimal digits that change with anything the scenario says (overrides included),
    /// not with layout or comments, nor with the contents of the mesh file.
    std::string hash;
    /// What the hash is of: each value as text with its path, in the order of the paths.
    std::vector<std::pair<std::string, std::string>> contents;
};

/// The names by which scenarios and frames know fields and compressions, indexed by them.
inline constexpr std::array<std::string_view, 8> field_names = {
    "displacement", "velocity", "mass", "force", "stress", "von_mises", "J", "energy_density"};
inline constexpr std::array<std::string_view, 4> compression_names = {"none", "lz4", "zlib",
                                                                      "lzma"};

}  // namespace incise::scenario
