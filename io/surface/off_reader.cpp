// Surfaces in the Object File Format (.off).
// Source: Geomview manual, "OFF Files".
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/off_reader.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/line_words.h"
#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_collector.h"

namespace incise::io {

namespace {

// The shortest possible lines: "0 0 0" and "3 0 0 0", each with its end.
constexpr std::size_t bytes_of_point = 6;
constexpr std::size_t bytes_of_face = 8;

class OffReader {
  public:
    explicit OffReader(const InputFile& file) : scanner_(file), collector_(file, scanner_) {}

    SurfaceFile read() {
        read_keyword();
        // The third number, that of edges, is missing in some files and not needed.
        if (words_.size() < 2)
            scanner_.fail("expected the numbers of points, faces and edges, found " +
                          in_quotes(words_.front()) + " alone");
        const auto num_points = count(0, "the number of points", bytes_of_point);
        const auto num_faces = count(1, "the number of faces", bytes_of_face);
        for (std::uint64_t i = 0; i < num_points; ++i) {
            read_line("a point");
            collector_.add_point(words_);
        }
        for (std::uint64_t i = 0; i < num_faces; ++i) {
            read_line("a face");
            read_face();
        }
        if (!scanner_.at_end())
            scanner_.fail_expected(
                "the end of the file behind " + std::to_string(num_faces) + " faces",
                scanner_.token("the end"));
        return collector_.finish();
    }

  private:
    /// Reads up to the counts, which are then in words_. The counts may be on the line of the
    /// keyword, also without a blank between.
    void read_keyword() {
        constexpr std::string_view name = "off";
        read_line("OFF");
        const auto word = words_.front();
        const auto begin = lower_case(word).find(name);
        if (begin == word.npos) scanner_.fail_expected("OFF", word);
        auto prefix = word.substr(0, begin);
        for (const std::string_view extra : {"ST", "C", "N"})
            if (prefix.starts_with(extra)) prefix.remove_prefix(extra.size());
        if (!prefix.empty())
            scanner_.fail(in_quotes(word) +
                          " cannot be read; save as OFF with points of three coordinates");
        words_.front().remove_prefix(begin + name.size());
        if (words_.front().empty()) words_.erase(words_.begin());
        if (words_.empty()) read_line("the number of points");
        if (lower_case(words_.front()) == "binary")
            scanner_.fail("is binary OFF, which cannot be read; save it as text");
    }

    /// Reads the words of the next line that is neither empty nor a comment.
    void read_line(std::string_view what) {
        words_.clear();
        if (scanner_.at_end()) scanner_.token(what);  // throws
        append_words(without_comment(scanner_.rest_of_line()), words_);
    }

    std::uint64_t count(std::size_t word, std::string_view what, std::size_t bytes_each) const {
        const auto result = parse_number<std::uint64_t>(words_[word]);
        if (!result) scanner_.fail_expected(what, words_[word]);
        scanner_.require_room(*result, bytes_each, what);
        return *result;
    }

    /// Reads a face: the number of corners, the corners, and a colour, which is skipped.
    void read_face() {
        const auto num_corners = parse_number<std::uint64_t>(words_.front());
        if (!num_corners) scanner_.fail_expected("the number of corners of a face", words_.front());
        if (*num_corners > words_.size() - 1)
            scanner_.fail("a face has " + std::to_string(*num_corners) +
                          " corners, but its line has " + std::to_string(words_.size() - 1) +
                          " numbers for them");
        corners_.clear();
        for (const auto word :
             std::span(words_).subspan(1, static_cast<std::size_t>(*num_corners))) {
            const auto corner = parse_number<std::int64_t>(word);
            if (!corner) scanner_.fail_expected("a point index", word);
            collector_.check_corner(*corner, collector_.num_points());
            corners_.push_back(*corner);
        }
        collector_.add_polygon(corners_);
    }

    Scanner scanner_;
    SurfaceCollector collector_;
    std::vector<std::string_view> words_;  ///< of the current line
    std::vector<std::int64_t> corners_;    ///< of the current face
};

}  // namespace

SurfaceFile read_off(const InputFile& file) { return OffReader(file).read(); }

}  // namespace incise::io
