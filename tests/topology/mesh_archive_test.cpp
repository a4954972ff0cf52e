// A mesh that has been written and read is the same mesh, and damaged bytes are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_archive.h"

#include <gtest/gtest.h>

#include "incise/base/error.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::topology {
namespace {

std::string bytes_of(const Mesh& mesh) {
    ArchiveWriter ar;
    save(mesh, ar);
    return ar.bytes();
}

Mesh read(const std::string& bytes) {
    ArchiveReader ar(bytes);
    Mesh mesh = load_mesh(ar);
    if (!ar.is_at_end()) throw InputError("there is more");
    return mesh;
}

TEST(MeshArchive, GivesTheSameMeshBackAfterEdits) {
    for (const auto& family : test::mesh_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            Mesh mesh = Mesh::build(family.data).mesh;
            test::Random random(seed);
            std::vector<ChangeSet> edits;
            for (int i = 0; i < 10 && mesh.num_elements() > 4; ++i) {
                edits.push_back(test::random_edit(mesh, random));
                const std::string bytes = bytes_of(mesh);
                Mesh copy = read(bytes);
                ASSERT_EQ(bytes_of(copy), bytes);
                ASSERT_EQ(validate(copy), std::vector<std::string>{});
            }
            // It takes the same edits, and takes them back.
            Mesh copy = read(bytes_of(mesh));
            for (; !edits.empty(); edits.pop_back()) {
                if (edits.back().is_empty()) continue;
                replay(copy, inverse(edits.back()));
                replay(mesh, inverse(edits.back()));
            }
            EXPECT_EQ(bytes_of(copy), bytes_of(mesh));
            EXPECT_EQ(validate(copy), std::vector<std::string>{});
        }
    }
}

TEST(MeshArchive, RefusesDamagedBytesOrReadsASoundMesh) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    test::Random random(3);
    for (int i = 0; i < 4; ++i) test::random_edit(mesh, random);
    const std::string good = bytes_of(mesh);
    int num_refused = 0;
    for (int i = 0; i < test::num_cases(2000); ++i) {
        SCOPED_TRACE(i);
        std::string bytes = good;
        const std::size_t place = random.below(bytes.size() - 8);
        if (random.below(3) == 0)
            bytes.erase(place, 1 + random.below(8));
        else if (random.below(2) == 0)
            bytes.replace(place, 4, bytes.substr(random.below(bytes.size() - 4), 4));
        else
            bytes[place] = static_cast<char>(random.below(256));
        try {
            EXPECT_EQ(validate(read(bytes)), std::vector<std::string>{});
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()), "");
            ++num_refused;
        }
    }
    EXPECT_GT(num_refused, test::num_cases(400));
}

}  // namespace
}  // namespace incise::topology
