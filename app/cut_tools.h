// The tools of `incise cut`, as given on the command line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "incise/app/verbs.h"
#include "incise/cutting/rest/cut_at_rest.h"

namespace incise::app {

/// An option of the command line that adds a tool.
struct CutToolOption {
    const char* name;     ///< "--plane"
    const char* form;     ///< form of the value, for help and messages
    const char* meaning;  ///< line of the help text
};
/// Returns all options that add a tool.
std::span<const CutToolOption> cut_tool_options();

/// The result of parse_cut_tool().
struct ParsedCutTool {
    cutting::RestTool tool;
    std::vector<std::string> warnings;  ///< about the file of the surface; each names it
};

/// Parses the value of an option, and reads the file of its surface if it has one.
/// Throws InputError. For a wrong value the message has the option, its text and the expected form.
/// @param snap  of the tool, if it divides elements
ParsedCutTool parse_cut_tool(const CutToolArgument& argument, double snap);

}  // namespace incise::app
