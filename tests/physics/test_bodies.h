// Bodies for the tests of this folder: materials by region, random states, runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {

/// Laws of test_laws() and springs, each with a density of its own, in as many regions.
inline MaterialTable table_of_all_materials(std::size_t num_elements = 5000) {
    MaterialTable table;
    table.fibres = random_fibres(num_elements);
    double density = 900.0;
    const auto add = [&](const auto& method) {
        table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
        table.materials.push_back({density, method});
        density += 37.0;
    };
    for (const NamedLaw& named : test_laws()) {
        const auto* ogden = std::get_if<Ogden>(&named.law);
        if (ogden != nullptr && ogden->num_terms > 1) continue;  // each costs as much as ten laws
        add(HyperElasticLinks{named.law});
    }
    add(MassSprings{1e4});
    return table;
}

/// Hybrid springs of several Poisson's ratios and ratios of springs, each in a region of its own.
inline MaterialTable table_of_hybrid_springs() {
    MaterialTable table;
    double density = 900.0;
    for (const double kappa : {0.0, 3e4, -1e3, 4e5})
        for (const double ratio : {1.0, 0.5, std::numeric_limits<double>::infinity()}) {
            table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
            table.materials.push_back({density, HybridSprings{4e3, kappa, ratio}});
            density += 37.0;
        }
    return table;
}

/// The same material everywhere.
template <class Method>
MaterialTable table_of_one_material(const Method& method, double density = 1000.0) {
    MaterialTable table;
    table.materials.push_back({density, method});
    table.of_region[0] = 0;
    if (table.materials[0].has_fibres()) table.fibres = random_fibres(500);
    return table;
}
inline MaterialTable table_of_one_law(const Law& law, double density = 1000.0) {
    return table_of_one_material(HyperElasticLinks{law}, density);
}

/// Of bodies whose law does not matter.
inline const NeoHookean soft_law{1.5e3, 4e3};

struct NamedMaterial {
    std::string name;
    topology::CellKind kind;  ///< what it is for
    MaterialTable table;
};

/// Each method, viscosity and a law of principal stretches.
inline std::vector<NamedMaterial> materials_of_all_methods() {
    const auto tet = topology::CellKind::tetrahedron, hex = topology::CellKind::hexahedron;
    const std::vector<PronyTerm> prony{{0.3, 0.05}, {0.2, 0.2}};
    return {
        {"neo-Hookean", tet, table_of_one_law(soft_law)},
        {"Ogden", tet, table_of_one_law(Ogden{{{{2500.0, 4.0}, {500.0, -2.0}}}, 2, 8000.0})},
        {"viscous", tet, table_of_one_material(HyperElasticLinks{soft_law, 0.4, prony})},
        {"viscous by the nodal rule", tet,
         table_of_one_material(HyperElasticLinks{soft_law, 0.4, prony, PronyRule::nodal})},
        {"springs", tet, table_of_one_material(MassSprings{8e3})},
        {"neo-Hookean hexahedra", hex, table_of_one_law(soft_law)},
        {"viscous hexahedra", hex, table_of_one_material(HyperElasticLinks{soft_law, 0.4, prony})},
        {"hybrid springs", hex, table_of_one_material(HybridSprings{3e3, 1e4, 1.0})}};
}

/// 0.2 x 0.1 x 0.1 m of 4 x 2 x 2 bricks.
inline topology::Mesh bar(topology::CellKind kind = topology::CellKind::tetrahedron) {
    return topology::Mesh::build(topology::box_mesh(kind, Vec3::Zero(), {0.2, 0.1, 0.1}, {4, 2, 2}))
        .mesh;
}

/// Gives the cells the regions 0 to num_regions - 1 in turn, so that every node sees several.
/// @param first of the first cell
inline topology::MeshData with_regions(topology::MeshData data, std::size_t num_regions,
                                       std::size_t first = 0) {
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        data.regions[c] = static_cast<int>((first + c) % num_regions);
    return data;
}

struct BodyState {
    std::vector<Vec3> positions, velocities;
    bool operator==(const BodyState&) const = default;
};

inline BodyState state_of(const Model& model) {
    return {{model.positions().begin(), model.positions().end()},
            {model.velocities().begin(), model.velocities().end()}};
}

/// At rest, by node of a mesh or of fragments.
template <class Mesh>
BodyState rest_state(const Mesh& mesh) {
    return {{mesh.rest_positions().begin(), mesh.rest_positions().end()},
            std::vector<Vec3>(mesh.node_capacity(), Vec3::Zero())};
}

/// A stretched and sheared body whose nodes are shaken besides, moving at random.
/// @param shake in metres
template <class Mesh>
BodyState random_state(const Mesh& mesh, test::Random& random, double shake, double speed) {
    BodyState state = rest_state(mesh);
    Mat3 F = Mat3::Identity();
    for (int c = 0; c < 3; ++c) F.col(c) += random.vector(0.1);
    for (Vec3& x : state.positions) x = F * x + random.vector(shake);
    for (Vec3& v : state.velocities) v = random.vector(speed);
    return state;
}

/// Moves the nodes of a state that constraints hold to where these want them.
inline void put_on_constraints(const Model& model, double time, BodyState& state) {
    for (const NodeId n : model.fragments().nodes())
        if (const auto* constraint_of = model.boundary().constraints().of_node(n.index()))
            model.boundary().constraints().prescribe(*constraint_of, model.fragments(), n, time,
                                                     state.positions[n.index()]);
}

inline void set_state(Model& model, const BodyState& state, double time = 0.0) {
    model.set_state(state.positions, state.velocities, time);
}

inline BodyEdit follow(Model& model, const topology::ChangeSet& changes) {
    return model.apply(model.mesh(), changes);
}
inline void take_back(topology::Mesh& mesh, Model& model, const BodyEdit& edit) {
    replay(mesh, inverse(edit.material));
    model.apply(mesh, inverse(edit));
}

inline void step(Model& model, double& time, double dt) {
    model.compute_forces(time);
    ExplicitStep().move(model, time, dt);
    time += dt;
}

/// A constraint that holds its nodes where they are at rest.
inline Constraint holding(std::string name, VertexSet nodes,
                          std::array<bool, 3> components = {true, true, true}) {
    Constraint constraint;
    constraint.name = std::move(name);
    constraint.nodes = std::move(nodes);
    constraint.components = components;
    return constraint;
}

/// Living nodes whose rest position is where `is_inside` says.
template <class Mesh, class Predicate>
auto nodes_where(const Mesh& mesh, Predicate is_inside) {
    std::vector<decltype(*mesh.nodes().begin())> nodes;
    for (const auto n : mesh.nodes())
        if (is_inside(mesh.rest_position(n))) nodes.push_back(n);
    return nodes;
}
inline VertexSet left_end(const topology::Mesh& mesh) {
    return VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.x() == 0.0; }));
}

template <class Mesh>
auto living_elements(const Mesh& mesh) {
    std::vector<decltype(*mesh.elements().begin())> elements;
    for (const auto e : mesh.elements()) elements.push_back(e);
    return elements;
}

}  // namespace incise::physics
