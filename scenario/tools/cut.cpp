// The keys of a cut along a plane or a surface.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/surface_check.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"

namespace incise::scenario {

namespace {

constexpr ToolKey cut_keys[] = {
    {"plane", {}, true}, {"surface", {}, true}, {"scale", {}, true}, {"snap"}};
constexpr std::string_view plane_keys[] = {"point", "normal"};

class CutKind final : public ToolKind {
  public:
    CutKind()
        : ToolKind(cutting::PlaneCut::traits, cut_keys,
                   {.time_hint = "when it cuts, seconds, as in time = 0.5",
                    .why_no_path = "belongs to a blade: leave it out"}) {}

    bool reads_unknown_kinds() const override { return true; }
    bool has_all(const TableReader& tool) const override {
        return tool.one_of({"plane", "surface"}).has_value();
    }
    void read(const TableReader& tool, const std::filesystem::path& folder,
              ToolSpec& spec) const override {
        cutting::PlaneCut cut;
        cut.snap = read_snap(tool);
        if (const auto plane = tool.table("plane", {plane_keys})) {
            plane->require("point", "a point of the plane, as in point = [0, 0, 0]");
            plane->require("normal", "across the plane, as in normal = [1, 0, 0]");
            cut.point = plane->vector("point");
            cut.normal = plane->direction("normal", Vec3::UnitZ());
        }
        spec.shape = cut;
        const double scale = tool.number("scale", 1.0, limits::positive);
        if (tool.has("surface")) {
            auto file =
                read_file_name(tool, "surface", folder, "surface file (STL, OBJ, PLY or OFF)");
            spec.shape = cutting::SurfaceCut{{}, cut.snap};
            if (tool.is_sound("surface"))
                spec.surface = {std::move(file), scale, tool.location_text("surface")};
        }
        if (tool.has("scale") && tool.has("plane") && !tool.has("surface"))
            tool.error("scale", "is for surfaces: leave it out");
    }
    void take_surface(const topology::SurfaceData& surface, double scale, cutting::ToolShape& shape,
                      std::vector<std::string>& warnings) const override {
        // They name places with the coordinates of the file.
        for (const auto& defect : cutting::defects_of_surface(surface)) warnings.push_back(defect);
        topology::SurfaceData scaled = surface;
        for (Vec3& x : scaled.points) x *= scale;
        std::get<cutting::SurfaceCut>(shape).surface = std::move(scaled);
    }
};

}  // namespace

template <>
struct KindFor<cutting::PlaneCut> {
    using type = CutKind;
};
template const ToolKind& kind_for<cutting::PlaneCut>();

template <>
struct KindFor<cutting::SurfaceCut> {
    using type = CutKind;
};
template const ToolKind& kind_for<cutting::SurfaceCut>();

}  // namespace incise::scenario
