// The text of an Abaqus or CalculiX deck, with the files that it includes in their places.
// Source: Abaqus 6.14 Keywords Reference Guide, "*INCLUDE"; CalculiX CrunchiX 2.20 user's
// manual, 7. SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/input_file.h"

namespace incise::io {

/// A deck in which the text of a file stands in place of each line *INCLUDE, INPUT=file, and behind
/// each line *NODE, INPUT=file or *ELEMENT, INPUT=file, as its rows. Names are relative to the
/// folder of the deck, also in files that are included themselves.
class AbaqusText {
  public:
    /// Reads the files. Throws InputError that names the file and the line for an INPUT without a
    /// name, a file that cannot be read, and files that include each other in a circle.
    /// @lifetime  the deck must outlive this object
    explicit AbaqusText(const InputFile& deck);
    AbaqusText(const AbaqusText&) = delete;
    AbaqusText& operator=(const AbaqusText&) = delete;

    /// Returns the deck itself if it includes nothing, else the whole text under its name.
    const InputFile& whole() const { return segments_.empty() ? deck_ : whole_; }
    /// Returns the name of the file and the line from which byte `byte` of the text comes.
    std::string location(std::size_t byte) const;

  private:
    /// A part of the text that comes from one file without a break.
    struct Segment {
        std::size_t begin;  ///< its first byte in the text
        std::string file;
        std::size_t line;  ///< of that byte in the file
    };

    void append(const InputFile& file, std::vector<std::filesystem::path>& open_files);
    /// Appends a file; `place` is the location and the keyword that names it, for messages.
    void include(std::string_view name, const std::string& place,
                 std::vector<std::filesystem::path>& open_files);

    const InputFile& deck_;
    InputFile whole_;
    std::vector<Segment> segments_;  ///< in ascending order; empty if the deck includes nothing
    std::size_t num_included_ = 0;
};

}  // namespace incise::io
