// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>

#include "incise/base/error.h"
#include "incise/topology/face_triangles.h"

namespace incise::physics {

namespace {

bool is_on_boundary(const topology::Mesh& mesh, FaceId f) {
    return f.cell.index() < mesh.element_capacity() && mesh.is_alive(f.cell) &&
           !mesh.neighbor(f).is_valid();
}

/// Returns some corners of a cell as a face, in the fragment that carries the cell.
PressedFace face_in_fragment(const BodyView& body, CellId cell, std::span<const VertexId> corners) {
    const ElementId fragment = body.fragments.fragment_of_cell(cell);
    PressedFace face;
    face.num_corners = corners.size();
    for (std::size_t p = 0; p < face.num_corners; ++p)
        face.corners[p] = body.fragments.embedded(fragment, body.mesh.rest_position(corners[p]));
    return face;
}

/// Calls visit(face) for the members that carry a load: whole faces that are on the boundary. Those
/// of polyhedra that edits have made come in triangles.
template <class Visit>
void for_loaded(const FaceSet& faces, const BodyView& body, Visit visit) {
    const topology::Mesh& mesh = body.mesh;
    for (const FaceSet::Member& member : faces.members()) {
        const FaceId f = member.face;
        if (member.left_to.is_valid() || !is_on_boundary(mesh, f)) continue;
        if (mesh.is_polyhedron(f.cell) && !mesh.whole_cell(f.cell)) {
            topology::for_each_triangle(mesh, f, [&](VertexId a, VertexId b, VertexId c) {
                visit(face_in_fragment(body, f.cell, std::array{a, b, c}));
            });
            continue;
        }
        std::array<VertexId, topology::max_face_corners> corners;
        const int size = mesh.face_size(f);
        for (int p = 0; p < size; ++p)
            corners[static_cast<std::size_t>(p)] = mesh.face_corner(f, p);
        visit(face_in_fragment(body, f.cell,
                               std::span(corners).first(static_cast<std::size_t>(size))));
    }
}

/// Sums of shares by node, in the order in which the shares are added.
class ShareSums {
  public:
    void add(NodeId n, double share) {
        shares_.push_back({static_cast<std::uint32_t>(n.index()), share});
    }
    /// Adds a share of a point of a fragment to the corners of this fragment.
    void add(const fragments::EmbeddedPoint& at, double share) {
        at.for_each([&](NodeId n, double weight) { add(n, weight * share); });
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
            if (load.shares[i] > 0.0)
                shares.add(body.fragments.embedded(body.mesh, members[i].node), load.shares[i]);
        return std::move(shares).sums();
    }
    std::vector<NodalContribution> operator()(const TractionLoad& load) const {
        ShareSums shares;
        for_loaded(load.faces, body, [&](const PressedFace& face) {
            const double area = face.area_vector(body.fragments.rest_positions()).norm();
            for (std::size_t p = 0; p < face.num_corners; ++p)
                shares.add(face.corners[p], area / static_cast<double>(face.num_corners));
        });
        return std::move(shares).sums();
    }
    std::vector<NodalContribution> operator()(const BodyLoad& load) const {
        struct Loaded {
            std::size_t num_cells = 0;
            double volume = 0.0;  // m3
        };
        std::map<ElementId, Loaded> loaded;  // by fragment
        for (const CellId cell : load.elements.members()) {
            if (cell.index() >= body.mesh.element_capacity() || !body.mesh.is_alive(cell)) continue;
            Loaded& fragment = loaded[body.fragments.fragment_of_cell(cell)];
            ++fragment.num_cells;
            fragment.volume += topology::rest_volume(body.mesh, cell);
        }
        ShareSums shares;
        for (const auto& [e, part] : loaded) {
            const auto corners = body.fragments.corners(e);
            const bool is_whole = part.num_cells == body.fragments.cells_of(e).size();
            const double volume =
                is_whole ? body.elements.block_of(body.fragments, e).rest_volume(e) : part.volume;
            const auto masses = body.elements.block_of(body.fragments, e).contributions(e).mass;
            const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
            for (std::size_t k = 0; k < corners.size(); ++k)
                shares.add(corners[k], volume * masses[k] / sum);
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

std::vector<PressedFace> pressed_faces(const FaceSet& faces, const BodyView& body) {
    std::vector<PressedFace> pressed;
    for_loaded(faces, body, [&](const PressedFace& face) { pressed.push_back(face); });
    return pressed;
}

/// Returns the nodes of faces in ascending order.
std::vector<PressedNode> pressed_nodes(std::span<const PressedFace> faces) {
    std::vector<PressedNode> pressed;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t p = 0; p < faces[f].num_corners; ++p)
            faces[f].corners[p].for_each([&](NodeId n, double weight) {
                pressed.push_back(
                    {static_cast<std::uint32_t>(n.index()), static_cast<std::uint32_t>(f), weight});
            });
    std::stable_sort(pressed.begin(), pressed.end(),
                     [](const PressedNode& a, const PressedNode& b) { return a.node < b.node; });
    return pressed;
}

/// Returns the entries of a list, in ascending order of nodes, whose nodes are in the range.
template <class Entry>
std::span<const Entry> entries_of(const std::vector<Entry>& entries, NodeRange range) {
    const auto is_before = [](const Entry& entry, std::size_t node) { return entry.node < node; };
    const auto begin = std::lower_bound(entries.begin(), entries.end(), range.begin, is_before);
    return {begin, std::lower_bound(begin, entries.end(), range.end, is_before)};
}

/// A tangent of the nodes of a face or of an element, N/m.
constexpr int most_rows = 3 * topology::max_corners;
using FaceTangent =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_rows, most_rows>;

/// Returns the tangent of a pressure on a face by the positions of its corners.
FaceTangent tangent_of(const PressedFace& face, double pressure, std::span<const Vec3> x) {
    const std::size_t size = face.num_corners, num_rows = 3 * size;
    const auto at = [&](std::size_t p) { return face.corner(p % size, x); };
    // The derivative of the area vector by corner p is v -> edge x v / 2. All corners of the face
    // have the same force, so that all rows are equal.
    FaceTangent K(num_rows, num_rows);
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
    return 0.5 * (K + K.transpose());
}

/// Passes the tangent of a pressure on one face by the positions of the nodes of its fragment.
void visit_tangent(const PressedFace& face, double pressure, std::span<const Vec3> x,
                   TangentSink& sink) {
    std::array<std::uint32_t, topology::max_corners> nodes;  // of the face, or of the element
    std::size_t num_nodes = 0;
    FaceTangent weights = FaceTangent::Zero(most_rows, most_rows);  // of corner p, in column 3 p
    for (std::size_t p = 0; p < face.num_corners; ++p)
        face.corners[p].for_each([&](NodeId n, double weight) {
            const auto node = static_cast<std::uint32_t>(n.index());
            const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(num_nodes);
            const auto it = std::find(nodes.begin(), end, node);
            if (it == end) nodes[num_nodes++] = node;
            for (int c = 0; c < 3; ++c)
                weights(3 * (it - nodes.begin()) + c, static_cast<Eigen::Index>(3 * p) + c) =
                    weight;
        });
    const FaceTangent W = weights.topLeftCorner(static_cast<Eigen::Index>(3 * num_nodes),
                                                static_cast<Eigen::Index>(3 * face.num_corners));
    const FaceTangent K =
        W.lazyProduct(tangent_of(face, pressure, x)).eval().lazyProduct(W.transpose());
    sink.add(std::span(nodes).first(num_nodes), {K.data(), static_cast<std::size_t>(K.size())});
}

double factor_of(const Load& load, double time) {
    return load.factor.is_empty() ? 1.0 : load.factor.at(time);
}

/// Returns the mass of the material at a node of the mesh, lumped, kg.
double mass_at(const BodyView& body, VertexId n) {
    double mass = 0.0;
    std::vector<CellId> star;
    body.mesh.star(n, star);
    for (const CellId cell : star)
        mass += body.mass_at_corner(cell, static_cast<std::size_t>(body.mesh.corner_of(cell, n)));
    return mass;
}

// Computes the shares again for every family of copies with a member among `touched`. A family has
// all copies of one node of the first selection.
void share(NodalLoad& load, const BodyView& body, std::span<const VertexId> touched) {
    const auto& members = load.nodes.members();
    load.shares.resize(members.size(), 0.0);
    std::map<VertexId, double> family_mass;
    for (const VertexId n : touched)
        if (const auto* member = load.nodes.find(n); member && member->origin.is_valid())
            family_mass[member->origin] = 0.0;
    if (family_mass.empty()) return;
    std::vector<std::pair<std::size_t, double>> masses;  // of the members of these families
    for (std::size_t i = 0; i < members.size(); ++i)
        if (const auto family = family_mass.find(members[i].origin); family != family_mass.end()) {
            masses.emplace_back(i, mass_at(body, members[i].node));
            family->second += masses.back().second;
        }
    for (const auto& [i, mass] : masses)
        load.shares[i] = mass > 0.0 ? mass / family_mass.at(members[i].origin) : 0.0;
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

Vec3 PressedFace::corner(std::size_t p, std::span<const Vec3> positions) const {
    return corners[p].value(positions);
}

Vec3 PressedFace::area_vector(std::span<const Vec3> positions) const {
    const auto at = [&](std::size_t p) { return corner(p, positions); };
    if (num_corners == 3) return 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    return 0.5 * (at(2) - at(0)).cross(at(3) - at(1));
}

Loads::Loads(const Vec3& gravity, std::vector<Load> loads, const BodyView& body)
    : gravity_(gravity), loads_(std::move(loads)) {
    for (Load& load : loads_) share_out(load, body);
    update(body);
}

void Loads::share_out(Load& load, const BodyView& body) {
    auto* nodal = std::get_if<NodalLoad>(&load.kind);
    if (!nodal || !nodal->shares.empty()) return;
    std::vector<VertexId> all;
    for (const auto& member : nodal->nodes.members()) all.push_back(member.node);
    share(*nodal, body, all);
}

void Loads::add(Load load, const BodyView& body) {
    share_out(load, body);
    loads_.push_back(std::move(load));
    is_up_to_date_ = false;
}

void Loads::set(std::size_t i, Load load, const BodyView& body) {
    share_out(load, body);
    loads_[i] = std::move(load);
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
    AssembledLoad assembled{std::visit(ShareFinder{body}, load.kind), {}, {}};
    if (const auto* pressure = std::get_if<PressureLoad>(&load.kind)) {
        assembled.faces = pressed_faces(pressure->faces, body);
        assembled.pressed = pressed_nodes(assembled.faces);
    }
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
        for (const PressedNode& entry : entries_of(assembled_[i].pressed, range)) {
            const PressedFace& face = assembled_[i].faces[entry.face];
            forces[entry.node] -= entry.weight *
                                  (pressure / static_cast<double>(face.num_corners)) *
                                  face.area_vector(positions);
        }
    }
}

void Loads::visit_tangents(std::span<const Vec3> positions, double time, TangentSink& sink) const {
    assert(is_up_to_date_);
    for (std::size_t i = 0; i < loads_.size(); ++i) {
        const auto* load = std::get_if<PressureLoad>(&loads_[i].kind);
        const double factor = factor_of(loads_[i], time);
        if (!load || factor == 0.0) continue;
        for (const PressedFace& face : assembled_[i].faces)
            visit_tangent(face, factor * load->pressure, positions, sink);
    }
}

void Loads::apply(const BodyView& body, const BodyEdit& edit) {
    struct Follower {
        const BodyView& body;
        const BodyEdit& edit;

        void operator()(NodalLoad& load) const {
            load.nodes.apply(body.mesh, edit.material);
            share(load, body, edit.touched_vertices);
        }
        void operator()(TractionLoad& load) const { load.faces.apply(body.mesh, edit.material); }
        void operator()(PressureLoad& load) const { load.faces.apply(body.mesh, edit.material); }
        void operator()(BodyLoad& load) const { load.elements.apply(body.mesh, edit.material); }
    };
    for (Load& load : loads_) std::visit(Follower{body, edit}, load.kind);
    is_up_to_date_ = false;
}

}  // namespace incise::physics
