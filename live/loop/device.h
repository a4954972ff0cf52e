// A device that takes part in a live session, beside the pages.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/live/display_mesh.h"
#include "incise/live/order.h"
#include "incise/live/session.h"

namespace incise::live {

/// The loop calls all functions on its own thread. They must not wait for anything.
class Device {
  public:
    virtual ~Device() = default;
    /// Is called before each tick. Returns what to do. Orders that are refused are told to all.
    virtual std::vector<Order> orders(const Session& session) = 0;
    /// Is called after each tick.
    virtual void publish(const Session& session, const DisplayMesh& surface) = 0;
    /// Is called again and again while nothing moves, as in a pause.
    virtual void rest() = 0;
    /// Is called now and then. Returns what to tell the user.
    virtual std::vector<std::string> complaints() = 0;
};

}  // namespace incise::live
