// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/plane_section.h"

#include <algorithm>
#include <cmath>

namespace incise::test {

std::vector<Vec3> plane_section(const std::array<Vec3, 4>& corners, const Vec3& point,
                                const Vec3& normal) {
    std::vector<Vec3> section;
    for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t q = 0; q < p; ++q) {
            const Vec3 &x = corners[p], &y = corners[q];
            const double a = normal.dot(x - point), b = normal.dot(y - point);
            if (a * b < 0.0) section.push_back(x + a / (a - b) * (y - x));
        }
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : section) middle += x / static_cast<double>(section.size());
    const Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    std::ranges::sort(section, {}, [&](const Vec3& x) {
        return std::atan2(v.dot(x - middle), u.dot(x - middle));
    });
    return section;
}

double polygon_area(std::span<const Vec3> polygon) {
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 2; i < polygon.size(); ++i)
        area += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
    return area.norm();
}

}  // namespace incise::test
