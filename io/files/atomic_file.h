// Atomic output files: written under a temporary name, then renamed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace incise::io {

/// When a file that is written is on the disk: at once, or after sync_files(). Until then a loss of
/// power may damage it. A kill does not.
enum class OnDisk { now, later };

/// Replaces the contents of the file atomically. A reader finds the old contents or the new ones,
/// also after a kill, and if it is on the disk also after a loss of power.
///
/// The bytes go to a hidden file in the same folder, which is synchronised with the disk and then
/// renamed. A symbolic link is followed and stays a link. A device or a pipe is written directly.
///
/// Throws OutputError that names the file, the reason of the system and a remedy. The hidden file
/// is then removed, and the file has its old contents. If only the last wait for the disk failed,
/// the file has the new contents.
///
/// Cost: two or three waits for the disk; none with OnDisk::later.
/// @thread  SIGINT, SIGTERM and SIGHUP to this thread are blocked while the hidden file exists
void write_file(const std::filesystem::path& path, std::string_view bytes,
                OnDisk on_disk = OnDisk::now);

/// Waits until files that write_file() has written are on the disk, with their names. Files that
/// are gone are left out. Throws OutputError as write_file() does.
void sync_files(std::span<const std::filesystem::path> paths);

/// Checks in advance whether write_file() can write the file, for a file that is written after long
/// work. Throws OutputError if the folder does not exist or is not writable, or if the path is a
/// folder. Does not detect a full disk. Leaves no file.
void require_writable(const std::filesystem::path& path);

/// Makes the folder and its missing parents, and checks that files can be written in it. Throws
/// OutputError as write_file() does.
void make_output_folder(const std::filesystem::path& folder);

/// Checks in advance whether make_output_folder() can make the folder. Looks only at the
/// permissions of the folder, or of its nearest existing parent. Throws OutputError as
/// make_output_folder() does. Changes nothing.
void require_output_folder(const std::filesystem::path& folder);

/// Removes the hidden files that processes left in the folder when they were killed during
/// write_file(). Throws OutputError as write_file() does.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Removes a file if it exists. Throws OutputError as write_file() does.
void remove_output_file(const std::filesystem::path& path);

/// Throws OutputError that names the path, the reason and a remedy. The reason is that of the error
/// number (errno). Throws std::bad_alloc instead if the error is ENOMEM.
[[noreturn]] void throw_output_error(const std::filesystem::path& path, int error_number);

}  // namespace incise::io
