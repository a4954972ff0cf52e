// Keys of a value that depends on time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::scenario {

/// A key of a piecewise linear function of time. The function is constant before the first key and
/// after the last. The times of its keys ascend strictly.
template <class Value>
struct TimeKey {
    double time = 0.0;  ///< s
    Value value;
};

}  // namespace incise::scenario
