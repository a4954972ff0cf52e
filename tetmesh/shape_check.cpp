// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/shape_check.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "tetmesh/region_faces.h"

namespace incise::tetmesh {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;
using Regions = std::pair<int, int>;  // the lower one first

/// No gap or part is told that is wider than this, over the length of edges.
constexpr double max_width = 4.0;

Kernel::Point_3 to_point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// The faces of a mesh, by the regions between which they are.
class FacesByRegions {
  public:
    FacesByRegions(const topology::MeshData& mesh, const std::vector<RegionFace>& faces) {
        for (const RegionFace& face : faces) {
            const auto at = [&](std::size_t k) {
                return to_point(mesh.points[static_cast<std::size_t>(face.nodes[k])]);
            };
            triangles_[std::minmax(face.inner, face.outer)].emplace_back(at(0), at(1), at(2));
        }
        for (const auto& [regions, triangles] : triangles_)
            trees_.try_emplace(regions, triangles.begin(), triangles.end());
    }

    /// Returns the distance to the nearest face between two regions; infinity if there is none.
    double distance(const Vec3& x, const Regions& regions) const {
        const auto tree = trees_.find(regions);
        if (tree == trees_.end()) return HUGE_VAL;
        return std::sqrt(tree->second.squared_distance(to_point(x)));
    }

  private:
    std::map<Regions, Triangles> triangles_;
    std::map<Regions, Tree> trees_;
};

/// Returns how far a line runs within its first region, at most `limit`.
double extent_along(const BodyShape& body, const Vec3& x, const Vec3& direction, double first,
                    double limit) {
    const int region = body.region_at(x + first * direction);
    constexpr double growth = 1.1;
    double in = first, out = first;
    while (out < limit && body.region_at(x + out * direction) == region) {
        in = out;
        out *= growth;
    }
    if (!(out < limit)) return limit;
    constexpr int num_halvings = 20;
    for (int i = 0; i < num_halvings; ++i) {
        const double middle = 0.5 * (in + out);
        (body.region_at(x + middle * direction) == region ? in : out) = middle;
    }
    return out;
}

/// A place at which the mesh may have another shape than the body.
struct Place {
    Vec3 x;
    double width = -1.0;  ///< of the gap or of the part of the body that is there
    bool is_gap = false;
};

/// Returns what is narrower at a point of the surface: the gap outside, or the part inside.
Place place_at(const BodyShape& body, const Vec3& x, const Vec3& outwards, double beside,
               double limit) {
    const double gap = extent_along(body, x, outwards, beside, limit),
                 part = extent_along(body, x, -outwards, beside, limit);
    return {x, std::min(gap, part), gap < part};
}

/// Calls visit(x, outwards, regions, beside) for points of the surface of the body, one in each
/// cube of half an edge. `beside` is a small distance to both sides.
template <class Visit>
void visit_points(const BodyShape& body, double edge, const Visit& visit) {
    constexpr double spacing_of_edge = 0.5;
    const double spacing = spacing_of_edge * edge;
    const double beside = 1e-6 * body.box.diagonal().norm();
    std::set<std::array<std::int64_t, 3>> visited;
    body.visit_surface(spacing, [&](const Vec3& x, const Vec3& outwards) {
        const auto cube = [&](Eigen::Index axis) {
            return static_cast<std::int64_t>(
                std::floor((x[axis] - body.box.min()[axis]) / spacing));
        };
        if (!visited.insert({cube(0), cube(1), cube(2)}).second) return;
        const Regions regions = std::minmax(
            {body.region_at(x - beside * outwards), body.region_at(x + beside * outwards)});
        if (regions.first != regions.second) visit(x, outwards, regions, beside);
    });
}

/// The widest gap and the thickest part that the mesh does not have.
struct Lost {
    Place gap, part;
};

Lost lost_places(const topology::MeshData& mesh, const std::vector<RegionFace>& faces,
                 const BodyShape& body, double edge) {
    // Rounded edges of the body come nearer than this.
    constexpr double far_of_edge = 0.5, far_of_roughness = 4.0;
    const double far = std::max(far_of_edge * edge, far_of_roughness * body.roughness);
    const FacesByRegions faces_of(mesh, faces);
    Lost lost;
    visit_points(body, edge,
                 [&](const Vec3& x, const Vec3& outwards, const Regions& regions, double beside) {
                     if (faces_of.distance(x, regions) <= far) return;
                     const Place place = place_at(body, x, outwards, beside, max_width * edge);
                     Place& widest = place.is_gap ? lost.gap : lost.part;
                     if (place.width > widest.width) widest = place;
                 });
    return lost;
}

/// Returns where the body, or a gap of it, is thinnest.
Place narrowest_place(const BodyShape& body, double edge) {
    Place narrowest{Vec3::Zero(), HUGE_VAL};
    visit_points(body, edge,
                 [&](const Vec3& x, const Vec3& outwards, const Regions&, double beside) {
                     const Place place = place_at(body, x, outwards, beside, max_width * edge);
                     if (place.width < narrowest.width) narrowest = place;
                 });
    return narrowest;
}

/// The topology of the surface between the body and its outside.
SurfaceTopology outer_topology(const std::vector<RegionFace>& faces) {
    std::vector<std::array<std::int64_t, 3>> triangles;
    for (const RegionFace& face : faces)
        if (face.outer == 0) triangles.push_back(face.nodes);
    return topology_of(triangles);
}

std::string description_of(const Place& place) {
    std::ostringstream text;
    text << std::setprecision(2) << place.width << (place.is_gap ? " wide" : " thick")
         << std::setprecision(6) << " at (" << place.x.x() << ", " << place.x.y() << ", "
         << place.x.z() << ")";
    return text.str();
}

/// Returns what to do to have a place in the mesh.
std::string remedy_of(const Place& place, double edge) {
    // Edges of this many widths were short enough for gaps between plane and curved surfaces.
    constexpr double edges_of_width = 3.0, less = 0.5;
    std::ostringstream text;
    text << "; give a --size or --size-surface of at most " << std::setprecision(2)
         << std::min(edges_of_width * place.width, less * edge);
    return text.str();
}

std::string counts_of(const SurfaceTopology& surface) {
    const auto counted = [](std::int64_t n, const char* noun) {
        return std::to_string(n) + noun + (n == 1 ? "" : "s");
    };
    return counted(surface.num_parts, " closed part") + " and " +
           counted(surface.num_handles(), " handle");
}

}  // namespace

std::vector<std::string> differences_of_shape(const topology::MeshData& mesh, const BodyShape& body,
                                              double edge) {
    const auto faces = region_faces(mesh);
    const auto [gap, part] = lost_places(mesh, faces, body, edge);
    std::vector<std::string> warnings;
    if (gap.width > 0.0)
        warnings.push_back("the mesh closes a gap of the input, up to " + description_of(gap) +
                           remedy_of(gap, edge));
    if (part.width > 0.0)
        warnings.push_back("the mesh lacks a part of the input, up to " + description_of(part) +
                           remedy_of(part, edge));
    if (!warnings.empty() || !body.topology) return warnings;
    const auto made = outer_topology(faces);
    if (made == *body.topology) return warnings;
    const Place place = narrowest_place(body, edge);
    warnings.push_back("the surface of the mesh has " + counts_of(made) + ", that of the input " +
                       counts_of(*body.topology) + "; its narrowest " +
                       (place.is_gap ? "gap" : "part") + " is " + description_of(place) +
                       remedy_of(place, edge));
    return warnings;
}

}  // namespace incise::tetmesh
