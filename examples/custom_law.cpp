// A law that the library does not have: Gent's, whose chains cannot be stretched beyond a limit.
// A bar of it is pulled, and its stress is compared with the formula.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <incise/sim/selection.h>
#include <incise/sim/world.h>
#include <incise/topology/box_mesh.h>

#include <cmath>
#include <iostream>

using namespace incise;

/// w = -mu/2 Jm ln(1 - (I1 - 3)/Jm) - mu ln J + lambda/2 (ln J)^2.
/// Source: A. N. Gent, A new constitutive relation for rubber, Rubber Chemistry and Technology 69
/// (1996) 59-61, with a term for the volume.
struct Gent {
    double mu, lambda, limit;  ///< Pa, Pa, 1

    double rest_mu() const { return mu; }
    double rest_lambda() const { return lambda; }
    // The library asks this with numbers and with numbers that carry their derivatives.
    template <class T>
    physics::LawResponse<T> response(const physics::LinkStrain<T>& s, double J0) const {
        using std::log;
        // Singular at J = 0: goes on as a parabola below J0, so that flat elements have forces.
        const auto term = [&](const T& J) {
            return physics::logarithmic_volume_term(J, lambda, mu);
        };
        const auto volume = physics::extended(term, s.J, J0);
        const T left = 1.0 - s.a / limit;
        return {-0.5 * mu * limit * log(left) + volume.value, 0.5 * mu / left, 0.0, volume.first};
    }
};

int main() {
    const Gent law{1000.0, 20000.0, 2.0};
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.02, 0.02},
                                  {10, 2, 2});
    def.materials = {
        {.density = 1000.0, .method = physics::HyperElasticLinks{physics::custom_law(law)}}};
    def.solver = sim::Solver::statics;
    sim::World world(std::move(def));

    // The ends can slide across the bar; one is drawn away.
    const auto plane = [&](double x) {
        return sim::select_nodes(world.mesh(), {.box = sim::BoxRegion{{x, 0, 0}, {x, 0.02, 0.02}}});
    };
    constexpr double stretch = 1.5;
    world.add_constraint({.name = "left", .nodes = plane(0.0), .components = {true, false, false}});
    const auto right =
        world.add_constraint({.name = "right",
                              .nodes = plane(0.1),
                              .components = {true, false, false},
                              .displacement = physics::TimeCurve<Vec3>(
                                  {{0.0, Vec3::Zero()}, {1.0, {0.1 * (stretch - 1.0), 0, 0}}})});
    for (int i = 0; i < 10; ++i) world.step_to((i + 1) / 10.0);

    // The formula: the stretch across the bar makes the stress across it zero.
    const auto stress = [&](double along, double across, double direction) {
        const double I1 = along * along + 2.0 * across * across;
        const double lnJ = std::log(along * across * across);
        return law.mu * direction / (1.0 - (I1 - 3.0) / law.limit) +
               (law.lambda * lnJ - law.mu) / direction;
    };
    double low = 0.5, high = 1.0;
    while (high - low > 1e-14) {
        const double middle = 0.5 * (low + high);
        (stress(stretch, middle, middle) > 0.0 ? high : low) = middle;
    }
    const double expected = stress(stretch, low, stretch) * 0.02 * 0.02;
    const double force = world.reaction(right).force.x();
    std::cout << "force " << force << " N, by the formula " << expected << " N\n";
    return std::abs(force - expected) < 1e-6 * expected ? 0 : 1;
}
