// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/rest/body_measures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "incise/fragments/centre_division.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::cutting {

using fragments::FragmentMesh;
using topology::CellKind;
using topology::Mesh;

namespace {

/// Returns the volume at rest of the whole body, m3. The sum has more digits than its terms, so
/// that the volume error has no part from the summation.
double volume_at_rest(const Mesh& mesh) {
    long double sum = 0.0;
    for (const CellId e : mesh.elements()) sum += topology::rest_volume(mesh, e);
    return static_cast<double>(sum);
}

/// The tetrahedra that a carrier is divided into, and the gradients of its motion in them.
struct CarrierPart {
    double volume;                ///< m3
    std::vector<Vec3> gradients;  ///< 1/m, of the motion of each corner of the carrier
};

/// Returns the gradients of linear functions that are 1 at one corner of a tetrahedron, 1/m.
/// @param volume  receives that of the tetrahedron, m3
std::array<Vec3, 4> gradients_of(const std::array<Vec3, 4>& x, double& volume) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.row(k) = x[static_cast<std::size_t>(k) + 1] - x[0];
    volume = edges.determinant() / 6.0;
    const Eigen::Matrix3d inverse = edges.inverse();
    return {-inverse.rowwise().sum(), inverse.col(0), inverse.col(1), inverse.col(2)};
}

std::vector<CarrierPart> parts_of(const FragmentMesh& fragments, ElementId e) {
    const auto nodes = fragments.corners(e);
    std::vector<CarrierPart> parts;
    if (fragments.kind(e) == CellKind::tetrahedron) {
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = fragments.rest_position(nodes[k]);
        double volume = 0.0;
        const std::array<Vec3, 4> gradients = gradients_of(x, volume);
        parts.push_back({volume, {gradients.begin(), gradients.end()}});
        return parts;
    }
    fragments::with_division(fragments.kind(e), [&](auto division) {
        using Division = decltype(division);
        typename Division::Corners corners;
        for (std::size_t k = 0; k < corners.size(); ++k)
            corners[k] = fragments.rest_position(nodes[k]);
        const auto points = Division::points(corners, fragments.diagonals(e));
        for (const auto& part : Division::parts()) {
            double volume = 0.0;
            const std::array<Vec3, 4> gradients = gradients_of(
                {points[part[0]], points[part[1]], points[part[2]], points[part[3]]}, volume);
            typename Division::Points at_points;
            at_points.fill(Vec3::Zero());
            for (std::size_t k = 0; k < 4; ++k) at_points[part[k]] = gradients[k];
            const auto at_corners = Division::gathered(at_points, fragments.diagonals(e));
            parts.push_back({volume, {at_corners.begin(), at_corners.end()}});
        }
    });
    return parts;
}

/// Returns the stable step of fragments in a body of one material, times the speed of waves, m. It
/// is 2 / sqrt(s / m) at a node (physics::StableStep). s is the sum over the tetrahedra of its
/// fragments of V |g| sum_j |g_j| with the gradients g of the motions of corners: in a tetrahedron
/// they are 1 / h with the altitudes h. m is the sum of the volumes of the fragments, divided by
/// the number of their corners.
double step_length_of(const FragmentMesh& fragments) {
    std::vector<double> stiffness(fragments.node_capacity(), 0.0), volume = stiffness;
    for (const ElementId e : fragments.elements()) {
        const auto corners = fragments.corners(e);
        const std::span<const double> shares = fragments.part_shares(e);
        const std::vector<CarrierPart> parts = parts_of(fragments, e);
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const double share = shares.empty() ? fragments.volume_share(e) : shares[p];
            double sum = 0.0;
            for (const Vec3& g : parts[p].gradients) sum += g.norm();
            for (std::size_t k = 0; k < corners.size(); ++k)
                stiffness[corners[k].index()] +=
                    share * parts[p].volume * parts[p].gradients[k].norm() * sum;
        }
        for (const NodeId n : corners)
            volume[n.index()] += fragments.volume(e) / static_cast<double>(corners.size());
    }
    double least = std::numeric_limits<double>::infinity();
    for (const NodeId n : fragments.nodes())
        least = std::min(least, 2.0 * std::sqrt(volume[n.index()] / stiffness[n.index()]));
    return least;
}

}  // namespace

FragmentCounts counts_of(const Mesh& mesh, const FragmentMesh& fragments) {
    FragmentCounts counts;
    counts.fragments = fragments.num_elements();
    for (const ElementId e : fragments.elements())
        counts.smallest_share = std::min(counts.smallest_share, fragments.volume_share(e));
    std::vector<bool> has_material(fragments.node_capacity(), false);
    for (const VertexId n : mesh.nodes())
        if (const fragments::EmbeddedPoint at = fragments.embedded(mesh, n); at.count == 1)
            has_material[at.nodes[0].index()] = true;
    for (const NodeId n : fragments.nodes()) counts.ghost_nodes += has_material[n.index()] ? 0 : 1;
    return counts;
}

BodyMeasures measures_of(const Mesh& mesh, const FragmentMesh& fragments) {
    const topology::ShapeMetrics metrics = topology::measure_shapes(mesh);
    BodyMeasures body;
    static_cast<FragmentCounts&>(body) = counts_of(mesh, fragments);
    body.elements = mesh.num_elements();
    body.nodes = mesh.num_nodes();
    body.volume = volume_at_rest(mesh);
    body.min_dihedral_angle = metrics.min_dihedral_angle;
    body.min_altitude = metrics.min_altitude;
    body.mean_edge_length = metrics.mean_edge_length;
    body.box_min = metrics.box.min();
    body.box_max = metrics.box.max();
    body.step_length = step_length_of(fragments);
    return body;
}

std::vector<Piece> pieces_of(const Mesh& mesh) {
    const topology::Components components = topology::components(mesh);
    std::vector<Piece> pieces(static_cast<std::size_t>(components.count));
    std::vector<long double> volumes(pieces.size(), 0.0);
    for (const CellId e : mesh.elements()) {
        const auto p = static_cast<std::size_t>(components.of_element[e.index()]);
        volumes[p] += topology::rest_volume(mesh, e);
        ++pieces[p].elements;
    }
    for (std::size_t p = 0; p < pieces.size(); ++p)
        pieces[p].volume = static_cast<double>(volumes[p]);
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.volume > b.volume; });
    return pieces;
}

}  // namespace incise::cutting
