// Files that hold no mesh but name others that do: ParaView's collections and series, and VTK's
// parallel files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/io/files/input_file.h"

namespace incise::io {

/// The files that a series (.vtu.series, JSON) names; none if it is no series.
std::vector<std::string> files_of_series(const InputFile& file);

/// Throws InputError for a file whose name says that it is a series: as refuse_index, or that it
/// cannot be read, or that it names no files.
[[noreturn]] void refuse_series(const InputFile& file);

/// Throws InputError for an index that names no files.
[[noreturn]] void refuse_empty_index(const InputFile& index);

/// Throws InputError, which names the first and the last of the files as they lie beside the index.
/// @param names  at least one, relative to the folder of the index
/// @param are_parts  whether the files are parts of one mesh
[[noreturn]] void refuse_index(const InputFile& index, const std::vector<std::string>& names,
                               bool are_parts = false);

}  // namespace incise::io
