// The organs that the project ships, as shapes of its own making: no scan of anyone was used.
// Frame: x to the left of the body, y to its back, z up; metres.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "incise/base/types.h"

namespace incise::organs {

struct Organ {
    using Shape = std::function<double(const Vec3&)>;  ///< negative inside, see implicit_shapes.h

    std::string name;
    Shape body;              ///< region 1, where it is not region 2
    Shape inner;             ///< region 2, as far as it lies in the body
    double bounding_radius;  ///< of a ball round the origin that holds the body; metres
    double surface_size;     ///< largest circumradius of elements at the surface; metres
    double core_size;        ///< the same deep inside; metres
    double size_growth;      ///< growth of that radius per depth
};

/// A liver of some 20 cm with a tumour of 2.5 cm (region 2) in its right lobe.
Organ liver();

/// A right kidney of 11 cm: cortex (region 1), medulla and pelvis (region 2).
Organ kidney();

std::vector<Organ> all_organs();

}  // namespace incise::organs
