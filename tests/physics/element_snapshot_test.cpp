// What elements did at one moment, worked out while the body goes on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/element_snapshot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <future>
#include <span>
#include <vector>

#include "incise/topology/box_mesh.h"
#include "tests/physics/model_snapshot.h"

namespace incise::physics {
namespace {

using topology::CellKind;

/// All numbers of a result, to compare to the bit.
using ResultNumbers = std::array<double, 12>;

ResultNumbers numbers_of(const ElementResult& result) {
    ResultNumbers numbers{result.energy, result.volume, result.volume_ratio};
    std::copy_n(result.cauchy_stress.data(), 9, numbers.begin() + 3);
    return numbers;
}

std::vector<ResultNumbers> numbers_of(const std::vector<ElementResult>& results) {
    std::vector<ResultNumbers> numbers;
    for (const ElementResult& result : results) numbers.push_back(numbers_of(result));
    return numbers;
}

std::vector<ResultNumbers> results_of(const Model& model, std::span<const ElementId> elements) {
    std::vector<ResultNumbers> numbers;
    for (const ElementId e : elements) numbers.push_back(numbers_of(model.element_result(e)));
    return numbers;
}

/// The fast kernel's and those of the reference.
void expect_near(const std::vector<ResultNumbers>& numbers,
                 const std::vector<ResultNumbers>& expected) {
    ASSERT_EQ(numbers.size(), expected.size());
    ResultNumbers largest{};
    for (const ResultNumbers& result : expected)
        for (std::size_t k = 0; k < result.size(); ++k)
            largest[k] = std::max(largest[k], std::abs(result[k]));
    const double stress = *std::max_element(largest.begin() + 3, largest.end());
    std::fill(largest.begin() + 3, largest.end(), stress);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (std::size_t k = 0; k < largest.size(); ++k)
            EXPECT_NEAR(numbers[i][k], expected[i][k], 1e-12 * largest[k]);
}

TEST(ElementSnapshot, IsUnchangedByMotionAndEdits) {
    for (const CellKind kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        SCOPED_TRACE(topology::traits(kind).name);
        const auto box = topology::box_mesh(kind, Vec3::Zero(), {0.4, 0.4, 0.4}, {4, 4, 4});
        const MaterialTable table = table_for(box);
        auto mesh = topology::Mesh::build(with_regions(box, table.materials.size())).mesh;
        Model model(mesh, table);
        test::Random random(5);
        set_state(model, random_state(mesh, random, 0.01, 0.5));
        double time = 0.0;
        const auto go_on = [&] { step(model, time, 0.1 * model.stable_step()); };
        go_on();

        for (int i = 0; i < 5; ++i) {
            const auto elements = living_elements(model.fragments());
            const auto expected = numbers_of(ElementSnapshot(model).results(elements));
            expect_near(expected, results_of(model, elements));
            const ElementSnapshot snapshot(model);
            // On a thread of its own, so that a sanitizer sees whether they meet.
            auto results = std::async(std::launch::async,
                                      [&] { return numbers_of(snapshot.results(elements)); });
            for (int k = 0; k < 3; ++k) {
                model.apply(model.mesh(), test::random_edit(mesh, random));
                go_on();
            }
            EXPECT_EQ(results.get(), expected);
            EXPECT_EQ(numbers_of(snapshot.results(elements)), expected);
            EXPECT_NE(mesh.num_elements(), 0u);
        }
    }
}

}  // namespace
}  // namespace incise::physics
