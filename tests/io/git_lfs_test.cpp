// Pointers of Git LFS, which lie where the file itself was not fetched.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "incise/io/image/label_image.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/surface/surface_reader.h"
#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

const std::string pointer =
    "version https://git-lfs.github.com/spec/v1\n"
    "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";

TEST(GitLfsPointer, IsNamedByEveryReader) {
    const auto mesh = [](const auto& path) { read_mesh(path); };
    const auto surface = [](const auto& path) { read_surface(path); };
    const auto image = [](const auto& path) { read_label_image(path); };
    const auto expect = [](const std::string& name, auto read) {
        EXPECT_EQ(refusal_by(read, name, pointer),
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
    const auto message = refusal("a.msh", pointer + std::string(1000, ' '));
    EXPECT_EQ(message.find("Git LFS"), message.npos) << message;
}

}  // namespace
}  // namespace incise::io
