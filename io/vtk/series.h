// The frames of a run, and the indexes by which ParaView opens them as a film.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/written_bytes.h"
#include "incise/io/vtk/frame.h"
#include "incise/io/vtk/packed_blocks.h"

namespace incise::io {

/// A frame of a run that goes on.
struct FrameWritten {
    double time = 0.0;  ///< s
    BytesWritten file;
    static void archive(auto& ar, auto& self) { ar(self.time, self.file); }
};

/// Throws InputError unless files can be called so, and an index in XML can name them.
void require_series_name(std::string_view name);

/// Throws InputError, naming the file, what has become of it and what to do, unless these are the
/// first frames of the series of that name. Cost: that of reading them, which is small beside what
/// it took to compress them.
void require_frames(const std::filesystem::path& folder, const std::string& name,
                    std::span<const FrameWritten> frames);

/// FOLDER/frames/NAME_000000.vtu and so on, and the indexes FOLDER/NAME.pvd and
/// FOLDER/NAME.vtu.series. Every file is written whole or not at all, a frame before the indexes:
/// at any moment, also after a kill, they name only frames that are there.
/// Paths in the indexes are relative, so that the folder may be moved.
/// Every function throws OutputError if a file cannot be written or removed.
class Series {
  public:
    /// Makes the folders. `kept` are the first frames of a former run that goes on here, which
    /// require_frames() has found; all other frames and indexes of that name are removed, so that
    /// no stale frame mixes in. Throws InputError if the name does not do.
    Series(std::filesystem::path folder, std::string name,
           Compression compression = Compression::zlib, std::span<const FrameWritten> kept = {});

    /// Writes the frame and the indexes. Time of a frame without one: 0.
    /// Cost: that of the frame, and of an index line for each frame so far.
    /// @pre the time is finite, and later than that of the last frame
    void add(const Frame& frame);

    std::span<const FrameWritten> frames() const { return frames_; }
    std::filesystem::path pvd_path() const;

  private:
    void remove_frames_from(std::size_t first);
    void write_indexes();

    std::filesystem::path folder_;
    std::string name_;
    Compression compression_;
    PackedBlocks packed_;  // of the last frame
    std::vector<FrameWritten> frames_;
};

}  // namespace incise::io
