// The faces of a cell of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// The faces of a cell, each as the list of its corners, anticlockwise as seen from outside. The
/// cell is a ball: a face meets each of its corners once, each edge has two faces, and no two edges
/// join the same two corners.
class CellShape {
  public:
    int num_faces() const { return static_cast<int>(ends_.size()); }
    std::span<const VertexId> face(int f) const {
        const std::size_t begin = begin_of(f);
        return {corners_.data() + begin, end_of(f) - begin};
    }
    /// True if the face lay inside the body before any cut: see Mesh::was_inside().
    bool is_inside(int f) const { return is_inside_[static_cast<std::size_t>(f)] != 0; }
    void set_inside(int f, bool is_inside) {
        is_inside_[static_cast<std::size_t>(f)] = is_inside ? 1 : 0;
    }

    void add_face(std::span<const VertexId> corners, bool is_inside) {
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        ends_.push_back(static_cast<std::int32_t>(corners_.size()));
        is_inside_.push_back(is_inside ? 1 : 0);
    }
    /// Makes `v` a corner of a face, before the one at a position.
    void insert_corner(int f, int position, VertexId v) {
        corners_.insert(corners_.begin() + static_cast<std::ptrdiff_t>(begin_of(f)) + position, v);
        for (auto i = static_cast<std::size_t>(f); i < ends_.size(); ++i) ++ends_[i];
    }
    /// Divides a face by an edge between two of its corners, or by two with the new corner `middle`
    /// between them. The part from `a` on to `b` keeps the number of the face; the other part
    /// becomes the last face.
    void divide_face(int f, VertexId a, VertexId b, VertexId middle = {});
    /// Divides a face by a new corner `v` with an edge to each of its corners. The triangle at the
    /// first edge of the face keeps its number; the others become the last faces.
    void divide_face_by(int f, VertexId v);
    /// Replaces a corner in all faces.
    void replace_corner(VertexId from, VertexId to) {
        for (VertexId& v : corners_)
            if (v == from) v = to;
    }
    /// Appends the corners of the cell, each once, in the order in which the faces name them.
    void append_corners(std::vector<VertexId>& corners) const;

    /// Returns how much memory its lists take, bytes.
    std::size_t num_bytes() const {
        return ends_.size() * (sizeof(ends_[0]) + sizeof(is_inside_[0])) +
               corners_.size() * sizeof(VertexId);
    }
    bool operator==(const CellShape&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.ends_, self.corners_, self.is_inside_); }
    /// True if the lists fit together, and each face has three corners or more.
    bool is_sound() const;

  private:
    /// Puts other corners in the place of a face.
    void replace_face(int f, std::span<const VertexId> corners);
    std::size_t begin_of(int f) const {
        return f == 0 ? 0 : static_cast<std::size_t>(ends_[static_cast<std::size_t>(f) - 1]);
    }
    std::size_t end_of(int f) const {
        return static_cast<std::size_t>(ends_[static_cast<std::size_t>(f)]);
    }

    std::vector<std::int32_t> ends_;  // by face, the end of its corners in the list
    std::vector<VertexId> corners_;
    std::vector<std::uint8_t> is_inside_;  // by face
};

}  // namespace incise::topology
