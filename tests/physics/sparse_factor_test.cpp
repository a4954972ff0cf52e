// The Cholesky factor against solutions, other factors and eigenvalues; its order of elimination.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/sparse_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <set>

#include "incise/physics/solve/elimination_tree.h"
#include "physics/processors_at_hand.h"
#include "support/mesh_families.h"

namespace incise::physics {
namespace {

struct Points {
    Graph graph;
    std::vector<Vec3> places;
};

/// Points in a box, of which neighbours are those nearer than `reach`.
Points random_points(std::size_t count, double reach, std::uint64_t seed) {
    test::Random random(seed);
    Points points;
    for (std::size_t i = 0; i < count; ++i)
        points.places.emplace_back(random.uniform(0, 1), random.uniform(0, 1),
                                   random.uniform(0, 1));
    points.graph.starts.push_back(0);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j)
            if (i != j && (points.places[i] - points.places[j]).norm() < reach)
                points.graph.neighbours.push_back(static_cast<std::uint32_t>(j));
        points.graph.starts.push_back(points.graph.neighbours.size());
    }
    return points;
}

/// Points of a grid, of which neighbours share a brick.
Points grid(int nx, int ny, int nz) {
    Points points;
    points.graph.starts.push_back(0);
    const auto number = [&](int i, int j, int k) { return (k * ny + j) * nx + i; };
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                points.places.emplace_back(i, j, k);
                for (int c = std::max(k - 1, 0); c <= std::min(k + 1, nz - 1); ++c)
                    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, ny - 1); ++b)
                        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, nx - 1); ++a)
                            if (number(a, b, c) != number(i, j, k))
                                points.graph.neighbours.push_back(
                                    static_cast<std::uint32_t>(number(a, b, c)));
                points.graph.starts.push_back(points.graph.neighbours.size());
            }
    return points;
}

/// A matrix with `per_vertex` rows for each vertex, in the order of elimination.
struct System {
    SparseFactor::Matrix lower;
    std::vector<SparseFactor::Group> groups;

    Eigen::MatrixXd dense() const {
        return lower.selfadjointView<Eigen::Lower>() *
               Eigen::MatrixXd::Identity(lower.rows(), lower.rows());
    }
};

/// Random entries, and `diagonal` on the diagonal.
System random_system(const Points& points, int per_vertex, double diagonal, std::uint64_t seed) {
    test::Random random(seed);
    const EliminationTree tree = dissect(points.graph, points.places);
    std::vector<int> place(points.places.size());
    for (std::size_t i = 0; i < place.size(); ++i) place[tree.order[i]] = static_cast<int>(i);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::uint32_t v = 0; v < place.size(); ++v)
        for (int c = 0; c < per_vertex; ++c) {
            const int column = place[v] * per_vertex + c;
            for (int d = c; d < per_vertex; ++d)
                entries.emplace_back(place[v] * per_vertex + d, column,
                                     c == d ? diagonal : random.uniform(-1, 1));
            for (const std::uint32_t n : points.graph.neighbours_of(v))
                if (place[n] > place[v])
                    for (int d = 0; d < per_vertex; ++d)
                        entries.emplace_back(place[n] * per_vertex + d, column,
                                             random.uniform(-1, 1));
        }
    System system;
    const auto size = static_cast<Eigen::Index>(place.size()) * per_vertex;
    system.lower.resize(size, size);
    system.lower.setFromTriplets(entries.begin(), entries.end());
    for (const auto& [begin, end, parent] : tree.groups)
        system.groups.push_back({static_cast<std::int32_t>(begin) * per_vertex,
                                 static_cast<std::int32_t>(end) * per_vertex, parent});
    return system;
}

Eigen::VectorXd random_side(Eigen::Index size, std::uint64_t seed) {
    test::Random random(seed);
    Eigen::VectorXd side(size);
    for (double& value : side) value = random.uniform(-1, 1);
    return side;
}

TEST(SparseFactor, SolvesSystemsOfAnyShape) {
    const Workers workers(1);
    std::vector<Points> shapes{random_points(1, 1.0, 1),
                               random_points(7, 0.0, 2),
                               random_points(40, 2.0, 3),
                               random_points(300, 0.15, 4),
                               random_points(300, 0.05, 5),
                               grid(40, 1, 1),
                               grid(30, 30, 1),
                               grid(9, 8, 7)};
    // Chains beside each other, of which the last is divided first: some groups join nothing.
    Points chains;
    chains.graph.starts.push_back(0);
    for (const auto& [length, y] : {std::pair{39, 0}, std::pair{40, 1}, std::pair{241, 2}})
        for (int i = 0; i < length; ++i) {
            const auto v = static_cast<std::uint32_t>(chains.places.size());
            chains.places.emplace_back(i, y, 0.0);
            if (i > 0) chains.graph.neighbours.push_back(v - 1);
            if (i + 1 < length) chains.graph.neighbours.push_back(v + 1);
            chains.graph.starts.push_back(chains.graph.neighbours.size());
        }
    shapes.push_back(chains);
    for (int n = 10; n < 40; ++n) {  // blocks side by side, with random sizes
        Points blocks = grid(3, 3, n);
        const Points other = grid(3, 3, 2 * n - 11);
        const auto shift = static_cast<std::uint32_t>(blocks.places.size());
        for (const Vec3& place : other.places) blocks.places.emplace_back(place + Vec3(5, 0, 0));
        for (const std::uint32_t v : other.graph.neighbours)
            blocks.graph.neighbours.push_back(v + shift);
        const std::size_t start = blocks.graph.starts.back();
        for (std::size_t i = 1; i < other.graph.starts.size(); ++i)
            blocks.graph.starts.push_back(start + other.graph.starts[i]);
        shapes.push_back(blocks);
    }
    std::uint64_t seed = 0;
    for (const Points& points : shapes)
        for (const int per_vertex : {1, 3}) {
            const System system = random_system(points, per_vertex, 30.0 * per_vertex, ++seed);
            SparseFactor factor;
            factor.analyse(system.lower, system.groups);
            for (int again = 0; again < 2; ++again)
                ASSERT_TRUE(factor.factorise(system.lower, workers)) << seed;
            const Eigen::VectorXd side = random_side(system.lower.rows(), seed);
            Eigen::VectorXd x = side;
            factor.solve(x);
            const Eigen::VectorXd rest = system.lower.selfadjointView<Eigen::Lower>() * x - side;
            EXPECT_LT(rest.norm(), 1e-13 * side.norm()) << seed;
        }
}

TEST(SparseFactor, IsEmptyForNoRows) {
    SparseFactor factor;
    const System system = random_system(random_points(0, 0.0, 1), 3, 1.0, 1);
    factor.analyse(system.lower, system.groups);
    EXPECT_TRUE(factor.factorise(system.lower, Workers(1)));
    Eigen::VectorXd side(0);
    factor.solve(side);
    EXPECT_EQ(factor.num_entries(), 0u);
}

// Many values of the diagonal on both sides of the one for which the least eigenvalue is zero.
TEST(SparseFactor, RefusesWhatIsNotPositiveDefinite) {
    const Workers workers(1);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        System system = random_system(random_points(60, 0.3, seed), 2, 0.0, seed);
        const double least =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(system.dense()).eigenvalues()[0];
        SparseFactor factor;
        factor.analyse(system.lower, system.groups);
        for (const double beyond : {-1.0, -1e-3, -1e-8, 1e-8, 1e-3, 1.0}) {
            SparseFactor::Matrix shifted = system.lower;
            shifted.diagonal().array() += -least + beyond;
            EXPECT_EQ(factor.factorise(shifted, workers), beyond > 0.0) << seed << ' ' << beyond;
        }
        SparseFactor::Matrix singular = system.lower;
        singular.diagonal().array() = 0.0;
        EXPECT_FALSE(factor.factorise(singular, workers));
        singular.valuePtr()[0] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(factor.factorise(singular, workers));
    }
}

TEST(SparseFactor, HasTheSameBitsOnEveryProcessorWithAnyThreads) {
    const System system = random_system(grid(13, 12, 11), 3, 90.0, 1);
    SparseFactor factor;
    factor.analyse(system.lower, system.groups);
    const Eigen::VectorXd side = random_side(system.lower.rows(), 2);
    Eigen::VectorXd first;
    for (const Processor processor : processors_at_hand())
        for (const int num_threads : {1, 2, 5}) {
            ASSERT_TRUE(factor.factorise(system.lower, Workers(num_threads), processor));
            Eigen::VectorXd x = side;
            factor.solve(x);
            if (first.size() == 0) first = x;
            EXPECT_EQ(x, first) << static_cast<int>(processor) << ' ' << num_threads;
        }
}

/// One column after the other; each product is subtracted on its own.
void eliminate_plainly(Eigen::MatrixXd& A, Eigen::Index num_columns) {
    for (Eigen::Index k = 0; k < num_columns; ++k) {
        const double root = std::sqrt(A(k, k)), scale = 1.0 / root;
        for (Eigen::Index i = k; i < A.rows(); ++i) A(i, k) *= scale;
        A(k, k) = root;
        for (Eigen::Index j = k + 1; j < A.rows(); ++j)
            for (Eigen::Index i = j; i < A.rows(); ++i)
                A(i, j) = std::fma(-A(i, k), A(j, k), A(i, j));
    }
}

TEST(DenseFront, IsEliminatedByTheSameOperationsWhateverTheTiles) {
    for (const auto& [size, num_own] : std::vector<std::pair<int, int>>{
             {1, 1}, {5, 3}, {24, 24}, {31, 9}, {97, 50}, {200, 97}, {230, 230}, {300, 1}}) {
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(size, size);
        test::Random random(static_cast<std::uint64_t>(size));
        for (int j = 0; j < size; ++j)
            for (int i = j; i < size; ++i)
                expected(i, j) = i == j ? 2.0 * size : random.uniform(-1, 1);
        const Eigen::MatrixXd start = expected;
        eliminate_plainly(expected, num_own);
        for (const Processor processor : processors_at_hand()) {
            const FrontKernels& kernels = front_kernels_for(processor);
            const auto n = static_cast<std::size_t>(size), own = static_cast<std::size_t>(num_own);
            NumberBuffer values(DenseFront::num_values(n)),
                scratch(PackedColumns::num_values(n, columns_together));
            std::fill_n(values.data(), values.capacity(), 0.0);
            const DenseFront front{values.data(), n};
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = j; i < n; ++i)
                    front.column(j)[i] = start(static_cast<int>(i), static_cast<int>(j));
            PivotRange pivots;
            for (std::size_t k = 0; k < own; k += columns_together) {
                const std::size_t last = std::min(k + columns_together, own);
                ASSERT_TRUE(kernels.eliminate(front, k, last, scratch.data(), pivots));
                const PackedColumns packed{scratch.data(), last, last - k};
                kernels.pack(front, k, packed);
                for (std::size_t strip = 0; last + strip * kernels.rows_of_strip < n; ++strip)
                    kernels.subtract(front, packed, strip);
            }
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = j; i < n; ++i)
                    ASSERT_EQ(front.column(j)[i],
                              expected(static_cast<int>(i), static_cast<int>(j)))
                        << size << ' ' << num_own << ": " << i << ' ' << j;
        }
    }
}

TEST(EliminationTree, JoinsNoGroupsButAncestors) {
    std::vector<Points> shapes{random_points(400, 0.12, 1), random_points(500, 0.06, 2),
                               random_points(100, 2.0, 3), grid(9, 9, 9)};
    Points same_place = random_points(200, 2.0, 4);  // as on both sides of a cut
    for (Vec3& place : same_place.places) place.setZero();
    shapes.push_back(same_place);
    for (const Points& points : shapes) {
        const EliminationTree tree = dissect(points.graph, points.places);
        const std::set<std::uint32_t> all(tree.order.begin(), tree.order.end());
        ASSERT_EQ(all.size(), points.places.size());
        ASSERT_EQ(tree.order.size(), points.places.size());
        std::vector<std::size_t> group_of(points.places.size());
        std::size_t end = 0;
        for (std::size_t g = 0; g < tree.groups.size(); ++g) {
            ASSERT_EQ(tree.groups[g].begin, end);
            end = tree.groups[g].end;
            for (std::size_t i = tree.groups[g].begin; i < end; ++i) group_of[tree.order[i]] = g;
            ASSERT_TRUE(g + 1 == tree.groups.size() || tree.groups[g].parent > g);
        }
        ASSERT_EQ(end, points.places.size());
        for (std::uint32_t v = 0; v < points.places.size(); ++v)
            for (const std::uint32_t n : points.graph.neighbours_of(v)) {
                std::size_t low = std::min(group_of[v], group_of[n]);
                const std::size_t high = std::max(group_of[v], group_of[n]);
                while (low < high) low = tree.groups[low].parent;
                ASSERT_EQ(low, high) << v << ' ' << n;
            }
    }
}

// Entries that are stored although they are zero are counted, too.
TEST(EliminationTree, StoresAtMostAThirdMoreThanMinimumDegreeNeeds) {
    for (const Points& points : {grid(16, 16, 16), grid(60, 20, 4)}) {
        const System system = random_system(points, 1, 60.0, 1);
        SparseFactor factor;
        factor.analyse(system.lower, system.groups);
        Eigen::SimplicialLLT<SparseFactor::Matrix, Eigen::Lower> other(system.lower);
        const auto other_entries =
            static_cast<double>(other.matrixL().nestedExpression().nonZeros());
        EXPECT_LT(static_cast<double>(factor.num_entries()), 1.3 * other_entries);
    }
}

}  // namespace
}  // namespace incise::physics
