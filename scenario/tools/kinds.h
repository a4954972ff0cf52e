// How a kind of tool makes itself known. Internal to the folder.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

/// The class of the kind of a shape. The file of each kind specializes it, and instantiates
/// kind_for() for the shape: a shape without that does not link.
template <class Shape>
struct KindFor;

template <class Shape>
const ToolKind& kind_for() {
    static const typename KindFor<Shape>::type kind;
    return kind;
}

}  // namespace incise::scenario
