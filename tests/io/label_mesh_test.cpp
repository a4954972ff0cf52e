// Hexahedra from label images: how many, where, and that they are one body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/image/label_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "incise/base/error.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"

namespace incise::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using topology::MeshData;

LabelImage image(std::array<std::int64_t, 3> dimensions, std::vector<int> labels) {
    LabelImage image;
    image.dimensions = dimensions;
    image.labels = std::move(labels);
    return image;
}

LabelImage filled(std::array<std::int64_t, 3> dimensions, int label = 1) {
    const auto [x, y, z] = dimensions;
    return image(dimensions, std::vector<int>(static_cast<std::size_t>(x * y * z), label));
}

Eigen::Matrix3d turn(double angle, const Vec3& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

double volume(const MeshData& mesh, std::size_t cell) {
    std::vector<Vec3> corners;
    for (const auto p : mesh.cell(cell))
        corners.push_back(mesh.points[static_cast<std::size_t>(p)]);
    return topology::signed_volume(mesh.kinds[cell], corners);
}

Vec3 centre(const MeshData& mesh, std::size_t cell) {
    Vec3 sum = Vec3::Zero();
    for (const auto p : mesh.cell(cell)) sum += mesh.points[static_cast<std::size_t>(p)];
    return sum / 8.0;
}

std::map<int, int> cells_of_regions(const MeshData& mesh) {
    std::map<int, int> cells;
    for (const int region : mesh.regions) ++cells[region];
    return cells;
}

std::string meshing_refusal(const LabelImage& image, std::optional<double> size) {
    try {
        hex_mesh(image, size);
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "was meshed";
    return {};
}

TEST(HexMesh, MakesBoxesOfLabelledVoxelsInOrder) {
    auto labels = image({2, 3, 1}, {0, 7, -2, 7, 0, 7});
    labels.spacing = {1, 2, 4};
    labels.origin = {10, 20, 30};
    const auto mesh = hex_mesh(labels);
    EXPECT_THAT(mesh.regions, ElementsAre(7, -2, 7, 7));
    ASSERT_EQ(mesh.num_cells(), 4u);
    EXPECT_EQ(centre(mesh, 0), Vec3(11, 20, 30));
    EXPECT_EQ(centre(mesh, 1), Vec3(10, 22, 30));
    EXPECT_EQ(centre(mesh, 2), Vec3(11, 22, 30));
    EXPECT_EQ(centre(mesh, 3), Vec3(11, 24, 30));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(volume(mesh, c), 8.0);
    // Two layers of 4 x 3 places without two corners each.
    EXPECT_EQ(mesh.points.size(), 20u);
    EXPECT_EQ(mesh.points.front(), Vec3(10.5, 19, 28));
    EXPECT_EQ(mesh.points.back(), Vec3(11.5, 25, 32));
}

TEST(HexMesh, NumbersSharedPointsOnceAndOnlyThoseUsed) {
    std::mt19937 random(7);
    auto labels = filled({6, 5, 4}, 0);
    for (auto& label : labels.labels) label = static_cast<int>(random() % 3);
    const auto mesh = hex_mesh(labels);
    std::set<std::int64_t> used(mesh.corners.begin(), mesh.corners.end());
    EXPECT_EQ(used.size(), mesh.points.size());
    EXPECT_EQ(*used.rbegin(), static_cast<std::int64_t>(mesh.points.size()) - 1);
    const auto before = [](const Vec3& a, const Vec3& b) {
        return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
    };
    EXPECT_TRUE(std::is_sorted(mesh.points.begin(), mesh.points.end(), before));
    const std::set<Vec3, decltype(before)> distinct(mesh.points.begin(), mesh.points.end(), before);
    EXPECT_EQ(distinct.size(), mesh.points.size());
    const auto num_labelled = std::ranges::count_if(labels.labels, [](int l) { return l != 0; });
    EXPECT_EQ(mesh.num_cells(), static_cast<std::size_t>(num_labelled));
    EXPECT_EQ(hex_mesh(filled({6, 5, 4})).points.size(), 7u * 6u * 5u);
}

TEST(HexMesh, IsAValidMeshInAnyPose) {
    std::mt19937 random(11);
    for (const bool is_mirrored : {false, true})
        for (const auto size : {std::optional<double>(), std::optional(0.9), std::optional(2.1)}) {
            auto labels = filled({7, 6, 5}, 0);
            for (auto& label : labels.labels)
                label = random() % 4 ? static_cast<int>(random() % 3) : 0;
            labels.spacing = {1, 1.5, 0.7};
            labels.origin = {-100, 50, 3};
            labels.directions = turn(0.6, {1, 2, -1});
            if (is_mirrored) labels.directions.col(0) *= -1.0;
            const auto mesh = hex_mesh(labels, size);
            const double expected = size ? *size * *size * *size : 1 * 1.5 * 0.7;
            for (std::size_t c = 0; c < mesh.num_cells(); ++c)
                ASSERT_NEAR(volume(mesh, c), expected, 1e-12 * 100);
            const auto built = topology::Mesh::build(mesh);
            EXPECT_EQ(built.mesh.num_elements(), mesh.num_cells());
            EXPECT_THAT(topology::validate(built.mesh), testing::IsEmpty());
        }
}

TEST(HexMesh, PlacesVoxelsAsTheirDirectionsSay) {
    auto labels = image({2, 1, 1}, {0, 5});
    labels.spacing = {3, 2, 1};
    labels.origin = {1, 2, 3};
    labels.directions << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // to y, z, x
    const auto mesh = hex_mesh(labels);
    EXPECT_EQ(centre(mesh, 0), Vec3(1, 5, 3));
    Vec3 low = mesh.points[0], high = low;
    for (const auto& p : mesh.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    EXPECT_EQ(high - low, Vec3(1, 3, 2));
}

TEST(HexMesh, SamplesAtTheCentresOfCubes) {
    // Spacing 1, 2, 3: 6 x 6 x 6 millimetres, the halves along x of regions 1 and 2.
    auto labels = filled({6, 3, 2}, 1);
    for (std::size_t v = 0; v < labels.labels.size(); ++v)
        if (v % 6 >= 3) labels.labels[v] = 2;
    labels.spacing = {1, 2, 3};
    labels.origin = {0.5, 1, 1.5};  // begins at 0
    for (const double size : {1.0, 0.5, 3.0}) {
        const auto mesh = hex_mesh(labels, size);
        const auto n = static_cast<int>(6 / size);
        EXPECT_EQ(cells_of_regions(mesh),
                  (std::map<int, int>{{1, n * n * n / 2}, {2, n * n * n / 2}}));
        EXPECT_EQ(mesh.points.size(), static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1)));
        for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
            EXPECT_DOUBLE_EQ(volume(mesh, c), size * size * size);
            EXPECT_EQ(mesh.regions[c], centre(mesh, c).x() < 3.0 ? 1 : 2);
        }
    }
    // Cubes of 4: of the second along each axis the centre lies at 6, outside.
    const auto mesh = hex_mesh(labels, 4.0);
    ASSERT_EQ(mesh.num_cells(), 1u);
    EXPECT_EQ(centre(mesh, 0), Vec3(2, 2, 2));
    // Of 2, the second has its centre at 3, where the second half begins.
    EXPECT_EQ(cells_of_regions(hex_mesh(labels, 2.0)), (std::map<int, int>{{1, 9}, {2, 18}}));
}

TEST(HexMesh, AtImageSpacingEqualsThatOfVoxels) {
    std::mt19937 random(3);
    for (const double spacing : {1.0, 0.1, 0.7421875, 1.0 / 3.0}) {
        auto labels = filled({9, 8, 7}, 0);
        for (auto& label : labels.labels) label = static_cast<int>(random() % 4);
        labels.spacing = Vec3::Constant(spacing);
        labels.origin = {-3, 4, 5};
        // As of a file with numbers of single precision.
        labels.directions = turn(0.3, {1, 0, 2}).cast<float>().cast<double>();
        for (int a = 0; a < 3; ++a) labels.directions.col(a).normalize();
        const auto voxels = hex_mesh(labels), cubes = hex_mesh(labels, spacing);
        EXPECT_EQ(cubes.regions, voxels.regions);
        EXPECT_EQ(cubes.corners, voxels.corners);
        ASSERT_EQ(cubes.points.size(), voxels.points.size());
        for (std::size_t p = 0; p < voxels.points.size(); ++p)
            EXPECT_LT((cubes.points[p] - voxels.points[p]).norm(), 1e-5 * spacing);

        // Centres between voxels: rounding of the directions decides nothing.
        auto upright = labels;
        upright.directions.setIdentity();
        EXPECT_EQ(hex_mesh(labels, 2 * spacing).regions, hex_mesh(upright, 2 * spacing).regions);
    }
}

TEST(HexMesh, PutsCubesOnVoxelsWhereverTheyAre) {
    // A label far from the image's corner, sampled finer and coarser: the cubes fill its voxels.
    auto labels = filled({40, 30, 20}, 0);
    for (std::int64_t k = 10; k < 16; ++k)
        for (std::int64_t j = 4; j < 12; ++j)
            for (std::int64_t i = 30; i < 38; ++i)
                labels.labels[static_cast<std::size_t>(i + 40 * (j + 30 * k))] = 9;
    labels.origin = {0.5, 0.5, 0.5};
    for (const double size : {0.5, 1.0, 2.0}) {
        const auto mesh = hex_mesh(labels, size);
        double sum = 0.0;
        for (std::size_t c = 0; c < mesh.num_cells(); ++c) sum += volume(mesh, c);
        EXPECT_DOUBLE_EQ(sum, 8.0 * 8.0 * 6.0);
        EXPECT_EQ(mesh.points.front(), Vec3(30, 4, 10));
        EXPECT_EQ(mesh.points.back(), Vec3(38, 12, 16));
    }
}

TEST(HexMesh, MakesCubesAlsoOfSkewAxes) {
    // As of a tilted gantry: the third axis leans over the second.
    auto labels = filled({20, 20, 20});
    labels.directions.col(2) = Vec3(0, std::sin(0.3), std::cos(0.3));
    const auto mesh = hex_mesh(labels, 0.5);
    double sum = 0.0;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        ASSERT_NEAR(volume(mesh, c), 0.125, 1e-12);
        sum += volume(mesh, c);
    }
    EXPECT_NEAR(sum, 8000.0 * std::cos(0.3), 0.03 * 8000.0);
    // The voxels themselves are skew boxes.
    EXPECT_NEAR(volume(hex_mesh(labels), 0), std::cos(0.3), 1e-12);
    EXPECT_THAT(topology::validate(topology::Mesh::build(hex_mesh(labels)).mesh),
                testing::IsEmpty());
}

TEST(HexMesh, LabelsCubesByTheirCentresInAnyPose) {
    std::mt19937 random(5);
    for (const double lean : {0.0, 0.4})
        for (int mirrored = -1; mirrored < 3; ++mirrored) {
            auto labels = filled({9, 8, 7}, 0);
            double labelled = 0.0;
            for (auto& label : labels.labels) {
                label = static_cast<int>(random() % 3);
                labelled += label != 0;
            }
            labels.spacing = {1, 1.5, 0.7};
            labels.origin = {-100, 50, 3};
            labels.directions = turn(0.6, {1, 2, -1});
            if (mirrored >= 0) labels.directions.col(mirrored) *= -1.0;
            for (const int a : {1, 2}) {
                labels.directions.col(a) += lean * labels.directions.col(a - 1);
                labels.directions.col(a).normalize();
            }
            const Eigen::Matrix3d steps = labels.directions * labels.spacing.asDiagonal();
            constexpr double size = 0.31;
            const auto mesh = hex_mesh(labels, size);
            for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
                const Vec3 at = steps.inverse() * (centre(mesh, c) - labels.origin);
                const Eigen::Vector3i voxel = at.array().round().cast<int>();
                ASSERT_EQ(mesh.regions[c], labels.label(voxel.x(), voxel.y(), voxel.z()));
                ASSERT_NEAR(volume(mesh, c), size * size * size, 1e-10);
            }
            const double expected = labelled * std::abs(steps.determinant()) / (size * size * size);
            EXPECT_NEAR(static_cast<double>(mesh.num_cells()), expected, 0.03 * expected);
        }
}

TEST(HexMesh, RefusesWhatCannotBe) {
    auto labels = filled({10, 10, 10});
    for (const double size : {0.0, -1.0, std::nan(""), HUGE_VAL})
        EXPECT_THAT(meshing_refusal(labels, size), HasSubstr("it must be above 0")) << size;
    EXPECT_THAT(
        meshing_refusal(labels, 0.02),
        HasSubstr("a mesh of 125000000 cells is too large, 1e8 are the most; give a larger"));
    EXPECT_THAT(meshing_refusal(labels, 1e-3), HasSubstr("more than 2147483647 in the box"));
    EXPECT_THAT(meshing_refusal(labels, 1e-300), HasSubstr("give a larger size"));
    EXPECT_THAT(meshing_refusal(labels, 1e-320), HasSubstr("give a larger size"));
    EXPECT_THAT(meshing_refusal(labels, 100.0), HasSubstr("no cube of edge 100 has its centre"));
    EXPECT_THAT(meshing_refusal(labels, 1e300), testing::Not(testing::IsEmpty()));
    labels.origin = {1e17, 0, 0};
    EXPECT_THAT(meshing_refusal(labels, std::nullopt),
                HasSubstr("beyond the precision of numbers"));
    labels.origin = Vec3::Zero();
    labels.spacing = Vec3::Constant(1e-200);
    EXPECT_THAT(meshing_refusal(labels, std::nullopt),
                HasSubstr("beyond the precision of numbers"));
    EXPECT_EQ(meshing_refusal(filled({2, 2, 2}, 0), std::nullopt),
              "no voxel with a label: all are 0");
}

}  // namespace
}  // namespace incise::io
