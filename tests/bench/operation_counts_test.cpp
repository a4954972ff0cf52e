// Operations recounted on the papers' cubes: docs/comparison.md has these numbers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/operation_counts.h"

#include <gtest/gtest.h>

#include <map>
#include <ostream>
#include <string>

#include "incise/topology/validate.h"

namespace incise::bench {

void PrintTo(const Operations& o, std::ostream* out) {
    *out << o.additions << " additions, " << o.multiplications << " multiplications, "
         << o.divisions << " divisions, " << o.functions << " functions";
}

namespace {

struct Cube {
    topology::Mesh mesh;
    std::vector<Nodes> tetrahedra;

    explicit Cube(int n)
        : mesh(topology::Mesh::build(cube_of_five_tetrahedra(n)).mesh),
          tetrahedra(tetrahedra_of(mesh)) {}
};

TEST(Counted, CountsWhatIsDone) {
    Counted::take();
    Counted x = Counted(2.0) * 3.0 + 1.0;
    x -= log(x) / sqrt(-x * -x);
    EXPECT_EQ(Counted::take(), (Operations{2, 2, 1, 2}));
    EXPECT_EQ(Counted::take(), Operations{});
    Vector<Counted> v(1.0, 2.0, 3.0);
    EXPECT_EQ(v.dot(v).value(), 14.0);
    EXPECT_EQ(Counted::take(), (Operations{2, 3, 0, 0}));
}

TEST(CubeOfFiveTetrahedra, IsThatOfThePapers) {
    for (const auto& [n, nodes, tetrahedra] :
         {std::tuple{4, 125u, 320u}, std::tuple{9, 1000u, 3645u}}) {
        const Cube cube(n);
        EXPECT_EQ(cube.mesh.num_nodes(), nodes);
        EXPECT_EQ(cube.mesh.num_elements(), tetrahedra);
        EXPECT_EQ(topology::validate(cube.mesh), std::vector<std::string>());
        double volume = 0.0;
        for (const Nodes& t : cube.tetrahedra)
            volume += ShapeFunctions(corners_of(t, cube.mesh.rest_positions())).volume;
        EXPECT_NEAR(volume, 1.0, 1e-13);
    }
}

// HEML 2015, Table 5, and HEML 2006, Table 3, in thousands: 2999 and 36 198.
TEST(OperationCounts, MatchThePaperIfZeroMassTensorsCount) {
    EXPECT_EQ((printed_mass_tensor_operations(Cube(4).tetrahedra) + 500) / 1000, 2999);
    EXPECT_EQ((printed_mass_tensor_operations(Cube(9).tetrahedra) + 500) / 1000, 36198);
}

std::map<std::string, Operations> counts_of(const Cube& cube) {
    std::map<std::string, Operations> counts;
    for (const auto& [name, operations] :
         count_operations(cube.tetrahedra, cube.mesh.rest_positions()))
        counts[name] = operations;
    return counts;
}

// Additions, multiplications, divisions, functions of an element, with three additions a corner. On
// the cube of 320.
TEST(OperationCounts, OfElementsMatchTheDocs) {
    const std::map<std::string, Operations> expected{
        {"HEML as printed, StVK", {117, 99, 0, 0}},
        {"HEML, StVK", {131, 110, 0, 0}},
        {"HEML, NH", {113, 91, 3, 1}},
        {"HEML, MR", {151, 136, 3, 1}},
        {"TLED, StVK", {102, 115, 0, 0}},
        {"TLED, NH", {108, 143, 1, 1}},
        {"TLED, MR", {117, 150, 1, 1}},
        {"MJED, StVK", {102, 111, 0, 0}},
        {"MJED, NH", {84, 97, 3, 1}},
        {"MJED, MR", {120, 141, 3, 1}},
    };
    const auto counts = counts_of(Cube(4));
    for (const auto& [name, c] : expected) {
        SCOPED_TRACE(name);
        constexpr std::int64_t elements = 320;
        EXPECT_EQ(counts.at(name), (Operations{elements * c.additions, elements * c.multiplications,
                                               elements * c.divisions, elements * c.functions}));
    }
    EXPECT_EQ(counts.size(), expected.size() + 2);
}

TEST(OperationCounts, OfNodesAndEdgesMatchTheDocs) {
    const auto small = counts_of(Cube(4)), large = counts_of(Cube(9));
    EXPECT_EQ(small.at("mass-tensor, StVK").total(), 695579);
    EXPECT_EQ(large.at("mass-tensor, StVK").total(), 7214104);
    // 540 edges; a spring takes 21.
    EXPECT_EQ(small.at("springs"), (Operations{540 * 12, 540 * 7, 540, 540}));
}

}  // namespace
}  // namespace incise::bench
