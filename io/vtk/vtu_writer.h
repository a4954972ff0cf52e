// VTK's XML unstructured grids (.vtu), as ParaView, meshio and VTK read them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/io/vtk/frame.h"
#include "incise/io/vtk/packed_blocks.h"

namespace incise::io {

/// The text of a .vtu file. Arrays stand in the text as base64 (many ParaView builds fail on
/// appended data), compressed at the fastest level (higher ones take 25 times longer and save
/// nothing). meshio does not read lz4. Field data TimeValue holds the time.
/// The same frame gives the same bytes.
/// @param known keeps the compressed blocks for the next file, which is faster then; with the same
/// compression
/// Throws std::invalid_argument if a field does not fit the mesh.
/// Cost: 100 000 tetrahedra with a few fields take about 0.1 s.
std::string vtu_text(const Frame& frame, Compression compression = Compression::zlib,
                     PackedBlocks* known = nullptr);

/// Writes that text as write_file() does. Throws OutputError too.
void write_vtu(const std::filesystem::path& path, const Frame& frame,
               Compression compression = Compression::zlib);

}  // namespace incise::io
