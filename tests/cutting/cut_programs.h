// Random cuts of every sort, for programs of several through one body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "incise/physics/body/model.h"
#include "split_body.h"
#include "support/mesh_families.h"

namespace incise::cutting {

enum class CutKind { plane, blade, sheet, sphere };

struct RandomCut {
    CutKind kind{};
    std::string description;
    Stroke stroke;
    std::optional<BladeEnd> end;                       ///< of a blade
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  ///< of a plane
};

/// A cut of a body whose nodes are there. Planes: anywhere, through three nodes, through one along
/// the axes. Blades: polylines of one to three segments that go anywhere in one to five steps, in
/// or out of a plane. Sheets: wavy, right through or with their rims inside. Spheres: inside or
/// only partly.
RandomCut random_cut(std::span<const Vec3> positions, test::Random& random);

/// Cuts a body at rest by the rule for cells of any shape, whatever its cells are. A blade is left
/// in it.
void cut_cells(topology::Mesh& mesh, fragments::FragmentMesh& fragments, const RandomCut& cut);
/// A cut of a body at rest.
RandomCut random_cut(const topology::Mesh& mesh, test::Random& random);

/// A smooth motion of all of space: a strain and some waves. Displacement at X (m).
class SmoothField {
  public:
    /// @param strain   about the largest gradient
    /// @param size     of the body, m
    SmoothField(double strain, double size, test::Random& random);
    Vec3 at(const Vec3& X) const;

  private:
    struct Wave {
        Vec3 amplitude, number;
        double phase;
    };
    Eigen::Matrix3d gradient_;
    std::array<Wave, 3> waves_;
};

/// Moves a body smoothly, and gives it some velocity.
/// @param size  of the body, m
void deform(physics::Model& model, double strain, double size, test::Random& random);

}  // namespace incise::cutting
