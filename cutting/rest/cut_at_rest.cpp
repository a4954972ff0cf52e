// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/rest/cut_at_rest.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "incise/base/error.h"
#include "incise/cutting/cutter.h"
#include "incise/cutting/exact/cut_plan.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/triangle_surface.h"
#include "incise/cutting/tools/separator.h"
#include "incise/fragments/carriers.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/geometry.h"

namespace incise::cutting {

using fragments::FragmentMesh;
using topology::Mesh;

namespace {

/// The boundary of a mesh before a split, from which the faces that the split opens are found.
class FacesBefore {
  public:
    explicit FacesBefore(const Mesh& mesh)
        : num_cells_(mesh.element_capacity()), num_nodes_(mesh.node_capacity()) {
        for (const FaceId f : topology::boundary_faces(mesh)) {
            std::vector<VertexId>& corners = open_[f.cell].emplace_back();
            for (int p = 0; p < mesh.face_size(f); ++p) corners.push_back(mesh.face_corner(f, p));
        }
    }

    /// Returns both sides of the faces that the split has opened: the faces on a cut that are in no
    /// face of the former boundary. So one that parts nothing from such a face is not among them.
    std::vector<FaceId> opened_by(const topology::ChangeSet& changes, const Mesh& mesh) const {
        std::vector<FaceId> opened;
        for (const CellId e : topology::touched_cells(changes)) {
            if (!mesh.is_alive(e)) continue;
            CellId root = e;
            while (root.index() >= num_cells_)
                root = changes.elements_added[root.index() - num_cells_].parent;
            const auto open = open_.find(root);
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                if (!mesh.is_on_cut({e, f})) continue;
                const bool was_open =
                    open != open_.end() && std::ranges::any_of(open->second, [&](const auto& face) {
                        for (int p = 0; p < mesh.face_size({e, f}); ++p)
                            if (!is_in(mesh.face_corner({e, f}, p), face, changes)) return false;
                        return true;
                    });
                if (!was_open) opened.push_back({e, f});
            }
        }
        return opened;
    }

  private:
    /// True if a node is a corner of a face, or lies between such.
    bool is_in(VertexId n, const std::vector<VertexId>& face,
               const topology::ChangeSet& changes) const {
        if (std::ranges::find(face, n) != face.end()) return true;
        if (n.index() < num_nodes_) return false;
        const topology::VertexRecord& record = changes.nodes_added[n.index() - num_nodes_];
        const auto sources =
            std::span(record.sources).first(static_cast<std::size_t>(record.num_sources));
        return std::ranges::all_of(
            sources, [&](const auto& source) { return is_in(source.node, face, changes); });
    }

    std::map<CellId, std::vector<std::vector<VertexId>>> open_;
    std::size_t num_cells_, num_nodes_;
};

/// Returns the surface that the edge sweeps: two triangles for each segment and motion, as in
/// cutting/surfaces/space_time.h.
topology::SurfaceData swept_surface(const Sweep& sweep) {
    topology::SurfaceData surface;
    for (std::size_t p = 0; p + 1 < sweep.poses.size(); ++p)
        for (std::size_t s = 0; s + 1 < sweep.poses[p].size(); ++s) {
            const auto a = static_cast<std::int64_t>(surface.points.size());
            for (const std::size_t pose : {p, p + 1})
                for (const std::size_t end : {s, s + 1})
                    surface.points.push_back(sweep.poses[pose][end]);
            const std::int64_t b = a + 1, a_after = a + 2, b_after = a + 3;
            surface.triangles.push_back({a, b, b_after});
            surface.triangles.push_back({a, b_after, a_after});
        }
    return surface;
}

/// Returns the end of the sweep. Its direction is that of the last motion that was not zero.
BladeEnd end_of(const Sweep& sweep) {
    const auto& last = sweep.poses.back();
    std::vector<Vec3> motion(last.size(), Vec3::Zero());
    const auto before = std::find_if(sweep.poses.rbegin(), sweep.poses.rend(),
                                     [&](const auto& pose) { return pose != last; });
    if (before != sweep.poses.rend())
        for (std::size_t i = 0; i < last.size(); ++i) motion[i] = last[i] - (*before)[i];
    return {last, motion};
}

/// Returns the length of the longest edge of the elements of the physics, at rest, m.
double longest_edge(const FragmentMesh& fragments) {
    double longest = 0.0;
    for (const ElementId e : fragments.elements()) {
        const auto corners = fragments.corners(e);
        for (const NodeId a : corners)
            for (const NodeId b : corners)
                longest = std::max(
                    longest, (fragments.rest_position(a) - fragments.rest_position(b)).norm());
    }
    return longest;
}

/// Returns the normal scaled by a power of two, so that squares neither overflow nor become zero.
/// The scaling is exact: it changes neither signs nor the plane.
Vec3 well_scaled(const Vec3& normal) {
    const int exponent = -std::ilogb(normal.cwiseAbs().maxCoeff());
    return normal.unaryExpr([&](double x) { return std::scalbn(x, exponent); });
}

void add(const CutCounts& counts, CutCounts& total) {
    total.elements_crossed += counts.elements_crossed;
    total.elements_added += counts.elements_added;
    total.elements_removed += counts.elements_removed;
    total.nodes_added += counts.nodes_added;
    total.nodes_duplicated += counts.nodes_duplicated;
    total.nodes_snapped += counts.nodes_snapped;
    total.faces_opened += counts.faces_opened;
    total.cut_area += counts.cut_area;
    total.volume_removed += counts.volume_removed;
    total.split_seconds += counts.split_seconds;
    if (counts.mean_angle) {  // of all planes so far, by their areas
        const double before = total.mean_angle.value_or(0.0) * (total.cut_area - counts.cut_area);
        total.mean_angle = (before + *counts.mean_angle * counts.cut_area) / total.cut_area;
    }
    if (const auto& distance = counts.surface_distance) {
        if (!total.surface_distance) total.surface_distance = CutCounts::Distance{};
        auto& largest = *total.surface_distance;
        largest.nodes = std::max(largest.nodes, distance->nodes);
        largest.faces = std::max(largest.faces, distance->faces);
    }
}

/// A cutter that applies tools one after the other and counts the changes by each.
class CountingCutter {
  public:
    CountingCutter(Mesh& mesh, CutMode mode)
        : mesh_(mesh), mode_(mode), cutter_(mesh, mesh.rest_positions()), fragments_(mesh) {}

    const FragmentMesh& fragments() const { return fragments_; }

    CutCounts apply(const RestTool& tool) {
        counts_ = {};
        opened_faces_ = {};
        // Twice, so that the nodes that the last tool opened rest beside its cut, too.
        keep_margins();
        keep_margins();
        std::visit([&](const auto& kind) { cut(kind); }, tool.kind);
        return counts_;
    }

  private:
    /// Has the cutter move the nodes that were opened off their cut, as it does in each step of a
    /// run: else rounding would decide on which side of the same cut they are.
    void keep_margins() {
        cutter_.settle(mesh_);
        cutter_.follow_motion(mesh_, mesh_.rest_positions());
    }

    void cut(const PlaneCut& plane) {
        const Vec3 normal = well_scaled(plane.normal), unit = normal.normalized();
        const Plane surface(plane.point, normal);
        if (mode_ == CutMode::split)
            split(surface, plane.snap);
        else
            separate(
                [&](const Vec3& a, const Vec3& b) { return surface.side(a) != surface.side(b); });
        measure_distance([&](const Vec3& x) { return std::abs(unit.dot(x - plane.point)); });
        measure_angle(unit);
    }

    void cut(const SurfaceCut& given) {
        const TriangleSurface surface(given.surface);
        std::vector<Crossing> crossings;
        if (mode_ == CutMode::split)
            split(surface, given.snap);
        else
            separate([&](const Vec3& a, const Vec3& b) {
                crossings.clear();
                surface.append_crossings({a, a}, {b, b}, crossings);
                return crossings.size() % 2 == 1;
            });
        measure_distance([&](const Vec3& x) { return surface.distance(x); });
    }

    void cut(const Sweep& sweep) {
        const CutId cut = cutter_.begin_cut(sweep.snap);
        for (std::size_t p = 0; p + 1 < sweep.poses.size(); ++p) {
            if (p > 0) keep_margins();
            const auto &before = sweep.poses[p], &after = sweep.poses[p + 1];
            const auto rest = mesh_.rest_positions();
            if (mode_ == CutMode::split)
                split_by([&] { return cutter_.split(cut, mesh_, before, after); });
            else
                open(faces_to_open({mesh_, rest, rest}, before, after));
        }
        Sweep followed = sweep;
        if (cutter_.is_in_tissue(cut)) {
            const BladeEnd end = end_of(sweep);
            split_by([&] { return cutter_.end_cut(cut, mesh_, fragments_, end); });
            // The cut may end up to half an element ahead of the edge, on this continuation.
            followed.poses.push_back(end.edge_after(longest_edge(fragments_)));
        }
        cutter_.remove_cut(cut);
        if (counts_.faces_opened == 0) return;
        const TriangleSurface surface(swept_surface(followed));
        measure_distance([&](const Vec3& x) { return surface.distance(x); });
    }

    void cut(const Removal& removal) {
        const Pose pose{Eigen::Quaterniond::Identity(), removal.at};
        const auto changes = cutter_.carve(mesh_, removal.shape, pose, pose).changes;
        long double removed = 0.0;
        for (const topology::CellRecord& record : changes.elements_removed)
            removed += topology::rest_volume(mesh_, changes, record);
        counts_.volume_removed = static_cast<double>(removed);
        record_changes(changes);
    }

    void split(const CutSurface& surface, double snap) {
        split_by([&] { return cutter_.split(mesh_, surface, snap); });
    }

    /// Makes a split and counts its changes. edit() makes the split and returns a Split.
    template <class Edit>
    void split_by(Edit edit) {
        const FacesBefore faces(mesh_);
        const auto start = std::chrono::steady_clock::now();
        const Split result = edit();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        counts_.split_seconds += elapsed.count();
        counts_.elements_crossed += result.report.elements_crossed;
        counts_.nodes_snapped += result.report.nodes_snapped;
        counts_.faces_opened += result.report.faces_opened;
        counts_.cut_area += result.report.cut_area;
        if (result.report.faces_opened > 0) {
            const auto opened = faces.opened_by(result.changes, mesh_);
            assert(opened.size() <= 2 * result.report.faces_opened);
            for (const FaceId f : opened) remember(f);
        }
        record_changes(result.changes);
    }

    /// Opens the faces between elements whose centres at rest satisfy `are_separated`.
    template <class AreParted>
    void separate(AreParted are_separated) {
        std::vector<FaceId> faces;
        const auto rest = mesh_.rest_positions();
        for (const CellId e : mesh_.elements()) {
            const Vec3 centre = TissueMotion::centre(mesh_, e, rest);
            for (int f = 0; f < mesh_.num_faces(e); ++f) {
                const FaceId face{e, f}, other = mesh_.neighbor(face);
                if (face < other &&
                    are_separated(centre, TissueMotion::centre(mesh_, other.cell, rest)))
                    faces.push_back(face);
            }
        }
        open(faces);
    }

    void open(const std::vector<FaceId>& faces) {
        const auto changes = execute({{}, faces}, mesh_);
        std::set<CellId> crossed;
        for (const topology::FacePair& pair : changes.faces_opened) {
            crossed.insert({pair.a.cell, pair.b.cell});
            remember(pair.a);
            counts_.cut_area += topology::rest_area(mesh_, pair.a);
        }
        counts_.elements_crossed += crossed.size();
        counts_.faces_opened += changes.faces_opened.size();
        record_changes(changes);
    }

    void record_changes(const topology::ChangeSet& changes) {
        cutter_.apply(mesh_, changes);
        fragments_.apply(mesh_, changes);
        counts_.elements_added += changes.elements_added.size();
        counts_.elements_removed += changes.elements_removed.size();
        counts_.nodes_added += changes.nodes_added.size();
        for (const topology::VertexRecord& record : changes.nodes_added)
            counts_.nodes_duplicated += record.num_sources == 1;
    }

    void remember(FaceId f) {
        const int size = mesh_.face_size(f);
        const auto at = [&](int p) -> const Vec3& {
            return mesh_.rest_position(mesh_.face_corner(f, p % size));
        };
        Vec3 sum = Vec3::Zero();
        for (int p = 0; p < size; ++p) {
            opened_faces_.nodes.push_back(at(p));
            opened_faces_.middles.push_back(0.5 * (at(p) + at(p + 1)));
            sum += at(p);
        }
        opened_faces_.middles.push_back(sum / size);
        opened_faces_.areas.push_back(topology::area_vector(size, at));
    }

    void measure_angle(const Vec3& normal) {
        double sum = 0.0, all = 0.0;
        for (const Vec3& area : opened_faces_.areas) {
            sum += area.norm() * std::atan2(area.cross(normal).norm(), std::abs(area.dot(normal)));
            all += area.norm();
        }
        if (all > 0.0) counts_.mean_angle = sum / all;
    }

    template <class Distance>
    void measure_distance(Distance distance) {
        if (counts_.faces_opened == 0) return;
        const auto largest = [&](std::vector<Vec3>& points) {
            std::ranges::sort(points, [](const Vec3& a, const Vec3& b) {
                return std::ranges::lexicographical_compare(a, b);
            });
            points.erase(std::unique(points.begin(), points.end()), points.end());
            double value = 0.0;
            for (const Vec3& x : points) value = std::max(value, distance(x));
            return value;
        };
        const double nodes = largest(opened_faces_.nodes);
        counts_.surface_distance = {nodes, std::max(nodes, largest(opened_faces_.middles))};
    }

    Mesh& mesh_;
    const CutMode mode_;
    Cutter cutter_;
    FragmentMesh fragments_;
    // The counts and faces of the present tool.
    CutCounts counts_;
    struct {
        std::vector<Vec3> nodes, middles;  // m, at rest; middles of edges and of faces
        std::vector<Vec3> areas;           // m2
    } opened_faces_;
};

/// Returns a warning if the tool cut nothing, because this is rarely intended.
std::optional<std::string> complaint_about(const RestTool& tool, const CutCounts& counts,
                                           const BodyMeasures& body) {
    std::ostringstream text;
    text.precision(4);
    if (std::holds_alternative<Removal>(tool.kind)) {
        if (counts.elements_removed > 0) return std::nullopt;
        text << "removes nothing, it covers the centre of no element";
    } else {
        if (counts.faces_opened > 0) return std::nullopt;
        if (counts.elements_crossed > 0) {
            text << "opens no face, though it crosses " << counts.elements_crossed
                 << (counts.elements_crossed == 1 ? " element" : " elements")
                 << ": it grazes the body, runs along an earlier cut, or needs a smaller snap";
            return text.str();
        }
        text << "cuts nothing, it parts no two elements";
    }
    text << "; the body reached from " << body.box_min.transpose() << " to "
         << body.box_max.transpose() << " before the first tool";
    return text.str();
}

BodyMeasures measures_after(const Mesh& mesh, const FragmentMesh& fragments) {
    try {
        return measures_of(mesh, fragments);
    } catch (const InputError& error) {
        throw InputError(std::string("after the cuts: ") + error.what() +
                         "\nuse a larger snap, or move the cut a little");
    }
}

template <class A, class B>
std::optional<double> ratio(A a, B b) {
    if (!(b > B{})) return std::nullopt;
    return static_cast<double>(a) / static_cast<double>(b);
}

}  // namespace

double RestCutReport::volume_error() const {
    return std::abs(after.volume + total.volume_removed - before.volume) / before.volume;
}

std::optional<double> RestCutReport::growth() const {
    return ratio(total.elements_added, total.elements_crossed);
}

std::optional<double> RestCutReport::microseconds_per_crossed_element() const {
    if (total.split_seconds == 0.0) return std::nullopt;
    return ratio(1e6 * total.split_seconds, total.elements_crossed);
}

std::optional<double> RestCutReport::stable_step_ratio() const {
    return ratio(after.step_length, before.step_length);
}

RestCutReport cut_at_rest(Mesh& mesh, std::span<const RestTool> tools, CutMode mode) {
    RestCutReport report;
    CountingCutter cutter(mesh, mode);
    report.before = measures_of(mesh, cutter.fragments());
    for (const RestTool& tool : tools) {
        try {
            const CutCounts counts = cutter.apply(tool);
            if (mesh.num_elements() == 0)
                throw InputError("removes the last element: nothing is left of the body");
            if (const auto complaint = complaint_about(tool, counts, report.before))
                report.warnings.push_back(tool.name + ": " + *complaint);
            add(counts, report.total);
            report.tools.push_back({tool.name, counts, topology::components(mesh).count});
        } catch (const InputError& error) {
            throw InputError(tool.name + ": " + error.what());
        }
    }
    report.after = measures_after(mesh, cutter.fragments());
    report.pieces = pieces_of(mesh);
    report.mesh = topology::to_mesh_data(mesh, mesh.rest_positions());
    report.mesh.carriers = fragments::carriers_of(mesh, cutter.fragments());
    report.mesh.points_may_coincide = report.total.nodes_duplicated > 0;
    return report;
}

}  // namespace incise::cutting
