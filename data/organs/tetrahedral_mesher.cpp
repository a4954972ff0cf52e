// SPDX-License-Identifier: GPL-3.0-or-later
#include "data/organs/tetrahedral_mesher.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "incise/base/error.h"

namespace incise::organs {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace parameters = CGAL::parameters;

constexpr unsigned seed = 1;

template <class Point>
Vec3 to_vec3(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

/// Mesh_3 never returns from an empty domain, and cuts off what leaves the bounding ball.
void check_extent(const Organ& organ) {
    constexpr int half = 40;
    bool is_empty = true;
    for (int i = -half; i <= half; ++i)
        for (int j = -half; j <= half; ++j)
            for (int k = -half; k <= half; ++k) {
                const Vec3 p = organ.bounding_radius / half * Vec3(i, j, k);
                if (organ.body(p) >= 0.0) continue;
                is_empty = false;
                if (p.norm() > 0.98 * organ.bounding_radius)
                    throw InputError(organ.name + " leaves its bounding ball; enlarge the ball");
            }
    if (is_empty) throw InputError(organ.name + " is empty where it was sampled");
}

/// Elements grow with the distance from the surface and from the boundary between the regions.
struct SizeField {
    using FT = Kernel::FT;
    const Organ& organ;
    FT operator()(const Kernel::Point_3& point, int, const Domain::Index&) const {
        const Vec3 p = to_vec3(point);
        const double depth = std::min(std::abs(organ.body(p)), std::abs(organ.inner(p)));
        return std::min(organ.surface_size + organ.size_growth * depth, organ.core_size);
    }
};

Complex mesh_complex(const Organ& organ) {
    const auto region_at = [&](const Kernel::Point_3& point) {
        const Vec3 p = to_vec3(point);
        if (organ.body(p) >= 0.0) return 0;
        return organ.inner(p) < 0.0 ? 2 : 1;
    };
    CGAL::Random random(seed);
    CGAL::get_default_random() = CGAL::Random(seed);
    const Kernel::Sphere_3 bounds(CGAL::ORIGIN, organ.bounding_radius * organ.bounding_radius);
    const Domain domain(region_at, bounds, parameters::relative_error_bound = 1e-6,
                        parameters::p_rng = &random);

    const SizeField sizes{organ};
    const Criteria criteria(parameters::facet_angle = 28.0, parameters::facet_size = sizes,
                            parameters::facet_distance = 0.1 * organ.surface_size,
                            parameters::cell_radius_edge_ratio = 2.0,
                            parameters::cell_size = sizes);
    // Lloyd's even spreading of nodes leaves less work to what follows; slivers go last.
    // Without limits said, perturbation and exudation stop after as much time as the refinement
    // took, and so differ from run to run.
    constexpr double no_time_limit = 0.0;
    return CGAL::make_mesh_3<Complex>(domain, criteria, parameters::manifold(),
                                      parameters::lloyd(parameters::max_iteration_number = 20,
                                                        parameters::time_limit = no_time_limit),
                                      parameters::perturb(parameters::time_limit = no_time_limit),
                                      parameters::exude(parameters::time_limit = no_time_limit));
}

}  // namespace

topology::MeshData tetrahedralise(const Organ& organ) {
    check_extent(organ);
    const Complex complex = mesh_complex(organ);

    topology::MeshData mesh;
    std::unordered_map<Complex::Vertex_handle, std::int64_t, CGAL::Handle_hash_function> numbers;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
        std::array<std::int64_t, 4> corners;
        for (int i = 0; i < 4; ++i) {
            const auto [entry, is_new] =
                numbers.try_emplace(c->vertex(i), static_cast<std::int64_t>(mesh.points.size()));
            if (is_new) mesh.points.push_back(to_vec3(c->vertex(i)->point()));
            corners[static_cast<std::size_t>(i)] = entry->second;
        }
        mesh.add_cell(topology::CellKind::tetrahedron, corners, complex.subdomain_index(c));
    }
    return mesh;
}

}  // namespace incise::organs
