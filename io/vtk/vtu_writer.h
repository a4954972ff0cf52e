// VTK's XML unstructured grids (.vtu), as ParaView, meshio and VTK read them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/io/vtk/frame.h"
#include "incise/io/vtk/packed_blocks.h"

namespace incise::io {

/// Returns the text of a .vtu file. The same frame gives the same bytes.
///
/// Arrays are inline as base64, since many ParaView builds fail on appended data. They are
/// compressed at the fastest level: higher levels take 25 times longer and save nothing. meshio
/// does not read lz4. The field data TimeValue is the time.
///
/// If `known` is not null, it keeps the compressed blocks, which makes the next file faster. All
/// files of one `known` must have the same compression.
///
/// Throws std::invalid_argument if a field does not fit the mesh, std::runtime_error if VTK fails,
/// and OutputError in a build without VTK.
/// Cost: 100 000 tetrahedra with a few fields take about 0.1 s.
std::string vtu_text(const Frame& frame, Compression compression = Compression::zlib,
                     PackedBlocks* known = nullptr);

/// Writes the text of vtu_text() as write_file() does. Throws as both functions do.
void write_vtu(const std::filesystem::path& path, const Frame& frame,
               Compression compression = Compression::zlib);

}  // namespace incise::io
