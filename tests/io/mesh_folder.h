// Meshes that are in several files: written to a folder, then read from the first.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {

using Files = std::map<std::string, std::string>;

class MeshFolder : public testing::Test {
  protected:
    /// `first` is the name of the file that is read.
    explicit MeshFolder(std::string first) : first_(std::move(first)) {}

    void write(const Files& files) {
        for (const auto& [name, text] : files) {
            std::filesystem::create_directories((folder_ / name).parent_path());
            std::ofstream(folder_ / name) << text;
        }
    }
    MeshFile read(const Files& files) {
        write(files);
        return read_mesh(folder_ / first_);
    }
    /// The message, without the folder.
    std::string refused(const Files& files) {
        try {
            read(files);
        } catch (const InputError& error) {
            std::string text = error.what();
            const auto prefix = (folder_ / "").string();
            for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
                text.erase(at, prefix.size());
            return text;
        }
        return "not refused";
    }

    support::TemporaryFolder folder_;

  private:
    std::string first_;
};

}  // namespace incise::io
