// A mesh with fields at one moment: what is written for viewers and other programs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// Numbers at points or cells, in the order of the mesh: `components` values each, one point or
/// cell after the other. float halves the file where its seven digits do.
struct Field {
    using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>,
                                std::vector<std::int32_t>>;

    std::string name;
    int components = 1;
    Values values;

    std::size_t size() const {
        return std::visit([](const auto& v) { return v.size(); }, values);
    }
};

/// The regions of the mesh are written as the cell array "region" and need no field.
struct Frame {
    topology::MeshData mesh;          ///< its points are the current positions
    std::vector<Field> point_fields;  ///< names differ
    std::vector<Field> cell_fields;   ///< names differ, none is "region"
    std::optional<double> time;       ///< seconds
    std::string active_vectors;       ///< name of the point field that viewers warp by, or empty
};

enum class Compression { none, lz4, zlib, lzma };

}  // namespace incise::io
