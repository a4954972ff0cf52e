// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/hand_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"

namespace incise::scenario {
namespace {

using testing::HasSubstr;

Value text(std::string value) { return {.data = std::move(value), .location = {}}; }
Value number(double value) { return {.data = value, .location = {}}; }
Value list(std::initializer_list<Value> values) { return {.data = Array(values), .location = {}}; }
Value point(double x, double y, double z) { return list({number(x), number(y), number(z)}); }
Value table(std::initializer_list<std::pair<std::string, Value>> entries) {
    Table made;
    for (const auto& [key, value] : entries) made.push_back({key, {}, value});
    return {.data = std::move(made), .location = {}};
}

HandTool build(const Value& definition, const std::string& why_no_contact = {}) {
    return build_hand_tool("mine", definition, ".", why_no_contact);
}

std::string refusal_of(const Value& definition, const std::string& why_no_contact = {}) {
    try {
        build(definition, why_no_contact);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

const Value edge = list({point(0, 0, 0), point(0, 0, 0.1)});
const Value ball = table({{"sphere", table({{"radius", number(0.01)}})}});

TEST(HandTool, IsWhatTheKeysOfAScenarioSay) {
    const HandTool blade =
        build(table({{"kind", text("blade")}, {"edge", edge}, {"toughness", number(160.0)}}));
    EXPECT_EQ(blade.kind, "blade");
    const auto& shape = std::get<cutting::Blade>(blade.shape);
    EXPECT_EQ(shape.edge.size(), 2u);
    EXPECT_EQ(shape.toughness, 160.0);
    EXPECT_EQ(shape.mode, cutting::CutMode::split);

    const HandTool jaws = build(table({{"kind", text("grasper")}, {"shape", ball}}));
    EXPECT_TRUE(std::holds_alternative<cutting::Grasper>(jaws.shape));
    const HandTool burr = build(table({{"kind", text("carver")}, {"shape", ball}}));
    EXPECT_TRUE(std::holds_alternative<cutting::Carver>(burr.shape));
    const HandTool thread =
        build(table({{"kind", text("suture")}, {"points", edge}, {"stiffness", number(200.0)}}));
    EXPECT_EQ(std::get<cutting::Suture>(thread.shape).stiffness, 200.0);
    const HandTool plane =
        build(table({{"kind", text("cut")},
                     {"plane", table({{"point", point(0, 0, 0)}, {"normal", point(1, 0, 0)}})}}));
    EXPECT_TRUE(std::holds_alternative<cutting::PlaneCut>(plane.shape));
}

TEST(HandTool, SplitsUnlessToldOtherwise) {
    const Value blade = table({{"kind", text("blade")}, {"edge", edge}});
    const HandTool made = build_hand_tool("mine", blade, ".", "");
    EXPECT_EQ(std::get<cutting::Blade>(made.shape).mode, cutting::CutMode::split);
}

/// True if each line of the text begins with the name of the tool, once.
bool names_the_tool_once(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("tool 'mine'") || line.rfind("tool") != 0) return false;
    return true;
}

TEST(HandTool, IsNamedOnceInEachMessage) {
    const Value tough = table({{"kind", text("blade")},
                               {"edge", edge},
                               {"mode", text("separate")},
                               {"toughness", number(100.0)}});
    const Value of_file =
        table({{"kind", text("cut")}, {"surface", table({{"file", text("none.stl")}})}});
    const Value no_edge = table({{"kind", text("blade")}, {"edge", list({point(0, 0, 0)})}});
    for (const Value& definition : {tough, of_file, no_edge, number(3.0)}) {
        try {
            build_hand_tool("mine", definition, ".", "");
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            EXPECT_TRUE(names_the_tool_once(error.what())) << error.what();
        }
    }
}

TEST(HandTool, RefusesAllThatIsWrongAtOnce) {
    const std::string refusal = refusal_of(table({{"kind", text("blade")},
                                                  {"edge", list({point(0, 0, 0)})},
                                                  {"toughness", number(-1.0)},
                                                  {"path", list({})},
                                                  {"colour", text("red")}}));
    EXPECT_THAT(refusal, HasSubstr("tool 'mine': key 'edge': must have at least 2 points"));
    EXPECT_THAT(refusal, HasSubstr("key 'toughness': -1 is not allowed"));
    EXPECT_THAT(refusal, HasSubstr("key 'path': belongs to a tool of a scenario"));
    EXPECT_THAT(refusal, HasSubstr("colour"));
}

TEST(HandTool, RefusesWhatIsNoToolOrCannotTouch) {
    EXPECT_THAT(refusal_of(number(3.0)), HasSubstr("is the number 3, not a table"));
    EXPECT_THAT(refusal_of(table({})), HasSubstr("'kind'"));
    EXPECT_THAT(refusal_of(table({{"kind", text("scalpel")}})), HasSubstr("blade"));
    EXPECT_THAT(refusal_of(table({{"kind", text("probe")}, {"shape", ball}}), "statics has none"),
                HasSubstr("touches tissue, but statics has none"));
    EXPECT_THAT(
        refusal_of(table({{"kind", text("grasper")}, {"shape", ball}, {"close", number(1)}})),
        HasSubstr("led by hand"));
}

}  // namespace
}  // namespace incise::scenario
