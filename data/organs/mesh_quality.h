// Size and quality of a tetrahedral mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <map>

#include "incise/topology/mesh_data.h"

namespace incise::organs {

/// Metres, cubic metres, degrees.
struct MeshQuality {
    Eigen::AlignedBox3d box;
    std::map<int, double> volume_of_region;
    double mean_edge = 0.0;  ///< each edge counted once
    double min_edge = 0.0;
    double min_altitude = 0.0;  ///< the stable time step follows it
    double min_dihedral = 0.0;
    double max_dihedral = 0.0;
};

/// @pre all cells are tetrahedra of positive volume
MeshQuality measure(const topology::MeshData& mesh);

}  // namespace incise::organs
