// The keys of a blade.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

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

    bool reads_unknown_kinds() const override { return true; }
    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Blade blade;
        blade.edge = read_line(tool, "edge");
        const auto mode = tool.has("mode") ? tool.choice("mode", {modes}) : std::nullopt;
        if (mode) blade.mode = static_cast<CutMode>(*mode);
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
    std::vector<std::vector<Vec3>> edges(const ScriptedTool& tool, double end_time) const override {
        const auto& blade = std::get<Blade>(tool.shape);
        const auto& keys = tool.path.keys();
        std::vector<std::vector<Vec3>> edges;
        const auto add = [&](double time) {
            cutting::place_edge(blade, tool.path.pose(std::min(time, end_time)),
                                edges.emplace_back());
        };
        add(keys.front().time);
        // Where the edge turns, its points move on arcs. Short parts approximate these.
        constexpr double longest_turn = 0.05;
        for (std::size_t key = 1; key < keys.size() && keys[key - 1].time < end_time; ++key) {
            const auto &from = keys[key - 1], &to = keys[key];
            const double turn = from.value.rotation.angularDistance(to.value.rotation);
            const int num_parts = std::max(1, static_cast<int>(std::ceil(turn / longest_turn)));
            for (int part = 1; part < num_parts; ++part)
                add(from.time + part * (to.time - from.time) / num_parts);
            add(to.time);
        }
        return edges;
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
