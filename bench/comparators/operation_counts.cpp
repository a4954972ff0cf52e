// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/operation_counts.h"

#include <set>

#include "bench/comparators/heml.h"
#include "bench/comparators/mass_springs.h"
#include "bench/comparators/mass_tensor.h"
#include "bench/comparators/mjed.h"
#include "bench/comparators/tled.h"

namespace incise::bench {

topology::MeshData cube_of_five_tetrahedra(int n) {
    topology::MeshData data;
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) data.points.push_back(Vec3(i, j, k) / n);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const bool mirrored = (i + j + k) % 2 != 0;
                // The point at offsets a, b, c. In a mirrored brick the offset along x is reversed.
                const auto corner = [&](int a, int b, int c) -> std::int64_t {
                    const int x = i + (mirrored ? 1 - a : a);
                    return x + (n + 1) * (j + b + (n + 1) * (k + c));
                };
                const auto add = [&](std::int64_t a, std::int64_t b, std::int64_t c,
                                     std::int64_t d) {
                    if (mirrored) std::swap(a, b);
                    data.add_cell(topology::CellKind::tetrahedron, std::array{a, b, c, d});
                };
                const std::int64_t o = corner(0, 0, 0), xy = corner(1, 1, 0), xz = corner(1, 0, 1),
                                   yz = corner(0, 1, 1);
                add(o, xz, xy, yz);  // the one in the middle
                add(corner(1, 0, 0), xy, o, xz);
                add(corner(0, 1, 0), o, xy, yz);
                add(corner(0, 0, 1), o, yz, xz);
                add(corner(1, 1, 1), xy, xz, yz);
            }
    return data;
}

namespace {

constexpr physics::SaintVenantKirchhoff stvk{6000.0, 4000.0};
constexpr physics::NeoHookean nh{2000.0, 6000.0};
constexpr physics::MooneyRivlin mr{1200.0, 800.0, 2800.0};

}  // namespace

std::vector<MethodOperations> count_operations(std::span<const Nodes> tetrahedra,
                                               std::span<const Vec3> rest_positions) {
    std::vector<Vector<Counted>> x, f;
    for (const Vec3& X : rest_positions) {
        x.push_back((1.1 * X).cast<Counted>());
        f.push_back(Vec3::Zero().cast<Counted>());
    }
    std::vector<MethodOperations> counts;
    const auto count = [&](const char* name, auto evaluate) {
        Counted::take();
        evaluate();
        counts.push_back({name, Counted::take()});
    };
    const auto count_elements = [&](const char* name, const auto& kernel) {
        const ElementLoop<std::decay_t<decltype(kernel)>, Counted> loop(kernel, tetrahedra,
                                                                        rest_positions);
        count(name, [&] { loop.add_forces(x, f); });
    };
    count_elements("HEML as printed, StVK", PrintedHeml<Counted>{stvk.lambda, stvk.mu});
    count_elements("HEML, StVK", LinkHeml<Counted, physics::SaintVenantKirchhoff>{stvk});
    count_elements("HEML, NH", LinkHeml<Counted, physics::NeoHookean>{nh});
    count_elements("HEML, MR", LinkHeml<Counted, physics::MooneyRivlin>{mr});
    count_elements("TLED, StVK", Tled<Counted, physics::SaintVenantKirchhoff>{stvk});
    count_elements("TLED, NH", Tled<Counted, physics::NeoHookean>{nh});
    count_elements("TLED, MR", Tled<Counted, physics::MooneyRivlin>{mr});
    count_elements("MJED, StVK", Mjed<Counted, physics::SaintVenantKirchhoff>{stvk});
    count_elements("MJED, NH", Mjed<Counted, physics::NeoHookean>{nh});
    count_elements("MJED, MR", Mjed<Counted, physics::MooneyRivlin>{mr});
    const MassTensor tensor(stvk, tetrahedra, rest_positions);
    std::vector<Vector<Counted>> u;
    count("mass-tensor, StVK", [&] { tensor.add_forces<Counted>(x, f, u); });
    const MassSprings springs(1e4, tetrahedra, rest_positions);
    count("springs", [&] { springs.add_forces<Counted>(x, f); });
    return counts;
}

std::int64_t printed_mass_tensor_operations(std::span<const Nodes> tetrahedra) {
    std::vector<std::set<std::uint32_t>> neighbours;
    for (const Nodes& nodes : tetrahedra)
        for (const std::uint32_t p : nodes) {
            if (p >= neighbours.size()) neighbours.resize(p + 1);
            neighbours[p].insert(nodes.begin(), nodes.end());  // including p
        }
    std::int64_t sum = 0;
    for (const auto& star : neighbours) {
        const auto n = static_cast<std::int64_t>(star.size());
        if (n > 0) sum += 18 * n + 41 * n * n + 12 * n * n * n - 3;
    }
    return sum;
}

}  // namespace incise::bench
