// Cuts of a mesh at rest, one tool after the other and without dynamics: what `incise cut` does.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/splitter.h"
#include "incise/cutting/tools/carver.h"
#include "incise/cutting/tools/tool.h"
#include "incise/topology/mesh.h"
#include "incise/topology/surface_data.h"

namespace incise::app {

using cutting::CutMode;

/// Tools, in the mesh's unit of length (m).
struct PlaneCut {
    Vec3 point, normal;  ///< the normal is of any length but zero
};
struct SurfaceCut {
    topology::SurfaceData surface;
};
/// A blade's edge, a polyline, that moves straight from pose to pose. Each of its segments sweeps
/// two triangles then, which share the diagonal from its first point before to its second after.
struct SweepCut {
    std::vector<std::vector<Vec3>> poses;  ///< two or more, each of as many points, two or more
};
struct ShapeRemoval {
    cutting::CarverShape shape;
    Vec3 at = Vec3::Zero();  ///< the shape's origin
};

struct CutTool {
    std::string name;  ///< for reports and messages
    std::variant<PlaneCut, SurfaceCut, SweepCut, ShapeRemoval> kind;
};

struct GeometricCutOptions {
    CutMode mode = CutMode::split;        ///< of all tools; split is for tetrahedra only
    double snap = cutting::default_snap;  ///< see cutting::SplitOptions; split mode only
};

/// What one tool did, or all of them.
struct CutCounts {
    /// Split: elements through which the surface passed, of a sweep in each of its stretches.
    /// Separate: elements with a face that opened.
    std::size_t elements_crossed = 0;
    std::size_t elements_added = 0, elements_removed = 0;
    std::size_t nodes_added = 0;       ///< all new ones
    std::size_t nodes_duplicated = 0;  ///< those of them that are copies, where faces opened
    std::size_t nodes_snapped = 0;     ///< counted as on the surface, though they are only near it
    std::size_t faces_opened = 0;
    double cut_area = 0.0;        ///< of one side of the opened faces, m2
    double volume_removed = 0.0;  ///< m3
    double split_seconds = 0.0;   ///< wall time of the splits, nothing else
    /// Largest distance of the opened faces from the tool's surface, m; nothing if no face opened.
    struct Distance {
        double nodes = 0.0;  ///< of their nodes only
        double faces = 0.0;  ///< also of the middles of their edges and their own: more at folds
    };
    std::optional<Distance> surface_distance;
};

struct ToolReport {
    std::string tool;
    CutCounts counts;
    int pieces = 0;  ///< of the body, afterwards
};

struct Piece {
    double volume = 0.0;
    std::size_t elements = 0;
};

/// The body at one moment.
struct CutBody {
    std::size_t elements = 0, nodes = 0;
    double volume = 0.0;
    double min_dihedral_angle = 0.0;  ///< radians
    double min_altitude = 0.0, mean_edge_length = 0.0;
    Vec3 box_min = Vec3::Zero(), box_max = Vec3::Zero();
    /// cutting::step_length; nothing if there are other elements than tetrahedra.
    std::optional<double> step_length;
};

struct GeometricCutReport {
    CutBody before, after;
    std::vector<Piece> pieces;  ///< largest volume first
    CutCounts total;
    std::vector<ToolReport> tools;
    std::vector<std::string> warnings;  ///< tools that cut nothing; one sentence each

    /// |volume after + removed - before| / before.
    double volume_error() const;
    /// Elements added per crossed one; nothing if none was crossed.
    std::optional<double> growth() const;
    std::optional<double> microseconds_per_crossed_element() const;
    /// How much shorter the stable step of the body at rest becomes by the shape of its elements,
    /// if it is of one material.
    std::optional<double> stable_step_ratio() const;
};

/// Applies the tools in their order to the body at rest. Planes, surfaces and sweeps part it;
/// shapes remove the elements whose centres they cover.
///
/// Split: cutting::split, with limits from the mesh as given. Separate: a sweep opens
/// cutting::faces_to_open; planes and surfaces open the faces between elements whose centres are
/// on different sides (of a surface: the straight way between them crosses it an odd number of
/// times).
///
/// Throws InputError, naming the tool, if an element to be split is no tetrahedron, or nothing is
/// left of the body; the mesh then has what the earlier tools did to it.
/// Cost: some microseconds an element, and a tool.
GeometricCutReport geometric_cut(topology::Mesh& mesh, std::span<const CutTool> tools,
                                 const GeometricCutOptions& options);

}  // namespace incise::app
