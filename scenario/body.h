// Builds the body of a scenario: mesh, materials, constraints, loads and tools.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/source_mesh.h"
#include "incise/scenario/tool_build.h"
#include "incise/sim/world.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Returns the materials, the material of each region, the direction of the fibres of each element,
/// and the precision of the forces. Warns of regions that the mesh does not have.
/// Throws InputError if a region of the mesh has no material. Throws BodyError if the material of
/// an element has fibres and the vector of the element in the file has no direction.
physics::MaterialTable build_materials(const Scenario& scenario, const topology::Mesh& mesh,
                                       const CellVectors& cell_vectors,
                                       std::vector<std::string>& warnings);

/// Returns gravity, damping, constraints and loads. Throws BodyError with all empty selections, and
/// with all constraints that prescribe different values of a component of a node.
physics::BoundaryConditions build_boundary_conditions(const Scenario& scenario,
                                                      const topology::Mesh& mesh);

/// Builds the model of the body. Throws BodyError if a material does not suit its elements.
physics::Model make_model(const Scenario& scenario, const topology::Mesh& mesh,
                          const physics::MaterialTable& materials,
                          const physics::BoundaryConditions& boundary_conditions);

/// Builds the world of the body, without tools. Warns of elements that make its steps short. Throws
/// as make_model().
sim::World make_world(const Scenario& scenario, topology::Mesh mesh,
                      physics::MaterialTable materials,
                      physics::BoundaryConditions boundary_conditions,
                      std::vector<std::string>& warnings);

/// The body of a scenario at rest, with the tools.
struct Body {
    topology::Mesh mesh;
    physics::MaterialTable materials;
    physics::BoundaryConditions boundary_conditions;
    std::vector<ScriptedTool> tools;
    std::vector<std::string> warnings;  ///< each begins with its location or file
};

/// Builds the body of a scenario. Throws BodyError with all problems of mesh, materials, selections
/// and tools. If there are any, the model and the time step are checked too. Throws InputError if
/// the scenario has no mesh or no material, MemoryError as build_mesh().
Body build_body(const Scenario& scenario);

/// The problems of a body, one a line.
struct BodyFindings {
    std::vector<std::string> errors, warnings;
    /// How much the run has to do, if nothing is wrong and it makes explicit steps.
    struct Effort {
        double num_steps;          ///< while the body is as it is at the start
        double seconds_of_forces;  ///< of all of them, on one core of this machine
    };
    std::optional<Effort> effort;
    std::vector<std::string> joins;  ///< see topology::BuiltMesh
};

/// Returns what build_body(), make_model() and step_limit() refuse and warn of. If the scenario has
/// no mesh, materials or dynamics (see ScenarioReport), what depends on these is not checked.
/// Throws MemoryError as build_mesh().
BodyFindings check_body(const Scenario& scenario);

}  // namespace incise::scenario
