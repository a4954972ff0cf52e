// Keys of what changes with time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::scenario {

/// Key of something that is linear between keys and constant before the first and after the last.
/// Times ascend strictly.
template <class Value>
struct TimeKey {
    double time = 0.0;  ///< s
    Value value;
};

}  // namespace incise::scenario
