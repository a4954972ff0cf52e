// What an edit of a body has to keep, and what it may lose.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

    explicit Balance(const Model& model) : totals(model.totals()) {
        for (std::size_t n = 0; n < model.masses().size(); ++n) {
            const double p = model.masses()[n] * model.velocities()[n].norm();
            momentum_scale += p;
            angular_scale += p * model.positions()[n].norm();
            moment_of_mass += model.masses()[n] * model.positions()[n];
            moment_scale += model.masses()[n] * model.positions()[n].norm();
        }
        for (const ElementId e : living_elements(model.mesh())) {
            const double energy = model.element_result(e).energy;
            elastic_scale += std::abs(energy);
            if (model.mesh().region(e) == region_of_springs()) energy_of_springs += energy;
        }
    }

    static int region_of_springs() {
        static const auto last = table_of_all_materials(0).materials.size() - 1;
        return static_cast<int>(last);
    }
};

/// What lumped masses lose when edges are divided, by the formula for one edge from a to b with a
/// mass m in the elements round it: m/4 t (1 - t) (x_b - x_a) x (v_b - v_a) of angular momentum,
/// m/4 t (1 - t) |v_b - v_a|^2 / 2 of kinetic energy.
struct LossOfDivision {
    Vec3 angular_momentum = Vec3::Zero();
    double kinetic_energy = 0.0;

    /// @param masses before the edit, which removed nothing; `model` has followed it
    LossOfDivision(const topology::ChangeSet& changes, const std::vector<double>& masses,
                   const Model& model) {
        // A division takes m/4 (1 - t) from a and m/4 t from b for the new node. From the last to
        // the first this gives back, on the way m/4 itself, and in the end the masses of before.
        std::vector<double> share(model.masses().begin(), model.masses().end());
        const auto &x = model.positions(), &v = model.velocities();
        for (auto record = changes.nodes_added.rbegin(); record != changes.nodes_added.rend();
             ++record) {
            const double quarter = share[record->id.index()];
            Vec3 between = Vec3::Zero();
            for (int s = 0; s < record->num_sources; ++s) {
                const auto& source = record->sources[static_cast<std::size_t>(s)];
                share[source.node.index()] += source.weight * quarter;
                between += source.weight * x[source.node.index()];
            }
            EXPECT_LE((x[record->id.index()] - between).norm(), 1e-15 * (1.0 + between.norm()));
            if (record->num_sources != 2) continue;
            const std::size_t a = record->sources[0].node.index(),
                              b = record->sources[1].node.index();
            const double factor = quarter * record->sources[0].weight * record->sources[1].weight;
            angular_momentum += factor * (x[b] - x[a]).cross(v[b] - v[a]);
            kinetic_energy += 0.5 * factor * (v[b] - v[a]).squaredNorm();
        }
        for (std::size_t n = 0; n < masses.size(); ++n)
            // The volumes of thin parts lose digits to their distance from the origin.
            EXPECT_NEAR(share[n], masses[n], 1e-10 * masses[n]);
    }
};

/// What an element takes with it when it goes.
struct Carried {
    double mass, volume, energy;
    Vec3 momentum;
    double slenderness;  ///< of a tetrahedron; else 1
};

/// Ratio of longest edge to shortest altitude.
inline double slenderness(const topology::Mesh& mesh, ElementId e) {
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

inline Carried carried_by(const Model& model, const MaterialTable& table, ElementId e) {
    const ElementResult result = model.element_result(e);
    const double density = table.materials[table.of_region.at(model.mesh().region(e))].density;
    const bool is_tetrahedron = model.mesh().kind(e) == topology::CellKind::tetrahedron;
    Carried c{density * result.volume, result.volume, result.energy, Vec3::Zero(),
              is_tetrahedron ? slenderness(model.mesh(), e) : 1.0};
    const double share = 1.0 / static_cast<double>(model.mesh().corners(e).size());
    for (const NodeId n : model.mesh().corners(e))
        c.momentum += share * c.mass * model.velocities()[n.index()];
    return c;
}

inline bool divides_springs(const topology::ChangeSet& changes) {
    return std::any_of(
        changes.elements_added.begin(), changes.elements_added.end(),
        [](const auto& record) { return record.region == Balance::region_of_springs(); });
}

/// The highest ratio of longest edge to shortest altitude among the parts of divided elements, 1 if
/// there are none: by it their deformation gradients are rounded more coarsely.
inline double slenderness_of_parts(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    double highest = 1.0;
    for (const auto& record : changes.elements_added)
        for (const ElementId e : {record.id, record.parent})
            highest = std::max(highest, slenderness(mesh, e));
    return highest;
}

/// @param masses_before by node; `model` has followed the edit
inline void expect_balance(const Balance& before, const Model& model,
                           const topology::ChangeSet& changes,
                           const std::vector<Carried>& carried_by_element,
                           const std::vector<double>& masses_before) {
    const Balance after(model);
    const bool merges = std::any_of(changes.nodes_removed.begin(), changes.nodes_removed.end(),
                                    [](const auto& record) { return record.num_sources > 0; });
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
    EXPECT_LE(b.kinetic_energy, a.kinetic_energy * (1.0 + round_off));
    if (merges && !changes.elements_removed.empty()) return;  // which came first is not recorded
    EXPECT_LE((a.momentum - b.momentum - momentum).norm(), round_off * before.momentum_scale);
    if (merges) return;  // what comes together from two offsets moves, at a loss of motion
    // The parts of springs are other springs; all other laws see the deformation gradient, which
    // they share with the whole.
    if (divides_springs(changes)) energy += before.energy_of_springs - after.energy_of_springs;
    // Rounded strains change an energy M e^2 / 2 by M e times their rounding: more than its share
    // where the strain e is small.
    const double of_strain = std::sqrt(before.elastic_scale * model.stiffness_energy());
    EXPECT_NEAR(a.elastic_energy - b.elastic_energy, energy,
                round_off *
                    std::max(slenderness_of_parts(model.mesh(), changes),
                             slenderness_of_removed * slenderness_of_removed) *
                    (before.elastic_scale + 0.1 * of_strain));
    if (!changes.elements_removed.empty()) return;
    // Opened faces leave the same elements in the same offsets.
    if (changes.elements_added.empty()) {
        EXPECT_EQ(a.elastic_energy, b.elastic_energy);
    }
    const LossOfDivision loss(changes, masses_before, model);
    EXPECT_LE((a.angular_momentum - b.angular_momentum - loss.angular_momentum).norm(),
              round_off * before.angular_scale);
    EXPECT_NEAR(a.kinetic_energy - b.kinetic_energy, loss.kinetic_energy,
                round_off * a.kinetic_energy);
    EXPECT_LE((before.moment_of_mass - after.moment_of_mass).norm(),
              round_off * before.moment_scale);
    EXPECT_NEAR(a.gravity_energy, b.gravity_energy,
                round_off * (a.mass * 10.0 + std::abs(a.gravity_energy)));
}

}  // namespace incise::physics
