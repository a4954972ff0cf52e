// Damaged files are read or refused, never more: no crash, no other exception, no large allocation.
// Here are the formats that have several encodings; tests/fuzz has all formats, with fewer changes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "incise/base/error.h"
#include "incise/io/mesh/gmsh_reader.h"
#include "incise/io/vtk/legacy_vtk_reader.h"
#include "incise/io/vtk/vtu_reader.h"
#include "tests/io/reader_samples.h"
#include "tests/support/mesh_consistency.h"
#include "tests/support/mutation.h"
#include "tests/support/num_cases.h"

namespace incise::io {
namespace {

using Reader = MeshFile (*)(const InputFile&, const ReadOptions&);
constexpr int mutations_of_a_sample = test::num_cases(1500);

void expect_read_or_refused(Reader reader, const std::vector<Sample>& samples) {
    int num_refused = 0;
    for (const auto& sample : samples) {
        std::mt19937 random(12345);
        for (int i = 0; i < mutations_of_a_sample; ++i) {
            const InputFile file{sample.name, support::mutated(sample.bytes, random)};
            try {
                ASSERT_EQ(support::inconsistency_of(reader(file, {}).mesh), "");
            } catch (const InputError& error) {
                ++num_refused;
                EXPECT_TRUE(std::string_view(error.what()).starts_with(sample.name + ":"))
                    << error.what();
            } catch (const std::exception& error) {
                FAIL() << sample.name << ", mutation " << i << ": " << error.what();
            }
        }
    }
    EXPECT_GT(num_refused, 0);
}

TEST(MutatedFileReader, ReadsOrRefusesVtu) {
    auto samples = vtu_samples();
    // Byte order and header size change little: each encoding once, with either by turns. LZMA,
    // slow to set up, only appended raw.
    std::erase_if(samples, [](const Sample& sample) {
        const auto has = [&](const char* part) {
            return sample.name.find(part) != std::string::npos;
        };
        return has("-32-big-") || has("-64-little-") || (has("lzma") && !has("raw"));
    });
    ASSERT_EQ(samples.size(), 21u);
    expect_read_or_refused(read_vtu, samples);
}

TEST(MutatedFileReader, ReadsOrRefusesLegacyVtk) {
    expect_read_or_refused(read_legacy_vtk, legacy_vtk_samples());
}

TEST(MutatedFileReader, ReadsOrRefusesGmsh) { expect_read_or_refused(read_gmsh, gmsh_samples()); }

}  // namespace
}  // namespace incise::io
