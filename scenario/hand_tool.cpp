// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/hand_tool.h"

#include <utility>

#include "incise/scenario/definition.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/tool_build.h"

namespace incise::scenario {

HandTool build_hand_tool(const std::string& name, const Value& definition,
                         const std::filesystem::path& folder, const std::string& why_no_contact) {
    const std::string what = "tool '" + name + "'";
    HandTool tool;
    ToolSpec spec =
        read_definition(definition, what, "kind = \"blade\"", tool.warnings,
                        [&](const Table& table, Diagnostics& diagnostics) {
                            return read_hand_tool(table, folder, why_no_contact, diagnostics);
                        });
    tool.kind = std::exchange(spec.name, name);
    try {
        tool.shape = build_tool(spec, tool.warnings).shape;
    } catch (const InputError& error) {  // about the file of a surface
        throw InputError(what + ": " + error.what());
    }
    return tool;
}

std::string why_no_contact(const DynamicsSpec& dynamics, const contact::ContactSettings& contact) {
    if (dynamics.mode == Mode::statics) return "mode = \"static\" has no contact";
    if (dynamics.integrator != TimeIntegrator::semi_implicit_euler)
        return "integrator = \"implicit-euler\" has no contact";
    return contact.enabled ? "" : "[contact] has enabled = false";
}

}  // namespace incise::scenario
