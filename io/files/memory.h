// Whether something fits in this machine's memory: asked before it is allocated, because a process
// that takes more is killed without a word.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::io {

/// "takes ... GB of memory, and this machine has ... GB" if it has fewer bytes.
std::optional<std::string> lack_of_memory(double bytes);

/// Throws InputError "`what` takes ... GB of memory, and this machine has ...; `remedy`" if it
/// has fewer bytes.
void require_memory(double bytes, std::string_view what, std::string_view remedy);

}  // namespace incise::io
