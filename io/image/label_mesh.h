// Meshes from label images.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "incise/io/image/label_image.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// Returns a mesh with one hexahedron for each voxel whose label is not 0, in the order of the
/// voxels. The region of a cell is its label. Positions are in the unit and the frame of the image.
/// Neighbours share their points, which are in the order of the lattice, x fastest. Every point is
/// a corner. Volumes are positive, also if the axes of the image are left-handed.
///
/// With `size`, the cells are cubes of that edge instead of voxels. They are stacked along the axes
/// of the image, from the outer corner of its first voxel. A cube has the label of the voxel at its
/// centre, or of the upper one if the centre lies between two. A label that is thinner than a cube
/// may get no cell. If the axes are not orthogonal, the first axis of the cubes is that of the
/// image. Their second axis lies in the plane of the first two axes of the image.
///
/// Throws InputError, without the name of the file, for these reasons:
/// - the size is not positive and finite
/// - there are more than 1e8 cells, or the box round the labels has about 2^31 cubes or more
/// - the mesh, with its text when it is written, needs more memory than the machine has
/// - no cube has a label
/// - the coordinates are so large that rounding deforms the cells
///
/// Cost: linear in the voxels, or cubes, of the box round the labels. Memory: the mesh, and two
/// layers of that box.
topology::MeshData hex_mesh(const LabelImage& image, std::optional<double> size = std::nullopt);

}  // namespace incise::io
