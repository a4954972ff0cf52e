// What a cut of a body has to keep, and what it has to leave.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/physics/body/model.h"
#include "incise/topology/mesh_data.h"

namespace incise::cutting {

/// Each law of the tests, in a region of its own.
physics::MaterialTable all_materials(std::size_t num_elements);
/// Gives the cells their regions in turn.
topology::MeshData with_all_materials(topology::MeshData data);

/// Sums over the body, and the sums of absolute values that tell their rounding.
struct Balance {
    explicit Balance(const physics::Model& model);

    physics::Totals totals;
    Vec3 moment = Vec3::Zero();  ///< of mass
    double momentum_scale = 0.0, angular_scale = 0.0, moment_scale = 0.0, elastic_scale = 0.0;
};

/// Expects that a cut that took nothing away kept mass, volume and momenta; without light
/// fragments that join others also energies and the centre of mass.
/// @param before  of the model, which has followed the cut since
/// @param done    what it did to the model
/// @param has_exact_energies  false for bodies of other cells than tetrahedra: there the mean
/// volume
///                            of a part differs from that of the whole
void expect_kept(const Balance& before, const physics::Model& model, const physics::BodyEdit& done,
                 bool has_exact_energies = true);

/// Expects that the model is, to the bit, one built afresh on its mesh and fragments.
void expect_equal_to_a_fresh_one(physics::Model& model, const physics::MaterialTable& table);

}  // namespace incise::cutting
