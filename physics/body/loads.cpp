// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <map>

#include "incise/base/error.h"

namespace incise::physics {

namespace {

bool is_on_boundary(const topology::Mesh& mesh, FaceId f) {
    return f.element.index() < mesh.element_capacity() && mesh.is_alive(f.element) &&
           !mesh.neighbor(f).is_valid();
}

/// Returns the outward area vector of a face; for a quadrilateral that of its bilinear patch.
Vec3 area_vector(const PressedCorner& face, std::span<const Vec3> x) {
    const auto at = [&](std::size_t p) -> const Vec3& { return x[face.corners[p]]; };
    if (face.num_corners == 3) return 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    return 0.5 * (at(2) - at(0)).cross(at(3) - at(1));
}

PressedCorner first_corner(const topology::Mesh& mesh, FaceId f) {
    PressedCorner corner{0, static_cast<std::uint32_t>(mesh.face_size(f)), {}};
    for (std::uint32_t p = 0; p < corner.num_corners; ++p)
        corner.corners[p] =
            static_cast<std::uint32_t>(mesh.face_corner(f, static_cast<int>(p)).index());
    corner.node = corner.corners[0];
    return corner;
}

/// Calls visit(face) for the members that carry a load: whole faces that are on the boundary.
template <class Visit>
void for_loaded(const FaceSet& faces, const topology::Mesh& mesh, Visit visit) {
    for (const FaceSet::Member& member : faces.members())
        if (!member.left_to.is_valid() && is_on_boundary(mesh, member.face)) visit(member.face);
}

/// Sums of shares by node, in the order in which the shares are added.
class ShareSums {
  public:
    void add(NodeId n, double share) {
        shares_.push_back({static_cast<std::uint32_t>(n.index()), share});
    }
    /// Returns one sum for each node, in ascending order of nodes.
    std::vector<NodalContribution> sums() && {
        std::stable_sort(
            shares_.begin(), shares_.end(),
            [](const NodalContribution& a, const NodalContribution& b) { return a.node < b.node; });
        std::size_t num_nodes = 0;
        for (const NodalContribution& next : shares_) {
            if (num_nodes > 0 && shares_[num_nodes - 1].node == next.node)
                shares_[num_nodes - 1].share += next.share;
            else
                shares_[num_nodes++] = next;
        }
        shares_.resize(num_nodes);
        return std::move(shares_);
    }

  private:
    std::vector<NodalContribution> shares_;
};

/// Computes the shares of the nodes in a load. They are summed in the order of its members.
struct ShareFinder {
    const BodyView& body;

    std::vector<NodalContribution> operator()(const NodalLoad& load) const {
        ShareSums shares;
        const auto& members = load.nodes.members();
        for (std::size_t i = 0; i < members.size(); ++i)
            if (load.shares[i] > 0.0) shares.add(members[i].node, load.shares[i]);
        return std::move(shares).sums();
    }
    std::vector<NodalContribution> operator()(const TractionLoad& load) const {
        ShareSums shares;
        for_loaded(load.faces, body.mesh, [&](FaceId f) {
            const PressedCorner face = first_corner(body.mesh, f);
            const double area = area_vector(face, body.mesh.rest_positions()).norm();
            for (std::uint32_t p = 0; p < face.num_corners; ++p)
                shares.add(NodeId(face.corners[p]), area / face.num_corners);
        });
        return std::move(shares).sums();
    }
    std::vector<NodalContribution> operator()(const BodyLoad& load) const {
        ShareSums shares;
        for (const ElementId e : load.elements.members()) {
            if (e.index() >= body.mesh.element_capacity() || !body.mesh.is_alive(e)) continue;
            const auto corners = body.mesh.corners(e);
            const double volume = body.elements.block_of(body.mesh, e).rest_volume(e);
            for (const NodeId n : corners)
                shares.add(n, volume / static_cast<double>(corners.size()));
        }
        return std::move(shares).sums();
    }
    std::vector<NodalContribution> operator()(const PressureLoad&) const { return {}; }
};

/// The force on a node with a share of 1, N.
struct ForcePerShare {
    Vec3 operator()(const NodalLoad& load) const { return load.force; }
    Vec3 operator()(const TractionLoad& load) const { return load.traction; }
    Vec3 operator()(const BodyLoad& load) const { return load.force; }
    Vec3 operator()(const PressureLoad&) const { return Vec3::Zero(); }
};

std::vector<PressedCorner> pressed_corners(const FaceSet& faces, const topology::Mesh& mesh) {
    std::vector<PressedCorner> pressed;
    for_loaded(faces, mesh, [&](FaceId f) {
        PressedCorner corner = first_corner(mesh, f);
        for (std::uint32_t p = 0; p < corner.num_corners; ++p) {
            corner.node = corner.corners[p];
            pressed.push_back(corner);
        }
    });
    std::stable_sort(
        pressed.begin(), pressed.end(),
        [](const PressedCorner& a, const PressedCorner& b) { return a.node < b.node; });
    return pressed;
}

/// Returns the entries of a list, in ascending order of nodes, whose nodes are in the range.
template <class Entry>
std::span<const Entry> entries_of(const std::vector<Entry>& entries, NodeRange range) {
    const auto is_before = [](const Entry& entry, std::size_t node) { return entry.node < node; };
    const auto begin = std::lower_bound(entries.begin(), entries.end(), range.begin, is_before);
    return {begin, std::lower_bound(begin, entries.end(), range.end, is_before)};
}

/// Passes the tangent of a pressure on one face, which is given by its first corner.
void visit_tangent(const PressedCorner& face, double pressure, std::span<const Vec3> x,
                   TangentSink& sink) {
    const std::size_t size = face.num_corners, num_rows = 3 * size;
    const auto at = [&](std::size_t p) -> const Vec3& { return x[face.corners[p % size]]; };
    // The derivative of the area vector by corner p is v -> edge x v / 2. All corners of the face
    // have the same force, so that all rows are equal.
    constexpr int most = 12;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most, most> K(num_rows,
                                                                                         num_rows);
    for (std::size_t p = 0; p < size; ++p) {
        const Vec3 edge = size == 3 ? Vec3(at(p + 2) - at(p + 1)) : Vec3(at(p + 3) - at(p + 1));
        Eigen::Matrix3d by_corner;
        for (int c = 0; c < 3; ++c)
            by_corner.col(c) =
                0.5 * pressure / static_cast<double>(size) * edge.cross(Vec3::Unit(c));
        for (std::size_t row = 0; row < size; ++row)
            K.block<3, 3>(static_cast<Eigen::Index>(3 * row), static_cast<Eigen::Index>(3 * p)) =
                by_corner;
    }
    K = (0.5 * (K + K.transpose())).eval();
    sink.add(std::span(face.corners).first(size), {K.data(), static_cast<std::size_t>(K.size())});
}

double factor_of(const Load& load, double time) {
    return load.factor.is_empty() ? 1.0 : load.factor.at(time);
}

// Computes the shares again for every family of copies with a member among `touched`. A family has
// all copies of one node of the first selection.
void share(NodalLoad& load, const BodyView& body, std::span<const NodeId> touched) {
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

void Load::require_fit(const topology::Mesh& mesh) const {
    struct Requirement {
        const topology::Mesh& mesh;
        void operator()(const NodalLoad& load) const {
            load.nodes.require_fit(mesh);
            if (!load.shares.empty() && load.shares.size() != load.nodes.members().size())
                throw InputError("a nodal load has not as many shares as nodes");
        }
        void operator()(const TractionLoad& load) const { load.faces.require_fit(mesh); }
        void operator()(const PressureLoad& load) const { load.faces.require_fit(mesh); }
        void operator()(const BodyLoad& load) const { load.elements.require_fit(); }
    };
    std::visit(Requirement{mesh}, kind);
}

Loads::Loads(const Vec3& gravity, std::vector<Load> loads, const BodyView& body)
    : gravity_(gravity), loads_(std::move(loads)) {
    for (Load& load : loads_) share_out(load, body);
    update(body);
}

void Loads::share_out(Load& load, const BodyView& body) {
    auto* nodal = std::get_if<NodalLoad>(&load.kind);
    if (!nodal || !nodal->shares.empty()) return;
    std::vector<NodeId> all;
    for (const auto& member : nodal->nodes.members()) all.push_back(member.node);
    share(*nodal, body, all);
}

void Loads::add(Load load, const BodyView& body) {
    share_out(load, body);
    loads_.push_back(std::move(load));
    is_up_to_date_ = false;
}

void Loads::remove(std::size_t i) {
    loads_.erase(loads_.begin() + static_cast<std::ptrdiff_t>(i));
    is_up_to_date_ = false;
}

void Loads::update(const BodyView& body) {
    if (is_up_to_date_) return;
    assembled_.clear();
    for (const Load& load : loads_) assembled_.push_back(assemble(load, body));
    is_up_to_date_ = true;
}

Loads::AssembledLoad Loads::assemble(const Load& load, const BodyView& body) {
    AssembledLoad assembled{std::visit(ShareFinder{body}, load.kind), {}};
    if (const auto* pressure = std::get_if<PressureLoad>(&load.kind))
        assembled.pressed = pressed_corners(pressure->faces, body.mesh);
    return assembled;
}

void Loads::add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                       double time, std::span<Vec3> forces) const {
    assert(is_up_to_date_);
    for (std::size_t n = range.begin; n < range.end; ++n) forces[n] += body.masses[n] * gravity_;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
        const double factor = factor_of(loads_[i], time);
        if (factor == 0.0) continue;
        const Vec3 force = factor * std::visit(ForcePerShare{}, loads_[i].kind);
        for (const NodalContribution& entry : entries_of(assembled_[i].shares, range))
            forces[entry.node] += entry.share * force;
        const auto* load = std::get_if<PressureLoad>(&loads_[i].kind);
        if (!load) continue;
        const double pressure = factor * load->pressure;
        for (const PressedCorner& corner : entries_of(assembled_[i].pressed, range))
            forces[corner.node] -= pressure / corner.num_corners * area_vector(corner, positions);
    }
}

void Loads::visit_tangents(std::span<const Vec3> positions, double time, TangentSink& sink) const {
    assert(is_up_to_date_);
    for (std::size_t i = 0; i < loads_.size(); ++i) {
        const auto* load = std::get_if<PressureLoad>(&loads_[i].kind);
        const double factor = factor_of(loads_[i], time);
        if (!load || factor == 0.0) continue;
        for (const PressedCorner& corner : assembled_[i].pressed)
            if (corner.node == corner.corners[0])
                visit_tangent(corner, factor * load->pressure, positions, sink);
    }
}

void Loads::apply(const BodyView& body, const topology::ChangeSet& changes,
                  std::span<const NodeId> touched) {
    struct Follower {
        const topology::ChangeSet& changes;
        const BodyView& body;
        std::span<const NodeId> touched;

        void operator()(NodalLoad& load) const {
            load.nodes.apply(body.mesh, changes);
            share(load, body, touched);
        }
        void operator()(TractionLoad& load) const { load.faces.apply(body.mesh, changes); }
        void operator()(PressureLoad& load) const { load.faces.apply(body.mesh, changes); }
        void operator()(BodyLoad& load) const { load.elements.apply(body.mesh, changes); }
    };
    for (Load& load : loads_) std::visit(Follower{changes, body, touched}, load.kind);
    is_up_to_date_ = false;
}

}  // namespace incise::physics
