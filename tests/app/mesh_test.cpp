// incise mesh as users and scripts meet it: what it writes and tells, and what it refuses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "in_folder.h"

namespace incise {
namespace {

using nlohmann::json;

/// Spacing 1, 2, 3 about -10, 5, 7: six voxels of label 4, three of label 2, three of none.
const std::string image =
    "NRRD0004\ntype: short\ndimension: 3\nspace: LPS\nsizes: 2 3 2\n"
    "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (-10,5,7)\nencoding: text\n\n"
    "4 4  4 4  4 4  2 2  2 0  0 0\n";

class Mesh : public test::InFolder {
  protected:
    void SetUp() override { write("a.nrrd", image); }

    /// The message of status 2, after which nothing is written.
    std::string refusal(const std::string& arguments) {
        const auto outcome = run("mesh " + arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtu")) << arguments;
        return outcome.err;
    }
};

TEST_F(Mesh, MakesAHexahedronOfEachLabelledVoxel) {
    const auto outcome = run("mesh a.nrrd out.vtu --hex");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out,
              "out.vtu: 9 cells, 32 points; region 2: 3; region 4: 6; volume 54, bounding box "
              "-10.5 4 5.5 to -8.5 10 11.5\n");
    const auto info = json::parse(run("info out.vtu --json").out);
    EXPECT_EQ(info["hexes"], 9);
    EXPECT_EQ(info["tets"], 0);
    EXPECT_EQ(info["points"], 32);
    EXPECT_EQ(info["components"], 1);
    EXPECT_EQ(info["regions"], (json{{"2", 3}, {"4", 6}}));
    EXPECT_EQ(info["volume"], 54.0);
    EXPECT_EQ(info["warnings"], json::array());
}

TEST_F(Mesh, TakesNoScanForLabelsUnlessToldTo) {
    auto scan = image;
    scan.replace(scan.find("4 4  4 4"), 3, "-9 4");
    write("scan.nrrd", scan);
    EXPECT_EQ(refusal("scan.nrrd out.vtu --hex"),
              "incise: scan.nrrd: looks like a scan, an image of grey values: it has values below "
              "0, the lowest -9; give a segmentation of it, or, if each value is a label, say so "
              "with --labels\n");
    const auto outcome = run("mesh scan.nrrd out.vtu --hex --labels");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("region -9: 1;"), std::string::npos) << outcome.out;
}

TEST_F(Mesh, WritesRegionsInEveryFormatThatItReads) {
    for (const auto* out : {"b.vtu", "b.vtk", "b.msh"}) {
        ASSERT_EQ(run("mesh a.nrrd --hex " + std::string(out)).status, 0);
        const auto info = json::parse(run("info --json " + std::string(out)).out);
        EXPECT_EQ(info["regions"], (json{{"2", 3}, {"4", 6}})) << out;
    }
    for (const auto* out : {"b.inp", "b.mesh"})
        EXPECT_EQ(run("mesh a.nrrd --hex " + std::string(out)).status, 0) << out;
}

TEST_F(Mesh, SamplesCubesAndScales) {
    const auto outcome = run("mesh a.nrrd out.vtu --hex --size 0.001 --scale 0.001");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out.substr(0, outcome.out.find("points")), "out.vtu: 54 cells, 123 ");
    const auto info = json::parse(run("info out.vtu --json").out);
    EXPECT_EQ(info["hexes"], 54);
    EXPECT_NEAR(info["volume"].get<double>(), 54e-9, 1e-20);
    EXPECT_NEAR(info["edge_length"]["min"].get<double>(), 1e-3, 1e-16);
    EXPECT_NEAR(info["edge_length"]["max"].get<double>(), 1e-3, 1e-16);
    EXPECT_NEAR(info["bounding_box"]["min"][0].get<double>(), -0.0105, 1e-16);
    EXPECT_NEAR(info["bounding_box"]["max"][2].get<double>(), 0.0115, 1e-16);
}

TEST_F(Mesh, WarnsOfALabelThatNoCubeMeets) {
    auto text = image;
    text[text.find("4 4  2 2")] = '9';
    write("b.nrrd", text);
    const auto outcome = run("mesh b.nrrd out.vtu --hex --size 3");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err,
              "incise: warning: b.nrrd: label 9 has no cell: no cube has its centre in it; give a "
              "smaller --size\n");
}

TEST_F(Mesh, ReportsTheWarningsOfTheImage) {
    auto bare = image;
    const std::string directions = "space directions: (1,0,0) (0,2,0) (0,0,3)\n";
    write("b.nrrd", bare.erase(bare.find(directions), directions.size()));
    EXPECT_EQ(run("mesh b.nrrd out.vtu --hex").err,
              "incise: warning: b.nrrd: states neither space directions nor spacings; 1 is "
              "taken\n");
}

TEST_F(Mesh, HandsTetrahedraOverWithAllArguments) {
    const auto program = (folder_ / "incise").string();
    std::filesystem::copy_file(INCISE_PROGRAM, program);
    const auto missing = run("mesh a.nrrd out.vtu --size 2", program, "PATH=/none");
    EXPECT_EQ(missing.status, 2);
    EXPECT_EQ(missing.err.find("incise: incise-tetmesh: cannot be started, neither from "), 0u)
        << missing.err;
    EXPECT_NE(missing.err.find("libcgal-dev"), std::string::npos);

    const auto script = [&](const std::string& folder, const std::string& last_words) {
        const std::string name = folder + "incise-tetmesh";
        write(name, "#!/bin/sh\nprintf '<%s>' \"$@\"\n" + last_words + "\n");
        std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
    };
    std::filesystem::create_directory(folder_ / "bin");
    script("bin/", "exit 4");
    const std::string arguments = "mesh 'a b.stl' b.stl out.vtu --size 2 --scale 1e-3";
    const auto words = "<a b.stl><b.stl><out.vtu><--size=2><--scale=1e-3>";
    const auto in_path = run(arguments, program, "PATH=bin");
    EXPECT_EQ(in_path.out, words);
    EXPECT_EQ(in_path.status, 4);

    script("", "kill -9 $$");
    const auto beside = run(arguments + " --size-surface 1 --features 30", program);
    EXPECT_EQ(beside.out,
              "<a b.stl><b.stl><out.vtu><--size=2><--size-surface=1><--features=30>"
              "<--scale=1e-3>");
    EXPECT_EQ(beside.status, 5);
    EXPECT_NE(beside.err.find("was killed"), std::string::npos) << beside.err;
}

TEST_F(Mesh, TellsHexahedraAndTetrahedraApart) {
    EXPECT_EQ(refusal("a.nrrd out.vtu"),
              "incise: --size is required for tetrahedra: give the length of their edges, in the "
              "unit of the mesh; or --hex for one cube a voxel\n");
    EXPECT_EQ(refusal("a.stl out.vtu --hex"),
              "incise: --hex makes cubes of one label image, and a.stl is a surface; leave --hex "
              "out for tetrahedra\n");
    EXPECT_NE(refusal("a.nrrd b.nrrd out.vtu --hex").find("a.nrrd is not the only file"),
              std::string::npos);
    for (const std::string option : {"--size-surface", "--features"}) {
        EXPECT_NE(refusal("a.nrrd out.vtu --hex " + option + " 1").find("is for tetrahedra"),
                  std::string::npos);
        EXPECT_NE(refusal("a.nrrd out.vtu --size 1 " + option + "=-1").find("above 0"),
                  std::string::npos);
    }
}

TEST_F(Mesh, RefusesArgumentsThatCannotBe) {
    for (const auto* value : {"0", "-1", "x", "inf", "nan", "1e999"})
        for (const std::string option : {"--size", "--scale"})
            EXPECT_EQ(refusal("a.nrrd out.vtu --hex " + option + "=" + value),
                      "incise: " + option + ": '" + value +
                          "' is not allowed; it must be a number above 0\n");
    EXPECT_NE(
        refusal("a.nrrd out.vtu --hex --scale 1e-200").find("incise: a.nrrd: --scale: 1e-200"),
        std::string::npos);
    EXPECT_NE(refusal("a.nrrd out.vtu --hex --size 1e-4").find("incise: a.nrrd: cubes of edge"),
              std::string::npos);
    EXPECT_NE(refusal("a.nrrd out.vtu --hex --size 100").find("incise: a.nrrd: no cube of edge"),
              std::string::npos);
    EXPECT_NE(refusal("a.nrrd out.doc --hex").find("cannot be written as '.doc'"),
              std::string::npos);
    EXPECT_NE(refusal("a.nrrd --hex").find("OUT is required"), std::string::npos);
}

TEST_F(Mesh, RefusesImagesThatCannotBeRead) {
    EXPECT_EQ(refusal("none.nii out.vtu --hex"),
              "incise: none.nii: no such file; check the path\n");
    write("short.nrrd", image.substr(0, image.size() - 4));
    EXPECT_EQ(refusal("short.nrrd out.vtu --hex"),
              "incise: short.nrrd: ends too early: its header announces 12 values, and there are "
              "10; get it anew\n");
    auto half = image;
    half.replace(half.rfind("2 0"), 1, "0.5");
    write("half.nrrd", half);
    EXPECT_NE(refusal("half.nrrd out.vtu --hex").find("voxel (0, 1, 1) has the value 0.5"),
              std::string::npos);
}

TEST_F(Mesh, ReportsOutputFailures) {
    const auto outcome = run("mesh a.nrrd no/such/out.vtu --hex");
    EXPECT_EQ(outcome.status, 4);
    EXPECT_EQ(outcome.err.find("incise: no/such/out.vtu"), 0u) << outcome.err;
}

TEST_F(Mesh, ExplainsItselfInItsHelp) {
    const auto help = run("mesh --help").out;
    for (const auto* words :
         {"--hex", "--size EDGE", "--size-surface EDGE", "--features ANGLE", "--scale FACTOR",
          ".nii.gz", ".stl", "right, front and head", "Examples:", "  incise mesh liver.nii.gz"})
        EXPECT_NE(help.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace incise
