// Builds what a scenario describes: the mesh, its materials, what holds and loads it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/source_mesh.h"
#include "incise/scenario/tool_build.h"
#include "incise/sim/world.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Which region has which material, which element fibres of which direction, and the precision of
/// the forces. Warns of regions that the mesh does not have.
/// Throws InputError for a region of the mesh without material, BodyError for an element whose
/// material has fibres and whose vector in the file has no direction.
physics::MaterialTable build_materials(const Scenario& scenario, const topology::Mesh& mesh,
                                       const CellVectors& cell_vectors,
                                       std::vector<std::string>& warnings);

/// Gravity, damping, supports and loads. Throws BodyError with all empty selections and supports
/// that hold the same.
physics::BoundaryConditions build_boundary_conditions(const Scenario& scenario,
                                                      const topology::Mesh& mesh);

/// The model of it. Throws BodyError if a material does not suit its elements.
physics::Model make_model(const Scenario& scenario, const topology::Mesh& mesh,
                          const physics::MaterialTable& materials,
                          physics::BoundaryConditions boundary_conditions);

/// The world of it, without tools. Throws as make_model.
sim::World make_world(const Scenario& scenario, topology::Mesh mesh,
                      physics::MaterialTable materials,
                      physics::BoundaryConditions boundary_conditions);

/// What a scenario describes, at rest.
struct Body {
    topology::Mesh mesh;
    physics::MaterialTable materials;
    physics::BoundaryConditions boundary_conditions;
    std::vector<ScriptedTool> tools;
    std::vector<std::string> warnings;  ///< with the location or file in front
};

/// Throws BodyError with all that is at fault: mesh, materials, selections, tools, the time step;
/// MemoryError if the mesh is a box that this machine cannot hold, and so do those below and above.
Body build_body(const Scenario& scenario);

/// What build_body refuses and warns of, a line each.
struct BodyFindings {
    std::vector<std::string> errors, warnings;
};

/// Finds also what make_model and step_limit refuse. Without mesh, materials or dynamics in the
/// scenario (see ScenarioReport) what depends on these is left out.
BodyFindings check_body(const Scenario& scenario);

}  // namespace incise::scenario
