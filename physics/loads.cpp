// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/loads.h"

#include <Eigen/Geometry>
#include <array>
#include <map>

namespace incise::physics {

using topology::FaceId;
using topology::NodeId;

namespace {

bool is_on_boundary(const topology::Mesh& mesh, FaceId f) {
    return f.element.index() < mesh.element_capacity() && mesh.is_alive(f.element) &&
           !mesh.neighbor(f).is_valid();
}

/// Area vector of a face, outwards; for a quadrilateral that of its bilinear patch.
Vec3 area_vector(const topology::Mesh& mesh, FaceId f, std::span<const Vec3> x) {
    const auto at = [&](int p) -> const Vec3& { return x[mesh.face_corner(f, p).index()]; };
    if (mesh.face_size(f) == 3) return 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    return 0.5 * (at(2) - at(0)).cross(at(3) - at(1));
}

void spread(const topology::Mesh& mesh, FaceId f, const Vec3& force, std::span<Vec3> forces) {
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p)
        forces[mesh.face_corner(f, p).index()] += force / static_cast<double>(size);
}

struct Adder {
    const LoadedBody& body;
    double factor;
    std::span<Vec3> forces;

    void operator()(const NodalLoad& load) const {
        const auto& members = load.nodes.members();
        for (std::size_t i = 0; i < members.size(); ++i)
            if (load.shares[i] > 0.0)
                forces[members[i].node.index()] += factor * load.shares[i] * load.force;
    }
    void operator()(const TractionLoad& load) const {
        for_loaded(load.faces, [&](FaceId f) {
            const double area = area_vector(body.mesh, f, body.mesh.rest_positions()).norm();
            spread(body.mesh, f, factor * area * load.traction, forces);
        });
    }
    void operator()(const PressureLoad& load) const {
        for_loaded(load.faces, [&](FaceId f) {
            spread(body.mesh, f,
                   -factor * load.pressure * area_vector(body.mesh, f, body.positions), forces);
        });
    }
    void operator()(const BodyLoad& load) const {
        for (const ElementId e : load.elements.members()) {
            if (e.index() >= body.mesh.element_capacity() || !body.mesh.is_alive(e)) continue;
            const auto corners = body.mesh.corners(e);
            const double volume = body.elements.block_of(body.mesh, e).rest_volume(e);
            for (const NodeId n : corners)
                forces[n.index()] +=
                    factor * volume / static_cast<double>(corners.size()) * load.force;
        }
    }

    template <class Visit>
    void for_loaded(const FaceSet& faces, Visit visit) const {
        for (const FaceSet::Member& member : faces.members())
            if (!member.left_to.is_valid() && is_on_boundary(body.mesh, member.face))
                visit(member.face);
    }
};

/// Tangents of one pressure load on one face.
void visit_tangent(const topology::Mesh& mesh, FaceId f, double pressure, std::span<const Vec3> x,
                   TangentSink& sink) {
    const int size = mesh.face_size(f);
    std::array<std::uint32_t, 4> nodes{};
    for (int p = 0; p < size; ++p)
        nodes[static_cast<std::size_t>(p)] =
            static_cast<std::uint32_t>(mesh.face_corner(f, p).index());
    const auto at = [&](int p) -> const Vec3& {
        return x[nodes[static_cast<std::size_t>(p % size)]];
    };
    // With the area vector's derivative by corner p, v -> edge x v / 2, in all rows alike.
    Eigen::MatrixXd K(3 * size, 3 * size);
    for (int p = 0; p < size; ++p) {
        const Vec3 edge = size == 3 ? Vec3(at(p + 2) - at(p + 1)) : Vec3(at(p + 3) - at(p + 1));
        Eigen::Matrix3d by_corner;
        for (int c = 0; c < 3; ++c)
            by_corner.col(c) = 0.5 * pressure / size * edge.cross(Vec3::Unit(c));
        for (int row = 0; row < size; ++row) K.block<3, 3>(3 * row, 3 * p) = by_corner;
    }
    K = (0.5 * (K + K.transpose())).eval();
    sink.add(std::span(nodes).first(static_cast<std::size_t>(size)),
             {K.data(), static_cast<std::size_t>(K.size())});
}

// Anew for every family of copies with a member among `touched`.
void share(NodalLoad& load, const LoadedBody& body, std::span<const NodeId> touched) {
    const auto& members = load.nodes.members();
    load.shares.resize(members.size(), 0.0);
    std::map<NodeId, double> family_mass;
    for (const NodeId n : touched)
        if (const auto* member = load.nodes.find(n); member && member->origin.is_valid())
            family_mass[member->origin] = 0.0;
    if (family_mass.empty()) return;
    const auto mass_of = [&](const NodeSet::Member& m) {
        return body.mesh.is_alive(m.node) ? body.masses[m.node.index()] : 0.0;
    };
    for (const auto& m : members)
        if (const auto family = family_mass.find(m.origin); family != family_mass.end())
            family->second += mass_of(m);
    for (std::size_t i = 0; i < members.size(); ++i)
        if (const auto family = family_mass.find(members[i].origin); family != family_mass.end()) {
            const double mass = mass_of(members[i]);
            load.shares[i] = mass > 0.0 ? mass / family->second : 0.0;
        }
}

}  // namespace

Loads::Loads(std::vector<Load> loads, const LoadedBody& body) : loads_(std::move(loads)) {
    for (Load& load : loads_)
        if (auto* nodal = std::get_if<NodalLoad>(&load.kind)) {
            std::vector<NodeId> all;
            for (const auto& member : nodal->nodes.members()) all.push_back(member.node);
            share(*nodal, body, all);
        }
}

void Loads::add(const LoadedBody& body, double time, std::span<Vec3> forces) const {
    for (const Load& load : loads_) {
        const double factor = load.factor.is_empty() ? 1.0 : load.factor.at(time);
        if (factor != 0.0) std::visit(Adder{body, factor, forces}, load.kind);
    }
}

void Loads::visit_tangents(const LoadedBody& body, double time, TangentSink& sink) const {
    for (const Load& load : loads_) {
        const auto* pressure = std::get_if<PressureLoad>(&load.kind);
        const double factor = load.factor.is_empty() ? 1.0 : load.factor.at(time);
        if (!pressure || factor == 0.0) continue;
        for (const FaceSet::Member& member : pressure->faces.members())
            if (!member.left_to.is_valid() && is_on_boundary(body.mesh, member.face))
                visit_tangent(body.mesh, member.face, factor * pressure->pressure, body.positions,
                              sink);
    }
}

void Loads::apply(const topology::ChangeSet& changes, const LoadedBody& body,
                  std::span<const NodeId> touched) {
    struct Follower {
        const topology::ChangeSet& changes;
        const LoadedBody& body;
        std::span<const NodeId> touched;

        void operator()(NodalLoad& load) const {
            load.nodes.apply(changes);
            share(load, body, touched);
        }
        void operator()(TractionLoad& load) const { load.faces.apply(body.mesh, changes); }
        void operator()(PressureLoad& load) const { load.faces.apply(body.mesh, changes); }
        void operator()(BodyLoad& load) const { load.elements.apply(changes); }
    };
    for (Load& load : loads_) std::visit(Follower{changes, body, touched}, load.kind);
}

}  // namespace incise::physics
