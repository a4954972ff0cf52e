// The shape of a body that a label image shows.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "incise/io/image/label_image.h"
#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// Returns the shape of the body. Its regions are the labels other than 0, in the frame of the
/// image. Between the centres of voxels each label has the weight that linear interpolation gives
/// it, and the largest one wins: so surfaces are smoother than the voxels, and volumes nearly the
/// same. Parts of one label are connected if voxels share a face.
///
/// Throws InputError, without the name of the file, if all labels are 0.
/// Cost: linear in the voxels; a test of a point, some 0.05 us.
BodyShape shape_of(io::LabelImage image);

}  // namespace incise::tetmesh
