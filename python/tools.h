// incise.Tool, incise.Constraint and incise.Load, as C++ holds them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/python/handle.h"

namespace incise::python {

/// A tool of a world. It keeps the world alive.
struct Tool {
    World world;
    sim::ToolId id;
    std::string name;
};

/// A constraint of a world, found by its name.
struct Constraint {
    World world;
    std::string name;
};

/// A load of a world, found by its name.
struct Load {
    World world;
    std::string name;
};

}  // namespace incise::python
