// The material of a region: its density, and the method and law of its forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "incise/physics/laws/law.h"

namespace incise::physics {

/// A term of a Prony series: the share `alpha` of the stress relaxes as exp(-t / tau).
struct PronyTerm {
    double alpha;  ///< above 0; the sum over the terms of a series is below 1
    double tau;    ///< s, above 0
    bool operator==(const PronyTerm&) const = default;
};

/// The quantity that relaxes: the second Piola-Kirchhoff stress, or nodal forces. The latter is for
/// comparison with HEML 2015.
enum class PronyRule : std::uint8_t { stress, nodal };

/// HEML, hyper-elastic mass links. Cells other than tetrahedra are divided into some.
struct HyperElasticLinks {
    Law law;                           ///< with viscosity, the law of the instantaneous moduli
    double inversion_threshold = 0.4;  ///< J0: below it the force of volume terms is linear in J
    /// Empty for an elastic material. The long-time moduli are those of the law times 1 less the
    /// sum of the alphas.
    std::vector<PronyTerm> prony = {};
    PronyRule prony_rule = PronyRule::stress;
};

/// The mass-spring model on the edges of tetrahedra, a baseline for comparison. An element of
/// volume V adds E V / L^2 to the stiffness of each of its edges, with the rest length L. The
/// spring of an edge is the sum over its elements, so removing an element removes its share.
/// Source: A. Van Gelder, Approximate simulation of elastic membranes by triangulated spring
/// meshes, Journal of Graphics Tools 3 (1998), extended to tetrahedra.
struct MassSprings {
    double young;  ///< E, Young's modulus, Pa
};

/// HybMSS, the hybrid mass-spring system, on hexahedra that are boxes. Springs give the shear
/// modulus G, and alone have the Poisson ratio 1/4. The volume term has the energy
/// kappa/2 (V'/V - 1)^2 per rest volume, with the current volume V'.
struct HybridSprings {
    double shear_modulus;   ///< G, Pa
    double volume_modulus;  ///< kappa = K - 5/3 G, Pa; negative for Poisson ratios below 1/4
    /// A = k_f / k_c, the stiffness of face diagonals over that of inner diagonals. 0: no face
    /// diagonals; infinite: no inner diagonals.
    double stiffness_ratio = 1.0;
};

/// Returns the HEML material of a box of hybrid springs that a cut has divided. Springs join the
/// corners of the whole box, so that they cannot follow how a part fills it. The law is the closest
/// one without a limit on compression: the moduli at rest are the same, and at 10 % of tension,
/// compression or shear its energy is within 9 % of that of the springs (docs/theory.md, Parts of
/// boxes with hybrid springs).
inline HyperElasticLinks links_of_divided_box(const HybridSprings& springs) {
    return {StableNeoHookean::of_rest_moduli(springs.volume_modulus + springs.shear_modulus,
                                             springs.shear_modulus)};
}

struct Material {
    double density = 0.0;  ///< kg/m3
    std::variant<HyperElasticLinks, MassSprings, HybridSprings> method;

    /// True if the law needs the direction of fibres in each element.
    bool has_fibres() const {
        const auto* links = std::get_if<HyperElasticLinks>(&method);
        return links && physics::has_fibres(links->law);
    }
};

/// Returns Young's modulus at rest, Pa. With viscosity it is the instantaneous one, and with fibres
/// that across them. Springs count with Poisson's ratio 1/4, which they have alone.
inline double young_at_rest(const Material& material) {
    if (const auto* links = std::get_if<HyperElasticLinks>(&material.method)) {
        const double mu = rest_mu(links->law), lambda = rest_lambda(links->law);
        return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    }
    if (const auto* springs = std::get_if<MassSprings>(&material.method)) return springs->young;
    return 2.5 * std::get<HybridSprings>(material.method).shear_modulus;
}

}  // namespace incise::physics
