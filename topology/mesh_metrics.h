// Measures of a mesh: its size, its extent and the shape of its cells.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Measures of a mesh. Lengths are in the unit of the points, angles in radians.
struct MeshMetrics {
    std::array<std::size_t, num_cell_kinds + 1> num_of_kind{};  ///< indexed by CellKind
    std::map<int, std::size_t> cells_of_region;
    /// The sum of the volumes of all cells: SourceFaces::volume().
    double volume = 0.0;
    /// The area of all faces that belong to only one cell. The area of a quadrilateral is the mean
    /// over its two divisions into triangles, which is exact for a flat one. For a face of more
    /// corners it is the area of the projection onto its mean plane.
    double surface_area = 0.0;
    /// The bounding box of the points that cells use.
    Vec3 box_min = Vec3::Zero(), box_max = Vec3::Zero();
    /// An edge that several cells share counts once.
    double min_edge_length = 0.0, mean_edge_length = 0.0, max_edge_length = 0.0;
    /// The least altitude of all cells. At each corner where three edges of a cell meet, the
    /// altitude is the distance from the end of one edge to the plane of the two others. For a
    /// tetrahedron this is the usual altitude, for a brick the thickness. The apex of a pyramid,
    /// where four edges meet, is not such a corner. For a polyhedron it is three times the volume
    /// over the area of its largest face.
    double min_altitude = 0.0;
    /// The least angle between two faces of a cell at their common edge, measured at the ends of
    /// the edge. Polyhedra have no part in it.
    double min_dihedral_angle = 0.0;
};

/// Returns the edge of a cube of which the elements would be sixths, if they are tetrahedra, or the
/// whole, if not, m: a mean length of the elements at rest. Cost: O(n).
double mean_element_length(const Mesh& mesh);

/// Returns MeshMetrics::min_altitude of one cell.
double min_altitude(CellKind kind, std::span<const Vec3> corners);
/// Returns likewise that of a cell of a mesh at rest, m. For a polyhedron it is three times the
/// volume over the area of its largest face.
double min_altitude(const Mesh& mesh, CellId e);

/// Measures of the shapes of cells and edges of a mesh at rest, as MeshMetrics has them. Polyhedra
/// have no part in the angles.
struct ShapeMetrics {
    Box box;
    double mean_edge_length = 0.0;
    double min_altitude = std::numeric_limits<double>::infinity();
    double min_dihedral_angle = 0.0;
};
/// Returns the measures of a mesh. Cost: O(n log n).
ShapeMetrics measure_shapes(const Mesh& mesh);

/// Returns the measures of a mesh. Throws InputError with the errors of check(). Cost: O(n log n).
MeshMetrics measure(const MeshData& data);

}  // namespace incise::topology
