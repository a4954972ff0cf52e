// The laws that the tests of this folder run over, and random tetrahedra to run them on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/physics/elements/heml_kernel.h"
#include "incise/physics/elements/mass_spring_kernel.h"
#include "incise/physics/laws/material.h"
#include "support/mesh_families.h"
#include "support/reference_data.h"

namespace incise::physics {

/// What the custom law of the tests holds, which is to be as good as the library's own.
inline constexpr Yeoh held_by_custom_law{1500.0, 300.0, 100.0, 7000.0};

struct NamedLaw {
    std::string name;
    Law law;
};

/// Every law at several parameters, shear moduli of some kPa.
inline std::vector<NamedLaw> test_laws() {
    return {
        {"Saint Venant-Kirchhoff, nu 0.3", SaintVenantKirchhoff{5769.0, 3846.0}},
        {"Saint Venant-Kirchhoff, nu 0", SaintVenantKirchhoff{0.0, 5000.0}},
        {"Saint Venant-Kirchhoff, nu 0.49", SaintVenantKirchhoff{1.6e5, 3356.0}},
        {"neo-Hookean, nu 0.3", NeoHookean{1923.0, 5769.0}},
        {"neo-Hookean, nu 0", NeoHookean{2500.0, 0.0}},
        {"neo-Hookean, nu 0.49", NeoHookean{1678.0, 1.6e5}},
        {"Mooney-Rivlin", MooneyRivlin{1346.0, 577.0, 3462.0}},
        {"Mooney-Rivlin without C2", MooneyRivlin{1923.0, 0.0, 5769.0}},
        {"Mooney-Rivlin without lambda", MooneyRivlin{500.0, 1400.0, 0.0}},
        {"Fung-Demiray", FungDemiray{3846.0, 0.5, 1923.0}},
        {"Ogden, one term", Ogden{{{{3846.0, 4.0}}}, 1, 8333.0}},
        {"Ogden, three terms", Ogden{{{{2000.0, 1.3}, {900.0, 5.0}, {700.0, -3.0}}}, 3, 20000.0}},
        {"Ogden, brain-like", Ogden{{{{670.0, -19.0}}}, 1, 6000.0}},
        {"Ciarlet's neo-Hookean", CiarletNeoHookean{3846.0, 5769.0}},
        {"isochoric neo-Hookean", IsochoricMooneyRivlin{1923.0, 0.0, 8333.0}},
        {"isochoric Mooney-Rivlin", IsochoricMooneyRivlin{1346.0, 577.0, 8333.0}},
        {"isochoric Fung-Demiray", IsochoricFungDemiray{3846.0, 0.5, 8333.0}},
        {"stable neo-Hookean", StableNeoHookean::of_rest_moduli(5769.0, 3846.0)},
        {"stable neo-Hookean, nu -0.2", StableNeoHookean::of_rest_moduli(-1190.0, 4167.0)},
        {"stable neo-Hookean, nu 0.49", StableNeoHookean::of_rest_moduli(1.6e5, 3356.0)},
        {"Yeoh", Yeoh{1923.0, 400.0, 150.0, 8333.0}},
        {"custom", custom_law(held_by_custom_law)},
        {"fibres in parallel", HolzapfelGasserOgden{3846.0, 8333.0, 2000.0, 0.3, 0.0}},
        {"dispersed fibres", HolzapfelGasserOgden{3846.0, 8333.0, 2000.0, 0.3, 0.2}},
    };
}

/// The law of a reference file; none if the program has not that law.
inline std::optional<Law> law_of(const test::ReferenceLaw& reference) {
    const auto at = [&](const char* key) { return reference.parameters.at(key); };
    if (reference.name == "stvk") return SaintVenantKirchhoff{at("lam"), at("mu")};
    if (reference.name == "nh26") return NeoHookean{0.5 * at("mu"), at("lam")};
    if (reference.name == "ciarlet") return CiarletNeoHookean{at("mu"), at("lam")};
    if (reference.name == "nh_iso") return IsochoricMooneyRivlin{at("C1"), 0.0, at("K")};
    if (reference.name == "mr_iso") return IsochoricMooneyRivlin{at("C1"), at("C2"), at("K")};
    if (reference.name == "fd_iso") return IsochoricFungDemiray{at("mu"), at("g"), at("K")};
    if (reference.name == "fd_ln") return FungDemiray{at("mu"), at("g"), at("lam")};
    if (reference.name == "mr_ln") return MooneyRivlin{at("C1"), at("C2"), at("lam")};
    if (reference.name == "ogden")
        return Ogden{{{{at("mu1"), at("alpha1")}, {at("mu2"), at("alpha2")}}}, 2, at("K")};
    return std::nullopt;
}

inline Vec3 fibre_direction() { return Vec3(2.0, -1.0, 2.0) / 3.0; }

/// A kernel whose fibres, where its law has any, all have one direction.
template <class Kernel>
struct WithFibre : Kernel {
    explicit WithFibre(const Kernel& kernel) : Kernel(kernel) {}
    auto precompute(const typename Kernel::Corners& X) const {
        return Kernel::precompute(X, fibre_direction());
    }
};

/// Calls visit(name, kernel) for HEML with each law.
template <class Visit>
void for_each_heml_kernel(Visit visit, double inversion_threshold = 0.4) {
    for (const NamedLaw& named : test_laws())
        visit(named.name, WithFibre(HemlKernel{named.law, inversion_threshold}));
}

/// Calls visit(name, kernel) for each law of HEML and for springs.
template <class Visit>
void for_each_kernel(Visit visit) {
    for_each_heml_kernel(visit);
    visit(std::string("springs"), MassSpringKernel{1e4});
}

using Tetrahedron = std::array<Vec3, 4>;

/// A tetrahedron of side about `size`, near the origin, far from flat.
inline Tetrahedron random_tetrahedron(test::Random& random, double size = 1.0) {
    Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.87, 0), Vec3(0.5, 0.29, 0.82)};
    const Vec3 shift = random.vector(1.0);
    for (Vec3& x : X) x = size * (x + shift + random.vector(0.2));
    return X;
}

inline Mat3 random_rotation(test::Random& random) {
    Eigen::Quaterniond q;
    q.coeffs() << random.vector(1.0), random.uniform(0.1, 1.0);
    return q.normalized().toRotationMatrix();
}

/// Turned stretches, given along random axes.
inline Mat3 random_deformation(test::Random& random, const Vec3& stretches) {
    const Mat3 Q = random_rotation(random);
    return random_rotation(random) * Q * stretches.asDiagonal() * Q.transpose();
}

/// Directions of fibres by element id, each another, for the table of a test.
inline std::vector<Vec3> random_fibres(std::size_t num_elements) {
    test::Random random(77);
    std::vector<Vec3> fibres(num_elements);
    for (Vec3& fibre : fibres) fibre = random_rotation(random).col(0);
    return fibres;
}

template <std::size_t n>
std::array<Vec3, n> deformed(std::array<Vec3, n> corners, const Mat3& F) {
    for (Vec3& x : corners) x = F * x;
    return corners;
}

}  // namespace incise::physics
