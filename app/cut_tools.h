// The tools of `incise cut` as the command line names them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "incise/app/geometric_cut.h"
#include "incise/app/verbs.h"

namespace incise::app {

/// One option that adds a tool.
struct CutToolOption {
    const char* name;     ///< "--plane"
    const char* form;     ///< what its value holds
    const char* meaning;  ///< a line of help
};
std::span<const CutToolOption> cut_tool_options();

struct ParsedCutTool {
    app::CutTool tool;
    std::vector<std::string> warnings;  ///< about the surface's file; they name it
};

/// Reads the file of a surface too. Throws InputError that names the option, its text and what is
/// expected.
ParsedCutTool parse_cut_tool(const CutToolArgument& argument);

}  // namespace incise::app
