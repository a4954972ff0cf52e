// Surfaces in Wavefront OBJ (.obj).
// Source: Wavefront, "Advanced Visualizer Manual", appendix B1, "Object Files".
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/obj_reader.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/line_words.h"
#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_collector.h"

namespace incise::io {

namespace {

/// Statements that do not affect the surface. Others are an error: they are damaged, or add
/// geometry that would be missing (free-form surfaces, calls of other files).
constexpr std::string_view skipped_statements[] = {
    "vn",  "vt",       "vp",       "p",      "l",      "g",          "s",
    "o",   "mg",       "usemtl",   "mtllib", "usemap", "maplib",     "bevel",
    "lod", "c_interp", "d_interp", "ctech",  "stech",  "shadow_obj", "trace_obj"};

class ObjReader {
  public:
    explicit ObjReader(const InputFile& file)
        : file_(file), scanner_(file), collector_(file, scanner_) {}

    SurfaceFile read() {
        while (scanner_.remaining() > 0) {
            statement_begin_ = file_.bytes.size() - scanner_.remaining();
            read_words();
            if (!words_.empty()) read_statement();
        }
        if (highest_index_ > num_points())
            throw InputError(
                file_.name() + ":" + std::to_string(file_.line_of(highest_index_begin_)) +
                ": point index " + std::to_string(highest_index_) + " is out of range (" +
                std::to_string(num_points()) + " points, numbered from 1)");
        return collector_.finish();
    }

  private:
    /// Reads the words of the next line, and of the lines that continue it after a backslash.
    void read_words() {
        words_.clear();
        bool goes_on = true;
        while (goes_on) {
            auto line = without_comment(scanner_.rest_of_line());
            goes_on = line.ends_with('\\');
            if (goes_on) line.remove_suffix(1);
            append_words(line, words_);
        }
    }

    void read_statement() {
        const auto keyword = words_.front();
        const auto arguments = std::span(words_).subspan(1);
        if (keyword == "v")
            collector_.add_point(arguments);
        else if (keyword == "f")
            read_face(arguments);
        else if (std::ranges::find(skipped_statements, keyword) == std::end(skipped_statements))
            scanner_.fail(in_quotes(keyword) +
                          " is not a statement known here; export polygons, or remove the line");
    }

    void read_face(std::span<const std::string_view> arguments) {
        corners_.clear();
        for (const auto argument : arguments) corners_.push_back(corner_of(argument));
        collector_.add_polygon(corners_);
    }

    /// Returns the number, from 0, of a point given as "index", "index/texture" or
    /// "index/texture/normal".
    std::int64_t corner_of(std::string_view text) {
        const auto index = parse_number<std::int64_t>(text.substr(0, text.find('/')));
        if (!index) scanner_.fail_expected("a point index", text);
        if (*index == 0 || *index < -num_points())
            scanner_.fail("point index " + std::to_string(*index) + " is out of range (" +
                          std::to_string(num_points()) +
                          " points so far, numbered from 1, or from -1 backwards)");
        if (*index < 0) return num_points() + *index;
        if (*index > highest_index_) {
            highest_index_ = *index;
            highest_index_begin_ = statement_begin_;
        }
        return *index - 1;
    }

    std::int64_t num_points() const { return static_cast<std::int64_t>(collector_.num_points()); }

    const InputFile& file_;
    Scanner scanner_;
    SurfaceCollector collector_;
    std::vector<std::string_view> words_;  ///< of the current statement
    std::vector<std::int64_t> corners_;    ///< of the current face
    std::size_t statement_begin_ = 0;      ///< first byte of the current statement
    std::int64_t highest_index_ = 0;       ///< of all faces so far; its point may follow
    std::size_t highest_index_begin_ = 0;  ///< first byte of the statement with that index
};

}  // namespace

SurfaceFile read_obj(const InputFile& file) { return ObjReader(file).read(); }

}  // namespace incise::io
