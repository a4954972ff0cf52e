// The indexes of a series name all frames of this run and nothing else, at any moment.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/vtk/series.h"
#include "incise/topology/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

namespace fs = std::filesystem;
using support::count_entries;
using support::read_text;
using support::TemporaryFolder;
using testing::HasSubstr;

struct Entry {
    double time;
    std::string file;
    bool operator==(const Entry&) const = default;
};
void PrintTo(const Entry& entry, std::ostream* out) { *out << entry.time << " " << entry.file; }

std::vector<Entry> read_pvd(const fs::path& path) {
    vtkNew<vtkXMLDataParser> parser;
    parser->SetFileName(path.c_str());
    std::vector<Entry> entries;
    if (!parser->Parse()) throw std::runtime_error(path.string() + " is no valid XML");
    auto* collection = parser->GetRootElement()->FindNestedElementWithName("Collection");
    for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
        auto* element = collection->GetNestedElement(i);
        const std::string time = element->GetAttribute("timestep");
        Entry entry{-1, element->GetAttribute("file")};
        std::from_chars(time.data(), time.data() + time.size(), entry.time);
        entries.push_back(entry);
    }
    return entries;
}

std::vector<Entry> read_series(const fs::path& path) {
    std::vector<Entry> entries;
    const auto json = nlohmann::json::parse(read_text(path));
    for (const auto& file : json.at("files"))
        entries.push_back({file.at("time").get<double>(), file.at("name").get<std::string>()});
    return entries;
}

Frame make_frame(double time) {
    Frame frame;
    frame.mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    frame.time = time;
    return frame;
}

std::vector<FrameWritten> write_series(const fs::path& folder, const std::string& name,
                                       int num_frames) {
    Series series(folder, name);
    for (int i = 0; i < num_frames; ++i) series.add(make_frame(0.1 * i));
    return {series.frames().begin(), series.frames().end()};
}

TEST(Series, IndexesAreValidAndCompleteAfterEachFrame) {
    // Names that XML and JSON must escape are names all the same.
    for (const std::string name : {"liver", "a<b>&\"c\" d", "back\\slash", "Münze"}) {
        SCOPED_TRACE(name);
        const TemporaryFolder folder;
        Series series(folder / "run.out", name);
        EXPECT_FALSE(fs::exists(series.pvd_path()));
        std::vector<Entry> expected;
        for (int i = 0; i < 4; ++i) {
            const double time = i / 3.0;
            series.add(make_frame(time));
            expected.push_back({time, "frames/" + name + "_00000" + std::to_string(i) + ".vtu"});
            EXPECT_EQ(read_pvd(series.pvd_path()), expected);
            EXPECT_EQ(read_series(folder / "run.out" / (name + ".vtu.series")), expected);
            for (const auto& entry : expected)
                EXPECT_TRUE(fs::is_regular_file(folder / "run.out" / entry.file));
            EXPECT_EQ(count_entries(folder / "run.out/frames"), expected.size());
        }
    }
}

TEST(Series, RemovesOnlyFramesOfAFormerRun) {
    const TemporaryFolder folder;
    write_series(folder.path(), "a", 5);
    write_series(folder.path(), "a_1", 2);
    const auto frames = folder / "frames";
    write_file(frames / "a_notes.vtu", "");
    write_file(frames / "a_.vtu", "");
    write_file(frames / ".a_000003.vtu.tmp99999999-0", "of a killed run");
    write_file(folder / "history.csv", "");

    Series series(folder.path(), "a");
    EXPECT_FALSE(fs::exists(folder / "a.pvd"));
    EXPECT_FALSE(fs::exists(folder / "a.vtu.series"));
    series.add(make_frame(0));
    EXPECT_EQ(read_pvd(folder / "a.pvd").size(), 1U);
    EXPECT_TRUE(fs::exists(frames / "a_000000.vtu"));
    EXPECT_FALSE(fs::exists(frames / "a_000001.vtu"));
    EXPECT_EQ(read_pvd(folder / "a_1.pvd").size(), 2U);
    EXPECT_TRUE(fs::exists(frames / "a_1_000001.vtu"));
    EXPECT_TRUE(fs::exists(folder / "history.csv"));
    EXPECT_EQ(count_entries(frames), 1U + 2U + 2U);  // frames of a and a_1, two foreign files
}

TEST(Series, GoesOnFromTheFramesKept) {
    const TemporaryFolder folder;
    auto kept = write_series(folder.path(), "run", 5);
    kept.resize(2);
    require_frames(folder.path(), "run", kept);
    Series series(folder.path(), "run", Compression::zlib, kept);
    EXPECT_EQ(read_pvd(folder / "run.pvd").size(), 2U);
    EXPECT_EQ(count_entries(folder / "frames"), 2U);
    series.add(make_frame(0.15));
    const std::vector<Entry> expected = {{0.0, "frames/run_000000.vtu"},
                                         {0.1, "frames/run_000001.vtu"},
                                         {0.15, "frames/run_000002.vtu"}};
    EXPECT_EQ(read_pvd(folder / "run.pvd"), expected);
    require_frames(folder.path(), "run", series.frames());
}

TEST(Series, KnowsItsFramesAgain) {
    const TemporaryFolder folder;
    const auto frames = write_series(folder.path(), "run", 3);
    const auto refusal = [&] {
        try {
            require_frames(folder.path(), "run", frames);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(), "");
    const auto path = folder / "frames/run_000001.vtu";
    const std::string text = read_text(path);
    std::string other = text;
    other[text.size() / 2] ^= 1;
    for (const auto& [forged, why] :
         {std::pair{other, "been changed"}, std::pair{text.substr(0, 100), "become shorter"},
          std::pair{text + "\n", "become longer"}, std::pair{std::string(), "become shorter"}}) {
        write_file(path, forged);
        EXPECT_EQ(refusal().find(path.string() + ": has " + why), 0U) << refusal();
    }
    fs::remove(path);
    EXPECT_EQ(refusal().find(path.string() + ": has gone"), 0U) << refusal();
    write_file(path, text);
    EXPECT_EQ(refusal(), "");
}

TEST(Series, RefusesTimesThatDoNotAscend) {
    const TemporaryFolder folder;
    Series series(folder.path(), "run");
    series.add(make_frame(1.0));
    EXPECT_THROW(series.add(make_frame(1.0)), std::invalid_argument);
    EXPECT_THROW(series.add(make_frame(0.5)), std::invalid_argument);
    EXPECT_THROW(series.add(make_frame(NAN)), std::invalid_argument);
    EXPECT_EQ(series.frames().size(), 1U);
}

TEST(Series, RefusesNamesThatAreNoFileNames) {
    const TemporaryFolder folder;
    for (const std::string name : {"", "a/b", "a\nb", "\x7f"})
        EXPECT_THROW(Series(folder.path(), name), InputError) << name;
    // What is no UTF-8: a byte too few or too many, too long a form, beyond the last character.
    for (const std::string name :
         {"sc\xff"
          "en",
          "M\xfcnze", "a\xc3", "\xe2\x82", "\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
          "\xf4\x90\x80\x80", "\xf8\x88", "\xef\xbf\xbf"})
        EXPECT_THROW(require_series_name(name), InputError) << name;
    for (const std::string name : {"Münze", "\xe2\x82\xac", "\xf0\x9f\x94\xaa", "\xf4\x8f\xbf\xbd"})
        EXPECT_NO_THROW(require_series_name(name)) << name;
}

TEST(Series, SaysWhyItCannotWrite) {
    const TemporaryFolder folder;
    write_file(folder / "file", "");
    try {
        Series(folder / "file", "run");
        FAIL() << "no error";
    } catch (const OutputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("file: cannot be written: "));
    }
    fs::create_directory(folder / "frames");
    fs::create_symlink("/dev/full", folder / "frames/run_000000.vtu");
    Series series(folder.path(), "other");
    fs::create_symlink("/dev/full", folder / "frames/other_000000.vtu");
    EXPECT_THROW(series.add(make_frame(0)), OutputError);
    EXPECT_FALSE(fs::exists(series.pvd_path()));
    EXPECT_TRUE(series.frames().empty());
}

}  // namespace
}  // namespace incise::io
