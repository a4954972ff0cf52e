// Definitions of tools, as plain values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/split.h"
#include "incise/cutting/tools/carver.h"
#include "incise/topology/surface_data.h"

namespace incise::cutting {

class CutSurface;

/// The way in which a blade cuts. `split` divides the elements that it passes through. `separate`
/// opens the existing faces that lie nearest to its path.
enum class CutMode { split, separate };

/// What becomes of the force that it takes to cut. `report` only reports it: a blade then cuts all
/// that it meets. `apply` exerts it on the tissue: a blade pushes the tissue in front of it, until
/// the force is reached.
enum class CuttingForce { report, apply };

/// What the kind of a tool tells about it.
struct ToolTraits {
    const char* kind;         ///< its name in scenarios
    bool cuts = false;        ///< it edits the mesh
    bool touches = false;     ///< tissue exerts a force on it, whatever its values are
    bool has_pose = true;     ///< without one it is where the tissue is
    bool is_at_once = false;  ///< it lies in the frame of the world, and cuts in one step
    bool closes = false;      ///< it closes and opens
    bool holds = false;       ///< it holds tissue while it is closed, and can lose it
    const char* article = "a ";
};

/// A tool that cuts along what its edge sweeps. The edge is in the frame of the tool.
struct Blade {
    static constexpr ToolTraits traits{.kind = "blade", .cuts = true};
    std::vector<Vec3> edge;  ///< a polyline of at least two points, m
    CutMode mode = CutMode::split;
    double snap = default_snap;  ///< for mode split: see SplitOptions
    /// Energy that it takes to open an area, J/m2; 0: not known. Areas are current ones.
    double toughness = 0.0;
    CuttingForce cutting_force = CuttingForce::report;  ///< only with a toughness
    static void archive(auto& ar, auto& self) {
        ar(self.edge, self.mode, self.snap, self.toughness, self.cutting_force);
    }
};

/// A tool that removes the elements whose centre its shape covers.
struct Carver {
    static constexpr ToolTraits traits{.kind = "carver", .cuts = true};
    CarverShape shape;
    static void archive(auto& ar, auto& self) { ar(self.shape); }
};

/// A tool that divides elements along a plane, at once. The plane is in the frame of the world.
struct PlaneCut {
    static constexpr ToolTraits traits{.kind = "cut", .cuts = true, .is_at_once = true};
    Vec3 point = Vec3::Zero();    ///< m
    Vec3 normal = Vec3::UnitZ();  ///< of any length above 0
    double snap = default_snap;   ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.point, self.normal, self.snap); }
};

/// A tool that divides elements along a triangulated surface, at once. The surface is in the frame
/// of the world, m.
struct SurfaceCut {
    static constexpr ToolTraits traits{.kind = "cut", .cuts = true, .is_at_once = true};
    topology::SurfaceData surface;
    double snap = default_snap;  ///< see SplitOptions
    static void archive(auto& ar, auto& self) { ar(self.surface, self.snap); }
};

using ProbeShape = std::variant<Sphere, Capsule, Cuboid, HalfSpace, Solid>;

/// A rigid tool that pushes tissue and cuts nothing.
struct Probe {
    static constexpr ToolTraits traits{.kind = "probe", .touches = true};
    ProbeShape shape;
    double friction = 0.0;  ///< Coulomb's coefficient between it and the tissue
    static void archive(auto& ar, auto& self) { ar(self.shape, self.friction); }
};

/// A tool whose jaws hold the surface of the tissue that is in them when they close.
struct Grasper {
    static constexpr ToolTraits traits{
        .kind = "grasper", .touches = true, .closes = true, .holds = true};
    CarverShape jaws;  ///< what they enclose
    /// The largest force that they hold, N; above it tissue slips out of them.
    double max_force = std::numeric_limits<double>::infinity();
    static void archive(auto& ar, auto& self) { ar(self.jaws, self.max_force); }
};

/// A thread through points of the tissue, which it draws together. It slides through all of them,
/// so that its tension is everywhere the same, and it bears no pressure.
struct Suture {
    static constexpr ToolTraits traits{.kind = "suture", .touches = true, .has_pose = false};
    std::vector<Vec3> points;  ///< in order, at least two, where the tissue is at rest, m
    double stiffness = 0.0;    ///< of the whole thread, N/m
    /// Above it the thread tears, N.
    double max_force = std::numeric_limits<double>::infinity();
    /// How far from a point the tissue may be, m; a point that lies outside moves to it. 0: the
    /// mean length of an element.
    double reach = 0.0;
    static void archive(auto& ar, auto& self) {
        ar(self.points, self.stiffness, self.max_force, self.reach);
    }
};

/// Two blades that turn about the origin of the tool, in the plane of its axes x and z, and point
/// along -z. While they close they cut the triangle between the pivot and the tips of the open
/// blades, on a line that goes evenly from the pivot to the tips.
struct Scissors {
    static constexpr ToolTraits traits{
        .kind = "scissors", .cuts = true, .closes = true, .article = ""};
    static constexpr double least_angle = 0.01, largest_angle = 2.5;  ///< rad, the second excluded
    double length = 0.0;         ///< of a blade, from the pivot to its tip, m
    double angle = 0.6;          ///< between the blades when they are open, rad
    double closing_time = 0.2;   ///< from open to closed, s; they open as fast
    double snap = default_snap;  ///< see SplitOptions
    static void archive(auto& ar, auto& self) {
        ar(self.length, self.angle, self.closing_time, self.snap);
    }
};

using ToolShape =
    std::variant<Blade, Carver, PlaneCut, SurfaceCut, Probe, Grasper, Suture, Scissors>;

/// Returns what the kind of a tool tells about it.
inline const ToolTraits& traits_of(const ToolShape& shape) {
    return std::visit([](const auto& tool) -> const ToolTraits& { return tool.traits; }, shape);
}

/// True for tools that tissue exerts a known force on: those that touch it, and those with a
/// toughness.
inline bool feels_force(const ToolShape& shape) {
    return std::visit(
        [](const auto& tool) {
            if constexpr (requires { tool.toughness; })
                return tool.traits.touches || tool.toughness > 0.0;
            else
                return tool.traits.touches;
        },
        shape);
}

/// Returns the surface of a PlaneCut or a SurfaceCut, and null for other tools.
std::shared_ptr<const CutSurface> cut_surface_of(const ToolShape& shape);

/// Returns the line along which scissors cut, in their frame, m: from one open blade to the other,
/// at this share of their length.
/// @param closed  from 0, open, to 1, closed
std::array<Vec3, 2> meeting_line(const Scissors& scissors, double closed);

/// Sets `edge` to the points of a blade's edge at a pose of the blade, m. Memory of `edge` is
/// reused.
void place_edge(const Blade& blade, const Pose& pose, std::vector<Vec3>& edge);

}  // namespace incise::cutting
