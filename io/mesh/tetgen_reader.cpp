// Meshes of TetGen (.node and .ele).
// Source: H. Si, "TetGen: a quality tetrahedral mesh generator", user's manual 1.5, section 5.2.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/tetgen_reader.h"

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/line_words.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/node_tags.h"

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

// The code is the number of nodes; corners come first. Tetrahedra of TetGen have positive volume in
// VTK's order too.
constexpr CellForm tetrahedra_forms[] = {
    {4, "tetrahedron", 4, keep, CellKind::tetrahedron},
    {10, "second-order tetrahedron", 10, by_corners, CellKind::tetrahedron},
};

/// A position in a file of lines of numbers. Comments and empty lines are skipped.
class NumberLines {
  public:
    explicit NumberLines(const InputFile& file) : scanner_(file) {}

    /// Goes to the next line. Throws InputError if there is none; `what` names the expected item.
    void next(std::string_view what) {
        words_.clear();
        if (scanner_.at_end()) scanner_.token(what);  // throws
        append_words(without_comment(scanner_.rest_of_line()), words_);
    }
    std::size_t num_columns() const { return words_.size(); }

    template <class T>
    T number(std::size_t column, std::string_view what) const {
        if (column >= words_.size())
            fail(std::string(what) + " is missing: the line has " + std::to_string(words_.size()) +
                 " numbers");
        const auto parsed = parse_number<T>(words_[column]);
        if (!parsed) scanner_.fail_expected(what, words_[column], range_remark<T>(words_[column]));
        return *parsed;
    }
    /// Returns the number of rows that follow, each of at least `bytes_each` bytes. Throws
    /// InputError if so many do not fit in the rest of the file.
    std::uint64_t num_rows(std::string_view what, std::size_t bytes_each) const {
        const auto count = number<std::uint64_t>(0, what);
        scanner_.require_room(count, bytes_each, what);
        return count;
    }
    /// Throws InputError if the line has not `number` columns. `columns` describes them in the
    /// message. If `has_more` is true, more columns may follow.
    void expect_columns(std::size_t number, std::string_view columns, bool has_more = false) const {
        if (num_columns() < number || (num_columns() > number && !has_more))
            fail("expected " + std::string(columns) + ", as the first line has it, found " +
                 std::to_string(num_columns()) + " columns");
    }
    void expect_end(std::string_view rows) {
        if (!scanner_.at_end())
            scanner_.fail_expected("the end of the file behind " + std::string(rows),
                                   scanner_.token("the end"));
    }
    [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }
    std::string location() const { return scanner_.location(); }

  private:
    Scanner scanner_;
    std::vector<std::string_view> words_;
};

class TetgenReader {
  public:
    TetgenReader(const InputFile& nodes, const InputFile& elements, const ReadOptions& options)
        : nodes_(nodes),
          elements_(elements),
          nodes_name_(nodes.name()),
          collector_(elements.name(), "number of nodes", options) {}

    MeshFile read() {
        read_nodes();
        read_elements();
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    // n, dimension, attributes, markers; then n times: index x y z attributes marker
    void read_nodes() {
        constexpr std::size_t bytes_of_row = 8;  // four digits, each with a blank
        nodes_.next("the number of nodes");
        const auto num_nodes = nodes_.num_rows("the number of nodes", bytes_of_row);
        const auto dimension = nodes_.number<int>(1, "the dimension");
        if (dimension != 3)
            nodes_.fail("the dimension is " + std::to_string(dimension) + "; it must be 3");
        const auto num_attributes = count_or_0(nodes_, 2, "the number of attributes");
        const auto num_markers = count_or_0(nodes_, 3, "the number of boundary markers, 0 or 1");
        if (num_markers > 1)
            nodes_.fail("the number of boundary markers is " + std::to_string(num_markers) +
                        "; it must be 0 or 1");
        const bool has_more = nodes_.num_columns() < 4;  // the first line omits counts
        const auto columns = "an index, 3 coordinates, " + std::to_string(num_attributes) +
                             " attributes" +
                             (has_more ? "" : " and " + std::to_string(num_markers) + " markers");
        auto& points = result_.mesh.points;
        points.reserve(static_cast<std::size_t>(num_nodes));
        for (std::uint64_t i = 0; i < num_nodes; ++i) {
            nodes_.next("a node");
            tags_.add(nodes_.number<std::int64_t>(0, "the index of a node"));
            const double x = coordinate(1, "coordinate x");
            const double y = coordinate(2, "coordinate y");
            const double z = coordinate(3, "coordinate z");
            points.emplace_back(x, y, z);
            nodes_.expect_columns(4 + std::size_t{num_attributes} + num_markers, columns, has_more);
        }
        nodes_.expect_end(std::to_string(num_nodes) + " nodes");
        if (const auto twice = tags_.sort()) throw InputError(nodes_name_ + ": index " + *twice);
        result_.mesh.source_points = tags_.in_order();
    }

    /// Returns a count of the first line, or 0 if the line does not have it.
    static std::uint32_t count_or_0(const NumberLines& lines, std::size_t column,
                                    std::string_view what) {
        return column < lines.num_columns() ? lines.number<std::uint32_t>(column, what) : 0;
    }

    double coordinate(std::size_t column, std::string_view what) const {
        const auto value = nodes_.number<double>(column, what);
        if (!std::isfinite(value))
            nodes_.fail(std::string(what) + " is " + shown(value) + "; it must be finite");
        return value;
    }

    // n, nodes of each, attributes; then n times: index nodes attributes
    void read_elements() {
        constexpr std::size_t bytes_of_row = 10;
        elements_.next("the number of elements");
        const auto num_elements = elements_.num_rows("the number of elements", bytes_of_row);
        const auto num_nodes = elements_.number<int>(1, "the number of nodes of an element");
        const auto num_attributes = count_or_0(elements_, 2, "the number of attributes");
        const auto columns = "an index, " + std::to_string(num_nodes) + " nodes and " +
                             std::to_string(num_attributes) + " attributes";
        const auto* form = find_form(tetrahedra_forms, num_nodes);
        if (form == nullptr)
            elements_.fail("elements have " + std::to_string(num_nodes) +
                           " nodes; they must have 4");
        if (collector_.refuses(*form)) collector_.refuse(*form, elements_.location());
        if (num_attributes > 1)
            result_.warnings.push_back("elements have " + std::to_string(num_attributes) +
                                       " attributes; the first one of each is taken as the region");
        std::vector<std::int64_t> nodes(static_cast<std::size_t>(num_nodes));
        for (std::uint64_t i = 0; i < num_elements; ++i) {
            elements_.next("an element");
            elements_.expect_columns(1 + nodes.size() + num_attributes, columns);
            const auto index = elements_.number<std::int64_t>(0, "the index of an element");
            for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = node(index, 1 + k);
            collector_.keep(*form, index, nodes, num_attributes > 0 ? region(1 + nodes.size()) : 0,
                            result_.mesh);
        }
        elements_.expect_end(std::to_string(num_elements) + " elements");
    }

    std::int64_t node(std::int64_t element, std::size_t column) const {
        const auto tag = elements_.number<std::int64_t>(column, "a node of an element");
        const auto found = tags_.find(tag);
        if (!found)
            elements_.fail("element " + std::to_string(element) + ": node " + std::to_string(tag) +
                           " is not one of the " + std::to_string(tags_.size()) + " nodes in " +
                           nodes_name_);
        return *found;
    }

    int region(std::size_t column) const {
        const auto value = elements_.number<double>(column, "the attribute of an element");
        const auto whole = whole_number(value);
        if (!whole)
            elements_.fail("attribute " + shown(value) +
                           " is taken as the region, but is no whole number of 32 bits; number "
                           "the regions, or leave out the attributes");
        return *whole;
    }

    NumberLines nodes_, elements_;
    std::string nodes_name_;
    CellCollector collector_;
    NodeTags tags_;
    MeshFile result_;
};

}  // namespace

MeshFile read_tetgen_pair(const InputFile& nodes, const InputFile& elements,
                          const ReadOptions& options) {
    return TetgenReader(nodes, elements, options).read();
}

MeshFile read_tetgen(const InputFile& file, const ReadOptions& options) {
    const auto suffix = file.path.extension().string();
    const bool has_nodes = lower_case(suffix) == ".node";
    const bool is_upper = suffix != lower_case(suffix);
    auto path = file.path;
    path.replace_extension(has_nodes ? (is_upper ? ".ELE" : ".ele")
                                     : (is_upper ? ".NODE" : ".node"));
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw InputError(file.name() + ": has the " + (has_nodes ? "nodes" : "elements") +
                         " of a mesh only; put " + path.filename().string() + ", which has its " +
                         (has_nodes ? "elements" : "nodes") + ", beside it");
    const auto other = load_input_file(path);
    return has_nodes ? read_tetgen_pair(file, other, options)
                     : read_tetgen_pair(other, file, options);
}

}  // namespace incise::io
