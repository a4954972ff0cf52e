// The keys of a blade.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"

namespace incise::scenario {

namespace {

using cutting::Blade;

constexpr ToolKey blade_keys[] = {
    {"edge", "a line of points, as in edge = [[-0.01, 0, 0], [0.01, 0, 0]]", true},
    {"mode"},
    {"snap"},
    {"toughness"},
    {"cutting_force"}};
constexpr std::string_view modes[] = {"split", "separate"};         // in the order of CutMode
constexpr std::string_view cutting_forces[] = {"report", "apply"};  // in that of CuttingForce

class BladeKind final : public ToolKind {
  public:
    BladeKind()
        : ToolKind(Blade::traits, blade_keys, {.why_two_keys = "a blade cuts where it moves"}) {}

    bool is_suggested_by(const TableReader& tool) const override { return tool.has("edge"); }
    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Blade blade;
        blade.edge = read_line(tool, "edge");
        const auto mode = tool.has("mode") ? tool.choice("mode", {modes}) : std::nullopt;
        if (mode) blade.mode = static_cast<CutMode>(*mode);
        spec.has_usual_mode = !mode;
        blade.toughness = tool.number("toughness", 0.0, limits::positive);
        if (const auto force = tool.choice("cutting_force", {cutting_forces}))
            blade.cutting_force = static_cast<cutting::CuttingForce>(*force);
        if (tool.has("cutting_force"))
            tool.require("toughness", "energy to open an area, J/m2, as in toughness = 160");
        blade.snap = read_snap(tool);
        if (mode && blade.mode == CutMode::separate)
            for (const char* key : {"toughness", "snap"})
                if (tool.has(key)) tool.error(key, "belongs to mode = \"split\": leave it out");
        spec.shape = std::move(blade);
    }
    std::optional<Extent> extent(const cutting::ToolShape& shape) const override {
        return Extent{std::get<Blade>(shape).edge};
    }
    Table describe(const cutting::ToolShape& shape) const override {
        return {{"edge", {}, value_of(std::get<Blade>(shape).edge)}};
    }
};

}  // namespace

template <>
struct KindFor<cutting::Blade> {
    using type = BladeKind;
};
template const ToolKind& kind_for<cutting::Blade>();

}  // namespace incise::scenario
