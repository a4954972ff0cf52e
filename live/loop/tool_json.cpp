// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/tool_json.h"

#include <variant>

namespace incise::live {

namespace {

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json shape_json(const cutting::Sphere& sphere) { return {{"sphere", {{"radius", sphere.radius}}}}; }
Json shape_json(const cutting::Capsule& capsule) {
    return {{"capsule",
             {{"from", numbers(capsule.from)},
              {"to", numbers(capsule.to)},
              {"radius", capsule.radius}}}};
}
Json shape_json(const cutting::Cuboid& box) { return {{"box", {{"size", numbers(box.size)}}}}; }
Json shape_json(const cutting::HalfSpace& space) {
    return {{"plane", {{"point", numbers(space.point)}, {"normal", numbers(space.normal)}}}};
}
Json shape_json(const cutting::Solid& solid) {
    Json points = Json::array();
    for (const Vec3& point : solid.surface.points) points.push_back(numbers(point));
    return {{"mesh", {{"points", std::move(points)}, {"triangles", solid.surface.triangles}}}};
}

Json with_shape(const char* kind, const auto& shape) {
    return {{"kind", kind},
            {"shape", std::visit([](const auto& one) { return shape_json(one); }, shape)}};
}

Json tool_json(const cutting::Blade& blade) {
    Json edge = Json::array();
    for (const Vec3& point : blade.edge) edge.push_back(numbers(point));
    return {{"kind", "blade"}, {"edge", std::move(edge)}};
}
Json tool_json(const cutting::Carver& carver) { return with_shape("carver", carver.shape); }
Json tool_json(const cutting::Probe& probe) { return with_shape("probe", probe.shape); }
Json tool_json(const cutting::Grasper& grasper) { return with_shape("grasper", grasper.jaws); }
Json tool_json(const auto&) { return nullptr; }

}  // namespace

std::optional<Json> json_of(const cutting::ToolShape& shape) {
    Json json = std::visit([](const auto& tool) { return tool_json(tool); }, shape);
    if (json.is_null()) return std::nullopt;
    return json;
}

}  // namespace incise::live
