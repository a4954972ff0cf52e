// What all formats share: every encoding gives the same mesh, and files that are none are refused.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/mesh_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/topology/box_mesh.h"
#include "tests/io/reader_samples.h"
#include "tests/support/num_cases.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using support::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using topology::CellKind;

constexpr const char* written_suffixes[] = {".vtu", ".vtk", ".msh", ".mesh", ".inp"};

TEST(MeshReader, ReadsTheSameMeshFromEveryEncoding) {
    for (const auto& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        const auto file = read_bytes(sample.name, sample.bytes);
        expect_same_mesh(file.mesh, sample_mesh());
        EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("ignored 1 line and 2 triangles")));
    }
}

TEST(MeshReader, KeepsWhatTheFileCallsCellsAndPoints) {
    for (const auto& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        const auto mesh = read_bytes(sample.name, sample.bytes).mesh;
        const auto is_a = [&](const char* suffix) { return sample.name.ends_with(suffix); };
        if (is_a(".vtu") || is_a(".vtk")) {
            EXPECT_THAT(mesh.source_cells, ElementsAre(1, 3, 4, 6));
            EXPECT_EQ(mesh.point_name(3), "point 3");
        } else if (is_a(".msh") || is_a(".feb")) {
            EXPECT_THAT(mesh.source_cells, ElementsAre(4, 5, 6, 7));
            EXPECT_EQ(mesh.point_name(3), "point 3 (number 979 in the file)");
        } else if (is_a(".inp")) {
            EXPECT_THAT(mesh.source_cells, ElementsAre(1, 6, 11, 16));
            EXPECT_EQ(mesh.point_name(3), "point 3 (number 979 in the file)");
        } else {
            ASSERT_TRUE(is_a(".mesh"));
            EXPECT_THAT(mesh.source_cells, ElementsAre(1, 1, 1, 1));  // each the first of its kind
            EXPECT_EQ(mesh.point_name(3), "point 3 (number 4 in the file)");
        }
    }
}

TEST(MeshReader, RecognizesFormatsByContentWhateverTheSuffix) {
    for (const auto& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        expect_same_mesh(read_bytes("mesh.dat", sample.bytes).mesh, sample_mesh());
    }
}

TEST(MeshReader, AcceptsByteOrderMarksAndWindowsLineEnds) {
    for (const auto& sample : all_samples()) {
        if (!sample.name.starts_with("ascii")) continue;
        SCOPED_TRACE(sample.name);
        std::string bytes = "\xEF\xBB\xBF\r\n \r\n";
        for (const char c : sample.bytes) {
            if (c == '\n') bytes += '\r';
            bytes += c;
        }
        expect_same_mesh(read_bytes(sample.name, bytes).mesh, sample_mesh());
    }
}

TEST(MeshReader, ReadsBackWrittenMeshesToTheBit) {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.01, 0.01);
    for (const auto kind : {CellKind::tetrahedron, CellKind::hexahedron}) {
        auto mesh = topology::box_mesh(kind, Vec3(0.1, -0.2, 1e-5), Vec3(1, 2, 3), {3, 4, 5});
        for (auto& point : mesh.points)
            for (auto& x : point) x += shift(random);
        for (std::size_t c = 0; c < mesh.num_cells(); ++c)
            mesh.regions[c] = static_cast<int>(c % 3);
        for (const char* suffix : written_suffixes) {
            SCOPED_TRACE(suffix);
            const auto path = folder / (std::string("mesh") + suffix);
            write_mesh(path, mesh);
            const auto file = read_mesh(path);
            EXPECT_THAT(file.warnings, ElementsAre());
            expect_same_mesh(file.mesh, mesh);
        }
    }
}

TEST(MeshReader, KnowsAgainWhosePointsMayCoincide) {
    const TemporaryFolder folder;
    auto mesh = topology::box_mesh(CellKind::hexahedron, Vec3(0, 0, 0), Vec3(1, 2, 3), {2, 2, 2});
    for (const char* suffix : written_suffixes)
        for (const bool may_coincide : {false, true}) {
            SCOPED_TRACE(suffix);
            mesh.points_may_coincide = may_coincide;
            const auto path = folder / (std::string("mesh") + suffix);
            write_mesh(path, mesh);
            const auto file = read_mesh(path);
            EXPECT_EQ(file.mesh.points_may_coincide, may_coincide);
            EXPECT_THAT(file.warnings, ElementsAre());
            expect_same_mesh(file.mesh, mesh);
        }
}

TEST(MeshReader, LetsThePointsOfAFrameCoincide) {
    const TemporaryFolder folder;
    Frame frame;
    frame.mesh = topology::box_mesh(CellKind::hexahedron, Vec3(0, 0, 0), Vec3(1, 2, 3), {1, 1, 1});
    frame.point_fields.push_back({"rest_position", 3, std::vector<double>(24, 0.0)});
    write_vtu(folder / "frame.vtu", frame);
    EXPECT_FALSE(read_mesh(folder / "frame.vtu").mesh.points_may_coincide);
    frame.point_fields.push_back({"node_id", 1, std::vector<std::int64_t>(8, 0)});
    write_vtu(folder / "frame.vtu", frame);
    EXPECT_TRUE(read_mesh(folder / "frame.vtu").mesh.points_may_coincide);
}

/// The cell of the sample of that number, alone.
topology::MeshData sample_cell(std::size_t c, bool is_mirrored) {
    const auto sample = sample_mesh();
    topology::MeshData mesh;
    mesh.points = sample.points;
    const auto& mirrored = topology::traits(sample.kinds[c]).mirrored;
    std::vector<std::int64_t> corners;
    for (std::size_t k = 0; k < sample.cell(c).size(); ++k)
        corners.push_back(sample.cell(c)[is_mirrored ? static_cast<std::size_t>(mirrored[k]) : k]);
    mesh.add_cell(sample.kinds[c], corners, sample.regions[c]);
    return mesh;
}

TEST(MeshReader, TurnsCellsThatAreAllInverted) {
    const TemporaryFolder folder;
    for (const char* suffix : written_suffixes)
        for (std::size_t c = 0; c < sample_mesh().num_cells(); ++c) {
            SCOPED_TRACE(std::string(suffix) + ", cell " + std::to_string(c));
            const auto path = folder / (std::string("mesh") + suffix);
            write_mesh(path, sample_cell(c, true));
            const auto file = read_mesh(path);
            EXPECT_THAT(file.warnings,
                        ElementsAre("the only cell has negative volume by VTK's order of corners: "
                                    "the order was reversed; make sure that the body is not the "
                                    "mirror image of what is meant"));
            expect_same_mesh(file.mesh, sample_cell(c, false));
        }
}

TEST(MeshReader, TurnsCellsOfAKindThatIsInverted) {
    const TemporaryFolder folder;
    for (const char* suffix : written_suffixes)
        for (std::size_t c = 0; c < sample_mesh().num_cells(); ++c) {
            SCOPED_TRACE(std::string(suffix) + ", cell " + std::to_string(c));
            auto mesh = sample_mesh();
            const auto mirrored = sample_cell(c, true);
            std::ranges::copy(mirrored.corners,
                              mesh.corners.begin() + static_cast<std::ptrdiff_t>(mesh.offsets[c]));
            const auto path = folder / (std::string("mesh") + suffix);
            write_mesh(path, mesh);
            const auto file = read_mesh(path);
            EXPECT_THAT(
                file.warnings,
                ElementsAre(std::string("the only ") + topology::traits(mesh.kinds[c]).name +
                            " has negative volume by VTK's order of corners: the order was "
                            "reversed; the other cells have their corners in that order"));
            if (std::string_view(suffix) != ".mesh")  // which lists cells by kind
                expect_same_mesh(file.mesh, sample_mesh());
        }
}

TEST(MeshReader, LeavesSomeInvertedCellsAsTheyAre) {
    const TemporaryFolder folder;
    auto mesh = topology::box_mesh(CellKind::tetrahedron, Vec3(0, 0, 0), Vec3(1, 2, 3), {2, 2, 2});
    for (std::size_t c = 1; c < mesh.num_cells(); ++c)
        std::swap(mesh.corners[4 * c], mesh.corners[4 * c + 1]);
    for (const char* suffix : written_suffixes) {
        SCOPED_TRACE(suffix);
        const auto path = folder / (std::string("mesh") + suffix);
        write_mesh(path, mesh);
        const auto file = read_mesh(path);
        EXPECT_THAT(file.warnings, ElementsAre());
        expect_same_mesh(file.mesh, mesh);
    }
}

TEST(MeshReader, AlwaysTakesRegionsOfGmshFromPhysicalGroups) {
    for (const auto& sample : gmsh_samples()) {
        SCOPED_TRACE(sample.name);
        const auto file = read_bytes(sample.name, sample.bytes, {.region_array = "organ"});
        EXPECT_EQ(file.mesh.regions, sample_mesh().regions);
    }
}

TEST(MeshReader, RefusesVectorsOfFormatsWithoutThem) {
    const auto samples = gmsh_samples();
    EXPECT_THAT(refusal(samples.front().name, samples.front().bytes, {.vector_arrays = {"fibre"}}),
                HasSubstr("has no cell array 'fibre': none is read from meshes of the format Gmsh; "
                          "use VTU or legacy VTK"));
}

TEST(MeshReader, RefusesFilesThatAreCutShort) {
    for (const auto& sample : all_samples()) {
        // Legacy VTK and Abaqus have no end mark: what follows the cells, and in Abaqus rows of
        // cells, may be missing unnoticed.
        const bool has_end = !sample.name.ends_with(".vtk") && !sample.name.ends_with(".inp");
        const std::size_t last = has_end ? 9 : 4;
        for (std::size_t tenths = 1; tenths <= last; tenths += test::is_sanitized ? 8 : 2) {
            SCOPED_TRACE(sample.name + ", tenths: " + std::to_string(tenths));
            const auto size = sample.bytes.size() * tenths / 10;
            refusal(sample.name, std::string_view(sample.bytes).substr(0, size));
        }
    }
}

TEST(MeshReader, RefusesWhatIsNoMeshFile) {
    EXPECT_THAT(refusal("notes.txt", "Dear diary,\n"),
                AllOf(HasSubstr("no mesh format known"), HasSubstr("VTU (.vtu)")));
    EXPECT_THAT(refusal("liver.vtu", "  \n\n"), HasSubstr("no mesh format known"));
    EXPECT_THAT(refusal("liver.vtu", ""), HasSubstr("the file is empty"));
    // A binary file whose first byte is the mark of Gmsh.
    EXPECT_THAT(refusal("cube.msh", std::string("$\0\0\0$\0\0\0", 8)),
                HasSubstr("no mesh format known"));
    EXPECT_THAT(refusal("liver.vtk", "#vtk DataFile Version 2.0\nliver\nASCII\n"),
                HasSubstr("write '# vtk DataFile' there"));
}

TEST(MeshReader, NamesMeshesOfOtherPrograms) {
    for (const auto& [text, name] : std::initializer_list<std::pair<std::string, const char*>>{
             {"(0 \"GAMBIT to Fluent File\")\n(2 3)\n", "a mesh of ANSYS Fluent"},
             {"/COM,ANSYS RELEASE 19.2\n/PREP7\n", "an archive of ANSYS Mechanical"},
             {"*KEYWORD\n*NODE\n", "a mesh of LS-DYNA"},
             {"mesh3d\ndimension\n3\n", "a mesh of Netgen"},
             {"MESH dimension 3 ElemType Tetrahedra Nnode 4\n", "a mesh of GiD"},
             {"        CONTROL INFO 2.3.16\n** GAMBIT NEUTRAL FILE\n", "a neutral file of GAMBIT"},
             {"   -1\r\n   100\r\n<NULL>\r\n", "a neutral file of FEMAP"},
             {"    -1\n  2411\n", "a universal file (UNV) of I-DEAS"},
             {"NDIME= 3\n", "a mesh of SU2"},
             {"\x89HDF\r\n\x1a\n", "an HDF5 file, as of Fluent (.msh.h5), CGNS and MED"},
             {std::string("CDF\x01\0\0", 6), "a NetCDF file, as of Exodus"},
         }) {
        SCOPED_TRACE(name);
        EXPECT_THAT(refusal("liver.msh", text),
                    AllOf(StartsWith(std::string("liver.msh: is ") + name +
                                     ", which cannot be read; convert it, with Gmsh or meshio for "
                                     "instance, to one of: VTU (.vtu), "),
                          HasSubstr("Gmsh (.msh)")));
    }
}

/// A .pvd, .vtu.series or .pvtu, which names these files.
std::string index_text(const std::string& suffix, const std::vector<std::string>& files) {
    std::string rows;
    for (const auto& file : files)
        rows += suffix == ".series" ? (rows.empty() ? "" : ", ") + ("{\"name\": \"" + file + "\"}")
                : suffix == ".pvd"  ? "<DataSet timestep=\"0\" file=\"" + file + "\"/>"
                                    : "<Piece Source=\"" + file + "\"/>";
    if (suffix == ".series") return "{\"file-series-version\": \"1.0\", \"files\": [" + rows + "]}";
    const std::string type = suffix == ".pvd" ? "Collection" : "PUnstructuredGrid";
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + "\">\n<" + type + ">" + rows +
           "</" + type + "></VTKFile>\n";
}

TEST(MeshReader, NamesTheFilesOfAnIndex) {
    for (const std::string suffix : {".series", ".pvd", ".pvtu"}) {
        SCOPED_TRACE(suffix);
        const auto refusal_of = [&](const std::vector<std::string>& files) {
            return refusal("liver" + suffix, index_text(suffix, files));
        };
        const auto several = refusal_of({"frames/a_0.vtu", "frames/a_1.vtu", "/b/a_2.vtu"});
        EXPECT_THAT(several, StartsWith("liver" + suffix +
                                        ": holds no mesh itself but names 3 files, from "));
        EXPECT_THAT(several, HasSubstr(" from frames/a_0.vtu to /b/a_2.vtu"));
        EXPECT_THAT(several, HasSubstr(suffix == ".pvtu" ? "which are parts of one mesh; save them "
                                                           "as one .vtu"
                                                         : "; give one of them"));
        EXPECT_THAT(refusal_of({"a.vtu"}), testing::EndsWith(" a.vtu; give that one"));
        EXPECT_THAT(refusal_of({}),
                    StartsWith("liver" + suffix + ": is an index of other files and names none; "));
    }
}

TEST(MeshReader, SaysWhatAnUnreadableSeriesShouldBe) {
    for (const char* text : {"{\"files\": [", "[]", "3", "Dear diary"})
        EXPECT_THAT(refusal("liver.vtu.series", text),
                    StartsWith("liver.vtu.series: is no readable series of frames, which is an "
                               "object in JSON with a list of \"files\"; "))
            << text;
    for (const char* text : {"{}", "{\"files\": 3}", "{\"files\": [{\"time\": 0}]}"})
        EXPECT_THAT(refusal("liver.vtu.series", text), HasSubstr("names none")) << text;
}

TEST(MeshReader, NamesFreeFemMeshesWithTheGmshSuffix) {
    const std::string mesh = "0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 2 3 4 1\n";
    for (const std::string header : {"4 1 0\n", "  4\t1 0 \r\n"})
        EXPECT_THAT(refusal("liver.msh", header + mesh),
                    AllOf(StartsWith("liver.msh: begins with three counts and has no $MeshFormat, "
                                     "so it is a mesh of FreeFEM"),
                          HasSubstr("savemesh(Th, \"NAME.mesh\")")))
            << header;
    for (const std::string header : {"4 1\n", "4 1 0 0\n", "4 1 x\n", "4 1 -1\n", "4 1 0.5\n"})
        EXPECT_THAT(refusal("liver.msh", header + mesh), HasSubstr("no mesh format known"))
            << header;
    EXPECT_THAT(refusal("liver.txt", "4 1 0\n" + mesh), HasSubstr("no mesh format known"));
}

/// The message about a path that names no file to read.
std::string refusal_of_path(const std::filesystem::path& path) {
    try {
        read_mesh(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(MeshReader, RefusesPathsThatNameNoFile) {
    const TemporaryFolder folder;
    EXPECT_THAT(refusal_of_path(folder / "liver.vtu"),
                AllOf(HasSubstr("liver.vtu: "), HasSubstr("no such file")));
    EXPECT_THAT(refusal_of_path(folder.path()), HasSubstr("is a directory"));
    EXPECT_THAT(refusal_of_path("/dev/null"), HasSubstr("is not a regular file"));
    std::ofstream(folder / "file") << "x";
    EXPECT_THAT(refusal_of_path(folder / "file" / "liver.vtu"), HasSubstr("liver.vtu: "));
}

}  // namespace
}  // namespace incise::io
