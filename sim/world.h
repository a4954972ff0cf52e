// A body that is deformed and cut, stepped from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "incise/base/error.h"
#include "incise/contact/contact_settings.h"
#include "incise/contact/tool_contact_point.h"
#include "incise/cutting/tools/tool.h"
#include "incise/physics/body/body_arrays.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/model.h"
#include "incise/physics/elements/element_result.h"
#include "incise/sim/handles.h"
#include "incise/sim/ledger.h"
#include "incise/sim/step_inputs.h"
#include "incise/sim/undo_point.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/pose.h"

namespace incise::cutting {
class Cutter;
}

namespace incise::sim {

/// The time integration method of a world.
enum class Solver {
    semi_implicit_euler,  ///< explicit: steps up to World::stable_step()
    implicit_euler,       ///< steps of any length
    statics,              ///< equilibrium at the end of each step
};

/// The definition of a world, as plain values.
struct WorldDef {
    /// The body at rest, m. Mesh data are checked and built into a mesh: see topology::Mesh::build.
    std::variant<topology::MeshData, topology::Mesh> mesh = {};

    std::vector<physics::Material> materials = {};
    /// By region, an index into `materials`. If empty, all regions have the first material.
    std::map<int, std::size_t> material_of_region = {};
    /// By cell id, the direction of the fibres at rest, of unit length. Needed only if a
    /// material has fibres.
    std::vector<Vec3> fibres = {};
    physics::Precision precision = physics::Precision::double_precision;

    Vec3 gravity = Vec3::Zero();                        ///< m/s2
    double damping = 0.0;                               ///< mass-proportional, 1/s
    std::vector<physics::Constraint> constraints = {};  ///< nodes are given by id
    std::vector<physics::Load> loads = {};

    /// Contact between the surfaces of the body. It acts with the explicit solver only.
    contact::ContactSettings contact = {};

    Solver solver = Solver::semi_implicit_euler;
    int num_threads = 1;  ///< does not change any result
};

/// The definition of a tool.
struct ToolDef {
    std::string name = {};  ///< for reports and messages
    cutting::ToolShape shape = {};
};

/// One edit of the mesh by a tool.
struct Edit {
    ToolId tool;
    EditRecord record;       ///< conservation record of the edit
    physics::BodyEdit body;  ///< what it did to mesh and physics
};

/// The state of a tool after a step.
struct ToolState {
    ToolId tool;
    Pose pose;
    bool is_in_tissue = false;  ///< true if the tool splits elements and its cut ends inside one
    /// What the tissue exerts on a tool, mean over the step: force, N, and torque about the origin
    /// of the tool at the end of the step, N m. For a suture, the force on its thread at its first
    /// point, whose length is the tension, and no torque. Zero for carvers, cuts, scissors, and
    /// blades without a toughness.
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

/// Contact in a step.
struct ContactState {
    std::size_t num_points = 0;    ///< points of contact with an impulse
    double max_penetration = 0.0;  ///< largest overlap before the step, m
    double dissipation = 0.0;      ///< energy that contact has taken since the start, J
    double fracture_energy = 0.0;  ///< see contact::Contact::fracture_energy(), J
};

/// The report of one step.
struct StepReport {
    double from = 0.0, to = 0.0;   ///< s
    std::size_t num_substeps = 1;  ///< explicit steps that the step was divided into
    std::vector<Edit> edits;       ///< in order of execution
    /// Those present at the end of the step, and those with a force that were withdrawn at its end.
    std::vector<ToolState> tools;
    ContactState contact;  ///< in the last substep of the step
};

/// Thrown if a tool meets something that it cannot cut.
struct ToolError : InputError {
    ToolError(const std::string& text, ToolId which) : InputError(text), tool(which) {}
    ToolId tool;
};

/// A deformable body with its boundary conditions and the tools that cut it.
///
/// A world can be moved. A world that was moved from can only be destroyed or assigned to.
///
/// Threads: several threads may step several worlds of one process, but only one thread at a time
/// may use the same world.
///
/// Lifetime: references that member functions return are valid until the world is stepped, restored
/// or destroyed. They stay valid when the world is moved.
class World {
  public:
    /// Builds a world in its rest state at time 0.
    /// Throws InputError for an invalid definition: an unsound mesh, a material that does not suit
    /// its elements, constraints that conflict. Cost: O(n log n).
    explicit World(WorldDef def);
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    /// Advances the world by `dt`, s.
    /// @param inputs  where tools and grasps are to be at the end of the step
    ///
    /// First the tissue moves, while the tools move to their new poses. Then the tools, in the
    /// order of tools(), cut the tissue that they have met. With Solver::statics the edited body
    /// then moves to its new equilibrium, and tissue that crosses a tool during this motion is cut
    /// too.
    ///
    /// With the explicit solver, a step above stable_step() moves the tissue in equal parts that
    /// are not above it: StepReport::num_substeps. So does a step in which a probe moves by more
    /// than a quarter of an element, or of its least half width: it does not pass through a
    /// surface. A step of constant length therefore stays possible when strain stiffens the tissue;
    /// it only takes longer. Tools cut once, at the end of the step.
    ///
    /// Throws InputError, and changes nothing, if `dt` is not above 0, if `dt` is above
    /// rest_stable_step() or above 1000 times stable_step() with the explicit solver, if a probe
    /// would need more than 1000 parts, for inputs that require_possible() refuses, or if the world
    /// has failed before.
    /// Throws physics::MotionFailure if the solver fails, and ToolError if a tool meets something
    /// that it cannot cut. In both cases the world has failed: it can be read and restored, but not
    /// stepped.
    const StepReport& step(double dt, const StepInputs& inputs = {});
    /// Advances the world to `time`, s, in one step; see step().
    const StepReport& step_to(double time, const StepInputs& inputs = {});
    /// Throws InputError if a step would refuse these inputs: for tools and grasps that the world
    /// does not have, poses that are not sound, lengths below 0 or of what is no tied suture, and
    /// for tools that are withdrawn and are not there.
    void require_possible(const StepInputs& inputs) const;
    /// Returns the report of the last step. For a step that failed, it ends at the failure.
    const StepReport& report() const;
    /// True if the world has failed; see step().
    bool has_failed() const;

    double time() const;  ///< s
    std::uint64_t num_steps() const;
    /// Returns the upper bound on steps of the explicit solver for the present strain and motion,
    /// s. It is at most rest_stable_step(), and equal to it at small strain. It is computed anew
    /// every 96 steps, and earlier in fast motion. An edit lowers it at once where the nodes near
    /// the edit need that. It rises only after 2048 steps, or after 384 if it can rise by half, so
    /// that most steps are alike. Steps of 0.8 of it leave room for what changes in between.
    /// Source: docs/theory.md, Stable step.
    double stable_step() const;
    /// Returns the same bound for the body at rest, s. Only edits and force terms change it.
    double rest_stable_step() const;

    /// Adds a tool. The tool is present in the world only from its first pose on: that of
    /// place_tool(), or of the inputs of a step.
    /// Throws InputError for an invalid shape, such as a blade with fewer than two points, or a
    /// radius that is not above 0, and for a tool that feels a force in a world without contact.
    ToolId add_tool(const ToolDef& def);
    /// Puts a tool at a pose immediately. The tool cuts and pushes nothing on the path to this
    /// pose. A tool that was closed is open. Throws InputError if its cut ends in the tissue.
    void place_tool(ToolId tool, const Pose& pose);
    /// Closes a tool. The jaws of a grasper take hold of the surface that is in them at the present
    /// pose of the tool, and carry it from now on; returns how many points they hold. Scissors
    /// begin to close in the next step, and hold nothing.
    /// Throws InputError if the tool has nothing to close, or is not there.
    std::size_t close_tool(ToolId tool);
    /// Opens a tool. Tissue that jaws have held keeps its velocity. Throws as close_tool() does.
    void open_tool(ToolId tool);
    /// True from close_tool() to open_tool(), also while scissors are still closing, and if all
    /// tissue has slipped out of jaws. False for tools that do not close.
    bool is_tool_closed(ToolId tool) const;
    /// Returns how many points a grasper holds: 0 if it is open, or if all have slipped out.
    std::size_t num_held(ToolId tool) const;
    /// Passes the thread of a suture through its points, at the present positions of the tissue
    /// there. The thread is then as long as its way. Returns through how many points it passes:
    /// points without tissue in reach are left out. Throws InputError if the tool is no suture.
    std::size_t tie_suture(ToolId tool);
    /// Returns the length of a thread without tension, m; 0 if it is not tied.
    double suture_length(ToolId tool) const;
    /// Takes a thread out of the tissue. Throws InputError if the tool is no suture.
    void untie_suture(ToolId tool);
    /// True from tie_suture() to untie_suture(), until the thread has torn or an edit has left it
    /// fewer than two points.
    bool is_suture_tied(ToolId tool) const;
    /// Returns the points at which tissue exerted a force on a probe or a grasper in the last
    /// substep of the last step. In a step of one substep, the forces add up to
    /// that of its ToolState. Nothing for other tools, for tools that are not there, and after
    /// restore() and undo().
    /// @lifetime  until the world is stepped, restored or destroyed, or the tool is placed or
    /// opened
    std::span<const contact::ToolContactPoint> tool_contacts(ToolId tool) const;
    bool is_tool_present(ToolId tool) const;
    Pose tool_pose(ToolId tool) const;
    const ToolDef& tool(ToolId tool) const;
    std::optional<ToolId> find_tool(std::string_view name) const;
    /// Returns the tools in the order in which they were added. None is ever removed: the index of
    /// an id is its position here.
    /// @lifetime Until a tool is added or the world is restored.
    std::span<const ToolId> tools() const;

    /// Adds a constraint with a known motion: its curves are functions of the time of the world.
    /// Throws InputError, and changes nothing, if a node does not exist, or if another constraint
    /// prescribes another value of a component of a node.
    ConstraintId add_constraint(physics::Constraint constraint);
    /// Grasps nodes at their current positions. The nodes then move rigidly with a frame, for
    /// example that of a gripper.
    /// @param pose  the present pose of the frame, m
    /// Throws InputError as add_constraint() does, and for an invalid pose.
    ConstraintId grasp(std::string name, std::vector<VertexId> nodes, const Pose& pose);
    /// Returns the present pose of the frame of a grasp; nothing for another constraint.
    std::optional<Pose> grasp_pose(ConstraintId constraint) const;
    /// Replaces a constraint, which is no grasp, by another one from the next step on. The id
    /// stays. Throws as add_constraint().
    void set_constraint(ConstraintId constraint, physics::Constraint by);
    /// Removes a constraint, which may be a grasp. The nodes of the constraint keep their
    /// velocities.
    void release(ConstraintId constraint);
    /// Returns the force, N, and the torque, N m, that a constraint exerted on the body, means over
    /// the last step.
    const physics::Reaction& reaction(ConstraintId constraint) const;

    /// Returns the constraints, in the order of model().boundary().constraints(): those of the
    /// definition, then those that were added.
    /// @lifetime Until the list changes or the world is restored.
    std::span<const ConstraintId> constraints() const;

    /// Adds a load.
    /// Throws InputError, and changes nothing, if the load acts on nothing, or on nodes, faces or
    /// elements that do not exist.
    LoadId add_load(physics::Load load);
    /// Replaces a load. The id stays. Throws as add_load().
    void set_load(LoadId load, physics::Load by);
    /// Scales a load by a constant factor, which replaces its previous factor from now on.
    void set_load_factor(LoadId load, double factor);
    void remove_load(LoadId load);
    /// Returns the loads, in the order of model().boundary().loads(); see constraints().
    std::span<const LoadId> loads() const;

    /// Adds a force of your own, such as springs to points in space or a field. It acts in all
    /// steps from the next one on. Bytes of save() do not contain it: restore() keeps the terms
    /// that the world has, and calls their update().
    /// Throws InputError, and adds nothing, for null and for a bound on the stiffness that is not
    /// finite or below 0. Cost: O(n), for the stable step.
    void add_force_term(std::unique_ptr<physics::ForceTerm> term);
    /// Removes and destroys a force term. Throws InputError if the world does not have it.
    void remove_force_term(const physics::ForceTerm* term);

    /// Sets the gravity, m/s2, from the next step on. Throws InputError if it is not finite.
    void set_gravity(const Vec3& gravity);
    /// Sets the mass-proportional damping, 1/s, from the next step on. Throws InputError below 0.
    void set_damping(double damping);
    /// Gives regions another material from the next step on: tissue that is heated, swollen or
    /// torn. The body keeps positions, velocities and masses; the jump of its elastic energy counts
    /// as external work. Viscous stress stays where the Prony series has as many terms of the same
    /// rule as before; else it begins anew. restore() then needs bytes of a world whose
    /// materials were changed likewise; undo() brings the former ones back.
    /// @param regions  empty: all
    /// @param fibre    the direction of the fibres at rest, of unit length, for a law that needs
    /// it;
    ///                 if not set, elements keep theirs
    /// Throws InputError, and changes nothing, for an invalid material, one with another density
    /// than that of the region, a region that the body does not have, a material that does not suit
    /// its elements, and one that is too soft for the toughness of a blade of the world.
    /// Cost: O(n), that of a new world without its mesh.
    void set_material(const physics::Material& material, std::span<const int> regions = {},
                      const std::optional<Vec3>& fibre = {});

    /// Returns the surface of the body. The surface is built at the first call and then follows the
    /// edits.
    const topology::BoundarySurface& surface();
    /// Returns the positions in the list of triangles that are new since the last call, in
    /// ascending order; see BoundarySurface::take_changes().
    std::vector<std::size_t> take_surface_changes();

    /// Returns the forces of contact in the last step, N, at the nodes of the mesh at which they
    /// are not zero, in ascending order of the nodes; nothing for a world without contact. Graspers
    /// count; threads and the force of cutting, which act inside the tissue, do not.
    std::optional<std::vector<std::pair<VertexId, Vec3>>> contact_forces() const;

    void set_num_threads(int n);

    const topology::Mesh& mesh() const;
    /// Returns the positions, m, and the velocities, m/s, of the nodes of the mesh, by id. Dead
    /// nodes have values without meaning.
    /// @lifetime Until the world is stepped, restored or destroyed.
    std::span<const Vec3> positions() const;
    std::span<const Vec3> velocities() const;
    /// Returns the mass of the material at each node of the mesh, kg, by id. After a cut these
    /// masses and velocities() do not add up to the momentum: see body_arrays(). Cost: O(n).
    std::vector<double> masses() const;
    /// Returns the nodes that carry momentum and kinetic energy, with their positions, velocities,
    /// masses and elements, as copies. Cost: O(n).
    physics::BodyArrays body_arrays() const;
    /// Returns stress, energy and change of volume of the cells of mesh(), in ascending order of
    /// their ids, at the last step. Cells that one fragment carries have the same stress and volume
    /// ratio, and the energy and volume of the whole fragment. Cost: O(n).
    std::vector<physics::ElementResult> cell_results() const;
    /// Returns the model. Its arrays are by node of its fragments: after a cut, these nodes have
    /// other ids than those of the mesh.
    const physics::Model& model() const;
    const cutting::Cutter& cutter() const;
    const Ledger& ledger() const;

    /// The format of save(). It differs between two builds of Incise if save() or a checkpoint of a
    /// run lists other members, or if a world computes other bits.
    static constexpr std::uint32_t state_format = 30;

    /// Returns the state of the world as bytes: mesh, positions, velocities, gravity, damping,
    /// constraints, loads, contact, tools and cuts in progress. The materials and the solver are
    /// not included. Cost: some 100 bytes an element and as many a node.
    std::string save() const;
    /// Restores a state that save() has returned. Later steps give the same results bit for bit.
    /// Throws InputError, and changes nothing, for bytes that cannot be a state of a world with the
    /// same materials and the same solver. Force laws are compared by their kind and by their
    /// moduli at rest. The mesh may be any: that of the bytes. There is no checksum, so that a
    /// changed number may not be detected.
    ///
    /// Cost: that of a new world and of topology::validate().
    /// @pre  the saved world had the same materials and the same solver
    void restore(std::string_view bytes);

    /// Returns the present moment, to which undo() can go back. From now on the world remembers
    /// its edits, until all such moments are destroyed. Throws InputError if the world has failed.
    /// Cost: O(#nodes).
    UndoPoint undo_point() const;
    /// Goes back to a moment: takes back all edits since then, and gives body, tools, constraints,
    /// loads and time what they had. save() returns the bytes that it would have returned then, and
    /// later steps give the same bits. It also brings a world back that has failed. Ids of what has
    /// been added since then are refused from now on. The same moment can be gone back to again.
    /// Force terms stay, as in restore().
    /// Throws InputError, and changes nothing, for a moment of another world, for one after an edit
    /// that was taken back, and for one from before restore().
    /// Cost: that of the edits since then, and O(n), some steps.
    void undo(const UndoPoint& point);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::sim
