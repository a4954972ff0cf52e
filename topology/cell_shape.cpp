// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_shape.h"

#include <algorithm>
#include <array>

namespace incise::topology {

void CellShape::append_corners(std::vector<VertexId>& corners) const {
    const auto begin = static_cast<std::ptrdiff_t>(corners.size());
    for (const VertexId v : corners_)
        if (std::find(corners.begin() + begin, corners.end(), v) == corners.end())
            corners.push_back(v);
}

void CellShape::replace_face(int f, std::span<const VertexId> corners) {
    const auto old_size = static_cast<std::ptrdiff_t>(face(f).size());
    const auto begin = corners_.begin() + static_cast<std::ptrdiff_t>(begin_of(f));
    corners_.insert(corners_.erase(begin, begin + old_size), corners.begin(), corners.end());
    const auto more = static_cast<std::int32_t>(std::ssize(corners) - old_size);
    for (auto i = static_cast<std::size_t>(f); i < ends_.size(); ++i) ends_[i] += more;
}

void CellShape::divide_face(int f, VertexId a, VertexId b, VertexId middle) {
    std::vector<VertexId> whole(face(f).begin(), face(f).end());
    std::ranges::rotate(whole, std::ranges::find(whole, a));
    const auto end = std::ranges::find(whole, b);
    std::vector<VertexId> other(end, whole.end());
    other.push_back(a);
    whole.erase(end + 1, whole.end());
    if (middle.is_valid()) {
        other.push_back(middle);
        whole.push_back(middle);
    }
    replace_face(f, whole);
    add_face(other, is_inside(f));
}

void CellShape::divide_face_by(int f, VertexId v) {
    const std::vector<VertexId> whole(face(f).begin(), face(f).end());
    replace_face(f, std::array{whole[0], whole[1], v});
    for (std::size_t p = 1; p < whole.size(); ++p)
        add_face(std::array{whole[p], whole[(p + 1) % whole.size()], v}, is_inside(f));
}

bool CellShape::is_sound() const {
    if (is_inside_.size() != ends_.size()) return false;
    std::int32_t begin = 0;
    for (const std::int32_t end : ends_) {
        if (std::int64_t{end} < std::int64_t{begin} + 3) return false;
        begin = end;
    }
    return static_cast<std::size_t>(begin) == corners_.size();
}

}  // namespace incise::topology
