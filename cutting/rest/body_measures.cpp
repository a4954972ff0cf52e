// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/rest/body_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

bool is_all_tetrahedra(const Mesh& mesh) {
    bool is_all = true;
    for (const CellId e : mesh.elements()) is_all &= mesh.kind(e) == CellKind::tetrahedron;
    return is_all;
}

/// Returns the stable step of fragments in a body of one material, times the speed of waves, m. It
/// is 2 / sqrt(s / m) at a node (physics::StableStep), where s is the sum of V (1/h) sum_j (1/h_j)
/// over its fragments, and m that of V / 4, with the altitudes h.
double step_length_of(const FragmentMesh& fragments) {
    std::vector<double> stiffness(fragments.node_capacity(), 0.0), volume = stiffness;
    for (const ElementId e : fragments.elements()) {
        const auto corners = fragments.corners(e);
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = fragments.rest_position(corners[k]);
        std::array<double, 4> inverse_altitudes;
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 &a = x[(k + 1) % 4], &b = x[(k + 2) % 4], &c = x[(k + 3) % 4];
            inverse_altitudes[k] =
                (b - a).cross(c - a).norm() / (6.0 * fragments.carrier_volume(e));
            sum += inverse_altitudes[k];
        }
        for (std::size_t k = 0; k < 4; ++k) {
            stiffness[corners[k].index()] += fragments.volume(e) * inverse_altitudes[k] * sum;
            volume[corners[k].index()] += fragments.volume(e);
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (const NodeId n : fragments.nodes())
        least = std::min(least, std::sqrt(volume[n.index()] / stiffness[n.index()]));
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
    if (is_all_tetrahedra(mesh)) body.step_length = step_length_of(fragments);
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
