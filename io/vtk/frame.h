// A mesh with fields at one moment, as written for viewers and other programs.
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

/// Numbers at points or cells, in the order of the mesh. Each point or cell has `components`
/// consecutive values. Values of type float halve the size of the file, with seven digits.
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

/// A mesh with its fields. The regions of the mesh are written as the cell array "region" and need
/// no field. Carriers are written as the cell array "carrier" and the field data "carrier_corners"
/// and "carrier_types", and the faces on cuts as the cell arrays "cut_faces", "cut_faces_31", ...
struct Frame {
    topology::MeshData mesh;          ///< its points are the current positions
    std::vector<Field> point_fields;  ///< with different names
    std::vector<Field> cell_fields;   ///< with different names, none of those above
    std::vector<Field> field_data;    ///< of any lengths, with different names
    std::optional<double> time;       ///< s
    std::string active_vectors;       ///< name of the point field for warping in viewers, or empty
};

enum class Compression { none, lz4, zlib, lzma };

}  // namespace incise::io
