// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/json_values.h"

#include <cmath>
#include <limits>

#include "incise/base/error.h"

namespace incise::live {

namespace {

[[noreturn]] void refuse(std::string_view key, const std::string& text) {
    throw InputError("'" + std::string(key) + "': " + text);
}

scenario::Value value_of(const Json& json, int depth) {
    constexpr int most_nested = 16;
    if (depth > most_nested) throw InputError("the values are nested too deeply");
    scenario::Value value;
    switch (json.type()) {
        case Json::value_t::boolean:
            value.data = json.get<bool>();
            break;
        case Json::value_t::number_integer:
            value.data = json.get<std::int64_t>();
            break;
        case Json::value_t::number_unsigned:
            if (json.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()})
                value.data = json.get<double>();
            else
                value.data = json.get<std::int64_t>();
            break;
        case Json::value_t::number_float:
            value.data = json.get<double>();
            break;
        case Json::value_t::string:
            value.data = json.get<std::string>();
            break;
        case Json::value_t::array: {
            scenario::Array array;
            for (const Json& item : json) array.push_back(value_of(item, depth + 1));
            value.data = std::move(array);
            break;
        }
        case Json::value_t::object: {
            scenario::Table table;
            for (const auto& [key, item] : json.items())
                table.push_back({key, {}, value_of(item, depth + 1)});
            value.data = std::move(table);
            break;
        }
        default:
            throw InputError("null is no value: leave the key out");
    }
    return value;
}

Json named(const char* verb, const std::string& name) { return {{verb, name}}; }

Json json_of_order(const AddTool& order) {
    Json json = named("add", order.name);
    json["tool"] = json_of(order.definition);
    add_pose(json, order.pose);
    return json;
}
Json json_of_order(const MoveTool& order) {
    Json json = named("move", order.name);
    add_pose(json, order.pose);
    return json;
}
Json json_of_order(const WithdrawTool& order) { return named("withdraw", order.name); }
Json json_of_order(const CloseTool& order) { return named("close", order.name); }
Json json_of_order(const OpenTool& order) { return named("open", order.name); }
Json json_of_order(const DrawSuture& order) {
    Json json = named("draw", order.name);
    json["length"] = order.length;
    return json;
}
Json json_of_order(const UntieSuture& order) { return named("untie", order.name); }

}  // namespace

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json parse_object(std::string_view text) {
    // Who reads what was parsed may call itself for each level.
    constexpr int most_nested = 32;
    bool is_too_deep = false;
    const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
        is_too_deep = is_too_deep || depth > most_nested;
        return !is_too_deep;
    };
    Json json = Json::parse(text, keep, false);
    if (is_too_deep) throw InputError("the values are nested too deeply");
    if (!json.is_object()) throw InputError("this is no JSON object");
    return json;
}

const Json& member(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) refuse(key, "is missing");
    return *found;
}

double number_in(const Json& object, const char* key) {
    const Json& value = member(object, key);
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(key, "must be a number");
    return value.get<double>();
}

bool flag_in(const Json& object, const char* key) {
    const Json& value = member(object, key);
    if (!value.is_boolean()) refuse(key, "must be true or false");
    return value.get<bool>();
}

std::string text_in(const Json& object, const char* key) {
    const Json& value = member(object, key);
    if (!value.is_string()) refuse(key, "must be a text");
    return value.get<std::string>();
}

Vec3 vector_of(const Json& value, std::string_view name) {
    if (!value.is_array() || value.size() != 3) refuse(name, "must be three numbers");
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
        const Json& number = value[static_cast<std::size_t>(i)];
        if (!number.is_number() || !std::isfinite(number.get<double>()))
            refuse(name, "must be three numbers");
        v[i] = number.get<double>();
    }
    return v;
}

Pose pose_in(const Json& object) {
    Pose pose;
    pose.position = vector_of(member(object, "at"), "at");
    if (!object.contains("rotation")) return pose;
    const Json& q = object["rotation"];
    const bool is_list = q.is_array() && q.size() == 4;
    if (!is_list || !std::ranges::all_of(q, [](const Json& x) { return x.is_number(); }))
        refuse("rotation", "must be four numbers: a quaternion x, y, z, w");
    pose.rotation = {q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                     q[2].get<double>()};
    if (!(std::abs(pose.rotation.norm() - 1.0) < 1e-3))
        refuse("rotation", "must be a quaternion of unit length");
    // What was normalised before keeps its bits, so that a recording is exact.
    if (!pose.is_sound()) pose.rotation.normalize();
    return pose;
}

void add_pose(Json& object, const Pose& pose) {
    const auto& q = pose.rotation;
    object["at"] = {pose.position.x(), pose.position.y(), pose.position.z()};
    object["rotation"] = {q.x(), q.y(), q.z(), q.w()};
}

scenario::Value value_of(const Json& json) { return value_of(json, 0); }

Json json_of(const scenario::Value& value) {
    if (const auto* flag = value.get<bool>()) return *flag;
    if (const auto* integer = value.get<std::int64_t>()) return *integer;
    if (const auto* number = value.get<double>()) return *number;
    if (const auto* text = value.get<std::string>()) return *text;
    if (const auto* array = value.get<scenario::Array>()) {
        Json json = Json::array();
        for (const scenario::Value& item : *array) json.push_back(json_of(item));
        return json;
    }
    Json json = Json::object();
    if (const auto* table = value.get<scenario::Table>())
        for (const scenario::Entry& entry : *table) json[entry.key] = json_of(entry.value);
    return json;
}

Json json_of(const Order& order) {
    return std::visit([](const auto& one) { return json_of_order(one); }, order);
}

Order order_of(const Json& json) {
    const auto is = [&](const char* verb) { return json.contains(verb); };
    if (is("add"))
        return AddTool{text_in(json, "add"), value_of(member(json, "tool")), pose_in(json)};
    if (is("move")) return MoveTool{text_in(json, "move"), pose_in(json)};
    if (is("withdraw")) return WithdrawTool{text_in(json, "withdraw")};
    if (is("close")) return CloseTool{text_in(json, "close")};
    if (is("open")) return OpenTool{text_in(json, "open")};
    if (is("draw")) return DrawSuture{text_in(json, "draw"), number_in(json, "length")};
    if (is("untie")) return UntieSuture{text_in(json, "untie")};
    std::string keys;
    for (const auto& [key, value] : json.items()) keys += (keys.empty() ? "" : ", ") + key;
    throw InputError("this is no order" + (keys.empty() ? "" : ", with the keys " + keys) +
                     ": must be add, move, withdraw, close, open, draw or untie");
}

std::string to_json(const Order& order) { return text_of(json_of(order)); }

Order order_from_json(std::string_view text) { return order_of(parse_object(text)); }

void require_sound(const Pose& pose) {
    if (!pose.is_sound())
        throw InputError(
            "the pose is not sound: its position must be finite, and its rotation a "
            "quaternion of unit length");
}

}  // namespace incise::live
