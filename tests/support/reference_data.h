// Solutions by independent solvers, as data/references has them; see the README there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh_data.h"

namespace incise::test {

/// A law by the name that the files give it, with its parameters, SI units.
struct ReferenceLaw {
    std::string name;
    std::map<std::string, double> parameters;
};

/// Homogeneous uniaxial stress with free sides.
struct UniaxialRow {
    double stretch, first_piola_kirchhoff, lateral_stretch, volume_ratio;
};
struct UniaxialReference {
    ReferenceLaw law;
    double young, poisson;
    std::vector<UniaxialRow> rows;
};
std::vector<UniaxialReference> uniaxial_references();

/// A static equilibrium of a body, whole or cut.
struct StaticSolution {
    ReferenceLaw law;
    bool is_cut;
    std::vector<Vec3> displacements;        ///< by point, of the cut body if it is cut
    Vec3 reaction;                          ///< on the moved points, N; NaN where it is not given
    std::optional<double> deformed_volume;  ///< m3
};

/// A body of tetrahedra, some points of which are held, others moved, and its equilibria before
/// and after some of its inner faces are opened. Labels of nodes and elements are the numbers here.
struct CutReference {
    std::string name;
    topology::MeshData mesh;                             ///< uncut
    std::vector<std::array<std::int64_t, 3>> cut_faces;  ///< by points
    std::vector<std::array<std::int64_t, 4>> cut_tets;   ///< corners after the cut
    std::vector<std::int64_t> origin;                    ///< of each point after the cut
    std::vector<std::int64_t> fixed, moved;              ///< points of the uncut body
    Vec3 displacement;                                   ///< of the moved points, m
    std::vector<StaticSolution> solutions;
};
CutReference organ_reference();
/// Blocks that are notched and pulled: a fine one and a coarse one.
std::vector<CutReference> notch_references();

}  // namespace incise::test
