// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/limits.h"

#include <cmath>

#include "incise/base/number_format.h"

namespace incise::scenario {

std::string Limits::text() const {
    std::string text;
    if (std::isfinite(low)) text = (includes_low ? "at least " : "above ") + format_number(low);
    if (std::isfinite(high)) {
        if (!text.empty()) text += " and ";
        text += (includes_high ? "at most " : "below ") + format_number(high);
    }
    if (std::isinf(high) && includes_high) text += (text.empty() ? "a number or inf" : ", or inf");
    return text.empty() ? "a finite number" : text;
}

}  // namespace incise::scenario
