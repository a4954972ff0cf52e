// Checks of the memory of this machine, before a large allocation. The system kills a process that
// uses more, without a message.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

/// Returns "takes ... GB of memory, and this machine has ... GB" if the machine has fewer bytes.
/// Returns nothing if the bytes fit, or if the memory of the machine is not known.
std::optional<std::string> lack_of_memory(double bytes);

/// Throws InputError "`what` takes ... GB of memory, and this machine has ... GB; `remedy`" if the
/// machine has fewer bytes.
void require_memory(double bytes, std::string_view what, std::string_view remedy);

}  // namespace incise::io
