// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/power_differences.h"

#include <cmath>
#include <cstddef>
#include <span>

namespace incise::physics {

namespace {

constexpr std::size_t max_points = 6;

/// Symmetric sums of n + 1 points, one degree after another. A sum is that of all products of
/// `degree` points, with repetition, and equals the divided difference of x^(n + degree).
class SymmetricSums {
  public:
    explicit SymmetricSums(std::span<const double> points) : points_(points) { sums_.fill(1.0); }

    /// Returns the sum of the present degree, which is 0 at first.
    double value() const { return sums_[points_.size() - 1]; }
    void raise_degree() {
        double sum = 0.0;
        for (std::size_t k = 0; k < points_.size(); ++k)
            sums_[k] = sum = sum + points_[k] * sums_[k];
    }

  private:
    std::span<const double> points_;
    std::array<double, max_points> sums_;  // entry k: the sum of points 0 to k
};

/// Returns the divided difference of x^q over points within a factor of two, by the binomial series
/// about their middle.
double of_close_points(std::span<const double> points, double q) {
    const std::size_t n = points.size() - 1;
    const double middle = 0.5 * (points.front() + points.back());
    std::array<double, max_points> offsets{};
    for (std::size_t k = 0; k <= n; ++k) offsets[k] = (points[k] - middle) / middle;
    double binomial = 1.0;
    for (std::size_t k = 0; k < n; ++k)
        binomial *= (q - static_cast<double>(k)) / static_cast<double>(k + 1);
    SymmetricSums sums(std::span<const double>(offsets.data(), n + 1));
    double total = 0.0;
    constexpr std::size_t max_terms = 80;  // offsets are below 1/3
    for (std::size_t k = n; k < n + max_terms; ++k) {
        const double term = binomial * sums.value();
        total += term;
        // Sums of odd degree are zero if the points are symmetric about the middle.
        if (k > n + 1 && k % 2 == n % 2 && std::abs(term) <= 1e-18 * std::abs(total)) break;
        binomial *= (q - static_cast<double>(k)) / static_cast<double>(k + 1);
        sums.raise_degree();
    }
    return total * std::pow(middle, q - static_cast<double>(n));
}

/// Returns the divided difference of x^q for a whole number q.
double of_whole_power(std::span<const double> points, std::size_t q) {
    const std::size_t n = points.size() - 1;
    if (q < n) return 0.0;
    SymmetricSums sums(points);
    for (std::size_t degree = n; degree < q; ++degree) sums.raise_degree();
    return sums.value();
}

/// Returns the divided differences of x^m times the slope for m = 0 to num_powers - 1. The points
/// are c0, c1, c2, each taken `times` times.
template <std::size_t times, std::size_t num_powers>
std::array<double, num_powers> differences_of_powers(const std::array<double, 3>& c,
                                                     const PowerSlope& slope) {
    constexpr double kink = 0.01;
    std::array<bool, 3> is_above;
    for (std::size_t k = 3; k-- > 0;)
        is_above[k] = c[k] >= slope.floor ||
                      (k < 2 && is_above[k + 1] && c[k + 1] - c[k] < kink * slope.floor);
    constexpr std::size_t num_points = 3 * times;
    std::array<double, num_points> points;
    for (std::size_t i = 0; i < num_points; ++i) points[i] = c[i / times];
    const double line = slope.p * std::pow(slope.floor, slope.p - 2.0);

    std::array<double, num_powers> result;
    for (std::size_t m = 0; m < num_powers; ++m) {
        std::array<double, num_points> table;  // entry i: over `size` points from point i on
        for (std::size_t size = 1; size <= num_points; ++size)
            for (std::size_t i = 0; i + size <= num_points; ++i) {
                const std::size_t last = i + size - 1;
                const auto part = std::span<const double>(points).subspan(i, size);
                if (!is_above[last / times])
                    table[i] = line * of_whole_power(part, m + 1);
                else if (is_above[i / times] && part.back() <= 2.0 * part.front())
                    table[i] =
                        slope.p * of_close_points(part, slope.p - 1.0 + static_cast<double>(m));
                else
                    table[i] = (table[i + 1] - table[i]) / (part.back() - part.front());
            }
        result[m] = table[0];
    }
    return result;
}

}  // namespace

std::array<double, 3> differences(const std::array<double, 3>& c, const PowerSlope& slope) {
    return differences_of_powers<1, 3>(c, slope);
}

std::array<double, 5> doubled_differences(const std::array<double, 3>& c, const PowerSlope& slope) {
    return differences_of_powers<2, 5>(c, slope);
}

}  // namespace incise::physics
