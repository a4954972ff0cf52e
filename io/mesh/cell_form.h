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

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// One kind of cell of a file format.
struct CellForm {
    enum class Use : std::uint8_t {
        keep,    ///< a linear volume cell
        ignore,  ///< a cell of fewer than three dimensions, left out with a warning
        refuse   ///< a volume cell that is not supported, an error
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
    CellCollector(std::string file, std::string type_word)
        : file_(std::move(file)), type_word_(std::move(type_word)) {}

    /// Throws InputError about a cell of a form that cannot be used. The message begins with the
    /// location, which is the file and the cell.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location) const {
        refuse(form, location, std::to_string(form.code));
    }
    /// The same for a format in which the kind has a word instead of a number.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location,
                             std::string_view code) const;

    /// Appends a cell of a form that is kept. `number` is the number of the cell in the file.
    /// @pre  nodes.size() == form.num_nodes, and the nodes are points of the mesh
    void keep(const CellForm& form, std::int64_t number, std::span<const std::int64_t> nodes,
              int region, topology::MeshData& mesh) const {
        std::array<std::int64_t, topology::max_corners> corners{};
        for (std::size_t i = 0; i < nodes.size(); ++i) corners[i] = nodes[form.corner_order[i]];
        mesh.add_cell(form.kind, std::span(corners).first(nodes.size()), region);
        mesh.source_cells.push_back(number);
    }

    /// Counts cells of a form that is ignored.
    void ignore(const CellForm& form, std::size_t count = 1) {
        auto row = std::find_if(ignored_.begin(), ignored_.end(),
                                [&](const auto& entry) { return entry.first == &form; });
        if (row == ignored_.end()) row = ignored_.insert(row, {&form, 0});
        row->second += count;
    }

    std::size_t num_ignored() const {
        std::size_t sum = 0;
        for (const auto& [form, count] : ignored_) sum += count;
        return sum;
    }

    /// Ends the collection. Adds a warning about ignored cells, if there are any. Clears the
    /// numbers of the cells in the file if they are 0, 1, 2, ... Throws InputError if no cell was
    /// kept.
    void finish(topology::MeshData& mesh, std::vector<std::string>& warnings) const;

  private:
    std::string file_;
    std::string type_word_;
    std::vector<std::pair<const CellForm*, std::size_t>> ignored_;
};

}  // namespace incise::io
