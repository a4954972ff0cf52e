// Limits of the numbers in a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <string>

namespace incise::scenario {

/// An interval of allowed values, with or without its ends. Infinity is allowed only if it is an
/// included end.
struct Limits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool includes_low = false;
    bool includes_high = false;

    constexpr bool contains(double value) const {
        return (includes_low ? value >= low : value > low) &&
               (includes_high ? value <= high : value < high);
    }

    /// True if the interval has a finite end and does not contain infinity.
    constexpr bool excludes_infinity() const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return (low > -infinity || high < infinity) && !contains(infinity);
    }

    /// Returns the limits as text, such as "above 0 and at most 1". Returns "a finite number" for
    /// an interval without ends.
    std::string text() const;
};

namespace limits {
inline constexpr Limits any{};
inline constexpr Limits positive{.low = 0.0};
inline constexpr Limits non_negative{.low = 0.0, .includes_low = true};
}  // namespace limits

}  // namespace incise::scenario
