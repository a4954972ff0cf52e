// Cuts of a body at rest, one tool after the other and without dynamics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/rest/body_measures.h"
#include "incise/cutting/tools/tool.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"

namespace incise::cutting {

/// The edge of a blade, a polyline, whose points move along straight lines from pose to pose. From
/// one pose to the next, each segment sweeps two triangles. The triangles share the diagonal from
/// the first point of the segment before the motion to the second point after it.
struct Sweep {
    /// At least two poses. All have the same number of points, at least two.
    std::vector<std::vector<Vec3>> poses;
    double snap = default_snap;  ///< see SplitOptions
};
/// Removal of the elements whose centres a shape covers.
struct Removal {
    CarverShape shape;
    Vec3 at = Vec3::Zero();  ///< position of the origin of the shape, m
};

/// A tool that cuts a body at rest, with its name. The points of a sweep and of the tools at once
/// are in the frame of the mesh, m.
struct RestTool {
    std::string name;  ///< for reports and messages
    std::variant<PlaneCut, SurfaceCut, Sweep, Removal> kind;
};

/// Counts of the changes by one tool, or by all tools together.
struct CutCounts {
    /// With CutMode::split, the elements through which the surface passed. For a sweep this is the
    /// sum over the motions from pose to pose. With CutMode::separate, the elements with a face
    /// that was opened.
    std::size_t elements_crossed = 0;
    std::size_t elements_added = 0, elements_removed = 0;
    std::size_t nodes_added = 0;       ///< all new nodes
    std::size_t nodes_duplicated = 0;  ///< of these, the copies at opened faces
    std::size_t nodes_snapped = 0;     ///< nodes near the surface that were treated as on it
    std::size_t faces_opened = 0;
    double cut_area = 0.0;  ///< of one side of the opened faces, m2
    /// Angle between the opened faces and the plane, radians, weighted by area. Not set unless the
    /// tool is a plane.
    std::optional<double> mean_angle;
    double volume_removed = 0.0;  ///< m3
    double split_seconds = 0.0;   ///< wall time of the splits only, s
    /// Largest distance of the opened faces from the surface of the tool, m. Not set if no face was
    /// opened.
    struct Distance {
        double nodes = 0.0;  ///< at the nodes of the faces
        double faces = 0.0;  ///< also at the midpoints of edges and faces: larger at folds
    };
    std::optional<Distance> surface_distance;
};

/// The changes by one tool.
struct ToolReport {
    std::string tool;
    CutCounts counts;
    int pieces = 0;  ///< connected components of the body after the tool
};

/// What cut_at_rest() has done.
struct RestCutReport {
    BodyMeasures before, after;
    std::vector<Piece> pieces;  ///< largest volume first
    CutCounts total;
    std::vector<ToolReport> tools;
    /// The body after the cuts, with its carriers: fragments::carriers_of(). Its points may
    /// coincide if nodes were duplicated.
    topology::MeshData mesh;
    std::vector<std::string> warnings;  ///< one sentence for each tool that cut nothing

    /// Returns |volume after + volume removed - volume before| / volume before.
    double volume_error() const;
    /// Returns the number of added elements per crossed element, or nothing if none was crossed.
    std::optional<double> growth() const;
    /// Returns the wall time of the splits per crossed element, us, or nothing if there was no
    /// split.
    std::optional<double> microseconds_per_crossed_element() const;
    /// Returns the stable step at rest after the cuts, divided by that before, for a body of one
    /// material. Returns nothing if nothing is left.
    std::optional<double> stable_step_ratio() const;
};

/// Applies the tools in their order to a body at rest. Planes, surfaces and sweeps cut the body.
/// Shapes remove the elements whose centres they cover.
///
/// With CutMode::split, tools divide elements by Cutter::split(), with their snap. With
/// CutMode::separate, a sweep opens faces_to_open(). Planes and surfaces open the faces between
/// elements whose centres are on different sides. Two points are on different sides of a surface if
/// the straight line between them crosses it an odd number of times.
///
/// Throws InputError with the name of the tool if no element of the body is left. The mesh then has
/// the changes by the tools before it, and the removal of the last element.
/// Cost: some microseconds for each element and tool.
RestCutReport cut_at_rest(topology::Mesh& mesh, std::span<const RestTool> tools, CutMode mode);

}  // namespace incise::cutting
