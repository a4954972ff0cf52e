// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/frame_builder.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace incise::sim {

using topology::ElementId;
using topology::NodeId;

namespace {

/// One value a row, from a function of the row's id that returns a vector or a number.
template <class Number, class Id, class Value>
io::Field field(std::string name, int components, const std::vector<Id>& ids, Value value) {
    std::vector<Number> values;
    values.reserve(ids.size() * static_cast<std::size_t>(components));
    for (const Id id : ids) {
        if constexpr (std::is_arithmetic_v<decltype(value(id))>) {
            values.push_back(static_cast<Number>(value(id)));
        } else {
            const auto vector = value(id);
            for (int c = 0; c < components; ++c) values.push_back(static_cast<Number>(vector(c)));
        }
    }
    return {std::move(name), components, std::move(values)};
}

double von_mises(const Eigen::Matrix3d& stress) {
    const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
    return std::sqrt(1.5) * deviator.norm();
}

}  // namespace

io::Frame build_frame(const physics::Model& model, double time, std::span<const Field> fields) {
    const topology::Mesh& mesh = model.mesh();
    const auto has = [&](Field f) {
        return std::find(fields.begin(), fields.end(), f) != fields.end();
    };
    const auto name = [](Field f) { return std::string(field_names[static_cast<std::size_t>(f)]); };

    io::Frame frame;
    std::vector<NodeId> nodes;
    std::vector<ElementId> elements;
    frame.mesh = topology::to_mesh_data(mesh, model.positions(), &nodes, &elements);
    frame.time = time;

    auto& points = frame.point_fields;
    const auto rest = [&](NodeId n) { return mesh.rest_position(n); };
    if (has(Field::displacement)) {
        points.push_back(field<float>(name(Field::displacement), 3, nodes, [&](NodeId n) {
            return Vec3(model.positions()[n.index()] - mesh.rest_position(n));
        }));
        frame.active_vectors = name(Field::displacement);
    }
    points.push_back(field<double>("rest_position", 3, nodes, rest));
    if (has(Field::velocity))
        points.push_back(field<float>(name(Field::velocity), 3, nodes,
                                      [&](NodeId n) { return model.velocities()[n.index()]; }));
    if (has(Field::force))
        points.push_back(field<float>(name(Field::force), 3, nodes,
                                      [&](NodeId n) { return model.elastic_forces()[n.index()]; }));
    if (has(Field::mass))
        points.push_back(field<double>(name(Field::mass), 1, nodes,
                                       [&](NodeId n) { return model.masses()[n.index()]; }));
    points.push_back(
        field<std::int64_t>("node_id", 1, nodes, [&](NodeId n) { return mesh.label(n); }));

    auto& cells = frame.cell_fields;
    cells.push_back(
        field<std::int64_t>("element_id", 1, elements, [&](ElementId e) { return mesh.label(e); }));
    if (const auto fibres = model.fibres(); !fibres.empty())
        cells.push_back(
            field<double>("fibre", 3, elements, [&](ElementId e) { return fibres[e.index()]; }));
    const auto results = model.element_results(elements);
    std::vector<std::size_t> rows(elements.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
    if (has(Field::J))
        cells.push_back(field<float>(name(Field::J), 1, rows,
                                     [&](std::size_t i) { return results[i].volume_ratio; }));
    if (has(Field::energy_density))
        cells.push_back(field<float>(name(Field::energy_density), 1, rows, [&](std::size_t i) {
            return results[i].energy / results[i].volume;
        }));
    if (has(Field::stress))
        cells.push_back(field<float>(name(Field::stress), 9, rows, [&](std::size_t i) {
            return Eigen::Matrix<double, 9, 1>(results[i].cauchy_stress.reshaped());
        }));
    if (has(Field::von_mises))
        cells.push_back(field<float>(name(Field::von_mises), 1, rows, [&](std::size_t i) {
            return von_mises(results[i].cauchy_stress);
        }));
    return frame;
}

}  // namespace incise::sim
