// JSON as values of the simulation, and back. Internal: only sources of live include it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "incise/base/types.h"
#include "incise/live/order.h"
#include "incise/scenario/document.h"
#include "incise/topology/pose.h"

namespace incise::live {

using Json = nlohmann::json;

/// Returns JSON as text. Bytes that are no UTF-8, as names of files may have, are replaced.
std::string text_of(const Json& json);
/// Parses one JSON object. Throws InputError.
Json parse_object(std::string_view text);

/// Returns the member. Throws InputError if it is missing.
const Json& member(const Json& object, const char* key);
double number_in(const Json& object, const char* key);
bool flag_in(const Json& object, const char* key);
std::string text_in(const Json& object, const char* key);
/// Returns a vector of three finite numbers.
Vec3 vector_of(const Json& value, std::string_view name);

/// Reads the members `at` and `rotation` (x, y, z, w) of the object; without `rotation`, the pose
/// is not turned. The rotation is scaled to unit length if it is near to it.
Pose pose_in(const Json& object);
void add_pose(Json& object, const Pose& pose);

/// Values of a document, and back. Throws InputError for values nested too deeply, and for null.
scenario::Value value_of(const Json& json);
Json json_of(const scenario::Value& value);

Json json_of(const Order& order);
Order order_of(const Json& json);

}  // namespace incise::live
