// A scenario as plain data: what to simulate, how long, and what to write.
// docs/scenario.md describes the file; scenario_reader.h reads it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/contact/surface_contact.h"
#include "incise/cutting/tools/tool.h"
#include "incise/io/vtk/frame.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/laws/material.h"
#include "incise/scenario/material_catalog.h"
#include "incise/scenario/time_key.h"
#include "incise/sim/selection.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh_data.h"

namespace incise::scenario {

/// A box that topology::box_mesh divides into elements.
struct BoxMeshSpec {
    Vec3 size;
    std::array<int, 3> cells{1, 1, 1};
    topology::CellKind element = topology::CellKind::tetrahedron;
    Vec3 origin = Vec3::Zero();
};

/// The [mesh] section.
struct MeshSpec {
    /// A file, with the folder of the scenario in its path, or a box. The path is empty if the mesh
    /// is not known. A program can put a mesh of its own here after reading; it must not be null.
    std::variant<std::filesystem::path, BoxMeshSpec, std::shared_ptr<const topology::MeshData>>
        source;
    double scale = 1.0;  ///< factor of all coordinates of the source
    std::string region_array = "region";
    /// For a file: true if points at the same position are joined. False states that such points
    /// are separate on purpose. Without a value they are not joined, and a warning reports them.
    std::optional<bool> weld = std::nullopt;
    bool linear = false;  ///< true if cells of higher order of a file are read by their corners
    /// FILE:line:column for messages, of the source and of two keys.
    std::string location = {}, scale_location = {}, region_array_location = {};
};

/// A [[material]] section.
struct MaterialSpec {
    /// If not set, the material takes all regions that no other material names. At most one
    /// material has no regions.
    std::optional<std::vector<int>> regions;
    Method method = Method::heml;
    std::string_view law = "neo-hookean";   ///< HEML: the key of the law in laws()
    double density = 0.0;                   ///< kg/m3
    ElasticParameters parameters;           ///< as given; resolve() turns them into moduli
    bool has_published_moduli = false;      ///< all of `parameters` are those of a tissue
    double inversion_threshold = 0.4;       ///< HEML: J0, in (0, 1)
    std::vector<physics::PronyTerm> prony;  ///< HEML: empty for an elastic material
    physics::PronyRule prony_rule = physics::PronyRule::stress;
    /// For laws with fibres: the direction of the fibres at rest, of unit length, or the name of
    /// the cell array in the mesh file that holds the directions.
    std::variant<std::monostate, Vec3, std::string> fibre;
    double stiffness_ratio = 1.0;   ///< HybMSS: A, from 0 to infinity
    bool correction_forces = true;  ///< HybMSS: if false, Poisson's ratio is 1/4
    std::string location = {};      ///< for messages: FILE:line:column
    std::string regions_location = {};
};

enum class Mode { dynamic, statics };
enum class TimeIntegrator { semi_implicit_euler, implicit_euler };

/// The [dynamics] section.
struct DynamicsSpec {
    Mode mode = Mode::dynamic;
    TimeIntegrator integrator = TimeIntegrator::semi_implicit_euler;  ///< for Mode::dynamic
    double end_time = 0.0;                                            ///< s; 0 if not known
    /// True if a program steps the world, and the document names no end. The end time is then
    /// infinite; in statics it is the 1 s in which loads usually come up to their full values.
    bool is_endless = false;
    /// The fixed time step, s. If not set, the step is the stable step times `safety`. Implicit
    /// Euler needs a fixed step.
    std::optional<double> time_step;
    /// For Mode::statics: the number of load steps of the run. If not set, there is one load step
    /// for each frame.
    std::optional<int> steps;
    double safety = 0.8;          ///< in (0, 1]
    double damping = 0.0;         ///< mass-proportional, 1/s
    Vec3 gravity = Vec3::Zero();  ///< m/s2
    /// Precision of the forces in explicit steps. Single precision exists for HEML and HybMSS only.
    physics::Precision precision = physics::Precision::double_precision;
    std::string end_time_location = {}, time_step_location = {},
                precision_location = {};  ///< for messages

    /// True if the steps are explicit, and so have a largest stable length.
    bool is_explicit() const {
        return mode == Mode::dynamic && integrator == TimeIntegrator::semi_implicit_euler;
    }
};

/// A [[constraint]] section. The constraint prescribes the components of the positions of nodes
/// along the fixed axes: x = about + R(angle) (X - about) + by, with the rest position X. Without
/// keys in `move` and `rotate`, x = X.
struct ConstraintSpec {
    std::string name;
    sim::Selection where;
    /// The fixed axes. At least one is true, unless the axes or the motion are not known. If the
    /// scenario moves or rotates nodes and names no axes, all three are true.
    std::array<bool, 3> fixed{};
    std::vector<TimeKey<Vec3>> move;      ///< `by`, m
    std::vector<TimeKey<double>> rotate;  ///< `angle`, radians
    Vec3 about_point = Vec3::Zero();      ///< `about`, m
    Vec3 about_axis = Vec3::UnitZ();      ///< of unit length
    std::string location = {};            ///< for messages: FILE:line:column
};

struct NodalForce {
    Vec3 force;  ///< N, on each selected node
};
struct Traction {
    Vec3 stress;  ///< force per area at rest, N/m2, in a fixed direction
};
struct Pressure {
    double pressure = 0.0;  ///< Pa, per current area; a positive pressure pushes inwards
};
struct BodyForce {
    Vec3 density;  ///< force per rest volume, N/m3
};

/// A [[load]] section: a force on the selected nodes, boundary faces or elements, multiplied by a
/// factor that depends on time.
struct LoadSpec {
    std::string name;
    sim::Selection where;
    std::variant<NodalForce, Traction, Pressure, BodyForce> load;
    std::vector<TimeKey<double>> factor;  ///< if empty, the factor is 1
    std::string location = {};            ///< for messages: FILE:line:column
};

using cutting::CutMode;

/// The file of a triangulated surface that a tool has as its shape.
struct SurfaceFile {
    std::filesystem::path path;
    double scale = 1.0;         ///< factor of all coordinates
    std::string location = {};  ///< for messages: FILE:line:column
};

/// A [[tool]] or [[obstacle]] section. The tool is present from the first to the last key of its
/// path. A tool that no pose leads has one key: the time of a cut, or at which a suture is tied.
struct ToolSpec {
    std::string name;
    cutting::ToolShape shape = {};
    std::optional<SurfaceFile> surface = {};  ///< build_tool() reads it into the shape
    bool is_obstacle = false;                 ///< a probe that is always present
    /// At least one key, for a blade at least two. The path is empty if it is not known.
    std::vector<TimeKey<Pose>> path = {};
    std::optional<double> close = {};   ///< when jaws close, s
    std::optional<double> open = {};    ///< when they open, s; without it, at the end of the path
    double over = 0.0;                  ///< how long a thread is drawn, s
    std::optional<double> length = {};  ///< to which it is drawn, m; without it, it stays as it is
    std::string location = {};          ///< for messages: FILE:line:column
};

/// The fields that a frame can hold in addition to points, rest positions, ids and regions. The
/// last two have keys of their own. They stand for the arrays of physics::BodyArrays, and for
/// tetrahedra in place of all other cells.
enum class Field {
    displacement,
    velocity,
    mass,
    force,
    stress,
    von_mises,
    J,
    energy_density,
    physics,
    tetrahedra
};

/// The [output] section.
struct OutputSpec {
    double interval = 0.01;     ///< simulated time between frames, s; 0 for no frames
    std::vector<Field> fields;  ///< without repetitions
    /// Simulated time between checkpoints, s. If 0, there is a checkpoint only when a signal stops
    /// the run.
    double checkpoint_interval = 0.0;
    io::Compression compression = io::Compression::zlib;
};

/// Bounds on a quantity of the finished run.
struct Expectation {
    std::string quantity;
    std::optional<double> min, max;  ///< at least one is set; the bounds themselves are allowed
};

/// A whole scenario.
struct Scenario {
    std::string name;              ///< name of the file without folder and extension
    std::filesystem::path folder;  ///< folder of the file
    std::string title;
    MeshSpec mesh;
    std::vector<MaterialSpec> materials;
    DynamicsSpec dynamics;
    contact::ContactSettings contact;
    std::vector<ConstraintSpec> constraints;
    std::vector<LoadSpec> loads;
    std::vector<ToolSpec> tools;
    /// False if a constraint, load or tool has a mistake: what is left of them says little.
    bool knows_what_holds = true;
    OutputSpec output;
    std::vector<Expectation> expect;
    /// 16 hexadecimal digits that depend on all values of the scenario, with overrides. They do not
    /// depend on layout, comments or the contents of the mesh file.
    std::string hash;
    /// The values from which the hash is computed: path and text of each, in ascending order.
    std::vector<std::pair<std::string, std::string>> contents;
    /// The scenario as TOML, with overrides. Names of files are absolute, so that it can be run
    /// from any folder.
    std::string text;
};

/// The names of fields, without the last two, and of compressions in scenarios and frames, indexed
/// by Field and io::Compression.
inline constexpr std::array<std::string_view, 8> field_names = {
    "displacement", "velocity", "mass", "force", "stress", "von_mises", "J", "energy_density"};
inline constexpr std::array<std::string_view, 4> compression_names = {"none", "lz4", "zlib",
                                                                      "lzma"};

}  // namespace incise::scenario
