// What a region of the body is made of.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <variant>

#include "physics/law.h"

namespace incise::physics {

/// Hyper-elastic mass links on tetrahedra.
struct HyperElasticLinks {
    Law law;
    double inversion_threshold = 0.4;  ///< J0: below it volume terms are extended linearly in force
};

/// The classical mass-spring model on the edges of tetrahedra, as a baseline. Each element brings
/// its share E V / L^2 to the stiffness of each of its edges, so that an edge's spring is the sum
/// over the elements round it and no counting is needed when one of them goes.
/// Source: A. Van Gelder, Approximate simulation of elastic membranes by triangulated spring
/// meshes, Journal of Graphics Tools 3 (1998), carried over to tetrahedra.
struct MassSprings {
    double young;  ///< Pa
};

/// The hybrid mass-spring system on hexahedra that are boxes: springs of shear modulus G, which by
/// themselves have Poisson's ratio 1/4, and kappa/2 (V'/V - 1)^2 per rest volume.
struct HybridSprings {
    double shear_modulus;   ///< G, Pa
    double volume_modulus;  ///< kappa = K - 5/3 G, Pa; negative for Poisson's ratios below 1/4
    /// A = k_f / k_c, face over inner diagonals; 0: none in the faces, infinite: none inside.
    double stiffness_ratio = 1.0;
};

struct Material {
    double density = 0.0;  ///< kg/m3
    std::variant<HyperElasticLinks, MassSprings, HybridSprings> method;
};

}  // namespace incise::physics
