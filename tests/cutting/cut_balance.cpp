// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cut_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <variant>
#include <vector>

#include "split_body.h"
#include "tests/physics/test_materials.h"

namespace incise::cutting {

using physics::Model;
using topology::Mesh;

namespace {

/// The bits of what a model is that must not depend on how it came about: an exact cut may leave
/// slivers of which rounding makes strains that no law has a number for.
struct Figures {
    std::vector<std::uint64_t> bits;
    bool operator==(const Figures&) const = default;

    explicit Figures(Model& model) {
        const auto add = [&](double figure) {
            bits.push_back(std::bit_cast<std::uint64_t>(figure));
        };
        model.compute_forces(0.0);
        add(model.stable_step());
        for (const double mass : model.masses()) add(mass);
        for (const Vec3& force : model.elastic_forces())
            for (const double component : force) add(component);
        for (const ElementId e : model.fragments().elements()) add(model.element_result(e).energy);
    }
};

}  // namespace

physics::MaterialTable all_materials(std::size_t num_elements) {
    physics::MaterialTable table;
    table.fibres = physics::random_fibres(num_elements);
    for (const auto& named : physics::test_laws()) {
        const std::size_t i = table.materials.size();
        table.of_region[static_cast<int>(i)] = i;
        table.materials.push_back(
            {900.0 + 37.0 * static_cast<double>(i), physics::HyperElasticLinks{named.law}});
    }
    return table;
}

topology::MeshData with_all_materials(topology::MeshData data) {
    const auto num_materials = static_cast<int>(physics::test_laws().size());
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        data.regions[c] = static_cast<int>(c) % num_materials;
    return data;
}

Balance::Balance(const Model& model) : totals(model.energetics().totals()) {
    for (std::size_t n = 0; n < model.masses().size(); ++n) {
        const double m = model.masses()[n];
        moment += m * model.positions()[n];
        moment_scale += m * model.positions()[n].norm();
        momentum_scale += m * model.velocities()[n].norm();
        angular_scale += m * model.velocities()[n].norm() * model.positions()[n].norm();
    }
    for (const ElementId e : model.fragments().elements())
        elastic_scale += std::abs(model.element_result(e).energy);
}

void expect_kept(const Balance& before, const Model& model, const physics::BodyEdit& done,
                 bool has_exact_energies) {
    const Balance after(model);
    const physics::Totals &a = before.totals, &b = after.totals;
    EXPECT_NEAR(b.mass, a.mass, 1e-12 * a.mass);
    EXPECT_NEAR(b.rest_volume, a.rest_volume, 1e-12 * a.rest_volume);
    EXPECT_LE((b.momentum - a.momentum).norm(), 1e-12 * before.momentum_scale);
    EXPECT_LE((b.angular_momentum - a.angular_momentum).norm(), 1e-12 * before.angular_scale);
    if (done.physics.has_joins()) return;
    EXPECT_LE((after.moment - before.moment).norm(), 1e-12 * before.moment_scale);
    EXPECT_NEAR(b.kinetic_energy, a.kinetic_energy, 1e-12 * a.kinetic_energy);
    if (!has_exact_energies) return;
    // At rest there is nothing but rounding.
    EXPECT_NEAR(b.elastic_energy, a.elastic_energy,
                1e-12 * (before.elastic_scale + 1e-3 * model.structure().stiffness_energy()));
}

void expect_equal_to_a_fresh_one(Model& model, const physics::MaterialTable& table) {
    physics::MaterialTable of_now = table;
    of_now.fibres.assign(model.structure().fibres().begin(), model.structure().fibres().end());
    Model fresh(model.mesh(), model.fragments(), of_now);
    fresh.set_state(model.positions(), model.velocities(), 0.0);
    EXPECT_EQ(Figures(model), Figures(fresh));
}

}  // namespace incise::cutting
