// The keys of a suture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sstream>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"
#include "incise/topology/cell_point.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::scenario {

namespace {

using cutting::Suture;

constexpr ToolKey suture_keys[] = {
    {"points", "a line of points at rest, as in points = [[0, 0, 0], [0.01, 0, 0]]", true},
    {"stiffness", "of the thread, N/m, as in stiffness = 200"},
    {"reach"},
    {"tighten", {}, false, true},
    {"max_force"}};
constexpr std::string_view tighten_keys[] = {"over", "length"};

class SutureKind final : public ToolKind {
  public:
    SutureKind()
        : ToolKind(
              Suture::traits, suture_keys,
              {.time_hint = "when it is tied, seconds, as in time = 0.5",
               .why_no_path = "a suture has none: its points are in the tissue; leave it out"}) {}

    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Suture suture;
        suture.points = read_line(tool, "points");
        suture.stiffness = tool.number("stiffness", 1.0, limits::positive);
        suture.max_force =
            tool.number("max_force", suture.max_force, {.low = 0.0, .includes_high = true});
        suture.reach = tool.number("reach", 0.0, limits::positive);
        if (const auto tighten = tool.table("tighten", {tighten_keys})) {
            tighten->require("length", "to which the thread is drawn, m, as in length = 0.001");
            tighten->require("over", "how long it is drawn, seconds, as in over = 0.2");
            spec.over = tighten->number("over", 1.0, limits::positive);
            spec.length = tighten->number_if_given("length", limits::non_negative);
        }
        spec.shape = std::move(suture);
    }
    void check_times(const TableReader& tool, const ToolSpec& spec,
                     double end_time) const override {
        if (!(end_time > 0.0) || spec.path.empty()) return;
        const double time = spec.path.front().time;
        if (time == end_time)
            tool.warning("time", "tool " + in_quotes(spec.name) + " is tied at the end of the run");
        else if (spec.length && time < end_time && time + spec.over > end_time)
            tool.warning("tighten", "tool " + in_quotes(spec.name) + " is drawn until " +
                                        format_number(time + spec.over) + " s, after the end at " +
                                        format_number(end_time) + " s");
    }
    void require_fit(const ScriptedTool& tool, const topology::Mesh& mesh) const override {
        const auto& suture = std::get<Suture>(tool.shape);
        const double reach =
            suture.reach > 0.0 ? suture.reach : topology::mean_element_length(mesh);
        for (std::size_t i = 0; i < suture.points.size(); ++i) {
            const Vec3& x = suture.points[i];
            if (topology::find_point(mesh, mesh.rest_positions(), x, reach)) continue;
            std::ostringstream text;
            text << "tool '" << tool.name << "': point " << i << " (from 0), [" << x.x() << ", "
                 << x.y() << ", " << x.z() << "], is farther than its reach, "
                 << format_number(reach)
                 << " m, from the body at rest; check its coordinates and units";
            throw InputError(text.str());
        }
    }
};

}  // namespace

template <>
struct KindFor<cutting::Suture> {
    using type = SutureKind;
};
template const ToolKind& kind_for<cutting::Suture>();

}  // namespace incise::scenario
