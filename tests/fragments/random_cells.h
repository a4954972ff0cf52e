// Hexahedra, wedges and pyramids with jittered corners.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>

#include "incise/fragments/centre_division.h"
#include "support/mesh_families.h"

namespace incise::test {

/// A cell of unit size, in the order of cell_kind.h.
template <topology::CellKind kind>
typename fragments::CentreDivision<kind>::Corners unit_cell() {
    using topology::CellKind;
    if constexpr (kind == CellKind::hexahedron)
        return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
                Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1)};
    else if constexpr (kind == CellKind::wedge)
        return {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0),
                Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(1, 0, 1)};
    else
        return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0.5, 0.5, 1)};
}

/// Diagonals of some quadrilaterals of a cell; none at all in half of the cases.
inline topology::Diagonals random_diagonals(topology::CellKind kind, Random& random) {
    topology::Diagonals diagonals;
    if (random.below(2) == 0) return diagonals;
    const topology::CellTraits& traits = topology::traits(kind);
    for (int f = 0; f < traits.num_faces; ++f)
        if (traits.face(f).size() == 4)
            if (const std::size_t k = random.below(3); k < 2)
                diagonals.divide(f, static_cast<int>(k));
    return diagonals;
}

/// Calls check(kind, corners, random) for `count` cells of each kind, some of them not jittered.
void for_each_random_cell(int count, auto check) {
    for (int seed = 0; seed < count; ++seed) {
        const auto of_kind = [&]<topology::CellKind kind>() {
            SCOPED_TRACE(testing::Message() << topology::traits(kind).name << ", seed " << seed);
            Random random(static_cast<std::uint64_t>(seed));
            auto corners = unit_cell<kind>();
            const double size = random.uniform(0.01, 0.1), jitter = seed % 5 == 0 ? 0.0 : 0.12;
            const Vec3 shift = random.vector(0.1);
            for (Vec3& x : corners) x = shift + size * (x + random.vector(jitter));
            check(std::integral_constant<topology::CellKind, kind>(), corners, random);
        };
        of_kind.template operator()<topology::CellKind::hexahedron>();
        of_kind.template operator()<topology::CellKind::wedge>();
        of_kind.template operator()<topology::CellKind::pyramid>();
    }
}

}  // namespace incise::test
