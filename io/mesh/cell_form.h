// The kinds of cells of a file format, and the use of each. Each format has a table of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// One kind of cell of a file format.
struct CellForm {
    enum class Use : std::uint8_t {
        keep,        ///< a linear volume cell
        by_corners,  ///< a volume cell of higher order: kept by its corners, if asked for
        ignore,      ///< a cell of fewer than three dimensions, left out with a warning
        refuse       ///< a volume cell that is not supported, an error
    };

    int code;          ///< number of the kind in the format; 0 if the format has a word instead
    const char* name;  ///< singular; the plural of an ignored kind is the name with an s
    int num_nodes;     ///< 0: any number
    Use use = Use::refuse;
    topology::CellKind kind = topology::CellKind::tetrahedron;  ///< if kept
    /// If kept: corner i of the cell is node corner_order[i] of the file.
    std::array<std::uint8_t, topology::max_corners> corner_order = {0, 1, 2, 3, 4, 5, 6, 7};
};

/// Returns the row with this code, or null.
/// @pre  the table is in ascending order of the codes
constexpr const CellForm* find_form(std::span<const CellForm> forms, std::int64_t code) {
    const auto row = std::lower_bound(
        forms.begin(), forms.end(), code,
        [](const CellForm& form, std::int64_t wanted) { return form.code < wanted; });
    return row != forms.end() && row->code == code ? &*row : nullptr;
}

/// A collector that adds the volume cells of a file to a mesh and counts the cells that it ignores.
class CellCollector {
  public:
    /// @param file       the name of the file in messages
    /// @param type_word  the word of the format for the code of a kind of cell
    /// @param options    whether cells of higher order are kept
    CellCollector(std::string file, std::string type_word, const ReadOptions& options)
        : file_(std::move(file)),
          type_word_(std::move(type_word)),
          linear_(options.linear),
          linear_advice_(options.linear_advice) {}

    /// True if cells of the form cannot be used.
    bool refuses(const CellForm& form) const {
        return form.use == CellForm::Use::refuse ||
               (form.use == CellForm::Use::by_corners && !linear_);
    }
    /// Throws InputError about a cell of a form that cannot be used. The message begins with the
    /// location, which is the file and the cell.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location) const {
        refuse(form, location, std::to_string(form.code));
    }
    /// The same for a format in which the kind has a word instead of a number.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location,
                             std::string_view code) const;

    /// Appends a cell of a form that is kept. `number` is the number of the cell in the file.
    /// @pre  nodes has form.num_nodes nodes, or at least the corners if that is 0. They are points
    ///       of the mesh.
    void keep(const CellForm& form, std::int64_t number, std::span<const std::int64_t> nodes,
              int region, topology::MeshData& mesh) {
        std::array<std::int64_t, topology::max_corners> corners{};
        const auto num_corners = num_corners_of(form);
        for (std::size_t i = 0; i < num_corners; ++i) corners[i] = nodes[form.corner_order[i]];
        mesh.add_cell(form.kind, std::span(corners).first(num_corners), region);
        mesh.source_cells.push_back(number);
        if (form.use != CellForm::Use::by_corners) return;
        count(form, 1, by_corners_);
        if (is_no_corner_.size() < mesh.points.size()) is_no_corner_.resize(mesh.points.size());
        for (const auto node : nodes.subspan(num_corners))
            is_no_corner_[static_cast<std::size_t>(node)] = true;
    }
    static std::size_t num_corners_of(const CellForm& form) {
        return static_cast<std::size_t>(topology::traits(form.kind).num_corners);
    }

    /// Counts cells of a form that is ignored.
    void ignore(const CellForm& form, std::size_t num_cells = 1) {
        count(form, num_cells, ignored_);
    }

    std::size_t num_ignored() const {
        std::size_t sum = 0;
        for (const auto& [form, count] : ignored_) sum += count;
        return sum;
    }

    /// Ends the collection. Adds a warning about ignored cells, if there are any. Removes the nodes
    /// of cells of higher order that are no corner of any cell, with a warning. Clears the numbers
    /// of the cells in the file if they are 0, 1, 2, ... Throws InputError if no cell was kept.
    void finish(topology::MeshData& mesh, std::vector<std::string>& warnings) const;

  private:
    using Counts = std::vector<std::pair<const CellForm*, std::size_t>>;

    static void count(const CellForm& form, std::size_t num_cells, Counts& counts) {
        auto row = std::find_if(counts.begin(), counts.end(),
                                [&](const auto& entry) { return entry.first == &form; });
        if (row == counts.end()) row = counts.insert(row, {&form, 0});
        row->second += num_cells;
    }
    static std::string list_of(const Counts& counts);
    /// Returns the number of points that were removed.
    std::size_t remove_nodes_between_corners(topology::MeshData& mesh) const;

    std::string file_;
    std::string type_word_;
    bool linear_;
    std::string linear_advice_;
    Counts ignored_, by_corners_;
    /// By point: true for a node of a cell of higher order that is no corner of that cell.
    std::vector<bool> is_no_corner_;
};

}  // namespace incise::io
