// What a region of the body is made of.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "incise/physics/laws/law.h"

namespace incise::physics {

/// One branch of linear viscosity: the share `alpha` of the stress relaxes as exp(-t / tau).
struct PronyTerm {
    double alpha;  ///< above 0; the sum over the terms of a series is below 1
    double tau;    ///< s, above 0
    bool operator==(const PronyTerm&) const = default;
};

/// What relaxes: the second Piola-Kirchhoff stress, or, to compare with HEML 2015, nodal forces.
enum class PronyRule : std::uint8_t { stress, nodal };

/// Hyper-elastic mass links on tetrahedra.
struct HyperElasticLinks {
    Law law;                           ///< of instantaneous strain, where there is viscosity
    double inversion_threshold = 0.4;  ///< J0: below it volume terms are extended linearly in force
    /// Empty: elastic. The long-time moduli are 1 less the sum of the alphas of those of the law.
    std::vector<PronyTerm> prony = {};
    PronyRule prony_rule = PronyRule::stress;
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

    /// Whether its elements have to have fibres.
    bool has_fibres() const {
        const auto* links = std::get_if<HyperElasticLinks>(&method);
        return links && physics::has_fibres(links->law);
    }
};

}  // namespace incise::physics
