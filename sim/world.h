// A body that is deformed and cut, stepped from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "incise/base/error.h"
#include "incise/cutting/cutter.h"
#include "incise/cutting/tools/tool.h"
#include "incise/physics/body/model.h"
#include "incise/sim/ledger.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/pose.h"

namespace incise::sim {

/// How a world gets from one moment to the next.
enum class Solver {
    semi_implicit_euler,  ///< explicit: steps below World::stable_step()
    implicit_euler,       ///< any step
    statics,              ///< equilibrium at each moment
};

/// What a world is made of: plain values.
struct WorldDef {
    /// The body at rest, m. Mesh data are checked and built; see topology::Mesh::build.
    std::variant<topology::MeshData, topology::Mesh> mesh = {};

    std::vector<physics::Material> materials = {};
    /// The index of the material of each region. Empty: all regions have the first material.
    std::map<int, std::size_t> material_of_region = {};
    /// The direction of the fibres at rest, of unit length, by element id. Needed if a material has
    /// fibres.
    std::vector<Vec3> fibres = {};
    physics::Precision precision = physics::Precision::double_precision;

    Vec3 gravity = Vec3::Zero();                        ///< m/s2
    double damping = 0.0;                               ///< mass-proportional, 1/s
    std::vector<physics::Constraint> constraints = {};  ///< their nodes are ids of the mesh
    std::vector<physics::Load> loads = {};

    Solver solver = Solver::semi_implicit_euler;
    int num_threads = 1;  ///< of no influence on any result
};

/// The number of a tool in its world; never given to another one.
struct ToolId {
    std::size_t index = 0;
    bool operator==(const ToolId&) const = default;
};

/// The number of a constraint in its world; never given to another one.
struct ConstraintId {
    std::size_t index = 0;
    bool operator==(const ConstraintId&) const = default;
};

/// The number of a load in its world; never given to another one.
struct LoadId {
    std::size_t index = 0;
    bool operator==(const LoadId&) const = default;
};

struct ToolDef {
    std::string name = {};  ///< for reports and messages
    cutting::ToolShape shape = {};
};

/// One edit of the mesh, which a tool has made.
struct Edit {
    ToolId tool;
    EditRecord record;            ///< what it took and left
    topology::ChangeSet changes;  ///< what it did to the mesh
};

/// A tool after a step.
struct ToolState {
    ToolId tool;
    Pose pose;
    bool is_in_tissue = false;  ///< of a blade that splits: its cut ends within an element
};

/// What happened in one step.
struct StepReport {
    double from = 0.0, to = 0.0;   ///< s
    std::vector<Edit> edits;       ///< in the order in which they were made
    std::vector<ToolState> tools;  ///< those that took part
};

/// A tool has met what it cannot cut.
struct ToolError : InputError {
    ToolError(const std::string& text, ToolId which, bool meets_undividable)
        : InputError(text), tool(which), is_undividable(meets_undividable) {}
    ToolId tool;
    bool is_undividable;  ///< an element that is to be divided is no tetrahedron
};

/// A body, what acts on it, and the tools that cut it.
///
/// A world can be moved; the one that it was moved from can be destroyed and assigned to, and
/// nothing else. Several worlds can live in one process and be stepped by several threads,
/// each world by one thread at a time. References that its functions return are valid until the
/// world is stepped, restored or destroyed; moving it keeps them.
class World {
  public:
    /// Throws InputError for what is wrong with the definition: the mesh, a material that does not
    /// suit its elements, constraints that conflict. Cost: O(n log n).
    explicit World(WorldDef def);
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    /// Goes on by `dt`, s. First the tissue moves while the tools go to their poses. Then each
    /// tool, in the order of their ids, cuts what it has met. In statics the edited body goes to
    /// its new equilibrium, and what crosses a tool on the way is cut as well.
    ///
    /// Throws InputError, and changes nothing, if dt is not above 0, if it is above the stable step
    /// of an explicit solver, or if the world has failed before.
    /// Throws physics::MotionFailure if the motion is lost, ToolError if a tool meets what it
    /// cannot cut. The world has failed then: it can be looked at, and restored, but not stepped.
    const StepReport& step(double dt);
    /// The same with the time at the end of the step, s.
    const StepReport& step_to(double time);
    /// Of the last step; also of one that failed, up to there.
    const StepReport& report() const;
    bool has_failed() const;

    double time() const;  ///< s
    std::uint64_t num_steps() const;
    /// The bound on explicit steps at rest, s.
    double stable_step() const;

    /// Adds a tool. It is not in the body's space before it has a pose. Throws InputError for a
    /// shape that is none: a blade with fewer than two points, or a radius that is not above 0.
    ToolId add_tool(ToolDef def);
    /// Puts a tool to a pose at once: it cuts nothing on the way there.
    void place_tool(ToolId tool, const Pose& pose);
    /// Where the tool is to be at the end of the next step. Without a call it rests. A tool that
    /// was not there before appears at this pose.
    void set_tool_pose(ToolId tool, const Pose& pose);
    /// The tool takes part in the next step and is gone after it: its cut ends where the blade then
    /// is. It can come back by a new pose.
    /// @param pose_before  a pose a moment before its last one, which tells the direction in which
    ///                     it moved; null: that of the last step in which it moved
    void withdraw_tool(ToolId tool, const Pose* pose_before = nullptr);
    bool is_tool_present(ToolId tool) const;
    Pose tool_pose(ToolId tool) const;
    const ToolDef& tool(ToolId tool) const;
    std::size_t num_tools() const;

    /// Adds a constraint whose motion is known beforehand: its curves go with the time of the
    /// world. Those of the definition have the first numbers. Throws InputError, and changes
    /// nothing, if a node is not there, or if it prescribes what another constraint does.
    ConstraintId add_constraint(physics::Constraint constraint);
    /// Takes hold of nodes where they are now. `pose` is that of the thing that holds them, m: the
    /// nodes go where its frame goes. Throws as add_constraint().
    ConstraintId grasp(std::string name, std::vector<NodeId> nodes, const Pose& pose);
    /// Where the frame of a grasp is to be at the end of the next step. Without a call it rests.
    /// Throws InputError for a constraint that is no grasp.
    void set_grasp_pose(ConstraintId grasp, const Pose& pose);
    /// Removes a constraint, a grasp or another one. Its nodes go on with the velocities that they
    /// have.
    void release(ConstraintId constraint);
    /// What a constraint did to the body in the last step, N and N m.
    const physics::Reaction& reaction(ConstraintId constraint) const;

    /// Adds a load. Those of the definition have the first numbers. Throws InputError, and changes
    /// nothing, if it acts on what is not there, or on nothing.
    LoadId add_load(physics::Load load);
    /// Scales a load by a constant factor from now on.
    void set_load_factor(LoadId load, double factor);
    void remove_load(LoadId load);

    /// The surface of the body. It is built at the first call, and follows edits from then on.
    topology::BoundarySurface& surface();

    void set_num_threads(int n);

    const topology::Mesh& mesh() const;
    const physics::Model& model() const;
    const cutting::Cutter& cutter() const;
    const Ledger& ledger() const;

    /// Returns everything but the materials and the solver: mesh, state, constraints, loads, tools
    /// and cuts in progress. Cost: some 100 bytes an element and as many a node.
    std::string save() const;
    /// Goes on from what a world of the same materials and solver has saved, to the same bits.
    /// Throws InputError, and changes nothing, for bytes that cannot be those of such a world. Laws
    /// are compared by their kind and their moduli at rest. There is no checksum: a changed number
    /// goes unnoticed.
    /// Cost: that of a new world, and of topology::validate().
    void restore(std::string_view bytes);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::sim
