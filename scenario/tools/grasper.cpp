// The keys of a grasper.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/number_format.h"
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"

namespace incise::scenario {

namespace {

using cutting::Grasper;

constexpr ToolKey grasper_keys[] = {
    {"shape", shape_hint, true},
    {"close", "when its jaws close, seconds, as in close = 0.2", false, true},
    {"open", {}, false, true},
    {"max_force"}};

class GrasperKind final : public ToolKind {
  public:
    GrasperKind()
        : ToolKind(Grasper::traits, grasper_keys,
                   {.why_two_keys = "a grasper is there from the first to the last"}) {}

    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Grasper grasper{cutting::Sphere{1.0}};
        grasper.max_force =
            tool.number("max_force", grasper.max_force, {.low = 0.0, .includes_high = true});
        read_jaw_times(tool, spec);
        if (const auto shape = read_shape_of(tool)) grasper.jaws = *shape;
        spec.shape = grasper;
    }
    void check_times(const TableReader& tool, const ToolSpec& spec, double) const override {
        check_jaw_times(tool, spec);
    }
    std::optional<Extent> extent(const cutting::ToolShape& shape) const override {
        return extent_of(std::get<Grasper>(shape).jaws);
    }
    Table describe(const cutting::ToolShape& shape) const override {
        return {shape_entry(std::get<Grasper>(shape).jaws)};
    }
};

}  // namespace

template <>
struct KindFor<cutting::Grasper> {
    using type = GrasperKind;
};
template const ToolKind& kind_for<cutting::Grasper>();

}  // namespace incise::scenario
