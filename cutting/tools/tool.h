// What a tool is, as plain values in the frame of the tool.
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

/// How a blade cuts: it divides elements where it passes, or it opens the existing faces that lie
/// nearest to where it passes.
enum class CutMode { split, separate };

/// Cuts along what its edge sweeps.
struct Blade {
    std::vector<Vec3> edge;         ///< polyline of two points or more, m
    CutMode mode = CutMode::split;  ///< split is for tetrahedra only
    double snap = default_snap;     ///< of mode split: see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.edge, self.mode, self.snap); }
};

/// Removes the elements whose centres its shape covers.
struct Carver {
    CarverShape shape;
    static void archive(auto& ar, auto& self) { ar(self.shape); }
};

/// Divides elements along a plane, at once. The plane is in the frame of the world.
struct PlaneCut {
    Vec3 point = Vec3::Zero();    ///< m
    Vec3 normal = Vec3::UnitZ();  ///< of any length but zero
    double snap = default_snap;   ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.point, self.normal, self.snap); }
};

/// Divides elements along a triangulated surface, at once. The surface is in the frame of the
/// world, m.
struct SurfaceCut {
    topology::SurfaceData surface;
    double snap = default_snap;  ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.surface, self.snap); }
};

using ToolShape = std::variant<Blade, Carver, PlaneCut, SurfaceCut>;

/// The surface of a PlaneCut or a SurfaceCut; null for other tools.
std::shared_ptr<const CutSurface> cut_surface_of(const ToolShape& shape);

/// The points of a blade's edge, m, for a pose of the blade. `edge` keeps its memory.
void place_edge(const Blade& blade, const Pose& pose, std::vector<Vec3>& edge);

}  // namespace incise::cutting
