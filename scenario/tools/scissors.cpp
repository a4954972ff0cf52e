// The keys of scissors.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "incise/base/number_format.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"

namespace incise::scenario {

namespace {

using cutting::Scissors;

constexpr ToolKey scissors_keys[] = {
    {"length", "from the pivot to the tips, m, as in length = 0.02", true},
    {"angle", {}, true},
    {"closing_time"},
    {"snap"},
    {"close", "when they begin to close, seconds, as in close = 0.2", false, true},
    {"open", {}, false, true}};
constexpr Limits angle_limits{
    .low = Scissors::least_angle, .high = Scissors::largest_angle, .includes_low = true};

class ScissorsKind final : public ToolKind {
  public:
    ScissorsKind()
        : ToolKind(Scissors::traits, scissors_keys,
                   {.why_two_keys = "scissors are there from the first to the last"}) {}

    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Scissors scissors;
        scissors.length = tool.number("length", 1.0, limits::positive);
        scissors.angle = tool.number("angle", scissors.angle, angle_limits);
        scissors.closing_time =
            tool.number("closing_time", scissors.closing_time, limits::positive);
        scissors.snap = read_snap(tool);
        read_jaw_times(tool, spec);
        spec.shape = scissors;
    }
    void check_times(const TableReader& tool, const ToolSpec& spec,
                     double end_time) const override {
        check_jaw_times(tool, spec);
        if (spec.path.empty() || !tool.is_sound("close") || !tool.is_sound("closing_time")) return;
        const double whole = std::get<Scissors>(spec.shape).closing_time;
        double end = std::min(spec.path.back().time, spec.open.value_or(spec.path.back().time));
        if (end_time > 0.0) end = std::min(end, end_time);
        const double part = (end - *spec.close) / whole;
        constexpr double rounding = 1e-9;
        if (part < 1.0 - rounding)
            tool.warning("close",
                         "tool " + in_quotes(spec.name) + " closes by " +
                             format_number(std::floor(100.0 * std::max(part, 0.0) + rounding)) +
                             " % only, until " + format_number(end) +
                             " s: begin earlier, or use a shorter closing_time");
    }
    std::vector<std::vector<Vec3>> edges(const ScriptedTool& tool, double end_time) const override {
        const auto& scissors = std::get<Scissors>(tool.shape);
        std::vector<std::vector<Vec3>> edges;
        constexpr int num_parts = 16;  // they may move and turn while they close
        for (int part = 0; part <= num_parts && tool.close; ++part) {
            const double closed = static_cast<double>(part) / num_parts;
            const double time = *tool.close + closed * scissors.closing_time;
            if (time > std::min({end_time, tool.path.last_time(), tool.open.value_or(time)})) break;
            std::vector<Vec3>& edge = edges.emplace_back();
            for (const Vec3& x : cutting::meeting_line(scissors, closed))
                edge.push_back(tool.path.pose(time).to_world(x));
        }
        return edges;
    }
    std::optional<Extent> extent(const cutting::ToolShape& shape) const override {
        Extent extent{{Vec3::Zero()}};
        for (const Vec3& tip : cutting::meeting_line(std::get<Scissors>(shape), 1.0))
            extent.points.push_back(tip);
        return extent;
    }
    Table describe(const cutting::ToolShape& shape) const override {
        const auto& scissors = std::get<Scissors>(shape);
        return {{"length", {}, value_of(scissors.length)}, {"angle", {}, value_of(scissors.angle)}};
    }
};

}  // namespace

template <>
struct KindFor<Scissors> {
    using type = ScissorsKind;
};
template const ToolKind& kind_for<Scissors>();

}  // namespace incise::scenario
