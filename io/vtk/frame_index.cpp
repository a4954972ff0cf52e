// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/frame_index.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "incise/base/error.h"

namespace incise::io {

namespace {

std::string beside(const InputFile& index, std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return 0 <= c && c < ' '; }, '?');
    return (index.path.parent_path() / name).string();
}

}  // namespace

std::vector<std::string> files_of_series(const InputFile& file) {
    std::vector<std::string> names;
    const auto json = nlohmann::json::parse(file.bytes, nullptr, false);
    if (!json.is_object() || !json.contains("files")) return names;
    for (const auto& entry : json["files"])
        if (entry.is_object() && entry.contains("name") && entry["name"].is_string())
            names.push_back(entry["name"]);
    return names;
}

void refuse_series(const InputFile& file) {
    const auto json = nlohmann::json::parse(file.bytes, nullptr, false);
    if (!json.is_object())
        throw InputError(file.name() +
                         ": is no readable series of frames, which is an object in JSON with a "
                         "list of \"files\"; give one of the frames, which are .vtu files");
    const auto files = files_of_series(file);
    if (files.empty()) refuse_empty_index(file);
    refuse_index(file, files);
}

void refuse_empty_index(const InputFile& index) {
    throw InputError(index.name() +
                     ": is an index of other files and names none; give a file with a mesh, such "
                     "as a .vtu");
}

void refuse_index(const InputFile& index, const std::vector<std::string>& names, bool are_parts) {
    const auto first = beside(index, names.front()), last = beside(index, names.back());
    const bool is_one = names.size() == 1;
    throw InputError(
        index.name() + ": holds no mesh itself but names " +
        (is_one ? "the file " + first
                : std::to_string(names.size()) + " files, from " + first + " to " + last) +
        (is_one      ? "; give that one"
         : are_parts ? ", which are parts of one mesh; save them as one .vtu, for "
                       "instance with ParaView"
                     : "; give one of them"));
}

}  // namespace incise::io
