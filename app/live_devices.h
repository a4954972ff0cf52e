// What leads the tools of a live session beside the pages.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "incise/app/verbs.h"
#include "incise/live/loop/device.h"

namespace incise::app {

/// Opens what the options ask for: an OpenIGTLink server, or nothing. Throws InputError for --tool
/// without --igtl or the other way round, for a tool that is no table, and for names that no device
/// can have; OutputError if the port cannot be listened on.
/// @param scenario  name, for the line that says where it listens
std::unique_ptr<live::Device> open_device(const LiveOptions& options, const std::string& scenario);

/// Throws InputError if the session refuses one of the tools.
void require_tools(const LiveOptions& options, const live::Session& session);

}  // namespace incise::app
