// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/frame_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "incise/fragments/carriers.h"
#include "incise/physics/body/body_arrays.h"
#include "incise/runner/frame_tetrahedra.h"
#include "incise/topology/face_triangles.h"

namespace incise::runner {

namespace {

/// Returns a field with one value for each row. `value` is a function that returns a vector or a
/// number for a row.
template <class Number, class Row, class Value>
io::Field field(std::string name, int components, const std::vector<Row>& rows, Value value) {
    std::vector<Number> values;
    values.reserve(rows.size() * static_cast<std::size_t>(components));
    for (const Row& row : rows) {
        if constexpr (std::is_arithmetic_v<decltype(value(row))>) {
            values.push_back(static_cast<Number>(value(row)));
        } else {
            const auto vector = value(row);
            for (int c = 0; c < components; ++c) values.push_back(static_cast<Number>(vector(c)));
        }
    }
    return {std::move(name), components, std::move(values)};
}

double von_mises(const Eigen::Matrix3d& stress) {
    const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
    return std::sqrt(1.5) * deviator.norm();
}

std::string name(scenario::Field field) {
    return std::string(scenario::field_names[static_cast<std::size_t>(field)]);
}

}  // namespace

bool FrameBuilder::has(scenario::Field field) const {
    return std::find(fields_.begin(), fields_.end(), field) != fields_.end();
}

FrameBuilder::FrameBuilder(const physics::Model& model, double time,
                           std::span<const scenario::Field> fields, const ContactForces* contact)
    : fields_(fields.begin(), fields.end()) {
    const topology::Mesh& mesh = model.mesh();
    std::vector<VertexId> nodes;
    const auto positions = model.mesh_positions();
    frame_.mesh = topology::to_mesh_data(mesh, positions, &nodes, &cells_);
    frame_.mesh.carriers = fragments::carriers_of(mesh, model.fragments());
    frame_.mesh.cut_faces.resize(cells_.size());  // all frames of a run have the same arrays
    frame_.time = time;

    auto& points = frame_.point_fields;
    const auto rest = [&](VertexId n) { return mesh.rest_position(n); };
    if (has(scenario::Field::displacement)) {
        points.push_back(field<float>(
            name(scenario::Field::displacement), 3, nodes,
            [&](VertexId n) { return Vec3(positions[n.index()] - mesh.rest_position(n)); }));
        frame_.active_vectors = name(scenario::Field::displacement);
    }
    points.push_back(field<double>("rest_position", 3, nodes, rest));
    if (has(scenario::Field::velocity))
        points.push_back(field<float>(name(scenario::Field::velocity), 3, nodes, [&](VertexId n) {
            return model.mesh_velocities()[n.index()];
        }));
    if (has(scenario::Field::force)) {
        const auto forces = model.mesh_elastic_forces();
        points.push_back(field<float>(name(scenario::Field::force), 3, nodes,
                                      [&](VertexId n) { return forces[n.index()]; }));
    }
    if (has(scenario::Field::mass)) {
        const auto masses = model.structure().mesh_masses();
        points.push_back(field<double>(name(scenario::Field::mass), 1, nodes,
                                       [&](VertexId n) { return masses[n.index()]; }));
    }
    points.push_back(
        field<std::int64_t>("node_id", 1, nodes, [&](VertexId n) { return mesh.label(n); }));

    if (contact) add_contact(model, nodes, *contact);
    if (has(scenario::Field::physics)) add_physics(model);

    auto& cells = frame_.cell_fields;
    cells.push_back(
        field<std::int64_t>("element_id", 1, cells_, [&](CellId e) { return mesh.label(e); }));
    const fragments::FragmentMesh& fragments = model.fragments();
    if (const auto fibres = model.structure().fibres(); !fibres.empty())
        cells.push_back(field<double>("fibre", 3, cells_, [&](CellId e) {
            return fibres[fragments.fragment_of_cell(e).index()];
        }));
    if (has(scenario::Field::J) || has(scenario::Field::energy_density) ||
        has(scenario::Field::stress) || has(scenario::Field::von_mises))
        snapshot_.emplace(model);
    if (snapshot_)
        for (const CellId e : cells_) fragments_.push_back(fragments.fragment_of_cell(e));
}

/// Adds the nodes and elements of the physics, which are not those of the frame.
void FrameBuilder::add_physics(const physics::Model& model) {
    physics::BodyArrays arrays = physics::body_arrays(model);
    const auto add = [&](const char* array, const std::vector<Vec3>& values) {
        frame_.field_data.push_back(
            field<double>(array, 3, values, [](const Vec3& v) { return v; }));
    };
    add("physics_position", arrays.mesh.points);
    add("physics_rest_position", arrays.rest_positions);
    add("physics_velocity", arrays.velocities);
    auto& data = frame_.field_data;
    data.push_back({"physics_mass", 1, std::move(arrays.masses)});
    data.push_back({"physics_connectivity", 1, std::move(arrays.mesh.corners)});
    data.push_back(field<std::int64_t>("physics_offsets", 1, arrays.mesh.offsets,
                                       [](std::size_t offset) { return offset; }));
    data.push_back({"physics_volume_share", 1, std::move(arrays.volume_shares)});
    frame_.cell_fields.push_back({"fragment", 1, std::move(arrays.cell_of_element)});
}

/// Adds the force of contact at each node, and its part against the surface over the area of the
/// node: a third of the triangles there that face the force, at present.
void FrameBuilder::add_contact(const physics::Model& model, const std::vector<VertexId>& nodes,
                               const ContactForces& forces) {
    const topology::Mesh& mesh = model.mesh();
    const auto positions = model.mesh_positions();
    std::vector<Vec3> force(mesh.node_capacity(), Vec3::Zero());
    std::vector<Vec3> area(mesh.node_capacity(), Vec3::Zero());
    for (const auto& [n, f] : forces) force[n.index()] = f;
    constexpr double least_cosine = 0.3;  // a face that is more oblique bears none of the force
    const auto add_area = [&](VertexId at_a, VertexId at_b, VertexId at_c) {
        const Vec3 &a = positions[at_a.index()], &b = positions[at_b.index()],
                   &c = positions[at_c.index()];
        const Vec3 third = (b - a).cross(c - a) / 6.0;
        for (const std::size_t n : {at_a.index(), at_b.index(), at_c.index()})
            if (-force[n].dot(third) > least_cosine * force[n].norm() * third.norm())
                area[n] += third;
    };
    if (!forces.empty())
        for (const CellId e : mesh.elements())
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                if (!mesh.neighbor({e, f}).is_valid())
                    topology::for_each_triangle(mesh, {e, f}, add_area);
            }
    auto& points = frame_.point_fields;
    points.push_back(
        field<float>("contact_force", 3, nodes, [&](VertexId n) { return force[n.index()]; }));
    points.push_back(field<float>("contact_pressure", 1, nodes, [&](VertexId n) {
        const double square = area[n.index()].squaredNorm();
        return square > 0.0 ? -force[n.index()].dot(area[n.index()]) / square : 0.0;
    }));
}

io::Frame FrameBuilder::finish() {
    add_results();
    return has(scenario::Field::tetrahedra) ? with_tetrahedra(std::move(frame_))
                                            : std::move(frame_);
}

void FrameBuilder::add_results() {
    if (!snapshot_) return;
    const auto results = snapshot_->results(fragments_);
    const auto add = [&](scenario::Field kind, int components, auto value) {
        if (has(kind))
            frame_.cell_fields.push_back(field<float>(name(kind), components, results, value));
    };
    using Result = physics::ElementResult;
    add(scenario::Field::J, 1, [](const Result& r) { return r.volume_ratio; });
    add(scenario::Field::energy_density, 1, [](const Result& r) { return r.energy / r.volume; });
    add(scenario::Field::stress, 9,
        [](const Result& r) { return Eigen::Matrix<double, 9, 1>(r.cauchy_stress.reshaped()); });
    add(scenario::Field::von_mises, 1, [](const Result& r) { return von_mises(r.cauchy_stress); });
}

}  // namespace incise::runner
