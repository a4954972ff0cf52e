// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/tetrahedral_mesher.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/memory.h"
#include "incise/io/files/number_text.h"
#include "tetmesh/frame.h"
#include "tetmesh/mesh_smoothing.h"
#include "tetmesh/seed_points.h"
#include "tetmesh/size_field.h"

namespace incise::tetmesh {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Regions = CGAL::Labeled_mesh_domain_3<Kernel>;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<Regions>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace parameters = CGAL::parameters;

constexpr unsigned seed = 1;

// Bounds on radii that give edges of the wanted mean length, within some percent, for a ball.
constexpr double radius_of_edge = 0.74;
// Shape of triangles on the surface, degrees, and of tetrahedra, radius over shortest edge: the
// refinement always ends with angles up to 30 and ratios down to 2.
constexpr double least_facet_angle = 28.0, largest_radius_ratio = 2.0;
constexpr double distance_of_edge = 0.1;  // of the surface of the mesh, at most
/// Precision of points on the surface, over the length of edges.
constexpr double precision_of_edge = 1e-3;
/// Perturbation and exudation go on until all dihedral angles are above this, degrees, or they find
/// no further way. Each two degrees more take up to twice the time, most at edges of a box.
constexpr double angle_aim = 14.0;
constexpr double no_time_limit = 0.0;  // a limit would make results differ from run to run

constexpr double max_nodes = 2e7;         // 1e8 tetrahedra, as for hexahedra
constexpr double bytes_of_node = 6000.0;  // with its tetrahedra, outer ones included
/// With more nodes than this times the expected ones, plus some, the refinement does not end.
constexpr double excess = 10.0;
constexpr double excess_nodes = 2e4;

// How the work is divided, for 20,000 tetrahedra.
constexpr double refined = 0.5, perturbed = 0.95;

template <class Point>
Vec3 to_vec3(const Point& p) {
    return {p.x(), p.y(), p.z()};
}
Kernel::Point_3 to_point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Tells the observer how many nodes there are, now and then.
struct NodeCount {
    const Complex& complex;
    const Observer& observer;
    double expected;
    std::size_t num_calls = 0;

    void look() {
        constexpr std::size_t interval = 4096;
        if (++num_calls % interval != 0) return;
        const auto nodes = complex.triangulation().number_of_vertices();
        observer(refined * std::min(1.0, static_cast<double>(nodes) / expected),
                 "refining, " + std::to_string(nodes) + " nodes");
    }
};

/// The largest radius at a place. Mesh_3 asks for it at each step of its refinement.
struct RadiusField {
    using FT = Kernel::FT;
    const SizeField* sizes;
    NodeCount* count;
    double factor;
    FT operator()(const Kernel::Point_3& point, int, const Domain::Index&) const {
        count->look();
        return factor * sizes->at(to_vec3(point));
    }
};

void refuse_too_many(double expected) {
    if (expected > max_nodes)
        throw InputError("--size gives more than " + io::shown(max_nodes) +
                         " nodes; give a larger one, or a larger --size-surface. Sizes are in the "
                         "unit of the mesh: --scale 0.001 makes metres of millimetres");
    io::require_memory(bytes_of_node * expected, "a mesh of this --size",
                       "give a larger one, or a larger --size-surface");
}

Domain domain_of(const BodyShape& body, const ElementSizes& sizes, CGAL::Random& random) {
    const Vec3 margin = Vec3::Constant(0.05 * body.box.diagonal().norm());
    const Vec3 low = body.box.min() - margin, high = body.box.max() + margin;
    const auto region_at = [&body](const Kernel::Point_3& p) { return body.region_at(to_vec3(p)); };
    const double error = precision_of_edge * sizes.surface / (high - low).norm();
    Domain domain(Regions(region_at, Kernel::Iso_cuboid_3(to_point(low), to_point(high)),
                          parameters::relative_error_bound = error, parameters::p_rng = &random));
    std::vector<std::vector<Kernel::Point_3>> lines;
    for (const auto& edge : body.sharp_edges) {
        lines.emplace_back();
        for (const Vec3& x : edge) lines.back().push_back(to_point(x));
    }
    if (!lines.empty()) domain.add_features(lines.begin(), lines.end());
    return domain;
}

/// The first points of a body, and small triangles at each of them and beside it. The mesher goes
/// on from the triangles between its points whose duals cross the surface. Of points far apart
/// there may be none: the centre of a ring is outside.
std::vector<PartPoints> with_seeds(const BodyShape& body, const SizeField& sizes) {
    std::vector<PartPoints> all;
    for (const PartPoints& part : body.first_points) {
        auto& points = all.emplace_back(PartPoints{part.region, {}}).points;
        const auto seeds = [&](const Vec3& x, double length) {
            return seed_points(x, length, part.region, body.region_at);
        };
        const auto add_triangle = [&](const Vec3& x) {
            const auto others = seeds(x, sizes.at(x));
            points.push_back(x);
            points.insert(points.end(), others.begin(), others.end());
        };
        for (const Vec3& x : part.points) {
            add_triangle(x);
            // The first points are often tips of the body. Beside them it is smoother.
            if (const auto beside = seeds(x, 2.0 * sizes.at(x)); !beside.empty())
                add_triangle(beside.front());
        }
    }
    return all;
}

/// Inserts the first points, but those that are near to one before: the edge between them would
/// stay as short as it is.
void insert_first_points(const std::vector<PartPoints>& parts, const SizeField& sizes,
                         const Domain& domain, Complex& complex) {
    constexpr double near_of_edge = 0.7, near_of_part = 0.5;
    for (const PartPoints& part : parts) {
        Box box;
        for (const Vec3& x : part.points) box.extend(x);
        for (const Vec3& x : part.points) {
            const double near =
                std::min(near_of_edge * sizes.at(x), near_of_part * box.sizes().minCoeff());
            auto& triangulation = complex.triangulation();
            if (triangulation.number_of_vertices() > 0) {
                const auto nearest = triangulation.nearest_power_vertex(to_point(x));
                if ((to_vec3(nearest->point()) - x).norm() < near) continue;
            }
            const auto vertex = triangulation.insert(Triangulation::Weighted_point(to_point(x)));
            // A vertex on a sharp edge may cover the point, or be it.
            const bool is_new = vertex != Complex::Vertex_handle() &&
                                complex.in_dimension(vertex) != 0 &&
                                complex.in_dimension(vertex) != 1;
            if (!is_new) continue;
            complex.set_dimension(vertex, 2);
            complex.set_index(vertex, domain.index_from_surface_patch_index({0, part.region}));
        }
    }
}

struct MeshWithLines {
    topology::MeshData mesh;
    std::vector<bool> is_on_line;  ///< by node, true on the sharp edges that are kept
};

MeshWithLines mesh_of(const Complex& complex) {
    MeshWithLines made;
    auto& [mesh, is_on_line] = made;
    std::unordered_map<Complex::Vertex_handle, std::int64_t, CGAL::Handle_hash_function> numbers;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
        std::array<std::int64_t, 4> corners;
        for (int i = 0; i < 4; ++i) {
            const auto [entry, is_new] =
                numbers.try_emplace(c->vertex(i), static_cast<std::int64_t>(mesh.points.size()));
            if (is_new) {
                mesh.points.push_back(to_vec3(c->vertex(i)->point()));
                is_on_line.push_back(complex.in_dimension(c->vertex(i)) < 2);
            }
            corners[static_cast<std::size_t>(i)] = entry->second;
        }
        mesh.add_cell(topology::CellKind::tetrahedron, corners, complex.subdomain_index(c));
    }
    return made;
}

double facet_distance(const BodyShape& body, const ElementSizes& sizes) {
    return std::max(distance_of_edge * sizes.surface, body.roughness);
}

/// The refinement of a mesh, from the first points on.
struct Refinement {
    const BodyShape& body;
    const ElementSizes& sizes;
    const SizeField& field;
    double expected;  ///< nodes
    const Domain& domain;
    const Observer& observer;

    /// Throws InputError if it does not end.
    Complex from(const std::vector<PartPoints>& first_points) const {
        Complex complex;
        NodeCount count{complex, observer, expected};
        const RadiusField radius{&field, &count, radius_of_edge};
        const Criteria criteria(parameters::edge_size = RadiusField{&field, &count, 1.0},
                                parameters::facet_angle = least_facet_angle,
                                parameters::facet_size = radius,
                                parameters::facet_distance = facet_distance(body, sizes),
                                parameters::cell_radius_edge_ratio = largest_radius_ratio,
                                parameters::cell_size = radius);

        auto error = CGAL::CGAL_MESH_3_NO_ERROR;
        parameters::internal::Mesh_3_options options;
        options.maximal_number_of_vertices =
            static_cast<std::size_t>(excess * expected + excess_nodes);
        options.pointer_to_error_code = &error;
        if (!body.sharp_edges.empty())
            CGAL::Mesh_3::internal::init_c3t3_with_features(
                complex, domain, criteria, false, options.maximal_number_of_vertices, &error);
        insert_first_points(first_points, field, domain, complex);
        if (complex.triangulation().dimension() == 3 && error == CGAL::CGAL_MESH_3_NO_ERROR) {
            const auto topology =
                body.is_manifold ? parameters::manifold() : parameters::non_manifold();
            CGAL::refine_mesh_3(complex, domain, criteria, parameters::no_perturb(),
                                parameters::no_exude(), parameters::no_reset_c3t3(), options,
                                topology);
        }
        if (error != CGAL::CGAL_MESH_3_NO_ERROR)
            throw InputError("the mesh does not end: it has " +
                             std::to_string(complex.triangulation().number_of_vertices()) +
                             " nodes, more than ten times as many as --size asks for; give a "
                             "larger --size-surface, or leave out --features");
        return complex;
    }
};

/// True if a region has no tetrahedron, although it is larger than some.
bool lacks_region(const Complex& complex, const BodyShape& body, const ElementSizes& sizes) {
    std::set<int> regions;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c)
        regions.insert(complex.subdomain_index(c));
    return std::ranges::any_of(body.volumes, [&](const auto& entry) {
        return entry.second > std::pow(sizes.inside, 3) && !regions.contains(entry.first);
    });
}

}  // namespace

topology::MeshData tetrahedra_of(const BodyShape& given, const ElementSizes& given_sizes,
                                 const Observer& observer) {
    // A body without a first triangle is refused below, in the words of this program.
    CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {});
    CGAL::get_default_random() = CGAL::Random(seed);
    CGAL::Random random(seed);
    const Frame frame(given.box);
    const BodyShape body = frame.local(given);
    const ElementSizes sizes{frame.local(given_sizes.inside), frame.local(given_sizes.surface)};
    const SizeField field(body, sizes.inside, sizes.surface);
    const double expected = field.expected_nodes(body);
    refuse_too_many(expected);

    const Domain domain = domain_of(body, sizes, random);
    const Refinement refinement{body, sizes, field, expected, domain, observer};
    auto complex = refinement.from(body.first_points);
    if (lacks_region(complex, body, sizes)) complex = refinement.from(with_seeds(body, field));
    if (complex.number_of_cells_in_complex() == 0)
        throw InputError("no tetrahedron comes out of --size " + io::shown(given_sizes.inside) +
                         ": the longest side of the body is " +
                         io::shown(given.box.sizes().maxCoeff()) + "; give a smaller --size");

    observer(refined, "lifting flat tetrahedra");
    CGAL::perturb_mesh_3(complex, domain, parameters::time_limit = no_time_limit,
                         parameters::sliver_bound = angle_aim);
    observer(perturbed, "removing flat tetrahedra");
    CGAL::exude_mesh_3(complex, parameters::time_limit = no_time_limit,
                       parameters::sliver_bound = angle_aim);
    auto [mesh, is_on_line] = mesh_of(complex);
    raise_altitudes(mesh, is_on_line, body, field, angle_aim * std::numbers::pi / 180.0,
                    facet_distance(body, sizes));
    observer(1.0, "");
    for (Vec3& x : mesh.points) x = frame.given(x);
    return mesh;
}

}  // namespace incise::tetmesh
