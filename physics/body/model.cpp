// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/model.h"

#include <algorithm>
#include <utility>

#include "incise/base/error.h"
#include "incise/fragments/fragment_archive.h"

namespace incise::physics {

using fragments::FragmentMesh;

namespace {

/// Reads the fibres into the table.
MaterialTable read_fibres(MaterialTable table, ArchiveReader& ar) {
    ar(table.fibres);
    return table;
}

}  // namespace

Model::Model(const topology::Mesh& mesh, const MaterialTable& table,
             const BoundaryConditions& boundary_conditions)
    : Model(mesh, Fragmented(mesh, table, boundary_conditions.constraints), boundary_conditions) {}

Model::Model(const topology::Mesh& mesh, Fragmented body, BoundaryConditions boundary_conditions)
    : Model(mesh, std::move(body.fragments), body.table, std::move(boundary_conditions)) {}

Model::Fragmented::Fragmented(const topology::Mesh& mesh, const MaterialTable& of_mesh,
                              std::span<const Constraint> constraints)
    : fragments(mesh, fragments::default_light_share, constrained_by(mesh, constraints)),
      table(of_mesh) {
    if (table.fibres.empty()) return;
    table.fibres.resize(fragments.element_capacity(), Vec3::Zero());
    for (const ElementId e : fragments.elements())
        for (const CellId cell : fragments.cells_of(e))
            if (fragments.is_at_home(cell)) {
                table.fibres[e.index()] = of_mesh.fibres[cell.index()];
                break;
            }
}

Model::Model(const topology::Mesh& mesh, FragmentMesh fragments, const MaterialTable& table,
             BoundaryConditions boundary_conditions)
    : structure_(mesh, std::move(fragments), table),
      state_(structure_.fragments(), structure_.elements().history_size()),
      boundary_(structure_, state_, std::move(boundary_conditions)),
      energetics_(structure_, state_, boundary_, workers_),
      elastic_forces_(structure_.masses().size(), Vec3::Zero()) {
    compute_forces(0.0);
}

void Model::set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                      double time) {
    const State::Values values = state_.change();
    std::copy(positions.begin(), positions.end(), values.positions.begin());
    std::copy(velocities.begin(), velocities.end(), values.velocities.begin());
    advance_history(values.positions, values.positions, 0.0);
    compute_forces(time);
}

void Model::compute_forces(double time) {
    boundary_.update();
    structure_.elements_.compute_forces(state_, workers_);
    workers_.for_each_range(structure_.masses().size(), [&](NodeRange range) {
        structure_.elements().gather_forces(range, elastic_forces_);
        boundary_.compute_forces(range, time);
    });
}

void Model::compute_totals_and_forces() {
    structure_.elements_.compute_totals_and_forces(state_, workers_);
}

double Model::advance_history(std::span<const Vec3> before, std::span<const Vec3> after,
                              double dt) {
    if (state_.history().is_empty()) return 0.0;
    return structure_.elements_.advance(before, after, dt, workers_, state_.change().history);
}

std::vector<Vec3> Model::mesh_elastic_forces() const {
    const std::vector<double> mesh_masses = structure_.mesh_masses();
    std::vector<Vec3> forces(mesh_masses.size(), Vec3::Zero());
    for (const VertexId n : mesh().nodes()) {
        structure_.embedding().for_each(n, [&](NodeId node, double weight) {
            forces[n.index()] += mesh_masses[n.index()] * weight / masses()[node.index()] *
                                 elastic_forces_[node.index()];
        });
    }
    return forces;
}

double Model::max_displacement() const {
    double largest = 0.0;
    const auto x = mesh_positions();
    for (const VertexId n : mesh().nodes())
        largest = std::max(largest, (x[n.index()] - mesh().rest_position(n)).norm());
    return largest;
}

void Model::take_force_terms(Model& former, double time) {
    if (!former.boundary_.has_force_terms()) return;
    boundary_.swap_force_terms(former.boundary_);
    try {
        compute_forces(time);
        boundary_.sum_stiffness();
    } catch (...) {  // what a term throws
        boundary_.swap_force_terms(former.boundary_);
        throw;
    }
}

void Model::save(ArchiveWriter& ar) const {
    fragments::save(fragments(), ar);
    ar(std::vector(structure_.fibres().begin(), structure_.fibres().end()));
    save_state(ar);
}

void Model::save_motion(ArchiveWriter& ar) const {
    const auto constrained = fragments().constrained();
    ar(std::vector(constrained.begin(), constrained.end()));
    save_state(ar);
}

void Model::save_state(ArchiveWriter& ar) const {
    boundary_.save(ar);
    state_.save(ar);
    boundary_.save_reactions(ar);
    energetics_.save(ar);
    ar(structure_.size_, version());
}

Model::Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time)
    // Braces guarantee that the arguments read the archive from left to right.
    : Model{mesh, fragments::load_fragments(mesh, ar), read_fibres(std::move(table), ar),
            read_boundary_conditions(mesh, ar)} {
    const bool has_fibres =
        std::ranges::any_of(structure_.elements().materials().materials, &Material::has_fibres);
    if (has_fibres == structure_.fibres().empty())
        throw InputError("the fibres are those of another body");
    restore_state(ar, time);
}

void Model::restore_motion(ArchiveReader& ar, double time) {
    auto constrained = ar.read<std::vector<std::uint8_t>>();
    if (constrained.size() != mesh().node_capacity())
        throw InputError("the motion is that of another body");
    structure_.fragments_.set_constrained(std::move(constrained));
    boundary_.restore(ar);
    restore_state(ar, time);
}

void Model::restore_state(ArchiveReader& ar, double time) {
    state_.restore(ar);
    boundary_.restore_reactions(ar);
    energetics_.restore(ar);
    std::uint64_t version = 0;
    ar(structure_.size_, version);
    structure_.version_ = version - boundary_.version();
    compute_forces(time);
}

}  // namespace incise::physics
