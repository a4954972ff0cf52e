// Definitions of tools, as plain values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

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

using ToolShape = std::variant<Blade, Carver, PlaneCut, SurfaceCut, Probe>;

/// Returns the surface of a PlaneCut or a SurfaceCut, and null for other tools.
std::shared_ptr<const CutSurface> cut_surface_of(const ToolShape& shape);

/// Sets `edge` to the points of a blade's edge at a pose of the blade, m. Memory of `edge` is
/// reused.
void place_edge(const Blade& blade, const Pose& pose, std::vector<Vec3>& edge);

}  // namespace incise::cutting
