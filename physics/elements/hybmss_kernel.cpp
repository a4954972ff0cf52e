// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/hybmss_kernel.h"

#include <limits>
#include <sstream>

namespace incise::physics {

namespace {

/// The largest accepted distance of a corner from a box, over the shortest edge of the box.
constexpr double shape_tolerance = 1e-5;

/// The largest accepted ratio of the longest to the shortest edge. Above it, some springs of an
/// isotropic box are so weak, or even negative, that the lattice is unstable at strains of some
/// 10 %.
constexpr double largest_aspect = 1.42;

Vec3 edge_lengths(const BoxFrame& frame) {
    return {frame.a.norm(), frame.b.norm(), frame.c.norm()};
}

bool is_cube(const Vec3& edges) {
    return edges.maxCoeff() - edges.minCoeff() <= shape_tolerance * edges.minCoeff();
}

/// Returns the largest distance of a corner from its place in the nearest box, m.
double distance_from_box(const std::array<Vec3, 8>& x) {
    const BoxFrame frame(x);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& corner : x) centre += 0.125 * corner;
    // The axes of the box keep the direction of a and the plane of a and b.
    const Vec3 e0 = frame.a.normalized();
    const Vec3 e1 = (frame.b - e0.dot(frame.b) * e0).normalized();
    const Vec3 e2 = e0.cross(e1);
    const Vec3 half = 0.5 * edge_lengths(frame);
    double largest = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const auto& side = BoxFrame::sides[k];
        const Vec3 wanted =
            centre + side[0] * half[0] * e0 + side[1] * half[1] * e1 + side[2] * half[2] * e2;
        largest = std::max(largest, (x[k] - wanted).norm());
    }
    return largest;
}

}  // namespace

std::optional<SpringContributions> spring_contributions(const Vec3& edges, double shear_modulus,
                                                        double ratio) {
    if (edges.maxCoeff() > largest_aspect * edges.minCoeff()) return std::nullopt;
    if (ratio == 0.0 && !is_cube(edges)) return std::nullopt;
    const Vec3 squares = edges.cwiseAbs2();
    const double stiffness = shear_modulus * edges.prod();  // G V
    const double inner_square = squares.sum();
    const auto others = [](int c) { return std::array<int, 2>{(c + 1) % 3, (c + 2) % 3}; };

    // Between `low` and `high`, the values of k_c, no spring of an edge or face diagonal has a
    // negative stiffness.
    double mean = 0.0, low = -std::numeric_limits<double>::infinity(),
           high = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c) {
        const auto [p, q] = others(c);
        const double product = squares[p] * squares[q];
        mean += stiffness / product * 0.5 * (squares[p] + squares[q]) / 3.0;
        high = std::min(high, 0.25 * stiffness / product * inner_square);
        const double left = 3.0 - squares[c] / squares[p] - squares[c] / squares[q];
        low = std::max(low, -0.25 * stiffness * left * inner_square / (squares[c] * squares[c]));
    }
    double inner = std::isinf(ratio) ? 0.0 : 3.0 * mean / (4.0 + 3.0 * ratio);
    if (!is_cube(edges)) {
        // At the ends of the range some springs vanish, and the lattice wrinkles without them.
        const double range = high - low;
        inner = std::clamp(inner, std::max(low + 0.5 * range, 0.0), high - 0.1 * range);
    }

    SpringContributions shares{};
    for (int c = 0; c < 3; ++c) {
        const auto [p, q] = others(c);
        const double face_square = squares[p] + squares[q];
        const double edge = stiffness * (3.0 - squares[c] / squares[p] - squares[c] / squares[q]) +
                            4.0 * inner * squares[c] * squares[c] / inner_square;
        const double face = stiffness / (squares[p] * squares[q]) - 4.0 * inner / inner_square;
        const auto k = static_cast<std::size_t>(c);
        shares.stiffnesses[k] = 0.25 * edge / squares[c];
        shares.stiffnesses[3 + k] = ratio == 0.0 ? 0.0 : 0.25 * face * face_square;
        shares.lengths[k] = edges[c];
        shares.lengths[3 + k] = std::sqrt(face_square);
    }
    shares.stiffnesses[6] = inner;
    shares.lengths[6] = std::sqrt(inner_square);
    return shares;
}

std::optional<std::string> why_no_cell(const HybridSprings& material,
                                       const std::array<Vec3, 8>& corners) {
    const Vec3 edges = edge_lengths(BoxFrame(corners));
    std::ostringstream size, text;
    size << edges[0] << " x " << edges[1] << " x " << edges[2] << " m";
    const double off = distance_from_box(corners);
    double farthest = 0.0;
    for (const Vec3& x : corners) farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
    const double rounding = 4.0 * 0x1.0p-24 * farthest;  // of coordinates in single precision
    if (!(off <= shape_tolerance * edges.minCoeff() + rounding)) {
        text << "is no box: a corner is " << off << " m from where it would be in one of "
             << size.str() << "; the method hybmss needs boxes, such as voxels or a grid";
        return text.str();
    }
    if (spring_contributions(edges, material.shear_modulus, material.stiffness_ratio))
        return std::nullopt;
    text << "is a box of " << size.str() << "; ";
    if (material.stiffness_ratio == 0.0)
        text << "without face diagonals the method hybmss needs cubes";
    else
        text << "the method hybmss needs cubes, or boxes whose longest edge is at most 1.4 times "
                "the shortest";
    return text.str();
}

HybmssKernel::Element HybmssKernel::precompute(const Corners& X) const {
    const BoxFrame frame(X);
    const auto shares =
        spring_contributions(edge_lengths(frame), material.shear_modulus, material.stiffness_ratio);
    return {frame.volume(), shares.value_or(SpringContributions{})};
}

// The highest frequency of a cube is omega^2 = 12 max(K, 5 G / 3) / (rho l^2): that of its change
// of volume or, for negative kappa, that of its springs alone. A bound of 3/2 of modulus times
// length at each corner gives this frequency.
// Other boxes have bounds by Gershgorin's theorem. A spring k adds 2 k to the rows of its ends. The
// volume term adds kappa / V |g_i| sum_j |g_j|, with the gradients g of the volume. If kappa is
// negative, the volume term only lowers frequencies and is left out.
std::array<double, 8> HybmssKernel::stiffness_bounds(const Element& e, const Corners& X) const {
    const double kappa = std::max(material.volume_modulus, 0.0);
    const BoxFrame frame(X);
    const Vec3 edges = edge_lengths(frame);
    std::array<double, 8> s{};
    if (is_cube(edges)) {
        const double bulk_modulus = kappa + 5.0 / 3.0 * material.shear_modulus;
        s.fill(1.5 * bulk_modulus * e.volume / edges.cwiseAbs2().minCoeff());
        return s;
    }
    for (std::size_t g = 0; g < springs.size(); ++g)
        for (const auto& ends : springs[g])
            for (const std::size_t i : ends) s[i] += 2.0 * e.springs.stiffnesses[g];
    // |g_i| is the same for all corners of a box.
    const double gradient = 0.25 * std::sqrt(frame.b.cross(frame.c).squaredNorm() +
                                             frame.c.cross(frame.a).squaredNorm() +
                                             frame.a.cross(frame.b).squaredNorm());
    for (double& bound : s) bound += 8.0 * kappa / e.volume * gradient * gradient;
    return s;
}

namespace {

/// Returns the largest eigenvalue, at most, of a symmetric matrix with non-negative eigenvalues
/// from the first two invariants of it. It is exact if the two other eigenvalues are equal.
double largest_eigenvalue(double first, double second) {
    return (first + 2.0 * std::sqrt(std::max(first * first - 3.0 * second, 0.0))) / 3.0;
}

/// Returns the factor by which the highest frequency of the springs of a cube grows, squared, if
/// each spring had its stiffness in all directions. No strain exceeds it. The modes alternate along
/// one, two or three axes.
double largest_stiffening_of_springs(const SpringContributions& springs, double modulus_length) {
    const double edge = springs.stiffnesses[0], face = springs.stiffnesses[3],
                 inner = springs.stiffnesses[6];
    const double highest = std::max(
        {2.0 * edge + 4.0 * face + 2.0 * inner, 4.0 * (edge + face), 6.0 * edge + 2.0 * inner});
    return std::max(highest / (1.5 * modulus_length), 1.0);
}

}  // namespace

// The volume term is kappa/V (grad V' grad V'^T + (V' - V) grad grad V'). The mean edges give the
// deformation gradient F of the cell, by which grad V' grows like cof F, and the second derivative
// like F.
double HybmssKernel::stiffening(const Element& e, const Corners& x) const {
    const BoxFrame now(x);
    const auto& lengths = e.springs.lengths;
    const Vec3 a = now.a / lengths[0], b = now.b / lengths[1], c = now.c / lengths[2];
    const double J = a.dot(b.cross(c));
    const double first = a.squaredNorm() + b.squaredNorm() + c.squaredNorm();
    const double second =
        a.cross(b).squaredNorm() + b.cross(c).squaredNorm() + c.cross(a).squaredNorm();
    const double largest_square = largest_eigenvalue(first, second),
                 largest_of_areas = largest_eigenvalue(second, first * J * J);
    const double kappa = material.volume_modulus, positive = std::max(kappa, 0.0);
    const double of_volume =
        positive * largest_of_areas + std::abs(kappa * (J - 1.0)) * std::sqrt(largest_square);
    const double of_springs = 5.0 / 3.0 * material.shear_modulus;
    double factor = 1.0;
    if (is_cube({lengths[0], lengths[1], lengths[2]})) {
        // What remains of the positions without the mean deformation also strains the springs.
        Vec3 centre = Vec3::Zero();
        for (const Vec3& corner : x) centre += 0.125 * corner;
        double remainder = -2.0 * (now.a.squaredNorm() + now.b.squaredNorm() + now.c.squaredNorm());
        for (const Vec3& corner : x) remainder += (corner - centre).squaredNorm();
        const double strain = std::abs(largest_square - 1.0) + std::abs(first - 3.0) +
                              std::sqrt(std::max(remainder, 0.0)) / lengths[0];
        const double most = largest_stiffening_of_springs(
            e.springs, of_springs * e.volume / (lengths[0] * lengths[0]));
        constexpr double factor_of_strain = 2.0;
        factor = std::min(1.0 + factor_of_strain * strain, most);
    }
    return (of_volume + of_springs * factor) / (positive + of_springs);
}

}  // namespace incise::physics
