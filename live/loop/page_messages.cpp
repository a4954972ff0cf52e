// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/page_messages.h"

#include <algorithm>
#include <utility>

#include "incise/scenario/tools/tool_kind.h"

namespace incise::live {

namespace {

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const Pose& pose) {
    Json json;
    add_pose(json, pose);
    return json;
}

}  // namespace

std::string message_text(std::string_view level, const std::string& text) {
    return text_of(Json{{"type", "message"}, {"level", level}, {"text", text}});
}

PageMessages::PageMessages(const Session& session, const PictureMaker& pictures)
    : session_(session), pictures_(pictures) {
    const auto& specs = session.simulation().scenario().tools;
    for (std::size_t i = 0; i < specs.size(); ++i) {
        const sim::ToolId id = session.world().tools()[i];
        if (const auto definition = scenario::definition_of(session.world().tool(id).shape))
            scripted_tools_.push_back(
                {id, specs[i].name, specs[i].is_obstacle, live::json_of(*definition)});
    }
}

std::string PageMessages::hello(bool is_operator) const {
    const topology::Mesh& mesh = session_.world().mesh();
    Eigen::AlignedBox3d box;  // at rest: pieces may be far away by now
    for (const VertexId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    Json hello = {{"type", "hello"},
                  {"title", session_.simulation().scenario().title},
                  {"tick", session_.tick_length()},
                  {"role", is_operator ? "operator" : "watcher"},
                  {"size", {json_of(Vec3(box.min())), json_of(Vec3(box.max()))}},
                  {"element_size", session_.element_size()},
                  {"has_contact", session_.has_contact()},
                  {"recording", session_.simulation().scenario().name + ".jsonl"},
                  {"regions", Json::array()},
                  {"fields", Json::array()},
                  {"scripted_tools", Json::array()},
                  {"kinds", Json::array()}};
    for (const scenario::ToolKind* kind : scenario::tool_kinds()) {
        const cutting::ToolTraits& traits = kind->traits();
        if (!traits.is_at_once && (session_.has_contact() || !traits.touches))
            hello["kinds"].push_back(kind->name());
    }
    for (const int region : pictures_.mesh().regions())
        hello["regions"].push_back({{"id", region}, {"name", "region " + std::to_string(region)}});
    for (const ShownField& field : PictureMaker::fields())
        hello["fields"].push_back({{"name", field.name}, {"unit", field.unit}});
    for (const ScriptedTool& tool : scripted_tools_)
        hello["scripted_tools"].push_back({{"name", tool.name},
                                           {"kind", tool.definition["kind"]},
                                           {"is_obstacle", tool.is_obstacle},
                                           {"tool", tool.definition}});
    return text_of(hello);
}

std::string PageMessages::state(const LoopState& loop) {
    const sim::World& world = session_.world();
    const sim::BodyTotals& last = world.ledger().last();
    const auto& edits = session_.simulation().edits();
    for (; num_edits_counted_ < edits.size(); ++num_edits_counted_)
        cut_area_ += edits[num_edits_counted_].cut_area;
    Json state = {{"type", "state"},
                  {"tick", session_.num_ticks()},
                  {"time", world.time()},
                  {"paused", loop.is_paused},
                  {"speed", loop.speed},
                  {"factor", loop.factor},
                  {"step", session_.simulation().time_step()},
                  {"nodes", last.nodes},
                  {"elements", last.elements},
                  {"components", last.components},
                  {"edits", edits.size()},
                  {"cut_area", cut_area_},
                  {"mass", last.totals.mass},
                  {"field", pictures_.field()},
                  {"can_undo", loop.can_undo},
                  {"tools", Json::array()},
                  {"scripted", Json::array()}};
    for (const ScriptedTool& tool : scripted_tools_) state["scripted"].push_back(state_of(tool));
    for (const LedTool& tool : session_.tools()) {
        const bool is_there =
            tool.kind == "suture" ? world.is_suture_tied(tool.id) : tool.is_in_hand;
        if (is_there) state["tools"].push_back(state_of(tool, loop));
    }
    return text_of(state);
}

Json PageMessages::state_of(const ScriptedTool& tool) const {
    const sim::World& world = session_.world();
    if (!world.is_tool_present(tool.id)) return {{"present", false}};
    Json state = {{"present", true}, {"pose", json_of(world.tool_pose(tool.id))}};
    if (cutting::traits_of(world.tool(tool.id).shape).closes)
        state["closed"] = world.is_tool_closed(tool.id);
    if (cutting::feels_force(world.tool(tool.id).shape))
        state["force"] = json_of(session_.tool_forces().of(tool.id).force);
    return state;
}

Json PageMessages::state_of(const LedTool& tool, const LoopState& loop) const {
    const sim::World& world = session_.world();
    const bool is_suture = tool.kind == "suture";
    Json state = {{"name", tool.name},
                  {"kind", tool.kind},
                  {"tool", live::json_of(tool.definition)},
                  {"present", world.is_tool_present(tool.id)},
                  {"mine", tool.name == loop.in_hand},
                  {"pose", json_of(is_suture ? Pose() : world.tool_pose(tool.id))}};
    if (is_suture) state["length"] = world.suture_length(tool.id);
    if (cutting::feels_force(world.tool(tool.id).shape)) {
        const auto [force, torque] = session_.tool_forces().of(tool.id);
        state["force"] = json_of(force);
        state["torque"] = json_of(torque);
    }
    const cutting::ToolTraits& traits = cutting::traits_of(world.tool(tool.id).shape);
    if (traits.holds) state["held"] = world.num_held(tool.id);
    if (traits.closes) state["closed"] = world.is_tool_closed(tool.id);
    return state;
}

void PageMessages::forget_edits() {
    cut_area_ = 0.0;
    num_edits_counted_ = 0;
}

}  // namespace incise::live
