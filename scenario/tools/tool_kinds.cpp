// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

namespace {

/// Returns the kinds of the alternatives of a variant, each once.
template <class... Shapes>
std::vector<const ToolKind*> kinds_of(const std::variant<Shapes...>*) {
    std::vector<const ToolKind*> kinds;
    for (const ToolKind* kind : {&kind_for<Shapes>()...})
        if (std::ranges::find(kinds, kind->name(), &ToolKind::name) == kinds.end())
            kinds.push_back(kind);
    return kinds;
}

}  // namespace

std::span<const ToolKind* const> tool_kinds() {
    static const auto kinds = kinds_of(static_cast<const cutting::ToolShape*>(nullptr));
    return kinds;
}

const ToolKind& kind_of(const cutting::ToolShape& shape) {
    return std::visit(
        []<class Shape>(const Shape&) -> const ToolKind& { return kind_for<Shape>(); }, shape);
}

std::optional<Value> definition_of(const cutting::ToolShape& shape) {
    const ToolKind& kind = kind_of(shape);
    Table keys = kind.describe(shape);
    if (keys.empty()) return std::nullopt;
    keys.insert(keys.begin(), {"kind", {}, {std::string(kind.name()), {}}});
    return Value{std::move(keys), {}};
}

std::string owners_of(std::string_view key) {
    std::vector<std::string> owners;
    for (const ToolKind* kind : tool_kinds())
        if (std::ranges::find(kind->keys(), key, &ToolKey::name) != kind->keys().end())
            owners.push_back(kind->traits().article + std::string(kind->name()));
    std::string text;
    for (std::size_t i = 0; i < owners.size(); ++i)
        text += (i == 0 ? "" : i + 1 == owners.size() ? " or " : ", ") + owners[i];
    return text;
}

}  // namespace incise::scenario
