// SPDX-License-Identifier: LGPL-3.0-or-later
#include "tests/physics/generated_boundary_conditions.h"

#include <algorithm>
#include <ostream>

#include "tests/physics/test_bodies.h"

namespace incise::physics {

using topology::Mesh;

namespace {

std::array<double, 3> offset_of(const Mesh& mesh, VertexId n) {
    const Vec3& X = mesh.rest_position(n);
    return {X.x(), X.y(), X.z()};
}

/// Outwards, at rest.
Vec3 area_vector(const Mesh& mesh, FaceId f) {
    const auto X = [&](int p) { return mesh.rest_position(mesh.face_corner(f, p)); };
    const int last = mesh.face_size(f) - 1;
    return (X(1) - X(0)).cross(X(last) - X(0));
}

std::vector<VertexId> living_nodes(const Mesh& mesh) {
    return nodes_where(mesh, [](const Vec3&) { return true; });
}

Constraint moving(VertexSet nodes) {
    Constraint constraint = holding("moved", std::move(nodes), {true, false, true});
    constraint.displacement =
        TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.002, 0.001, -0.003)}});
    constraint.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, 0.02}});
    constraint.point = {0.1, 0.2, 0.3};
    return constraint;
}

const Vec3 force_on_node(0.3, -0.2, 0.5), traction(20.0, 30.0, -10.0), body_force(5.0, 7.0, -3.0);
constexpr double pressure = 50.0;

}  // namespace

std::ostream& operator<<(std::ostream& out, const GeneratedBoundaryConditions& chosen) {
    const auto list = [&](const char* what, const std::vector<std::size_t>& numbers) {
        for (std::size_t i = 0; i < numbers.size(); ++i)
            out << (i == 0 ? what : ", ") << numbers[i];
    };
    list("; held: elements ", chosen.held_elements);
    list("; moved: elements ", chosen.moved_elements);
    list("; loaded: nodes ", chosen.loaded_nodes);
    list("; loaded: faces ", chosen.loaded_faces);
    list("; loaded: regions ", chosen.loaded_regions);
    return out;
}

rc::Gen<GeneratedBoundaryConditions> generated_boundary_conditions() {
    const auto numbers = [](int most) {
        return test::up_to(most, rc::gen::inRange<std::size_t>(0, 100));
    };
    return rc::gen::apply(
        [](auto held, auto moved, auto nodes, auto faces, auto regions) {
            return GeneratedBoundaryConditions{std::move(held), std::move(moved), std::move(nodes),
                                               std::move(faces), std::move(regions)};
        },
        numbers(3), numbers(3), numbers(6), numbers(12), numbers(2));
}

Acting::Acting(const Mesh& mesh, const GeneratedBoundaryConditions& chosen) {
    std::map<Place, int> num_nodes;
    const auto nodes = living_nodes(mesh);
    for (const VertexId n : nodes) {
        places_[offset_of(mesh, n)] = {};
        ++num_nodes[offset_of(mesh, n)];
    }
    const auto elements = living_elements(mesh);
    const auto for_places = [&](const std::vector<std::size_t>& numbers, auto visit) {
        for (const std::size_t i : numbers)
            for (const VertexId n : mesh.corners(elements[i % elements.size()]))
                visit(places_.at(offset_of(mesh, n)));
    };
    for_places(chosen.held_elements, [](Membership& place) { place.is_held = true; });
    for_places(chosen.moved_elements, [](Membership& place) { place.is_moved = !place.is_held; });
    for (const std::size_t i : chosen.loaded_nodes) {
        const Place place = offset_of(mesh, nodes[i % nodes.size()]);
        // Of several nodes at one place each would have a force of its own.
        places_.at(place).is_loaded = num_nodes.at(place) == 1;
    }
    const auto boundary = topology::boundary_faces(mesh);
    for (const std::size_t i : chosen.loaded_faces) {
        const FaceId f = boundary[i % boundary.size()];
        for (int p = 0; p < mesh.face_size(f); ++p)
            places_.at(offset_of(mesh, mesh.face_corner(f, p))).faces |= 1u << face_areas_.size();
        face_areas_.push_back(area_vector(mesh, f));
    }
    for (const std::size_t i : chosen.loaded_regions)
        regions_.push_back(mesh.region(elements[i % elements.size()]));

    at_start_ = select(mesh);
    std::vector<VertexId> loaded;
    for (const VertexId n : nodes)
        if (places_.at(offset_of(mesh, n)).is_loaded) loaded.push_back(n);
    at_start_.loads.insert(at_start_.loads.begin(),
                           {"nodes", NodalLoad{VertexSet(loaded), force_on_node, {}}, {}});
}

void Acting::follow(const Mesh& mesh, const topology::ChangeSet& changes) {
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources < 2) continue;  // a copy, or back again: its place is known
        Membership of_all{true, true, false, ~0u};
        for (int s = 0; s < record.num_sources; ++s) {
            const VertexId source = record.sources[static_cast<std::size_t>(s)].node;
            const Membership& of_source = places_.at(offset_of(mesh, source));
            of_all.is_held &= of_source.is_held;
            of_all.is_moved &= of_source.is_moved;
            of_all.faces &= of_source.faces;
        }
        places_[offset_of(mesh, record.id)] = of_all;
    }
}

BoundaryConditions Acting::now(const Mesh& mesh, std::span<const double> masses) const {
    BoundaryConditions acting = select(mesh);
    std::map<Place, double> mass_at;
    std::vector<VertexId> loaded;
    for (const VertexId n : living_nodes(mesh))
        if (places_.at(offset_of(mesh, n)).is_loaded) {
            loaded.push_back(n);
            mass_at[offset_of(mesh, n)] += masses[n.index()];
        }
    std::vector<double> shares;
    for (const VertexId n : loaded)
        shares.push_back(masses[n.index()] / mass_at.at(offset_of(mesh, n)));
    acting.loads.insert(acting.loads.begin(),
                        {"nodes", NodalLoad{VertexSet(loaded), force_on_node, shares}, {}});
    return acting;
}

/// All but the forces on nodes.
BoundaryConditions Acting::select(const Mesh& mesh) const {
    std::vector<VertexId> held, moved;
    for (const VertexId n : living_nodes(mesh)) {
        const Membership& place = places_.at(offset_of(mesh, n));
        if (place.is_held) held.push_back(n);
        if (place.is_moved) moved.push_back(n);
    }
    std::vector<FaceId> faces;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        std::uint32_t of_all = ~0u;
        for (int p = 0; p < mesh.face_size(f); ++p)
            of_all &= places_.at(offset_of(mesh, mesh.face_corner(f, p))).faces;
        for (std::size_t i = 0; i < face_areas_.size(); ++i)
            if ((of_all >> i & 1u) && area_vector(mesh, f).dot(face_areas_[i]) > 0.0)
                faces.push_back(f);
    }
    std::vector<CellId> elements;
    for (const CellId e : living_elements(mesh))
        if (std::find(regions_.begin(), regions_.end(), mesh.region(e)) != regions_.end())
            elements.push_back(e);
    BoundaryConditions acting;
    acting.gravity = {0.0, 0.0, -9.81};
    acting.damping = 2.0;
    acting.constraints = {holding("held", VertexSet(held)), moving(VertexSet(moved))};
    acting.loads = {{"wind", TractionLoad{faces, traction}, {}},
                    {"gas", PressureLoad{faces, pressure}, {}},
                    {"field", BodyLoad{elements, body_force}, {}}};
    return acting;
}

}  // namespace incise::physics
