// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/live_devices.h"

#include <iostream>
#include <map>
#include <utility>

#include "incise/base/error.h"
#include "incise/live/json_values.h"
#include "incise/scenario/document.h"
#ifdef INCISE_HAS_IGTL
#include "incise/live/igtl/igtl_link.h"
#endif

namespace incise::app {

namespace {

[[noreturn]] void refuse(const std::string& tool, const std::string& text) {
    throw InputError("--tool " + tool + ": " + text);
}

/// Adds the tool that a text NAME={...} says.
void add_tool(std::map<std::string, scenario::Value>& tools, const std::string& text) {
    const std::string form =
        "must be NAME={...}, as in scalpel={kind=\"blade\", edge=[[0,0,0.01],[0,0,-0.02]]}";
    if (text.find('=') == text.npos) refuse(text, form);
    scenario::Value document{.data = scenario::Table(), .location = {}};
    try {
        scenario::apply_override(document, text, 0);
    } catch (const scenario::DocumentError& error) {
        refuse(text, error.text);
    }
    const scenario::Entry& entry = document.get<scenario::Table>()->front();
    if (!entry.value.get<scenario::Table>()) refuse(text, form);
    constexpr std::size_t longest_name = 20;  // in a message of OpenIGTLink
    if (entry.key.size() > longest_name)
        refuse(text, "the name of a device has at most 20 characters");
    if (entry.key == "tissue") refuse(text, "'tissue' is the name of the body in messages");
    // As JSON and back, it has no places in a file any more: just as from a recording.
    if (!tools.emplace(entry.key, live::value_of(live::json_of(entry.value))).second)
        refuse(text, "there are two tools of this name");
}

std::map<std::string, scenario::Value> tools_of(const LiveOptions& options) {
    std::map<std::string, scenario::Value> tools;
    for (const std::string& text : options.tools) add_tool(tools, text);
    return tools;
}

}  // namespace

std::unique_ptr<live::Device> open_device(const LiveOptions& options, const std::string& scenario) {
    auto tools = tools_of(options);
    if (!options.igtl) {
        if (!tools.empty())
            throw InputError("--tool is for OpenIGTLink: say with --igtl on which port it listens");
        return nullptr;
    }
#ifdef INCISE_HAS_IGTL
    if (tools.empty()) throw InputError("--igtl: say with --tool which tools OpenIGTLink leads");
    auto link = std::make_unique<live::IgtlLink>(
        live::IgtlOptions{options.host, *options.igtl, std::move(tools)});
    std::cerr << scenario << ": OpenIGTLink listens on " << options.host << ':' << link->port()
              << '\n';
    return link;
#else
    throw InputError(scenario +
                     ": --igtl: this build has no OpenIGTLink; install libopenigtlink-dev, and "
                     "build anew");
#endif
}

void require_tools(const LiveOptions& options, const live::Session& session) {
    Pose at_body;
    at_body.position =
        session.world().mesh().rest_position(*session.world().mesh().nodes().begin());
    for (const auto& [name, definition] : tools_of(options)) {
        try {
            if (session.check({name, definition, at_body}) == "suture")
                throw InputError("a suture is sewn, not led");
        } catch (const InputError& error) {
            refuse(name, error.what());
        }
    }
}

}  // namespace incise::app
