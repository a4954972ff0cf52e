// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/cell_form.h"

#include "incise/base/error.h"

namespace incise::io {

void CellCollector::refuse(const CellForm& form, const std::string& location,
                           std::string_view code) const {
    throw InputError(location + ": a " + form.name + " (" + type_word_ + " " + std::string(code) +
                     ") cannot be used; export linear elements (tetrahedra, hexahedra, wedges, "
                     "pyramids)");
}

void CellCollector::finish(topology::MeshData& mesh, std::vector<std::string>& warnings) const {
    std::string list;
    for (std::size_t i = 0; i < ignored_.size(); ++i) {
        const auto& [form, count] = ignored_[i];
        if (i > 0) list += i + 1 == ignored_.size() ? " and " : ", ";
        list += std::to_string(count) + " " + form->name + (count == 1 ? "" : "s");
    }
    if (mesh.num_cells() == 0)
        throw InputError(file_ + ": holds " +
                         (list.empty()
                              ? "no cells at all; "
                              : list + " but no tetrahedra, hexahedra, wedges or pyramids; ") +
                         "make a volume mesh of it first");
    if (!list.empty())
        warnings.push_back("ignored " + list +
                           ": only volume cells are used, and counted from 0 in what follows");
    bool are_counted_alike = true;
    for (std::size_t c = 0; c < mesh.source_cells.size(); ++c)
        are_counted_alike =
            are_counted_alike && mesh.source_cells[c] == static_cast<std::int64_t>(c);
    if (are_counted_alike) mesh.source_cells.clear();
}

}  // namespace incise::io
