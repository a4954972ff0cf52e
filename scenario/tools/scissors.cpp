// The keys of scissors.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

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
constexpr Limits angle_limits{.low = 0.0, .high = Scissors::largest_angle};

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
    void check_times(const TableReader& tool, const ToolSpec& spec, double) const override {
        check_jaw_times(tool, spec);
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
