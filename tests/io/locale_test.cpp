// Numbers in files have points, whatever the locale of the process that embeds the library.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <clocale>
#include <locale>
#include <map>
#include <string>

#include "incise/io/mesh/mesh_text.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/surface/surface_reader.h"
#include "tests/io/reader_samples.h"
#include "tests/io/surface_samples.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

/// 1.234,5
class CommaForPoint : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// A locale with a comma in C++ and, where the machine has one, in C; until the end of the scope.
class ForeignLocale {
  public:
    ForeignLocale() : cpp_(std::locale::global({std::locale::classic(), new CommaForPoint})) {
        for (const auto* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"})
            if (std::setlocale(LC_ALL, name) != nullptr) return;
    }
    ~ForeignLocale() {
        std::locale::global(cpp_);
        std::setlocale(LC_ALL, "C");
    }
    ForeignLocale(const ForeignLocale&) = delete;
    ForeignLocale& operator=(const ForeignLocale&) = delete;

  private:
    std::locale cpp_;
};

/// The tetrahedra alone, for formats that hold no others.
topology::MeshData tetrahedra_of(const topology::MeshData& mesh) {
    topology::MeshData result;
    result.points = mesh.points;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        if (mesh.kinds[c] == topology::CellKind::tetrahedron)
            result.add_cell(mesh.kinds[c], mesh.cell(c), mesh.regions[c]);
    return result;
}

/// What is written, by suffix.
std::map<std::string, std::string> written(const topology::MeshData& mesh) {
    const support::TemporaryFolder folder;
    std::map<std::string, std::string> files;
    for (const auto& suffix : writable_suffixes()) {
        write_mesh(folder / ("mesh" + suffix), suffix == ".usda" ? tetrahedra_of(mesh) : mesh);
        files[suffix] = support::read_text(folder / ("mesh" + suffix));
    }
    return files;
}

TEST(Locale, DoesNotChangeWhatIsWritten) {
    auto mesh = sample_mesh();
    mesh.points[8].x() = 1234567.25;
    for (auto& region : mesh.regions) region += 1000000;
    const auto expected = written(mesh);
    const ForeignLocale locale;
    EXPECT_EQ(written(mesh), expected);
}

TEST(Locale, DoesNotChangeWhatIsRead) {
    const auto samples = all_samples();
    const auto surfaces = surface_samples(tetrahedron());
    const auto expected = tetrahedron().triangulated();
    const support::TemporaryFolder folder;
    const ForeignLocale locale;
    for (const auto& sample : samples) {
        SCOPED_TRACE(sample.name);
        expect_same_mesh(read_bytes(sample.name, sample.bytes).mesh, sample_mesh());
    }
    for (const auto& sample : surfaces) {
        SCOPED_TRACE(sample.name);
        std::ofstream(folder / sample.name, std::ios::binary) << sample.bytes;
        EXPECT_EQ(read_surface(folder / sample.name).surface.points, expected.points);
    }
}

}  // namespace
}  // namespace incise::io
