// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_archive.h"

#include <algorithm>
#include <utility>

#include "incise/topology/validate.h"

namespace incise::topology {

/// The list of members that an archive of a mesh contains. Row offsets are recomputed from these
/// members.
class MeshArchive {
  public:
    static void list(auto& ar, auto& m) {
        ar(m.epoch_, m.num_nodes_, m.num_elements_, m.rest_positions_, m.incident_elements_,
           m.kinds_, m.alive_, m.regions_, m.corners_, m.neighbors_, m.inside_faces_,
           m.node_labels_, m.element_labels_, m.label_nodes_, m.pinched_);
    }

    static void save(const Mesh& mesh, ArchiveWriter& ar) {
        list(ar, mesh);
        ar(std::uint64_t{mesh.polyhedra_.size()});
        mesh.polyhedra_.for_each([&](CellId e, const Mesh::Polyhedron& cell) { ar(e, cell); });
    }

    static Mesh load(ArchiveReader& ar) {
        Mesh mesh;
        list(ar, mesh);
        std::vector<std::pair<CellId, Mesh::Polyhedron>> polyhedra;
        ar(polyhedra);
        for (auto& [e, cell] : polyhedra) {
            require(e.index() < mesh.kinds_.size() && mesh.is_polyhedron(e),
                    "a cell of another kind has faces");
            mesh.polyhedra_[e] = std::move(cell);
        }
        MeshArchive(mesh).restore_rows();
        MeshArchive(mesh).require_ids();
        if (const auto faults = validate(mesh); !faults.empty())
            throw InputError("it is no sound mesh: " + faults.front());
        return mesh;
    }

  private:
    explicit MeshArchive(Mesh& mesh) : mesh_(mesh) {}

    static void require(bool holds, const char* text) {
        if (!holds) throw InputError(std::string("it is no sound mesh: ") + text);
    }

    void restore_rows() {
        for (std::size_t i = 0; i < mesh_.kinds_.size(); ++i) {
            CellKind kind = mesh_.kinds_[i];
            require(static_cast<std::size_t>(kind) <= num_cell_kinds, "an unknown kind of element");
            if (kind == CellKind::polyhedron) {
                require(mesh_.polyhedra_.contains(CellId(i)), "a polyhedron has no faces");
                kind = restore(mesh_.polyhedra_.at(CellId(i)));
            }
            const CellTraits& t = traits(kind);
            mesh_.corner_begin_.push_back(mesh_.corner_begin_.back() +
                                          static_cast<std::uint32_t>(t.num_corners));
            mesh_.face_begin_.push_back(mesh_.face_begin_.back() +
                                        static_cast<std::uint32_t>(t.num_faces));
        }
        const std::size_t num_elements = mesh_.kinds_.size();
        require(mesh_.alive_.size() == num_elements && mesh_.regions_.size() == num_elements &&
                    mesh_.corners_.size() == mesh_.corner_begin_.back() &&
                    mesh_.neighbors_.size() == mesh_.face_begin_.back() &&
                    mesh_.inside_faces_.size() == num_elements &&
                    mesh_.incident_elements_.size() == mesh_.rest_positions_.size() &&
                    mesh_.element_labels_.size() <= num_elements &&
                    mesh_.node_labels_.size() <= mesh_.incident_elements_.size(),
                "its lists are of different lengths");
    }

    /// Completes a polyhedron, and returns the kind of its row.
    static CellKind restore(Mesh::Polyhedron& cell) {
        require(cell.shape.is_sound() && std::ssize(cell.neighbors) == cell.shape.num_faces() &&
                    static_cast<std::size_t>(cell.row_kind) <= num_cell_kinds &&
                    cell.diagonals.fits(cell.row_kind),
                "the faces of a polyhedron do not fit together");
        cell.shape.append_corners(cell.corners);
        return cell.row_kind;
    }

    void require_ids() const {
        const auto is_node = [&](VertexId n) {
            return n.is_valid() && n.index() < mesh_.node_capacity();
        };
        const auto is_element_or_none = [&](CellId e) {
            return !e.is_valid() || e.index() < mesh_.element_capacity();
        };
        const auto is_face_or_none = [&](FaceId f) {
            return !f.is_valid() ||
                   (is_element_or_none(f.cell) && f.face >= 0 && f.face < mesh_.num_faces(f.cell));
        };
        bool do_polyhedra_name_ids = true;
        mesh_.polyhedra_.for_each([&](CellId, const Mesh::Polyhedron& cell) {
            do_polyhedra_name_ids = do_polyhedra_name_ids &&
                                    std::ranges::all_of(cell.corners, is_node) &&
                                    std::ranges::all_of(cell.neighbors, is_face_or_none);
        });
        const auto is_labelled = [&](VertexId n) {
            return !n.is_valid() || n.index() < mesh_.node_labels_.size();
        };
        require(std::ranges::all_of(mesh_.rest_positions_,
                                    [](const Vec3& x) { return x.allFinite(); }) &&
                    std::ranges::all_of(mesh_.corners_, is_node) &&
                    std::ranges::all_of(mesh_.incident_elements_, is_element_or_none) &&
                    std::ranges::all_of(mesh_.neighbors_, is_face_or_none) &&
                    do_polyhedra_name_ids && std::ranges::all_of(mesh_.label_nodes_, is_labelled) &&
                    std::ranges::all_of(mesh_.pinched_,
                                        [&](const auto& row) { return is_node(row.second); }),
                "a node or an element that it names is not there");
    }

    Mesh& mesh_;
};

void save(const Mesh& mesh, ArchiveWriter& ar) { MeshArchive::save(mesh, ar); }

Mesh load_mesh(ArchiveReader& ar) { return MeshArchive::load(ar); }

}  // namespace incise::topology
