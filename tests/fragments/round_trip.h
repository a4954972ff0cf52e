// What a cut body is after a file: the same fragments, by the cells that they carry.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "incise/fragments/carriers.h"
#include "incise/fragments/fragment_archive.h"
#include "incise/fragments/validate.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"
#include "support/fragment_shape.h"

namespace incise::fragments {

/// Returns the body as a file contains it.
inline topology::MeshData written(const topology::Mesh& material, const FragmentMesh& fragments) {
    topology::MeshData data = topology::to_mesh_data(material, material.rest_positions());
    data.carriers = carriers_of(material, fragments);
    data.points_may_coincide = true;
    return data;
}

/// Returns the fragments with the cells named by their rows in a file.
inline test::FragmentShape shape_in_file(const topology::Mesh& material,
                                         const FragmentMesh& fragments) {
    std::vector<std::int64_t> row(material.element_capacity(), -1);
    std::int64_t next = 0;
    for (const CellId cell : material.elements()) row[cell.index()] = next++;
    return test::shape_of(fragments, [&](CellId cell) { return row[cell.index()]; });
}

inline test::FragmentShape shape_by_label(const topology::Mesh& material,
                                          const FragmentMesh& fragments) {
    return test::shape_of(fragments, [&](CellId cell) { return material.label(cell); });
}

/// Returns by fragment, in the order of their first cells, the shares of its tetrahedra.
inline std::vector<std::vector<double>> part_shares_of(const FragmentMesh& fragments) {
    std::map<CellId, std::vector<double>> by_cell;
    for (const ElementId e : fragments.elements()) {
        const auto shares = fragments.part_shares(e);
        by_cell[*fragments.cells_of(e).begin()] = {shares.begin(), shares.end()};
    }
    std::vector<std::vector<double>> all;
    for (auto& [cell, shares] : by_cell) all.push_back(std::move(shares));
    return all;
}

/// Returns the largest difference. Sums over the fragments of a carrier are in the order of their
/// ids, which are others after a file.
inline double difference(const std::vector<std::vector<double>>& a,
                         const std::vector<std::vector<double>>& b) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (a.size() != b.size()) return infinity;
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].size() != b[i].size()) return infinity;
        for (std::size_t k = 0; k < a[i].size(); ++k)
            most = std::max(most, std::abs(a[i][k] - b[i][k]));
    }
    return most;
}

inline void expect_same_mesh(const topology::MeshData& a, const topology::MeshData& b) {
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.kinds, b.kinds);
    EXPECT_EQ(a.offsets, b.offsets);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.regions, b.regions);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.cut_faces, b.cut_faces);
    EXPECT_EQ(a.further_cut_faces, b.further_cut_faces);
    EXPECT_TRUE(a.carriers == b.carriers);
}

/// Writes and builds the body, and reports what is not as before.
inline topology::BuiltMesh expect_round_trip(const topology::Mesh& material,
                                             const FragmentMesh& fragments) {
    const topology::MeshData data = written(material, fragments);
    topology::BuiltMesh built = topology::Mesh::build(data);
    EXPECT_TRUE(built.warnings.empty());
    const FragmentMesh read(built.mesh);
    EXPECT_EQ(topology::validate(built.mesh).size(), topology::validate(material).size());
    if (!data.carriers.is_empty()) {  // else cells and points have another order
        expect_same_mesh(written(built.mesh, read), data);
        EXPECT_LT(difference(part_shares_of(read), part_shares_of(fragments)), 1e-12);
    }
    // A sphere smaller than a cell can leave a fragment without volume.
    const bool is_sound = validate(fragments, material).empty();
    EXPECT_EQ(validate(read, built.mesh).empty(), is_sound);
    EXPECT_EQ(read.num_elements(), fragments.num_elements());
    EXPECT_EQ(read.num_nodes(), fragments.num_nodes());
    EXPECT_TRUE(shape_by_label(built.mesh, read) == shape_in_file(material, fragments));

    if (!is_sound) return built;
    ArchiveWriter out;
    save(read, out);
    ArchiveReader in(out.bytes());
    EXPECT_TRUE(load_fragments(built.mesh, in) == read);
    return built;
}

}  // namespace incise::fragments
