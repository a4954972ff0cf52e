// The keys of a probe, and of an obstacle, which is a probe that is always there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sstream>

#include "incise/base/error.h"
#include "incise/cutting/tools/probe_shape.h"
#include "incise/cutting/tools/solid.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::scenario {

namespace {

using cutting::Probe;

constexpr ToolKey probe_keys[] = {{"shape", shape_hint, true}, {"friction"}};
constexpr std::string_view solid_keys[] = {"half_space", "sphere", "capsule", "box", "surface"};
constexpr std::span<const std::string_view> without_half_space = std::span(solid_keys).subspan(1);
constexpr std::string_view solid_file_keys[] = {"file", "scale"};
constexpr std::string_view plane_side_keys[] = {"point", "normal"};

/// Reads the keys of a probe or an obstacle. Without a sound one, the shape is a ball.
void read_solid(const TableReader& tool, bool is_obstacle, const std::filesystem::path& folder,
                ToolSpec& spec) {
    Probe probe{cutting::Sphere{1.0}};
    probe.friction = tool.number("friction", probe.friction, limits::non_negative);
    const auto shape =
        is_obstacle ? tool.table("shape", {solid_keys}) : tool.table("shape", {without_half_space});
    if (shape) {
        if (is_obstacle)
            shape->one_of({"half_space", "sphere", "capsule", "box", "surface"});
        else
            shape->one_of({"sphere", "capsule", "box", "surface"});
        if (const auto found = read_simple_shape(*shape))
            std::visit([&](const auto& one) { probe.shape = one; }, *found);
        if (const auto surface = shape->table("surface", {solid_file_keys})) {
            surface->require("file", "a closed surface, as in file = \"probe.stl\"");
            auto file =
                read_file_name(*surface, "file", folder, "surface file (STL, OBJ, PLY or OFF)");
            const double scale = surface->number("scale", 1.0, limits::positive);
            if (surface->has("file") && surface->is_sound("file"))
                spec.surface = {std::move(file), scale, surface->location_text("file")};
        }
        if (const auto half_space =
                is_obstacle ? shape->table("half_space", {plane_side_keys}) : std::nullopt) {
            half_space->require("point", "a point of its surface, as in point = [0, 0, 0]");
            half_space->require("normal", "towards the free side, as in normal = [0, 0, 1]");
            probe.shape = cutting::HalfSpace{half_space->vector("point"),
                                             half_space->direction("normal", Vec3::UnitZ())};
        }
    }
    spec.shape = std::move(probe);
}

Entry described(const cutting::ProbeShape& shape) {
    if (const auto* space = std::get_if<cutting::HalfSpace>(&shape))
        return {"shape",
                {},
                value_of(Table{{"plane",
                                {},
                                value_of(Table{{"point", {}, value_of(space->point)},
                                               {"normal", {}, value_of(space->normal)}})}})};
    if (const auto* solid = std::get_if<cutting::Solid>(&shape)) {
        Array triangles;
        for (const auto& triangle : solid->surface.triangles) {
            Array corners;
            for (const std::int64_t corner : triangle) corners.push_back({corner, {}});
            triangles.push_back({std::move(corners), {}});
        }
        return {"shape",
                {},
                value_of(Table{{"mesh",
                                {},
                                value_of(Table{{"points", {}, value_of(solid->surface.points)},
                                               {"triangles", {}, {std::move(triangles), {}}}})}})};
    }
    return shape_entry(std::visit(
        [](const auto& one) -> cutting::CarverShape {
            if constexpr (std::is_constructible_v<cutting::CarverShape, decltype(one)>) return one;
            return cutting::Sphere{1.0};
        },
        shape));
}

class ProbeKind final : public ToolKind {
  public:
    ProbeKind()
        : ToolKind(Probe::traits, probe_keys,
                   {.why_two_keys = "a probe is there from the first to the last; for one that is "
                                    "always there, write an [[obstacle]]"}) {}

    void read(const TableReader& tool, const std::filesystem::path& folder,
              ToolSpec& spec) const override {
        read_solid(tool, false, folder, spec);
    }
    std::string advice_on(std::string_view key) const override {
        if (key != "surface") return "";
        return "goes into the shape, as in shape = { surface = { file = \"probe.stl\" } }";
    }
    void take_surface(const topology::SurfaceData& surface, double scale, cutting::ToolShape& shape,
                      std::vector<std::string>& warnings) const override {
        topology::SurfaceData scaled = surface;
        for (Vec3& x : scaled.points) x *= scale;
        bool was_turned = false;
        cutting::Solid solid = cutting::make_solid(scaled, was_turned);
        if (was_turned) warnings.push_back("its triangles face inwards, and are turned");
        if (const std::string fault = cutting::fault_of(solid); !fault.empty())
            throw InputError(fault);
        std::get<Probe>(shape).shape = std::move(solid);
    }
    std::optional<std::string> warning_of_begin(const ScriptedTool& tool,
                                                const topology::Mesh& mesh) const override;
    std::optional<Extent> extent(const cutting::ToolShape& shape) const override {
        const cutting::ProbeShape& of_probe = std::get<Probe>(shape).shape;
        if (std::holds_alternative<cutting::HalfSpace>(of_probe)) return std::nullopt;
        if (const auto* solid = std::get_if<cutting::Solid>(&of_probe))
            return Extent{solid->surface.points};
        if (const auto* sphere = std::get_if<cutting::Sphere>(&of_probe)) return extent_of(*sphere);
        if (const auto* capsule = std::get_if<cutting::Capsule>(&of_probe))
            return extent_of(*capsule);
        return extent_of(std::get<cutting::Cuboid>(of_probe));
    }
    Table describe(const cutting::ToolShape& shape) const override {
        return {described(std::get<Probe>(shape).shape)};
    }
};

// Cost: O(#nodes).
std::optional<std::string> ProbeKind::warning_of_begin(const ScriptedTool& tool,
                                                       const topology::Mesh& mesh) const {
    if (tool.path.keys().empty()) return std::nullopt;
    const cutting::ProbeShape& shape = std::get<Probe>(tool.shape).shape;
    const Pose& pose = tool.path.keys().front().value;
    const double size = topology::mean_element_length(mesh);
    const Vec3 margin = Vec3::Constant(1e-3 * size);
    const Box box = cutting::box_of(shape);
    std::size_t count = 0;
    Vec3 first = Vec3::Zero();
    for (const VertexId n : mesh.nodes()) {
        const Vec3 x = pose.to_tool(mesh.rest_position(n));
        // What lies on the surface is not inside.
        if (!Box(box.min() + margin, box.max() - margin).contains(x)) continue;
        if (!cutting::is_inside(shape, x)) continue;
        if (const auto* half_space = std::get_if<cutting::HalfSpace>(&shape);
            half_space && half_space->normal.dot(x - half_space->point) > -1e-3 * size)
            continue;
        if (count++ == 0) first = mesh.rest_position(n);
    }
    if (count == 0) return std::nullopt;
    std::ostringstream text;
    text << "tool '" << tool.name << "' has " << count << (count == 1 ? " point" : " points")
         << " of the body at rest inside it where its path begins, one of them at [" << first.x()
         << ", " << first.y() << ", " << first.z()
         << "]: such tissue is pushed out slowly or not at all; let the path begin outside";
    return text.str();
}

}  // namespace

template <>
struct KindFor<cutting::Probe> {
    using type = ProbeKind;
};
template const ToolKind& kind_for<cutting::Probe>();

void read_obstacle(const TableReader& obstacle, const std::filesystem::path& folder,
                   ToolSpec& spec) {
    read_solid(obstacle, true, folder, spec);
}

}  // namespace incise::scenario
