// What an edit of a body has to keep, and what it may lose.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "incise/topology/geometry.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {

inline constexpr double round_off = 1e-13;  // of sums of absolute values

/// Sums over the body with the sums of absolute values that tell their round-off.
struct Balance {
    Totals totals;
    double momentum_scale = 0.0, angular_scale = 0.0, elastic_scale = 0.0, moment_scale = 0.0;
    Vec3 moment_of_mass = Vec3::Zero();
    double energy_of_springs = 0.0;

    explicit Balance(const Model& model) : totals(model.energetics().totals()) {
        for (std::size_t n = 0; n < model.masses().size(); ++n) {
            const double p = model.masses()[n] * model.velocities()[n].norm();
            momentum_scale += p;
            angular_scale += p * model.positions()[n].norm();
            moment_of_mass += model.masses()[n] * model.positions()[n];
            moment_scale += model.masses()[n] * model.positions()[n].norm();
        }
        for (const ElementId e : living_elements(model.fragments()))
            elastic_scale += std::abs(model.element_result(e).energy);
    }
};

/// What an element takes with it when it goes.
struct Carried {
    double mass, volume, energy;
    Vec3 momentum;
    double slenderness;  ///< of a tetrahedron; else 1
};

/// Ratio of longest edge to shortest altitude.
inline double slenderness(const topology::Mesh& mesh, CellId e) {
    std::array<Vec3, 4> X;
    for (std::size_t k = 0; k < 4; ++k) X[k] = mesh.rest_position(mesh.corners(e)[k]);
    double longest = 0.0, largest_area = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, (X[i] - X[j]).norm());
        const Vec3 &p = X[(i + 1) % 4], &q = X[(i + 2) % 4], &r = X[(i + 3) % 4];
        largest_area = std::max(largest_area, 0.5 * (q - p).cross(r - p).norm());
    }
    const double volume = topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
    return longest * largest_area / (3.0 * volume);
}

inline Carried carried_by(const Model& model, CellId cell) {
    const topology::Mesh& mesh = model.mesh();
    const ElementId e = model.fragments().fragment_of_cell(cell);
    const ElementResult result = model.element_result(e);
    // A hexahedron has the volume of its material.
    const double volume = model.fragments().cells_of(e).size() == 1
                              ? result.volume
                              : topology::rest_volume(mesh, cell);
    const bool is_tetrahedron = mesh.kind(cell) == topology::CellKind::tetrahedron;
    Carried c{model.structure().density(mesh.region(cell)) * volume, volume,
              result.energy * volume / result.volume, Vec3::Zero(),
              is_tetrahedron ? slenderness(mesh, cell) : 1.0};
    const auto corners = model.fragments().corners(e);
    const auto masses =
        model.structure().elements().block_of(model.fragments(), e).contributions(e).mass;
    const double all = std::accumulate(masses.begin(), masses.end(), 0.0);
    std::size_t k = 0;
    for (const NodeId n : corners)
        c.momentum += c.mass * masses[k++] / all * model.velocities()[n.index()];
    return c;
}

/// @param edit              that the model has followed
/// @param energy_round_off  of elastic energies; larger where strains are small
inline void expect_balance(const Balance& before, const Model& model, const BodyEdit& edit,
                           const std::vector<Carried>& carried_by_element,
                           double energy_round_off = round_off) {
    const topology::ChangeSet& changes = edit.material;
    const Balance after(model);
    double mass = 0.0, volume = 0.0, energy = 0.0;
    // The energies of single elements are the reference's, that of the body comes from lanes: they
    // differ by the square of this (docs/theory.md, Accuracy).
    double slenderness_of_removed = 1.0;
    Vec3 momentum = Vec3::Zero();
    for (const auto& record : changes.elements_removed) {
        const Carried& c = carried_by_element[record.id.index()];
        mass += c.mass;
        volume += c.volume;
        energy += c.energy;
        momentum += c.momentum;
        slenderness_of_removed = std::max(slenderness_of_removed, c.slenderness);
    }
    const Totals &a = before.totals, &b = after.totals;
    EXPECT_NEAR(a.mass - b.mass, mass, round_off * a.mass);
    EXPECT_NEAR(a.rest_volume - b.rest_volume, volume, round_off * a.rest_volume);
    const auto& of_fragments = edit.physics;
    const bool merges =
        std::any_of(of_fragments.mesh.nodes_removed.begin(), of_fragments.mesh.nodes_removed.end(),
                    [](const auto& record) { return record.num_sources > 0; });
    if (of_fragments.has_joins()) {
        // A rigid change of velocities of the free nodes near the edit keeps the momentum.
        if (merges || edit.velocities.empty()) return;
        EXPECT_LE((a.momentum - b.momentum - momentum).norm(),
                  round_off * (before.momentum_scale + after.momentum_scale));
        return;
    }
    EXPECT_LE(b.kinetic_energy, a.kinetic_energy * (1.0 + round_off));
    if (merges && !changes.elements_removed.empty()) return;  // which came first is not recorded
    EXPECT_LE((a.momentum - b.momentum - momentum).norm(), round_off * before.momentum_scale);
    if (merges) return;  // what comes together from two offsets moves, at a loss of motion
    // Rounded strains change an energy M e^2 / 2 by M e times their rounding: more than its share
    // where the strain e is small.
    const double of_strain = std::sqrt(before.elastic_scale * model.structure().stiffness_energy());
    EXPECT_NEAR(a.elastic_energy - b.elastic_energy, energy,
                energy_round_off * slenderness_of_removed * slenderness_of_removed *
                    (before.elastic_scale + 0.1 * of_strain));
    if (!changes.elements_removed.empty()) return;
    // Divided or opened, the fragments move as the whole did.
    EXPECT_LE((a.angular_momentum - b.angular_momentum).norm(), round_off * before.angular_scale);
    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, round_off * a.kinetic_energy);
    EXPECT_LE((before.moment_of_mass - after.moment_of_mass).norm(),
              round_off * before.moment_scale);
    EXPECT_NEAR(a.gravity_energy, b.gravity_energy,
                round_off * (a.mass * 10.0 + std::abs(a.gravity_energy)));
}

}  // namespace incise::physics
