// A section that a program gives as a table, such as a tool that it adds to a world which runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/document.h"

namespace incise::scenario {

/// Returns read(table, diagnostics), and adds its warnings. Throws InputError with all problems
/// that it reports, one a line, or if the definition is no table.
/// @param what     what the table defines, for messages
/// @param example  of a key, such as kind = "blade"
template <class Read>
auto read_definition(const Value& definition, const std::string& what, std::string_view example,
                     std::vector<std::string>& warnings, Read read) {
    const Table* table = definition.get<Table>();
    if (!table)
        throw InputError(what + ": is " + definition.description() +
                         ", not a table of keys such as " + std::string(example));
    Diagnostics diagnostics(what, {});
    auto result = read(*table, diagnostics);
    std::string text;
    for (const std::string& error : diagnostics.errors())
        text += (text.empty() ? "" : "\n") + error;
    if (!text.empty()) throw InputError(text);
    for (std::string& warning : diagnostics.warnings()) warnings.push_back(std::move(warning));
    return result;
}

}  // namespace incise::scenario
