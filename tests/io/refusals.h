// Files that a reader must refuse: tables of faults, each with the message that it must give.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io {

/// What is wrong in a file that is sound otherwise, and what is said of it.
struct Fault {
    std::string from, to;  ///< `to` is in place of the first `from`; of all, if `from` is empty
    std::string message;   ///< quoted: "..." stands for any text
};

/// Returns the message with which `read` refuses a file of this name, without its folder. Fails the
/// test if the file is read, or if the message does not begin with its name.
std::string refusal_by(const std::function<void(const std::filesystem::path&)>& read,
                       const std::string& name, std::string_view bytes);

/// Gives the message with which a file of this name and text is refused.
using RefusalOf = std::function<std::string(const std::string& name, const std::string& text)>;
/// Expects that `text`, which is sound, is refused with each of the faults.
void expect_refusals(const RefusalOf& refusal_of, const std::string& name, const std::string& text,
                     const std::vector<Fault>& faults);
/// The same of a mesh.
void expect_refusals(const std::string& name, const std::string& text,
                     const std::vector<Fault>& faults);

}  // namespace incise::io
