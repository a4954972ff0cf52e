// Pointers of Git LFS, which lie where the file itself was not fetched.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "incise/base/error.h"
#include "incise/io/image/label_image.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/surface/surface_reader.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

const std::string pointer =
    "version https://git-lfs.github.com/spec/v1\n"
    "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";

/// The message with which `read` refuses a file of this name and text.
std::string refusal_of(const std::string& name, const std::string& text, auto read) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / name) << text;
    try {
        read(folder / name);
    } catch (const InputError& error) {
        const auto prefix = (folder / "").string();
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with(prefix)) << message;
        return message.substr(std::min(prefix.size(), message.size()));
    }
    return "not refused";
}

TEST(GitLfsPointer, IsNamedByEveryReader) {
    const auto mesh = [](const auto& path) { read_mesh(path); };
    const auto surface = [](const auto& path) { read_surface(path); };
    const auto image = [](const auto& path) { read_label_image(path); };
    const auto expect = [](const std::string& name, auto read) {
        EXPECT_EQ(refusal_of(name, pointer, read),
                  name +
                      ": is a pointer of Git LFS, a text that stands for the file, and not the "
                      "file itself; get the file with 'git lfs pull' in its repository");
    };
    for (const auto* name : {"a.vtu", "a.vtk", "a.msh", "a.mesh", "a.node", "a.inp", "a"})
        expect(name, mesh);
    for (const auto* name : {"a.stl", "a.obj", "a.ply", "a.off"}) expect(name, surface);
    for (const auto* name : {"a.nii.gz", "a.mha", "a.nrrd"}) expect(name, image);
}

TEST(GitLfsPointer, IsNoLongText) {
    const auto message = refusal_of("a.msh", pointer + std::string(1000, ' '),
                                    [](const auto& path) { read_mesh(path); });
    EXPECT_EQ(message.find("Git LFS"), message.npos) << message;
}

}  // namespace
}  // namespace incise::io
