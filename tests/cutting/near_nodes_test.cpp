// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/near_nodes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "incise/topology/mesh_edit.h"
#include "support/mesh_families.h"

namespace incise::cutting {
namespace {

/// A share of the edge, seen from each end in turn.
EdgeEnd random_end(const topology::Mesh& mesh, std::mt19937_64& random) {
    std::uniform_int_distribution<std::size_t> any_element(0, mesh.element_capacity() - 1);
    std::uniform_int_distribution<int> any_corner(0, 3);
    std::uniform_real_distribution<double> share(0.01, 0.99);
    const ElementId e(any_element(random));
    const int p = any_corner(random), q = (p + 1 + any_corner(random) % 3) % 4;
    const auto corners = mesh.corners(e);
    const double place = share(random);
    return {corners[static_cast<std::size_t>(p)], corners[static_cast<std::size_t>(q)], e, place,
            place * share(random)};
}

// What is known of the longest edges at nodes from earlier questions must not change an answer, how
// often edges may have been divided since.
TEST(NearNodes, AnswersTheSameWhileEdgesAreDivided) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> component;
        topology::Mesh mesh = topology::Mesh::build(test::jittered_cube(4, 0.2, seed)).mesh;
        topology::MeshEdit edit(mesh);
        const NearLimits limits{0.2, 0.2};
        NearNodes asked_before(mesh, limits);
        int num_near = 0;
        constexpr int num_questions = 4000, questions_a_division = 10;
        for (int i = 0; i < num_questions; ++i) {
            if (i % questions_a_division == 0) {
                const EdgeEnd end = random_end(mesh, random);
                edit.bisect(end.element, end.node, end.other, 0.5);
            }
            const EdgeEnd end = random_end(mesh, random);
            const Vec3 normal =
                Vec3(component(random), component(random), component(random)).normalized();
            const bool is_near = asked_before.has(end, normal);
            ASSERT_EQ(is_near, NearNodes(mesh, limits).has(end, normal)) << seed << ", " << i;
            num_near += is_near ? 1 : 0;
        }
        EXPECT_GT(num_near, num_questions / 10);
        EXPECT_LT(num_near, num_questions * 9 / 10);
    }
}

}  // namespace
}  // namespace incise::cutting
