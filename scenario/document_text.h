// A document as TOML text.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/scenario/document.h"

namespace incise::scenario {

/// Returns a document as TOML, which reads back as the same values. Comments and layout are those
/// of this function, not of the source.
/// @param document  a table without dates and times
std::string toml_text(const Value& document);

/// Makes names of files independent of the folder of the scenario: the texts of keys `file` and
/// `surface` become absolute paths.
/// @param folder  to which they are relative
void make_files_absolute(Value& document, const std::filesystem::path& folder);

}  // namespace incise::scenario
