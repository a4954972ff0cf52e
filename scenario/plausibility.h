// What a scenario may say, but hardly means: mistaken units, a body that falls, an idle blade.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Returns warnings of a size, a density or a stiffness that no tissue has, of a body that nothing
/// holds against gravity, of one that its own weight would crush, and of blades that move along
/// their own edge. Each begins with its location. Cost: O(n) in the nodes.
/// @param materials  null if the scenario has errors in them; then they give no warning
std::vector<std::string> implausible(const Scenario& scenario, const topology::Mesh& mesh,
                                     const physics::MaterialTable* materials);

/// Returns a warning, without its location, if no tissue has the density.
/// @param number   of the material, from 1
/// @param density  kg/m3
std::optional<std::string> doubt_of_density(std::size_t number, double density);

/// Returns a warning if a few elements alone make explicit steps less than half as long as the
/// others would. It names them. Cost: O(n) in the elements.
std::optional<std::string> warning_of_costly_elements(const physics::Model& model);

}  // namespace incise::scenario
