// What the mesher knows of a body: where its regions are, whatever file they came from.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "incise/base/types.h"
#include "tetmesh/surface_topology.h"

namespace incise::tetmesh {

/// Points on the surface of a connected part of a region.
struct PartPoints {
    int region = 0;
    std::vector<Vec3> points;
};

using SurfaceVisitor = std::function<void(const Vec3& x, const Vec3& across)>;

/// A body as regions in space. Lengths are in the unit of the mesh to make.
struct BodyShape {
    /// Returns the region at a point; 0 is outside of the body. The same point always gives the
    /// same region.
    std::function<int(const Vec3&)> region_at;
    Box box;                        ///< round the body
    std::map<int, double> volumes;  ///< by region
    double area = 0.0;              ///< of all surfaces of regions; a rough one will do
    /// The mesher begins with these points: it finds no part of which it has no point.
    std::vector<PartPoints> first_points;
    /// Calls visit with points of all surfaces between regions that are not further apart than a
    /// spacing or the size of a voxel, and with a unit vector from one region to the other.
    std::function<void(double spacing, const SurfaceVisitor& visit)> visit_surface;
    /// Of the surface between the body and its outside. Not set if that is not known.
    std::optional<SurfaceTopology> topology;
    /// Lines that the mesh follows with its edges; a line that ends where it begins is closed.
    std::vector<std::vector<Vec3>> sharp_edges;
    /// Distance that the surface of the mesh may have from that of the body, at least: the steps
    /// between voxels are no shape.
    double roughness = 0.0;
    /// True if the surface of the body is a manifold: it meets itself nowhere.
    bool is_manifold = false;
};

}  // namespace incise::tetmesh
