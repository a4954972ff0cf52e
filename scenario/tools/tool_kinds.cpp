// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>

#include "incise/scenario/tools/kinds.h"

namespace incise::scenario {

std::span<const ToolKind* const> tool_kinds() {
    static const auto kinds = [] {
        std::array<const ToolKind*, std::size(all_kinds)> all{};
        std::ranges::transform(all_kinds, all.begin(), [](const auto& kind) { return &kind(); });
        return all;
    }();
    return kinds;
}

const ToolKind& kind_of(const cutting::ToolShape& shape) {
    const std::string_view name = cutting::traits_of(shape).kind;
    return **std::ranges::find(tool_kinds(), name, &ToolKind::name);
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
            owners.push_back("a " + std::string(kind->name()));
    std::string text;
    for (std::size_t i = 0; i < owners.size(); ++i)
        text += (i == 0 ? "" : i + 1 == owners.size() ? " or " : ", ") + owners[i];
    return text;
}

}  // namespace incise::scenario
