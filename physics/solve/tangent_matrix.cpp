// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/tangent_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "incise/physics/solve/elimination_tree.h"

namespace incise::physics {

using fragments::FragmentMesh;

namespace {

/// Returns the graph whose edges join the nodes of an element. `vertices` are nodes; edges to
/// others are left out.
Graph coupling(const FragmentMesh& fragments, std::span<const std::uint32_t> vertices) {
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> vertex_of(fragments.node_capacity(), none);
    for (std::size_t v = 0; v < vertices.size(); ++v)
        vertex_of[vertices[v]] = static_cast<std::uint32_t>(v);
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<Edge> edges;  // both ways
    for (const ElementId e : fragments.elements())
        for (const NodeId a : fragments.corners(e))
            for (const NodeId b : fragments.corners(e)) {
                const Edge edge{vertex_of[a.index()], vertex_of[b.index()]};
                if (a != b && edge.first != none && edge.second != none) edges.push_back(edge);
            }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

    Graph graph;
    graph.starts.assign(vertices.size() + 1, 0);
    for (const auto& [from, to] : edges) {
        ++graph.starts[from + 1];
        graph.neighbours.push_back(to);
    }
    std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
    return graph;
}

}  // namespace

void TangentMatrix::set_pattern(const FragmentMesh& fragments,
                                std::span<const std::array<bool, 3>> is_free) {
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3> points;
    for (const NodeId n : fragments.nodes())
        if (is_free[n.index()] != std::array<bool, 3>{}) {
            vertices.push_back(static_cast<std::uint32_t>(n.index()));
            points.push_back(fragments.rest_position(n));
        }
    const Graph graph = coupling(fragments, vertices);
    const EliminationTree tree = dissect(graph, points);

    rows_.assign(fragments.node_capacity(), {-1, -1, -1});
    std::vector<std::size_t> place_of(vertices.size());
    std::vector<std::int32_t> first_rows;  // by place in the order
    std::int32_t num_rows = 0;
    for (std::size_t place = 0; place < tree.order.size(); ++place) {
        const std::uint32_t vertex = tree.order[place];
        place_of[vertex] = place;
        first_rows.push_back(num_rows);
        for (std::size_t c = 0; c < 3; ++c)
            if (is_free[vertices[vertex]][c]) rows_[vertices[vertex]][c] = num_rows++;
    }
    first_rows.push_back(num_rows);

    std::vector<std::int32_t> starts{0}, entries;
    std::vector<std::size_t> later;  // places of the neighbours that are eliminated later
    for (std::size_t place = 0; place < tree.order.size(); ++place) {
        later.clear();
        for (const std::uint32_t n : graph.neighbours_of(tree.order[place]))
            if (place_of[n] > place) later.push_back(place_of[n]);
        std::sort(later.begin(), later.end());
        for (std::int32_t column = first_rows[place]; column < first_rows[place + 1]; ++column) {
            for (std::int32_t row = column; row < first_rows[place + 1]; ++row)
                entries.push_back(row);
            for (const std::size_t n : later)
                for (std::int32_t row = first_rows[n]; row < first_rows[n + 1]; ++row)
                    entries.push_back(row);
            starts.push_back(static_cast<std::int32_t>(entries.size()));
        }
    }
    const std::vector<double> zeros(entries.size(), 0.0);
    lower_ = Eigen::Map<const SparseFactor::Matrix>(num_rows, num_rows,
                                                    static_cast<Eigen::Index>(entries.size()),
                                                    starts.data(), entries.data(), zeros.data());
    load_.setZero(num_rows);

    std::vector<SparseFactor::Group> groups;
    for (const auto& [begin, end, parent] : tree.groups)
        groups.push_back({first_rows[begin], first_rows[end], parent});
    factor_.analyse(lower_, std::move(groups));
}

void TangentMatrix::clear(std::span<const Vec3> increments) {
    std::fill_n(lower_.valuePtr(), lower_.nonZeros(), 0.0);
    increments_ = increments;
    load_.setZero();
}

void TangentMatrix::add(std::span<const std::uint32_t> nodes, std::span<const double> tangent) {
    const std::size_t size = 3 * nodes.size();
    const int* const starts = lower_.outerIndexPtr();
    const int* const inner = lower_.innerIndexPtr();
    for (std::size_t j = 0; j < nodes.size(); ++j)
        for (std::size_t c = 0; c < 3; ++c) {
            const double* const values = tangent.data() + (3 * j + c) * size;
            const std::int32_t column = rows_[nodes[j]][c];
            if (column < 0) {
                if (increments_.empty()) continue;
                const double u = increments_[nodes[j]][static_cast<Eigen::Index>(c)];
                if (u == 0.0) continue;
                for (std::size_t i = 0; i < nodes.size(); ++i)
                    for (std::size_t d = 0; d < 3; ++d)
                        if (const std::int32_t row = rows_[nodes[i]][d]; row >= 0)
                            load_[row] -= values[3 * i + d] * u;
                continue;
            }
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                // The rows of a node are adjacent, so one search finds them all.
                const int* it = nullptr;
                for (std::size_t d = 0; d < 3; ++d) {
                    const std::int32_t row = rows_[nodes[i]][d];
                    if (row < column) continue;
                    if (!it)
                        it = std::lower_bound(inner + starts[column], inner + starts[column + 1],
                                              row);
                    lower_.valuePtr()[it - inner] += values[3 * i + d];
                    ++it;
                }
            }
        }
}

void TangentMatrix::add_diagonal(std::size_t node, double value) {
    for (const std::int32_t row : rows_[node])
        if (row >= 0) lower_.valuePtr()[lower_.outerIndexPtr()[row]] += value;
}

void TangentMatrix::shift(double value) {
    for (int row = 0; row < lower_.cols(); ++row)
        lower_.valuePtr()[lower_.outerIndexPtr()[row]] += value;
}

}  // namespace incise::physics
