// Conversion of plain arrays to a mesh: check the data, renumber for locality, divide pinched nodes
// and join the faces that cells share.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_import.h"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "incise/base/disjoint_set.h"
#include "incise/base/error.h"
#include "incise/topology/geometry.h"
#include "incise/topology/hilbert.h"
#include "incise/topology/joined_quads.h"
#include "incise/topology/mesh.h"
#include "incise/topology/weld_outlook.h"

namespace incise::topology {

namespace {

std::string refusal(const std::vector<std::string>& errors) {
    std::string text = errors.front();
    for (std::size_t i = 1; i < errors.size(); ++i) text += "\n  " + errors[i];
    return text;
}

}  // namespace

/// The steps of Mesh::build, which share the mesh under construction.
class MeshImport {
  public:
    MeshImport(const MeshData& data, ImportRules rules)
        : data_(data),
          check_(check(data, rules.advice)),
          faces_(require_sound(data, check_)),
          keeps_order_(rules.keeps_order || !data.carriers.is_empty()) {
        if (rules.shared_faces) {
            check_.shared_faces = std::move(*rules.shared_faces);
            diagonals_ = std::move(rules.diagonals);
            joined_triangles_ = std::move(rules.joined_triangles);
            return;
        }
        joins_ = report_of_joins(data_, check_.joined_quads);
        diagonals_ = diagonals_of_cells(data_, check_.joined_quads);
        for (const JoinedQuad& joined : check_.joined_quads)
            for (const SourceFace triangle : joined.triangles)
                joined_triangles_.emplace_back(joined.quad, triangle);
    }

    BuiltMesh run() {
        order_elements();
        order_nodes();
        list_slots();
        divide_pinched_nodes();
        add_cells();
        join_faces();
        join_quads();
        mesh_.source_carriers_ = data_.carriers;
        return {std::move(mesh_), std::move(check_.warnings), std::move(joins_)};
    }

  private:
    static const MeshData& require_sound(const MeshData& data, const MeshCheck& check) {
        if (!check.errors.empty()) throw InputError(refusal(check.errors));
        return data;
    }

    /// Returns the cells in the order of their ids.
    std::vector<std::size_t> order_of_cells() const {
        if (keeps_order_) {
            std::vector<std::size_t> order(data_.num_cells());
            std::iota(order.begin(), order.end(), std::size_t{0});
            return order;
        }
        std::vector<Vec3> centres(data_.num_cells());
        std::vector<Vec3> x;
        for (std::size_t c = 0; c < data_.num_cells(); ++c) {
            x.clear();
            for (const std::int64_t p : data_.cell(c))
                x.push_back(data_.points[static_cast<std::size_t>(p)]);
            centres[c] = centre(x);
        }
        return hilbert_order(centres);
    }

    void order_elements() {
        cell_of_element_ = order_of_cells();
        element_of_cell_.resize(cell_of_element_.size());
        for (std::size_t e = 0; e < cell_of_element_.size(); ++e)
            element_of_cell_[cell_of_element_[e]] = CellId(e);
        mesh_.element_labels_.assign(cell_of_element_.begin(), cell_of_element_.end());
    }

    // Nodes are numbered in the order in which the elements first use them, or in that of the
    // points if the order is kept. Unused points become dead nodes at the end. Every label is then
    // the number of a point, and later nodes have higher ids.
    void order_nodes() {
        mesh_.label_nodes_.resize(data_.points.size());
        const auto number = [&](std::size_t point) {
            mesh_.label_nodes_[point] = VertexId(mesh_.node_labels_.size());
            mesh_.node_labels_.push_back(static_cast<std::int32_t>(point));
            mesh_.rest_positions_.push_back(data_.points[point]);
        };
        const auto number_all = [&](const auto& is_used) {
            for (std::size_t p = 0; p < data_.points.size(); ++p)
                if (is_used(p) && !mesh_.label_nodes_[p].is_valid()) number(p);
        };
        if (keeps_order_) {
            std::vector<bool> used(data_.points.size(), false);
            for (const std::int64_t p : data_.corners) used[static_cast<std::size_t>(p)] = true;
            number_all([&](std::size_t p) { return used[p]; });
        } else {
            for (const std::size_t c : cell_of_element_)
                for (const std::int64_t p : data_.cell(c))
                    if (!mesh_.label_nodes_[static_cast<std::size_t>(p)].is_valid())
                        number(static_cast<std::size_t>(p));
        }
        mesh_.num_nodes_ = mesh_.node_labels_.size();
        number_all([](std::size_t) { return true; });
        for (std::size_t p = 0; p < data_.welded_to.size(); ++p)
            mesh_.label_nodes_[p] =
                mesh_.label_nodes_[static_cast<std::size_t>(data_.welded_to[p])];
    }

    /// Lists the nodes of all corners: a slot for each corner of each element.
    void list_slots() {
        slots_.reserve(data_.corners.size());
        slot_begin_.reserve(cell_of_element_.size() + 1);
        slot_begin_.push_back(0);
        for (const std::size_t c : cell_of_element_) {
            for (const std::int64_t p : data_.cell(c))
                slots_.push_back(mesh_.label_nodes_[static_cast<std::size_t>(p)]);
            slot_begin_.push_back(slots_.size());
        }
    }

    std::size_t slot_of(std::size_t cell, std::int64_t point) const {
        const auto corners = data_.cell(cell);
        return slot_begin_[element_of_cell_[cell].index()] +
               static_cast<std::size_t>(std::ranges::find(corners, point) - corners.begin());
    }
    std::size_t corner_slot(SourceFace f, int position) const {
        const int size = faces_.size(f);
        return slot_of(f.cell, faces_.point(f, (position + size) % size));
    }

    void divide_pinched_nodes() {
        // Those of corners, which are joined where cells share a face.
        DisjointSet sets(slots_.size());
        const auto join = [&](std::size_t i, std::size_t j) {
            sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
        };
        for (const SharedFace& shared : check_.shared_faces)
            for (int p = 0; p < faces_.size(shared.a); ++p)
                join(corner_slot(shared.a, p), corner_slot(shared.b, shared.shift - p));
        for (const auto& [quad, triangle] : joined_triangles_)
            for (int p = 0; p < 3; ++p)
                join(corner_slot(triangle, p), slot_of(quad.cell, faces_.point(triangle, p)));
        // Slots are in ascending order of elements. The set of the first slot of a node keeps the
        // node.
        std::vector<std::size_t> first_set(mesh_.rest_positions_.size(), slots_.size());
        std::vector<VertexId> node_of_set(slots_.size());
        std::vector<bool> is_pinched(mesh_.rest_positions_.size(), false);
        std::size_t num_pinched = 0;
        for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
            const VertexId n = slots_[slot];
            const auto set = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(slot)));
            if (!node_of_set[set].is_valid()) {
                if (first_set[n.index()] == slots_.size()) {
                    first_set[n.index()] = set;
                    node_of_set[set] = n;
                } else {
                    node_of_set[set] = VertexId(mesh_.rest_positions_.size());
                    mesh_.rest_positions_.push_back(mesh_.rest_positions_[n.index()]);
                    mesh_.pinched_.emplace_back(mesh_.node_labels_[n.index()], node_of_set[set]);
                    ++mesh_.num_nodes_;
                    if (!is_pinched[n.index()] && ++num_pinched <= max_pinches_listed) {
                        std::ostringstream text;
                        text << data_.point_name(
                                    static_cast<std::size_t>(mesh_.node_labels_[n.index()]))
                             << " joins cells that share no face there; the cells get a node each";
                        check_.warnings.push_back(text.str());
                    }
                    is_pinched[n.index()] = true;
                }
            }
            slots_[slot] = node_of_set[set];
        }
        if (num_pinched > max_pinches_listed)
            check_.warnings.push_back("and " + std::to_string(num_pinched - max_pinches_listed) +
                                      " more such points");
        if (num_pinched > 0)
            if (const auto unlike = find_unlike_faces(data_, check_))
                check_.warnings.push_back(name_of(*unlike, data_) +
                                          " are no common face, so these cells are not joined: " +
                                          remedy_for_unlike_faces);
        std::sort(mesh_.pinched_.begin(), mesh_.pinched_.end());

        mesh_.incident_elements_.resize(mesh_.rest_positions_.size());
        for (std::size_t i = cell_of_element_.size(); i-- > 0;)
            for (std::size_t slot = slot_begin_[i]; slot < slot_begin_[i + 1]; ++slot)
                mesh_.incident_elements_[slots_[slot].index()] = CellId(i);
    }

    void add_cells() {
        std::size_t num_faces = 0;
        for (const CellKind kind : data_.kinds)
            if (kind != CellKind::polyhedron)
                num_faces += static_cast<std::size_t>(traits(kind).num_faces);
        reserve_with_room(data_.num_cells(), mesh_.kinds_, mesh_.alive_, mesh_.regions_,
                          mesh_.corner_begin_, mesh_.face_begin_, mesh_.inside_faces_);
        reserve_with_room(slots_.size(), mesh_.corners_);
        reserve_with_room(num_faces, mesh_.neighbors_);
        for (std::size_t i = 0; i < cell_of_element_.size(); ++i) {
            const std::size_t c = cell_of_element_[i];
            const bool is_polyhedron = data_.kinds[c] == CellKind::polyhedron;
            const auto corners = std::span(slots_).subspan(
                slot_begin_[i], is_polyhedron ? 0 : slot_begin_[i + 1] - slot_begin_[i]);
            mesh_.append_element_row(data_.kinds[c], data_.regions[c], corners);
            if (!is_polyhedron) continue;
            CellShape shape;
            std::vector<VertexId> face;
            for (int f = 0; f < faces_.num_faces(c); ++f) {
                face.clear();
                for (const std::int64_t p : faces_.points({c, f}))
                    face.push_back(slots_[slot_of(c, p)]);
                shape.add_face(face, false);
            }
            Mesh::Polyhedron& cell = mesh_.polyhedra_[CellId(i)];
            shape.append_corners(cell.corners);
            cell.neighbors.resize(static_cast<std::size_t>(shape.num_faces()));
            cell.shape = std::move(shape);
        }
    }

    void join_faces() {
        for (const SharedFace& shared : check_.shared_faces)
            mesh_.glue({element_of_cell_[shared.a.cell], shared.a.face},
                       {element_of_cell_[shared.b.cell], shared.b.face});
        if (data_.cut_faces.empty() && data_.further_cut_faces.empty()) return;
        for (std::size_t c = 0; c < data_.num_cells(); ++c)
            for (int f = 0; f < faces_.num_faces(c); ++f)
                if (data_.is_on_cut(c, f)) mesh_.set_inside({element_of_cell_[c], f});
    }

    /// Divides the quadrilaterals that meet two triangles, and joins them.
    void join_quads() {
        for (std::size_t c = 0; c < diagonals_.size(); ++c) {
            if (diagonals_[c].is_none()) continue;
            const CellId e = element_of_cell_[c];
            WholeCell cell = *mesh_.whole_cell(e);
            cell.diagonals = diagonals_[c];
            mesh_.set_shape(e, CellKind::polyhedron, cell.shape(mesh_.inside_faces_[e.index()]));
            mesh_.polyhedra_.at(e).diagonals = diagonals_[c];
        }
        for (const auto& [quad, triangle] : joined_triangles_) {
            // Triangles keep their numbers where other faces of their cell are divided.
            const FaceId other{element_of_cell_[triangle.cell], triangle.face};
            FaceId half{element_of_cell_[quad.cell], quad.face};
            const int end = mesh_.num_faces(half.cell);
            while (half.face < end && matching_shift(mesh_, half, other) < 0) ++half.face;
            if (half.face == end)
                throw InputError(data_.cell_name(triangle.cell) +
                                 " has a triangle that does not fit the quadrilateral of " +
                                 data_.cell_name(quad.cell) + " that it is joined to");
            mesh_.glue(half, other);
        }
    }

    static constexpr std::size_t max_pinches_listed = 5;

    const MeshData& data_;
    MeshCheck check_;
    SourceFaces faces_;
    std::vector<std::string> joins_;
    std::vector<Diagonals> diagonals_;  // by cell; empty if there are none
    std::vector<std::pair<SourceFace, SourceFace>> joined_triangles_;  // quadrilateral, triangle
    bool keeps_order_;
    Mesh mesh_;
    std::vector<std::size_t> cell_of_element_;
    std::vector<CellId> element_of_cell_;
    // By corner of an element, in ascending order of elements, its node; where each element begins.
    std::vector<VertexId> slots_;
    std::vector<std::size_t> slot_begin_;
};

BuiltMesh import_mesh(const MeshData& data, ImportRules rules) {
    return MeshImport(data, std::move(rules)).run();
}

BuiltMesh Mesh::build(const MeshData& data, const WeldAdvice& advice) {
    return import_mesh(data, {.advice = advice});
}

}  // namespace incise::topology
