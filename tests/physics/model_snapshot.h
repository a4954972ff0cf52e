// Bodies of many materials that are edited, and all that a model of them is, to compare.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "tests/physics/test_bodies.h"

namespace incise::physics {

inline std::vector<double> figures_of(const Totals& t) {
    std::vector<double> figures{t.mass, t.rest_volume, t.kinetic_energy, t.elastic_energy,
                                t.gravity_energy};
    for (const Vec3& v : {t.momentum, t.angular_momentum, t.centre_of_mass})
        figures.insert(figures.end(), {v.x(), v.y(), v.z()});
    return figures;
}

/// What a model is, as one comparable value.
struct ModelSnapshot {
    BodyState state;
    std::vector<Vec3> forces, outer_forces;
    std::vector<double> masses, volumes, energies;
    std::vector<double> history;
    std::vector<Vec3> fibres;
    std::vector<double> totals;
    double stable_step;
    bool operator==(const ModelSnapshot&) const = default;

    ModelSnapshot(Model& model, double time) : state(state_of(model)) {
        model.compute_forces(time);
        forces.assign(model.elastic_forces().begin(), model.elastic_forces().end());
        outer_forces.assign(model.boundary().outer_forces().begin(),
                            model.boundary().outer_forces().end());
        masses.assign(model.masses().begin(), model.masses().end());
        for (const ElementId e : living_elements(model.fragments())) {
            const ElementResult result = model.element_result(e);
            volumes.push_back(result.volume);
            energies.push_back(result.energy);
        }
        history.assign(model.state().history().values().begin(),
                       model.state().history().values().end());
        fibres.assign(model.structure().fibres().begin(), model.structure().fibres().end());
        stable_step = model.stable_step();
        totals = figures_of(model.energetics().totals());
    }
};

inline void expect_equal(const ModelSnapshot& a, const ModelSnapshot& b) {
    EXPECT_EQ(a.state.positions, b.state.positions);
    EXPECT_EQ(a.state.velocities, b.state.velocities);
    EXPECT_EQ(a.masses, b.masses);
    EXPECT_EQ(a.forces, b.forces);
    EXPECT_EQ(a.outer_forces, b.outer_forces);
    EXPECT_EQ(a.volumes, b.volumes);
    EXPECT_EQ(a.energies, b.energies);
    EXPECT_EQ(a.history, b.history);
    EXPECT_EQ(a.fibres, b.fibres);
    EXPECT_EQ(a.stable_step, b.stable_step);
    EXPECT_EQ(a.totals, b.totals);
}

/// A law, a viscous one, and one with fibres, for cells of any kind.
inline std::vector<Material> materials_of_any_cells() {
    const auto laws = test_laws();
    return {{950.0, HyperElasticLinks{laws[3].law}},
            {1010.0, HyperElasticLinks{laws[14].law, 0.4, {{0.3, 0.01}, {0.2, 1.0}}}},
            {1040.0, HyperElasticLinks{laws.back().law}}};
}

/// All materials for the cells of the mesh that there are in the precision; every other law of
/// tetrahedra with viscosity, by the two rules.
inline MaterialTable table_for(const topology::MeshData& data,
                               Precision precision = Precision::double_precision) {
    using topology::CellKind;
    const auto are_all = [&](CellKind kind) {
        return std::ranges::all_of(data.kinds, [&](CellKind of_cell) { return of_cell == kind; });
    };
    if (!are_all(CellKind::tetrahedron)) {
        MaterialTable table =
            are_all(CellKind::hexahedron) ? table_of_hybrid_springs() : MaterialTable();
        for (const Material& material : materials_of_any_cells()) {
            table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
            table.materials.push_back(material);
        }
        table.fibres = random_fibres(data.num_cells());
        table.precision = precision;
        return table;
    }
    MaterialTable table = table_of_all_materials(data.num_cells());
    table.precision = precision;
    if (precision == Precision::single_precision)
        for (Material& material : table.materials)
            if (std::holds_alternative<MassSprings>(material.method))
                material.method = HyperElasticLinks{soft_law};
    for (std::size_t i = 0; i < table.materials.size(); i += 2)
        if (auto* links = std::get_if<HyperElasticLinks>(&table.materials[i].method)) {
            links->prony = {{0.3, 0.01}, {0.2, 1.0}};
            links->prony_rule = i % 4 == 0 ? PronyRule::stress : PronyRule::nodal;
        }
    return table;
}

}  // namespace incise::physics
