// Definitions of tools, as plain values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/splitter.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/tools/carver.h"
#include "incise/topology/surface_data.h"

namespace incise::cutting {

/// The way in which a blade cuts. `split` divides the elements that it passes through. `separate`
/// opens the existing faces that lie nearest to its path.
enum class CutMode { split, separate };

/// A tool that cuts along what its edge sweeps. The edge is in the frame of the tool.
struct Blade {
    std::vector<Vec3> edge;         ///< a polyline of at least two points, m
    CutMode mode = CutMode::split;  ///< split is for tetrahedra only
    double snap = default_snap;     ///< for mode split: see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.edge, self.mode, self.snap); }
};

/// A tool that removes the elements whose centre its shape covers.
struct Carver {
    CarverShape shape;
    static void archive(auto& ar, auto& self) { ar(self.shape); }
};

/// A tool that divides elements along a plane, at once. The plane is in the frame of the world.
struct PlaneCut {
    Vec3 point = Vec3::Zero();    ///< m
    Vec3 normal = Vec3::UnitZ();  ///< of any length above 0
    double snap = default_snap;   ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.point, self.normal, self.snap); }
};

/// A tool that divides elements along a triangulated surface, at once. The surface is in the frame
/// of the world, m.
struct SurfaceCut {
    topology::SurfaceData surface;
    double snap = default_snap;  ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.surface, self.snap); }
};

using ProbeShape = std::variant<Sphere, Capsule, Cuboid, HalfSpace>;

/// A rigid tool that pushes tissue and cuts nothing.
struct Probe {
    ProbeShape shape;
    double friction = 0.0;  ///< Coulomb's coefficient between it and the tissue
    static void archive(auto& ar, auto& self) { ar(self.shape, self.friction); }
};

/// A tool whose jaws hold the surface of the tissue that is in them when they close.
struct Grasper {
    CarverShape jaws;  ///< what they enclose
    /// The largest force that they hold, N; above it tissue slips out of them.
    double max_force = std::numeric_limits<double>::infinity();
    static void archive(auto& ar, auto& self) { ar(self.jaws, self.max_force); }
};

using ToolShape = std::variant<Blade, Carver, PlaneCut, SurfaceCut, Probe, Grasper>;

/// True for tools that tissue exerts a force on: probes and graspers.
inline bool feels_force(const ToolShape& shape) {
    return std::holds_alternative<Probe>(shape) || std::holds_alternative<Grasper>(shape);
}

/// Returns the surface of a PlaneCut or a SurfaceCut, and null for other tools.
std::shared_ptr<const CutSurface> cut_surface_of(const ToolShape& shape);

/// Sets `edge` to the points of a blade's edge at a pose of the blade, m. Memory of `edge` is
/// reused.
void place_edge(const Blade& blade, const Pose& pose, std::vector<Vec3>& edge);

}  // namespace incise::cutting
