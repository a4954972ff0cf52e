// What runs leave, to compare one with another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "support/temporary_folder.h"

namespace incise::support {

/// All files of a run that has ended, by their names; the summary without figures of the wall
/// clock, and without how the run was started.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto name = std::filesystem::relative(entry.path(), folder).string();
        if (entry.is_regular_file()) files[name] = read_text(entry.path());
    }
    auto& summary = files["summary.json"];
    auto json = nlohmann::ordered_json::parse(summary);
    for (const char* name :
         {"wall_time", "steps_per_second", "real_time_factor", "started", "command", "directory"})
        json.erase(name);
    summary = json.dump();
    return files;
}

inline void expect_same(const std::map<std::string, std::string>& files,
                        const std::map<std::string, std::string>& others) {
    for (const auto& [name, text] : others) EXPECT_TRUE(files.contains(name)) << name;
    for (const auto& [name, text] : files) {
        ASSERT_TRUE(others.contains(name)) << name;
        EXPECT_TRUE(others.at(name) == text) << name << " differs";
    }
}

}  // namespace incise::support
