// Meshes of USD as text: what they mean, what is refused, and the way there and back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/topology/box_mesh.h"
#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string usda = R"(#usda 1.0
(
    doc = """All of "it" } ( \""""
    metersPerUnit = 1
    customLayerData = { string a = "}" }
)

def Xform "World" (
    kind = "component"
)
{
    uniform token[] xformOpOrder = []
    def Mesh "Skin" { point3f[] points = [(9, 9, 9)] }
    def TetMesh "Liver" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {
        float3[] extent = [(0, 0, 0), (1, 1, 1)]
        rel material:binding = </World/Looks>
        uniform token orientation = "rightHanded" # as is usual
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1),] (
            interpolation = "vertex"
        )
        int4[] tetVertexIndices = [(0, 1, 2, 3),
            (1, 2, 3, 4)]
        int3[] surfaceFaceVertexIndices
        def GeomSubset "Tumour"
        {
            uniform token elementType = "tetrahedron"
            int[] indices = [1]
        }
        def GeomSubset "Outside" { uniform token elementType = "face"; int[] indices = [77] }
    }
    over "Liver2" { }
}
)";

TEST(UsdaReader, ReadsPointsTetrahedraAndSubsets) {
    const auto file = read_bytes("a.usda", usda);
    EXPECT_EQ(file.mesh.points.size(), 5u);
    EXPECT_EQ(file.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.mesh.regions, ElementsAre(0, 1));
    EXPECT_THAT(file.warnings, ElementsAre("element sets are taken as regions: region 1 is "
                                           "'Tumour'; region 0 is in none of them"));
    expect_same_mesh(read_bytes("mesh.dat", usda).mesh, file.mesh);
}

TEST(UsdaReader, TurnsUnitsIntoMetres) {
    const auto cm = read_bytes("a.usda", replaced(usda, "metersPerUnit = 1", "metersPerUnit = .5"));
    EXPECT_EQ(cm.mesh.points[4], Vec3(.5, .5, .5));
    EXPECT_THAT(cm.warnings,
                ElementsAre(HasSubstr("taken as regions"),
                            "coordinates were multiplied by metersPerUnit, 0.5, which makes them "
                            "metres"));
    const auto none = read_bytes("a.usda", replaced(usda, "metersPerUnit = 1", ""));
    EXPECT_EQ(none.mesh.points[4], Vec3(1, 1, 1));
    EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("taken as regions"),
                                           StartsWith("has no metersPerUnit: coordinates are taken "
                                                      "as metres")));
}

TEST(UsdaReader, FollowsTheOrientation) {
    // Corners 1 and 2 change places, so that the volume stays positive.
    auto text = replaced(usda, "rightHanded", "leftHanded");
    text = replaced(replaced(text, "(0, 1, 2, 3)", "(0, 2, 1, 3)"), "(1, 2, 3, 4)", "(1, 3, 2, 4)");
    const auto file = read_bytes("a.usda", text);
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("taken as regions")));
}

TEST(UsdaReader, PutsMeshesOneBehindTheOther) {
    const auto file = read_bytes(
        "a.usda", usda +
                      "def TetMesh \"More\" { point3f[] points = [(0,0,5),(1,0,5),(0,1,5),"
                      "(0,0,6)]; int4[] tetVertexIndices = [(0,1,2,3)]\n"
                      "def GeomSubset \"REGION_m7\" { uniform token elementType = "
                      "\"tetrahedron\"; int[] indices = [0] } }\n");
    EXPECT_THAT(file.mesh.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8));
    EXPECT_THAT(file.mesh.regions, ElementsAre(0, 1, -7));
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("taken as regions"),
                                           "2 meshes were put one behind the other"));
}

const std::vector<Fault> usda_faults = {
    // Wrong numbers.
    {"(1, 2, 3, 4)", "(1, 2, 3, 5)",
     "a.usda:25: tetrahedron 1: point 5 is out of range (5 points, numbered from 0)"},
    {"(1, 2, 3, 4)", "(1, 2, 3)", "a.usda:25: expected ',' between numbers, found ')'"},
    {"(1, 1, 1),]", "(1, 1, nan)]", "a.usda:21: a coordinate is nan; it must be finite"},
    {"(1, 1, 1),]", "(1, x, 1)]", "a.usda:21: expected a coordinate, found 'x'"},
    {"indices = [1]", "indices = [2]",
     "a.usda:30: subset 'Tumour': tetrahedron 2 is out of range (2 tetrahedra, numbered from 0)"},
    {"\"rightHanded\"", "\"upright\"",
     "a.usda:14: TetMesh 'Liver': the orientation is 'upright'; it must be..."},
    {"metersPerUnit = 1", "metersPerUnit = -1", "a.usda: metersPerUnit is -1; it must be above 0"},
    {"metersPerUnit = 1", "metersPerUnit = one",
     "a.usda:4: expected the metres per unit, found 'one'..."},
    // What is not followed.
    {"xformOpOrder = []", "xformOpOrder = [\"xformOp:translate\"]",
     "a.usda:12: the mesh is moved by xformOpOrder of 'World', which is not done here; save its "
     "points..."},
    {"point3f[] points = [(0", "point3f[] points.timeSamples = {0: [(0)]}\nfloat[] more = [(0",
     "a.usda:21: TetMesh 'Liver' changes in time; save it at one time..."},
    {"tetVertexIndices", "vertexIndices",
     "a.usda:14: TetMesh 'Liver' has no tetVertexIndices; save it in one..."},
    {"def TetMesh", "def Mesh", "a.usda: there is no prim defined as a TetMesh here..."},
    {"def TetMesh", "over TetMesh", "...there is no prim defined..."},
    {"def Xform", "class Xform", "...there is no prim defined..."},
    {"", "#usda 1.0\ndef \"A\" (\n    references = @b.usda@</B>\n)\n{\n}\n",
     "a.usda:3: refers to another file, which is not read, and there is no..."},
    // Damaged text.
    {"\"World\" (", "World (", "a.usda:8: expected the name of a prim, found..."},
    {"\"tetrahedron\"", "\"tetrahedron", "a.usda:29: a text in quotes has no end..."},
    {"(1, 2, 3, 4)]", "(1, 2, 3, 4)", "...or ']' in a list..."},
    {"", usda + "}\n", "...expected a prim or a property..."},
};

TEST(UsdaReader, RefusesFaultyFiles) {
    expect_refusals("a.usda", usda, usda_faults);
    expect_refusals(
        "a.usda", replaced(usda, "metersPerUnit = 1", "metersPerUnit = 1e308"),
        {{"(1, 1, 1),]", "(10, 10, 10)]", "...makes coordinates beyond the range of numbers..."}});
    EXPECT_THAT(refusal("a.usdc", "PXR-USDC" + std::string(80, '\0')),
                StartsWith("a.usdc: is a binary file of USD (.usdc or .usd), which cannot be read; "
                           "turn it into text, for instance by 'usdcat"));
    EXPECT_THAT(refusal("a.usdz", "PK\x03\x04" + std::string(80, '\0')), HasSubstr("(.usdz)"));
    std::string deep = "#usda 1.0\n";
    for (int i = 0; i < 100000; ++i) deep += "def \"a\" {";
    EXPECT_THAT(refusal("a.usda", deep), HasSubstr("prims lie in each other more than 200 deep"));
    const auto end = usda.find("over \"Liver2\"");
    for (std::size_t size = 10; size < end; size += 7)
        EXPECT_NE(refusal("a.usda", usda.substr(0, size)), "") << size;
}

TEST(UsdaWriter, WritesWhatReadsBackToTheBit) {
    const support::TemporaryFolder folder;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.01, 0.01);
    auto mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3(0.1, -0.2, 1e-5),
                                   Vec3(1, 2, 3), {3, 4, 5});
    for (auto& point : mesh.points)
        for (auto& x : point) x += shift(random);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        mesh.regions[c] = static_cast<int>(c % 4) - 1;
    for (const bool may_coincide : {false, true}) {
        mesh.points_may_coincide = may_coincide;
        write_mesh(folder / "mesh.usda", mesh);
        const auto file = read_mesh(folder / "mesh.usda");
        EXPECT_THAT(file.warnings, ElementsAre());
        EXPECT_EQ(file.mesh.points_may_coincide, may_coincide);
        expect_same_mesh(file.mesh, mesh);
    }
}

TEST(UsdaWriter, RefusesOtherCells) {
    const support::TemporaryFolder folder;
    try {
        write_mesh(folder / "mesh.usda", sample_mesh());
        ADD_FAILURE() << "written";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("mesh.usda: the format holds tetrahedra alone, and "
                                            "cell 0 (wedge) is none; write .vtu"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "mesh.usda"));
}

}  // namespace
}  // namespace incise::io
