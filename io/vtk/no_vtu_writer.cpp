// Replacement of vtu_writer.cpp in a build without VTK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/error.h"
#include "incise/io/vtk/vtu_writer.h"

namespace incise::io {

std::string vtu_text(const Frame&, Compression, PackedBlocks*) {
    throw OutputError(
        "this build of incise writes no .vtu files, as it was built without VTK: build it with "
        "INCISE_VTK=ON, or write another format");
}

void write_vtu(const std::filesystem::path&, const Frame& frame, Compression compression) {
    vtu_text(frame, compression);
}

}  // namespace incise::io
