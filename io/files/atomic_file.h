// Files that are either whole or not there: written beside and renamed into place.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace incise::io {

/// Makes `bytes` the contents of the file, at once: whoever opens it, at any moment and also after
/// a kill or a loss of power, finds the old contents or the new ones. The bytes go to a hidden
/// file in the same folder, which is synchronised with the disk and renamed. A link is followed
/// and stays a link; a device or a pipe is written to as it is. SIGINT, SIGTERM and SIGHUP to this
/// thread wait until the hidden file has gone.
/// Throws OutputError that names the file, the system's reason and a remedy; no hidden file is
/// left behind then, and the contents are the old ones (or, if only the very last wait failed,
/// the new ones).
/// Cost: two or three waits for the disk.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Throws the OutputError that write_file would throw at once: there is no such folder, it may not
/// be written to, a folder is in the place of the file. For what is written after long work; a
/// disk may still be full then. Changes nothing.
void require_writable(const std::filesystem::path& path);

/// Makes the folder and its parents where they are missing, and makes sure that files can be
/// written in it. Throws OutputError as above.
void make_output_folder(const std::filesystem::path& folder);

/// Throws the OutputError that make_output_folder would throw, as far as permissions tell: those of
/// the folder, or of the nearest one above it that is there. Changes nothing.
void require_output_folder(const std::filesystem::path& folder);

/// Removes from the folder the hidden files that nobody writes any more: those of processes that
/// were killed in the middle of write_file. Throws OutputError as above.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Removes a file if it is there. Throws OutputError as above.
void remove_output_file(const std::filesystem::path& path);

/// The text of every OutputError of this folder: `path`, the reason of the system's error number,
/// and what to do about it. Throws std::bad_alloc instead where the system is out of memory.
[[noreturn]] void throw_output_error(const std::filesystem::path& path, int error_number);

}  // namespace incise::io
