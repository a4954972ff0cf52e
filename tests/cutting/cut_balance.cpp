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

/// Elastic energy of an element by its deformation gradient, J. The kernels see the squares of
/// edges, by which they lose digits with the fourth power of an element's slenderness, and at snap
/// 0 elements are as slender as chance will have it.
double energy(const Model& model, const physics::MaterialTable& table, ElementId e) {
    const Mesh& mesh = model.mesh();
    const auto corners = mesh.corners(e);
    Eigen::Matrix3d rest, current;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto c = static_cast<Eigen::Index>(k);
        rest.col(c) = mesh.rest_position(corners[k + 1]) - mesh.rest_position(corners[0]);
        current.col(c) =
            model.positions()[corners[k + 1].index()] - model.positions()[corners[0].index()];
    }
    const Eigen::Matrix3d F = current * rest.inverse();
    const Eigen::Matrix3d twice_E = F.transpose() * F - Eigen::Matrix3d::Identity();
    const Vec3& fibre = model.fibres()[e.index()];
    const physics::LinkStrain strain{twice_E.trace(), twice_E.squaredNorm(), F.determinant(),
                                     fibre.dot(twice_E * fibre)};
    const auto& material = table.materials[table.of_region.at(mesh.region(e))];
    const auto& links = std::get<physics::HyperElasticLinks>(material.method);
    const auto density = [&](const auto& law) {
        return law.response(strain, links.inversion_threshold).w;
    };
    return std::visit(density, links.law) * element_volume(mesh, e, mesh.rest_positions());
}

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
        for (std::size_t e = 0; e < model.mesh().element_capacity(); ++e)
            add(model.element_result(ElementId(e)).energy);
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

Balance::Balance(const Model& model, const physics::MaterialTable& table) : totals(model.totals()) {
    for (std::size_t n = 0; n < model.masses().size(); ++n) {
        const double m = model.masses()[n];
        moment += m * model.positions()[n];
        moment_scale += m * model.positions()[n].norm();
        momentum_scale += m * model.velocities()[n].norm();
    }
    for (std::size_t i = 0; i < model.mesh().element_capacity(); ++i) {
        const double w = energy(model, table, ElementId(i));
        elastic_energy += w;
        elastic_scale += std::abs(w);
    }
}

void expect_kept(const Balance& before, const Model& model, const physics::MaterialTable& table,
                 bool has_no_slivers) {
    const Balance after(model, table);
    const physics::Totals &a = before.totals, &b = after.totals;
    EXPECT_NEAR(b.mass, a.mass, 1e-12 * a.mass);
    EXPECT_NEAR(b.rest_volume, a.rest_volume, 1e-12 * a.rest_volume);
    EXPECT_LE((after.moment - before.moment).norm(), 1e-12 * before.moment_scale);
    EXPECT_LE((b.momentum - a.momentum).norm(), 1e-12 * before.momentum_scale);
    // At rest there is nothing but rounding.
    const double scale = before.elastic_scale + 1e-6 * model.stiffness_energy();
    EXPECT_NEAR(after.elastic_energy, before.elastic_energy, 1e-10 * scale);
    if (has_no_slivers) {
        EXPECT_NEAR(b.elastic_energy, a.elastic_energy, 1e-10 * scale);
    }
    EXPECT_LE(b.kinetic_energy, a.kinetic_energy * (1.0 + 1e-12));
}

void expect_equal_to_a_fresh_one(Model& model, const physics::MaterialTable& table) {
    physics::MaterialTable of_now = table;
    of_now.fibres.assign(model.fibres().begin(), model.fibres().end());
    Model fresh(model.mesh(), of_now);
    fresh.set_state(model.positions(), model.velocities(), 0.0);
    EXPECT_EQ(Figures(model), Figures(fresh));
}

}  // namespace incise::cutting
