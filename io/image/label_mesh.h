// Meshes from label images.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "incise/io/image/label_image.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// One hexahedron for each voxel whose label is not 0, its region the label, in the order of the
/// voxels; in the unit and the frame of the image. Neighbours share their points, which are
/// numbered in the order of the lattice, x fastest; there are no others. Volumes are positive, also
/// where the image's axes are left-handed.
///
/// With `size`, the cells are cubes of that edge in place of voxels: stacked along the image's
/// axes from the corner at which its first voxel begins, each with the label of the voxel in which
/// its centre lies (the upper one, if between two). Labels thinner than a cube may have none. Where
/// the axes are not orthogonal, the cubes run along the first, and the second as far as it can be.
///
/// Throws InputError, without the name of the file: size not positive and finite; more than 1e8
/// cells, or 2^31 cubes looked at; more memory, that of writing the mesh included, than the machine
/// has; no cube with a label; an image so far off that rounding spoils its cells.
/// Cost: linear in the voxels, or cubes, of the box round the labels; memory for the mesh and two
/// layers of that box.
topology::MeshData hex_mesh(const LabelImage& image, std::optional<double> size = std::nullopt);

}  // namespace incise::io
