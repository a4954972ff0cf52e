// What a file format calls its kinds of cells, and what becomes of each. A format has one table.
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

struct CellForm {
    enum class Use : std::uint8_t {
        keep,    ///< a linear volume cell
        ignore,  ///< of fewer than three dimensions
        refuse   ///< a volume cell that is not supported
    };

    int code;          ///< the format's number for the kind; 0 where it has a word
    const char* name;  ///< singular; where ignored, the plural is the name with an s
    int num_nodes;     ///< 0: any number
    Use use = Use::refuse;
    topology::CellKind kind = topology::CellKind::tetrahedron;  ///< where kept
    /// Where kept: corner i of the cell is node corner_order[i] of the file.
    std::array<std::uint8_t, topology::max_corners> corner_order = {0, 1, 2, 3, 4, 5, 6, 7};
};

/// The row of this code, or null. @pre the table ascends by code
constexpr const CellForm* find_form(std::span<const CellForm> forms, std::int64_t code) {
    const auto row = std::lower_bound(
        forms.begin(), forms.end(), code,
        [](const CellForm& form, std::int64_t wanted) { return form.code < wanted; });
    return row != forms.end() && row->code == code ? &*row : nullptr;
}

/// Collects the volume cells of a file in a mesh and counts the cells that are left out.
class CellCollector {
  public:
    /// `file` is its name in messages; `type_word` is what the format calls a kind's code.
    CellCollector(std::string file, std::string type_word)
        : file_(std::move(file)), type_word_(std::move(type_word)) {}

    /// Throws InputError about a cell of a form that cannot be used. `place` is what the message
    /// begins with: the file and the cell.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location) const {
        refuse(form, location, std::to_string(form.code));
    }
    /// The same where the format calls the kind by a word.
    [[noreturn]] void refuse(const CellForm& form, const std::string& location,
                             std::string_view code) const;

    /// Appends a cell of a form that is kept; `number` is what the file calls it.
    /// @pre nodes.size() == form.num_nodes, and they are points of the mesh
    void keep(const CellForm& form, std::int64_t number, std::span<const std::int64_t> nodes,
              int region, topology::MeshData& mesh) const {
        std::array<std::int64_t, topology::max_corners> corners{};
        for (std::size_t i = 0; i < nodes.size(); ++i) corners[i] = nodes[form.corner_order[i]];
        mesh.add_cell(form.kind, std::span(corners).first(nodes.size()), region);
        mesh.source_cells.push_back(number);
    }

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

    /// To be called when all are read. Adds a warning about the cells left out, if any. Throws
    /// InputError if none was kept.
    void finish(topology::MeshData& mesh, std::vector<std::string>& warnings) const;

  private:
    std::string file_;
    std::string type_word_;
    std::vector<std::pair<const CellForm*, std::size_t>> ignored_;
};

}  // namespace incise::io
