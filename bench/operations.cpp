// Prints the operations of one force evaluation on the two regular cubes of the papers, by method.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>

#include "bench/comparators/operation_counts.h"

int main() {
    using namespace incise;
    for (const int n : {4, 9}) {
        const topology::Mesh mesh = topology::Mesh::build(bench::cube_of_five_tetrahedra(n)).mesh;
        const auto tetrahedra = bench::tetrahedra_of(mesh);
        std::printf("\n%zu nodes, %zu tetrahedra\n", mesh.num_nodes(), tetrahedra.size());
        std::printf("%-24s %9s %9s %6s %6s %10s %8s\n", "method", "+ -", "*", "/", "f()", "total",
                    "each");
        for (const auto& [name, o] : bench::count_operations(tetrahedra, mesh.rest_positions()))
            std::printf("%-24s %9lld %9lld %6lld %6lld %10lld %8.1f\n", name,
                        static_cast<long long>(o.additions),
                        static_cast<long long>(o.multiplications),
                        static_cast<long long>(o.divisions), static_cast<long long>(o.functions),
                        static_cast<long long>(o.total()),
                        static_cast<double>(o.total()) / static_cast<double>(tetrahedra.size()));
        std::printf("%-24s %51lld\n", "mass-tensor, as printed",
                    static_cast<long long>(bench::printed_mass_tensor_operations(tetrahedra)));
    }
}
