// The frames of a run, and the indexes with which ParaView opens them as an animation.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/atomic_file.h"
#include "incise/io/files/written_bytes.h"
#include "incise/io/vtk/frame.h"
#include "incise/io/vtk/packed_blocks.h"

namespace incise::io {

/// A frame that a run has written.
struct FrameWritten {
    double time = 0.0;  ///< s
    BytesWritten file;
    static void archive(auto& ar, auto& self) { ar(self.time, self.file); }
};

/// Throws InputError unless the name is a valid file name and can be written in XML.
void require_series_name(std::string_view name);

/// Checks that these are the first frames of the series with this name. Throws InputError that
/// names the file, how it differs and a remedy. Cost: that of reading the frames, which is small
/// compared with that of compressing them.
void require_frames(const std::filesystem::path& folder, const std::string& name,
                    std::span<const FrameWritten> frames);

/// A writer of the files FOLDER/frames/NAME_000000.vtu and so on, and of the indexes
/// FOLDER/NAME.pvd and FOLDER/NAME.vtu.series.
///
/// Every file is written as write_file() does, a frame before the indexes. At any moment, also
/// after a kill, the indexes name only frames that exist. Files are on the disk after sync(), which
/// the series calls itself when a second has gone by. Paths in the indexes are relative, so
/// that the folder can be moved. Every function throws OutputError if a file cannot be written or
/// removed.
class Series {
  public:
    /// Makes the folders, and removes all frames with this name except `kept`. These are the first
    /// frames of a run that is resumed. The indexes then name only the kept frames. Throws
    /// InputError as require_series_name() does.
    /// @pre  require_frames() has succeeded for the kept frames
    Series(std::filesystem::path folder, std::string name,
           Compression compression = Compression::zlib, std::span<const FrameWritten> kept = {});

    /// Writes the frame and the indexes. A frame without a time has the time 0. Throws
    /// std::invalid_argument if the time is not finite, or not later than that of the last frame.
    /// Cost: that of the frame, and of an index line for each frame so far.
    void add(const Frame& frame);

    /// Waits until all files are on the disk.
    void sync();

    std::span<const FrameWritten> frames() const { return frames_; }
    std::filesystem::path pvd_path() const;

  private:
    void remove_frames_from(std::size_t first);
    void write_indexes(OnDisk on_disk);
    std::filesystem::path series_path() const;

    std::filesystem::path folder_;
    std::string name_;
    Compression compression_;
    PackedBlocks packed_;  // of the last frame
    std::vector<FrameWritten> frames_;
    std::vector<std::filesystem::path> not_on_disk_;  // frames
    std::chrono::steady_clock::time_point last_sync_ = std::chrono::steady_clock::now();
};

}  // namespace incise::io
