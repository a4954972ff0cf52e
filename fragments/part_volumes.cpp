// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/part_volumes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "incise/fragments/centre_division.h"
#include "incise/topology/geometry.h"

namespace incise::fragments {

using topology::CellKind;

namespace {

/// A polygon in space: a triangle that up to three planes have cut. It is convex, but for one in
/// such a plane within rounding, which may cross itself. Each plane then adds half as many corners.
struct Polygon {
    std::array<Vec3, 9> corners;
    std::size_t size = 0;
    void add(const Vec3& x) { corners[size++] = x; }
};

/// Returns the part of a polygon in which a coordinate is not below zero.
Polygon clipped(const Polygon& polygon, int axis) {
    Polygon part;
    for (std::size_t k = 0; k < polygon.size; ++k) {
        const Vec3 &a = polygon.corners[k], &b = polygon.corners[(k + 1) % polygon.size];
        if (a[axis] >= 0.0) part.add(a);
        if ((a[axis] < 0.0) == (b[axis] < 0.0)) continue;
        const double along = a[axis] / (a[axis] - b[axis]);
        Vec3 on_plane = a + along * (b - a);
        on_plane[axis] = 0.0;
        part.add(on_plane);
    }
    return part;
}

/// Returns six times the volume of the pyramid over a polygon, with its apex at the origin.
double six_volumes(const Polygon& base) {
    double sum = 0.0;
    for (std::size_t k = 2; k < base.size; ++k)
        sum += base.corners[0].dot(base.corners[k - 1].cross(base.corners[k]));
    return sum;
}

/// Returns six times the volume of the pyramid over a triangle below the plane x + y + z = 1.
/// @pre  no coordinate is below zero
double six_volumes_below(const std::array<Vec3, 3>& base) {
    Polygon below, above;  // the latter seen from the origin, on the plane
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = base[k], &b = base[(k + 1) % 3];
        const double of_a = a.sum() - 1.0, of_b = b.sum() - 1.0;
        if (of_a <= 0.0)
            below.add(a);
        else
            above.add(a / a.sum());
        if ((of_a <= 0.0) == (of_b <= 0.0)) continue;
        const Vec3 on_plane = a + of_a / (of_a - of_b) * (b - a);
        below.add(on_plane);
        above.add(on_plane);
    }
    return six_volumes(below) + six_volumes(above);
}

/// What is thinner than this, in barycentric coordinates, has no volume.
constexpr double flatness = 1e-15;

using Triangle = std::array<Vec3, 3>;

/// Sets the coordinates of a triangle in the basis of a tetrahedron at the origin. Returns false if
/// the tetrahedron of the origin and the triangle has no volume in common with it.
bool set_local(Triangle& local, const Eigen::Matrix3d& to_local, const Triangle& triangle) {
    for (int axis = 0; axis < 3; ++axis) {
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            local[k][axis] = to_local.row(axis).dot(triangle[k]);
            most = std::max(most, local[k][axis]);
        }
        if (most < flatness) return false;
    }
    return true;
}

/// Returns six times the signed volume that the tetrahedron of the origin and a triangle has in the
/// one of the origin and the unit vectors.
double six_volumes_in_unit(const Triangle& triangle) {
    const Vec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
    const Vec3 least = a.cwiseMin(b).cwiseMin(c);
    const bool is_in_cone = least.minCoeff() >= -flatness;
    if (is_in_cone && std::max({a.sum(), b.sum(), c.sum()}) <= 1.0 + flatness)
        return a.dot(b.cross(c));
    Polygon polygon{{a, b, c}, 3};
    for (int axis = 0; axis < 3; ++axis)
        if (least[axis] < -flatness) polygon = clipped(polygon, axis);
    // Triangles one by one: where rounding decides on which side of the plane points are, these
    // are divided without overlap, while a polygon need not be.
    double sum = 0.0;
    for (std::size_t k = 2; k < polygon.size; ++k)
        sum += six_volumes_below({polygon.corners[0], polygon.corners[k - 1], polygon.corners[k]});
    return sum;
}

template <class Division>
typename Division::Points points_of(std::span<const Vec3> corners, Diagonals diagonals) {
    typename Division::Corners of_cell;
    assert(corners.size() == of_cell.size());
    std::ranges::copy(corners, of_cell.begin());
    return Division::points(of_cell, diagonals);
}

template <class Division>
PartNumbers volumes_of_parts(std::span<const Vec3> corners, Diagonals diagonals) {
    const auto at = points_of<Division>(corners, diagonals);
    PartNumbers volumes{};
    std::size_t t = 0;
    for (const auto& p : Division::parts())
        volumes[t++] = topology::tetrahedron_volume(at[p[0]], at[p[1]], at[p[2]], at[p[3]]);
    return volumes;
}

// By the divergence theorem the volume of the polyhedron in a tetrahedron is the sum of the signed
// volumes of the tetrahedra of any point and the triangles, in this tetrahedron. The point is the
// centre of the cell, so that most triangles have nothing in a tetrahedron. In its barycentric
// coordinates it is that of the unit vectors.
template <class Division>
PartNumbers fractions_in_parts(std::span<const Vec3> corners,
                               std::span<const std::array<Vec3, 3>> surface, Diagonals diagonals) {
    static constexpr auto parts = Division::parts();
    const auto at = points_of<Division>(corners, diagonals);
    std::vector<Triangle> from_centre(surface.begin(), surface.end());
    for (Triangle& triangle : from_centre)
        for (Vec3& x : triangle) x -= at.back();
    PartNumbers fractions{};
    Triangle local;
    for (std::size_t t = 0; t < parts.size(); ++t) {
        const auto& p = parts[t];
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k)
            edges.col(k) = at[p[static_cast<std::size_t>(k) + 1]] - at.back();
        const Eigen::Matrix3d to_local = edges.inverse();
        double sum = 0.0;
        for (const Triangle& triangle : from_centre)
            if (set_local(local, to_local, triangle)) sum += six_volumes_in_unit(local);
        constexpr double rounding = 1e-14;
        const bool is_whole = std::abs(sum - 1.0) < rounding;
        fractions[t] = sum < rounding ? 0.0 : is_whole ? 1.0 : sum;
    }
    return fractions;
}

}  // namespace

std::size_t num_parts(CellKind kind) {
    return with_division(kind, []<class Division>(Division) { return Division::num_parts; });
}

PartNumbers part_volumes(CellKind kind, std::span<const Vec3> corners, Diagonals diagonals) {
    return with_division(kind, [&]<class Division>(Division) {
        return volumes_of_parts<Division>(corners, diagonals);
    });
}

PartNumbers part_fractions(CellKind kind, std::span<const Vec3> corners,
                           std::span<const std::array<Vec3, 3>> surface, Diagonals diagonals) {
    return with_division(kind, [&]<class Division>(Division) {
        return fractions_in_parts<Division>(corners, surface, diagonals);
    });
}

}  // namespace incise::fragments
