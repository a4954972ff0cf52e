// incise-render as a user meets it: the pictures it leaves, and what it says if there can be none.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cmath>
#include <fstream>
#include <set>

#include "incise/io/files/atomic_file.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/vtk/series.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/topology/box_mesh.h"
#include "tests/support/temporary_folder.h"

namespace incise {
namespace {

namespace fs = std::filesystem;
using support::count_entries;
using support::read_text;
using support::TemporaryFolder;
using testing::HasSubstr;

struct Outcome {
    int status;
    std::string out, err;
};

/// Starts the program with its output in files of `folder`; `arguments` are words for the shell.
Outcome render(const TemporaryFolder& folder, const std::string& arguments,
               const std::string& environment = "env -u DISPLAY") {
    const auto quoted = [&](const char* name) { return " '" + (folder / name).string() + "'"; };
    const auto command = "cd" + quoted(".") + " && " + environment + " " INCISE_RENDER_PROGRAM " " +
                         arguments + " >" + quoted("stdout") + " 2>" + quoted("stderr");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            read_text(folder / "stdout"), read_text(folder / "stderr")};
}

/// A bar that bends: its displacement grows from 0 in the first frame.
void write_run(const fs::path& folder, int num_frames) {
    io::Series series(folder, "bar");
    for (int k = 0; k < num_frames; ++k) {
        io::Frame frame;
        frame.mesh =
            topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {3, 1, 1}, {6, 2, 2});
        std::vector<double> displacement;
        for (auto& point : frame.mesh.points) {
            const Vec3 shift(0, 0, 0.1 * k * point.x() * point.x());
            point += shift;
            displacement.insert(displacement.end(), shift.begin(), shift.end());
        }
        for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
            frame.mesh.regions[c] = static_cast<int>(c % 3);
        frame.point_fields = {{"displacement", 3, displacement}};
        frame.cell_fields = {{"stress", 9, std::vector<float>(9 * frame.mesh.num_cells(), 2.0F)}};
        frame.time = 0.25 * k;
        series.add(frame);
    }
}

struct Picture {
    int width, height;
    std::vector<std::array<unsigned char, 3>> pixels;

    std::size_t num_colors() const { return std::set(pixels.begin(), pixels.end()).size(); }
    /// The part of the pixels in which one channel is well above another: the body's, since the
    /// background and the text are nearly gray.
    double colored_part() const {
        const auto count = std::count_if(pixels.begin(), pixels.end(), [](const auto& p) {
            return *std::max_element(p.begin(), p.end()) - *std::min_element(p.begin(), p.end()) >
                   40;
        });
        return static_cast<double>(count) / static_cast<double>(pixels.size());
    }
};

Picture read_picture(const fs::path& path) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    auto* image = reader->GetOutput();
    Picture picture{image->GetDimensions()[0], image->GetDimensions()[1], {}};
    const auto* bytes = static_cast<const unsigned char*>(image->GetScalarPointer());
    const auto size =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    for (std::size_t i = 0; bytes && i < size; ++i)
        picture.pixels.push_back({bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]});
    return picture;
}

TEST(Render, DrawsTheLastFrameByDefault) {
    const TemporaryFolder folder;
    write_run(folder / "run", 2);
    const auto outcome = render(folder, "run --size 320x240");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "run/pictures/bar_000001.png\n");
    EXPECT_EQ(outcome.err, "");
    const auto picture = read_picture(folder / "run/pictures/bar_000001.png");
    EXPECT_EQ(picture.width, 320);
    EXPECT_EQ(picture.height, 240);
    EXPECT_GT(picture.num_colors(), 500U);
    EXPECT_GT(picture.colored_part(), 0.1);
    EXPECT_LT(picture.colored_part(), 0.8);
}

TEST(Render, DrawsAllFramesWithOneCameraAndRange) {
    const TemporaryFolder folder;
    write_run(folder / "run", 3);
    const auto all = render(folder, "run --all --out film --size 320x240");
    EXPECT_EQ(all.status, 0) << all.err;
    EXPECT_EQ(all.out, "film/bar_000000.png\nfilm/bar_000001.png\nfilm/bar_000002.png\n");
    EXPECT_THAT(all.err, HasSubstr("drawing frame 3 of 3"));
    EXPECT_EQ(count_entries(folder / "film"), 3U);
    // The first frame is straight: alone it fills more of the picture than within the film.
    const auto alone = render(folder, "run --frame 0 --out first.png --size 320x240");
    EXPECT_EQ(alone.status, 0) << alone.err;
    EXPECT_GT(read_picture(folder / "first.png").colored_part(),
              1.1 * read_picture(folder / "film/bar_000000.png").colored_part());
    // The same command gives the same picture.
    const auto picture = read_text(folder / "film/bar_000001.png");
    EXPECT_EQ(render(folder, "run --all --out film --size 320x240").status, 0);
    EXPECT_EQ(read_text(folder / "film/bar_000001.png"), picture);
}

TEST(Render, DrawsSomeFramesAsAFilmHasThem) {
    const TemporaryFolder folder;
    write_run(folder / "run", 4);
    const auto some = render(folder, "run --frame 0,3 --out some --size 320x240");
    EXPECT_EQ(some.status, 0) << some.err;
    EXPECT_EQ(some.out, "some/bar_000000.png\nsome/bar_000003.png\n");
    // The camera is that of all frames that are drawn: the last one is the largest.
    EXPECT_EQ(render(folder, "run --all --out all --size 320x240").status, 0);
    EXPECT_EQ(read_text(folder / "some/bar_000000.png"), read_text(folder / "all/bar_000000.png"));
    EXPECT_EQ(read_text(folder / "some/bar_000003.png"), read_text(folder / "all/bar_000003.png"));
}

/// The part of the pixels that are dark red, as the faces of cuts are.
double red_part(const Picture& picture) {
    const auto count = std::count_if(
        picture.pixels.begin(), picture.pixels.end(),
        [](const auto& p) { return p[0] > 70 && p[0] > 2.5 * p[1] && p[0] > 2.5 * p[2]; });
    return static_cast<double>(count) / static_cast<double>(picture.pixels.size());
}

// A block of which one half has cut faces on all sides, in one region and in two.
TEST(Render, DrawsTheFacesOfCutsInRed) {
    const TemporaryFolder folder;
    for (const auto kind : {topology::CellKind::tetrahedron, topology::CellKind::hexahedron})
        for (const int cut_faces : {0, 63}) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << ", " << cut_faces);
            io::Frame frame;
            frame.mesh = topology::box_mesh(kind, {0, 0, 0}, {2, 1, 1}, {2, 1, 1});
            std::vector<std::int32_t> cuts(frame.mesh.num_cells(), 0);
            for (std::size_t c = 0; c < cuts.size() / 2; ++c) cuts[c] = cut_faces;
            frame.cell_fields = {{"cut_faces", 1, cuts}};
            io::write_vtu(folder / "block.vtu", frame);
            const auto outcome = render(folder, "block.vtu --out p.png --size 320x240");
            EXPECT_EQ(outcome.status, 0) << outcome.err;
            const auto picture = read_picture(folder / "p.png");
            EXPECT_GT(picture.colored_part(), 0.1);
            if (cut_faces == 0) {
                EXPECT_LT(red_part(picture), 0.003);  // but for an arrow
            } else {
                EXPECT_GT(red_part(picture), 0.1 * picture.colored_part());
                EXPECT_LT(red_part(picture), 0.9 * picture.colored_part());
            }
        }
}

// What is in front of the plane is left out; the section shows the inside and its fields.
TEST(Render, CutsTheBodyOpenAtAPlane) {
    const TemporaryFolder folder;
    io::Frame frame;
    frame.mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {4, 1, 1}, {8, 2, 2});
    std::vector<double> heights;
    for (const Vec3& point : frame.mesh.points) heights.push_back(point.x());
    frame.point_fields = {{"height", 1, heights}};
    io::write_vtu(folder / "bar.vtu", frame);
    const auto picture_of = [&](const std::string& arguments) {
        const auto outcome = render(folder, "bar.vtu --out p.png --size 320x240 " + arguments);
        EXPECT_EQ(outcome.status, 0) << arguments << outcome.err;
        return read_picture(folder / "p.png");
    };
    for (const std::string look : {"", "--color height --range 0,100 "}) {
        SCOPED_TRACE(look);
        const std::string field = "--view 0.05,-1,0 " + look;
        const double whole = picture_of(field).colored_part();
        EXPECT_NEAR(picture_of(field + "--section x=5").colored_part(), whole, 0.01 * whole);
        EXPECT_NEAR(picture_of(field + "--section x=1").colored_part(), 0.25 * whole, 0.1 * whole);
        EXPECT_NEAR(picture_of(field + "--section x").colored_part(), 0.5 * whole, 0.1 * whole);
        EXPECT_NEAR(picture_of(field + "--section 3,0,0,-1,0,0").colored_part(), 0.75 * whole,
                    0.1 * whole);
        EXPECT_NEAR(picture_of(field + "--section y").colored_part(), whole, 0.2 * whole);
    }
    // The eye sees the section alone, and in it the value there.
    const auto front = picture_of("--view 1,0,0 --color height --range 0,4").pixels;
    const auto section = picture_of("--view 1,0,0 --color height --range 0,4 --section x=2");
    const auto values = picture_of("--view 1,0,0 --color height --range 2,6 --section x=4.5");
    EXPECT_TRUE(section.pixels != front);
    const auto middle = section.pixels[120 * 320 + 135];
    const auto other = front[120 * 320 + 135];
    EXPECT_NE(middle, other);
    EXPECT_EQ(values.pixels[120 * 320 + 135], middle);  // 4 of 2 to 6 is as 2 of 0 to 4
}

// With a program in the place of ffmpeg that tells how it was started, and with one that fails.
TEST(Render, MakesAFilmOfAllFrames) {
    const TemporaryFolder folder;
    write_run(folder / "run", 3);
    std::ofstream(folder / "ffmpeg") << "#!/bin/sh\necho \"$@\" > film.mp4\n";
    fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
    const std::string here = "env -u DISPLAY PATH='" + folder.path().string() + "':\"$PATH\"";
    const auto outcome = render(folder, "run --video film.mp4 --size 320x240", here);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, testing::EndsWith("bar_000002.png\nfilm.mp4\n"));
    const auto words = read_text(folder / "film.mp4");
    EXPECT_THAT(words, HasSubstr("-framerate 4 -i run/pictures/bar_%06d.png"));
    std::ofstream(folder / "ffmpeg") << "#!/bin/sh\nexit 3\n";
    const auto failed = render(folder, "run --video film.mp4 --size 320x240", here);
    EXPECT_EQ(failed.status, 4);
    EXPECT_THAT(failed.err, HasSubstr("film.mp4: ffmpeg could not write it"));
    EXPECT_EQ(render(folder, "run --video a.mp4 --frame 1").status, 2);
}

TEST(Render, ColorsByEveryKindOfField) {
    const TemporaryFolder folder;
    write_run(folder / "run", 2);
    std::set<std::string> pictures;
    for (const std::string field : {"displacement", "displacement_z", "region", "stress", "none"}) {
        const auto outcome =
            render(folder, "run --out p.png --size 320x240 --edges --color " + field);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        pictures.insert(read_text(folder / "p.png"));
        EXPECT_GT(read_picture(folder / "p.png").colored_part(), 0.1) << field;
    }
    EXPECT_EQ(pictures.size(), 5U);
}

TEST(Render, DrawsASingleMeshAndAnEmptyBody) {
    const TemporaryFolder folder;
    io::write_mesh(folder / "box.vtu", topology::box_mesh(topology::CellKind::hexahedron, {0, 0, 0},
                                                          {1, 1, 1}, {2, 2, 2}));
    io::write_mesh(folder / "empty.vtu", {});
    EXPECT_EQ(render(folder, "box.vtu --size 320x240").out, "./box.png\n");
    EXPECT_GT(read_picture(folder / "box.png").colored_part(), 0.1);
    const auto outcome = render(folder, "empty.vtu --size 320x240");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_picture(folder / "empty.png").width, 320);
}

TEST(Render, SaysWhatIsWrongWithTheInput) {
    const TemporaryFolder folder;
    write_run(folder / "run", 2);
    fs::create_directory(folder / "nothing");
    const auto frame = read_text(folder / "run/frames/bar_000001.vtu");
    io::write_file(folder / "cut.vtu", frame.substr(0, frame.size() / 2));
    auto forged = frame;
    const std::string count = "NumberOfCells=\"";
    forged.insert(forged.find(count) + count.size(), "99999999");
    io::write_file(folder / "forged.vtu", forged);
    io::write_file(folder / "mesh.stl", "solid");
    io::write_file(folder / "bad.pvd", "<VTKFile><Collection>");
    io::write_file(folder / "empty.pvd", "<VTKFile type=\"Collection\"><Collection/></VTKFile>");

    const std::pair<const char*, const char*> cases[] = {
        {"missing", "missing: no such file or folder"},
        {"nothing", "nothing: holds no .pvd file"},
        {"mesh.stl", "no .vtu file"},
        {"bad.pvd", "bad.pvd: is no readable .pvd file"},
        {"empty.pvd", "empty.pvd: lists no frames; give a .vtu file, or run again"},
        {"cut.vtu", "cut.vtu: is cut short"},
        {"forged.vtu", "is more than the file can hold"},
        {"run --frame 2", "has no frame 2; there are 2, numbered 0 to 1"},
        {"run --frame 1,2", "has no frame 2; there are 2, numbered 0 to 1"},
        {"run --frame -1", "--frame"},
        {"run --frame 1,x", "--frame"},
        {"run --frame 0,1 --out two.png", "there are several frames; name a folder"},
        {"run --color colour",
         "no field is called 'colour'; there are: displacement, region, stress, none"},
        {"run --color region_x", "no field is called"},
        {"run --size 10x10", "--size 10x10: width and height are from 64"},
        {"run --size 320", "--size 320: is not of the form WxH"},
        {"run --view 0,0,0", "--view 0,0,0: is no direction"},
        {"run --range 1,1", "LOW must be below HIGH"},
        {"run --section q", "--section q: is not x, y or z"},
        {"run --section x=", "--section x=: is not x, y or z"},
        {"run --section x=nan", "--section x=nan: is not x, y or z"},
        {"run --section 0,0,0,0,0,0", "is not x, y or z"},
        {"run --section 0,0,0,1,0", "is not x, y or z"},
        {"run --section 0,0,0,1,0,0,", "is not x, y or z"},
        {"run --all --out film.png", "name a folder"},
        {"run --all --frame 1", "--frame"},
        {"", "DIR"},
    };
    for (const auto& [arguments, text] : cases) {
        const auto outcome = render(folder, arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_THAT(outcome.err, testing::StartsWith("incise-render: ")) << arguments;
        EXPECT_THAT(outcome.err, HasSubstr(text)) << arguments;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }

    fs::remove(folder / "run/frames/bar_000001.vtu");
    EXPECT_THAT(render(folder, "run").err, HasSubstr("bar_000001.vtu"));
}

TEST(Render, SaysThatADiskIsFull) {
    const TemporaryFolder folder;
    write_run(folder / "run", 1);
    fs::create_symlink("/dev/full", folder / "full.png");
    const auto outcome = render(folder, "run --out full.png --size 320x240");
    EXPECT_EQ(outcome.status, 4);
    EXPECT_THAT(outcome.err, HasSubstr("full.png: cannot be written: no space left on device"));
    EXPECT_EQ(render(folder, "run --out run/bar.pvd/pictures").status, 4);
}

TEST(Render, FindsADisplayOrNamesThePackages) {
    const TemporaryFolder folder;
    write_run(folder / "run", 1);
    const auto dead_display = render(folder, "run --size 320x240", "env DISPLAY=:9999");
    EXPECT_EQ(dead_display.status, 0) << dead_display.err;
    const auto no_xvfb = render(folder, "run", "env -u DISPLAY PATH=/nowhere");
    EXPECT_EQ(no_xvfb.status, 2);
    EXPECT_THAT(no_xvfb.err, HasSubstr("apt-get install xvfb libgl1-mesa-dri"));
}

TEST(Render, LeavesOnlyWholePicturesOnASignal) {
    const TemporaryFolder folder;
    write_run(folder / "run", 30);
    const auto run = (folder / "run").string();
    for (const int signal_number : {SIGINT, SIGTERM}) {
        const auto pictures = folder / ("stopped by " + std::to_string(signal_number));
        const pid_t child = ::fork();
        if (child == 0) {
            ::freopen("/dev/null", "w", stdout);
            ::freopen("/dev/null", "w", stderr);
            ::execl(INCISE_RENDER_PROGRAM, "incise-render", run.c_str(), "--all", "--out",
                    pictures.c_str(), static_cast<char*>(nullptr));
            ::_exit(127);
        }
        while (::waitpid(child, nullptr, WNOHANG) == 0 && !fs::exists(pictures / "bar_000000.png"))
            ::usleep(20'000);
        ::kill(child, signal_number);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status));
        EXPECT_EQ(WEXITSTATUS(status), 128 + signal_number);
        EXPECT_LT(count_entries(pictures), 30U);
        for (const auto& entry : fs::directory_iterator(pictures))
            EXPECT_EQ(read_picture(entry.path()).width, 1280) << entry.path();
    }
}

}  // namespace
}  // namespace incise
