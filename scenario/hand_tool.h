// Tools that a hand leads, from definitions with the keys of a [[tool]] section.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "incise/cutting/tools/tool.h"
#include "incise/scenario/document.h"
#include "incise/scenario/scenario.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// A tool that a hand leads.
struct HandTool {
    std::string kind;  ///< such as "blade"
    cutting::ToolShape shape;
    std::vector<std::string> warnings;
};

/// Builds a tool from a table with the keys of a [[tool]] section. The keys that say when the tool
/// is where are left out: `path`, `time`, `close`, `open`, `tighten`.
/// @param name            of the tool, for messages
/// @param definition      the table
/// @param folder          to which names of surface files are relative
/// @param why_no_contact  why tools cannot touch tissue; empty if they can: why_no_contact()
/// Throws InputError with all problems, one a line, each of which begins with the name of the tool.
HandTool build_hand_tool(const std::string& name, const Value& definition,
                         const std::filesystem::path& folder, const std::string& why_no_contact);

/// Returns why a run has no contact, for messages; empty if it has.
std::string why_no_contact(const DynamicsSpec& dynamics, const contact::ContactSettings& contact);

}  // namespace incise::scenario
