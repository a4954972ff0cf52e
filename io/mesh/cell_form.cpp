// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/cell_form.h"

#include <numeric>

#include "incise/base/error.h"

namespace incise::io {

void CellCollector::refuse(const CellForm& form, const std::string& location,
                           std::string_view code) const {
    throw InputError(location + ": a " + form.name + " (" + type_word_ + " " + std::string(code) +
                     ") cannot be used; export linear elements (tetrahedra, hexahedra, wedges, "
                     "pyramids)" +
                     (form.use == CellForm::Use::by_corners ? ", or " + linear_advice_ : ""));
}

std::string CellCollector::list_of(const Counts& counts) {
    std::string list;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const auto& [form, count] = counts[i];
        if (i > 0) list += i + 1 == counts.size() ? " and " : ", ";
        std::string name = form->name;
        if (count > 1) {
            constexpr std::string_view greek = "hedron";  // plural: hedra
            if (name.ends_with(greek))
                name.replace(name.size() - 2, 2, "a");
            else
                name += 's';
        }
        list += std::to_string(count) + " " + name;
    }
    return list;
}

std::size_t CellCollector::remove_nodes_between_corners(topology::MeshData& mesh) const {
    std::vector<bool> is_removed = is_no_corner_;
    is_removed.resize(mesh.points.size());
    for (const auto corner : mesh.corners) is_removed[static_cast<std::size_t>(corner)] = false;
    const auto num_removed =
        static_cast<std::size_t>(std::count(is_removed.begin(), is_removed.end(), true));
    if (num_removed == 0) return 0;
    if (mesh.source_points.empty()) {
        mesh.source_points.resize(mesh.points.size());
        std::iota(mesh.source_points.begin(), mesh.source_points.end(), std::int64_t{0});
    }
    std::vector<std::int64_t> new_number(mesh.points.size());
    std::size_t num_left = 0;
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        if (is_removed[p]) continue;
        new_number[p] = static_cast<std::int64_t>(num_left);
        mesh.points[num_left] = mesh.points[p];
        mesh.source_points[num_left] = mesh.source_points[p];
        ++num_left;
    }
    mesh.points.resize(num_left);
    mesh.source_points.resize(num_left);
    const auto renumber = [&](std::int64_t& p) { p = new_number[static_cast<std::size_t>(p)]; };
    std::ranges::for_each(mesh.corners, renumber);
    mesh.for_each_point_of_faces(renumber);
    return num_removed;
}

void CellCollector::finish(topology::MeshData& mesh, std::vector<std::string>& warnings) const {
    const std::string list = list_of(ignored_);
    if (mesh.num_cells() == 0)
        throw InputError(file_ + ": holds " +
                         (list.empty()
                              ? "no cells at all; "
                              : list + " but no tetrahedra, hexahedra, wedges or pyramids; ") +
                         "make a volume mesh of it first");
    if (!list.empty())
        warnings.push_back("ignored " + list +
                           ": only volume cells are used, and counted from 0 in what follows");
    if (!by_corners_.empty()) {
        const auto num_removed = remove_nodes_between_corners(mesh);
        warnings.push_back(
            "read " + list_of(by_corners_) + " by the corners alone, as linear; " +
            std::to_string(num_removed) +
            (num_removed == 1 ? " node that is no corner was" : " nodes that are no corners were") +
            " left out");
    }
    bool are_counted_alike = true;
    for (std::size_t c = 0; c < mesh.source_cells.size(); ++c)
        are_counted_alike =
            are_counted_alike && mesh.source_cells[c] == static_cast<std::int64_t>(c);
    if (are_counted_alike) mesh.source_cells.clear();
}

}  // namespace incise::io
