// Files without a mesh that name other files with meshes: the collections and series of ParaView,
// and the parallel files of VTK. They are refused, with a message that names these files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/io/files/input_file.h"

namespace incise::io {

/// Returns the files that a series (.vtu.series, JSON) names. Returns an empty list if the file is
/// no series.
std::vector<std::string> files_of_series(const InputFile& file);

/// Throws InputError for a file with the suffix of a series: that it cannot be read, that it names
/// no files, or as refuse_index() does.
[[noreturn]] void refuse_series(const InputFile& file);

/// Throws InputError for an index that names no files.
[[noreturn]] void refuse_empty_index(const InputFile& index);

/// Throws InputError for an index that names other files. The message gives the paths of the first
/// and the last of these files.
/// @param index      the index
/// @param names      at least one, relative to the folder of the index
/// @param are_parts  true if the files are parts of one mesh
[[noreturn]] void refuse_index(const InputFile& index, const std::vector<std::string>& names,
                               bool are_parts = false);

}  // namespace incise::io
