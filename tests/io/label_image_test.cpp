// What label images of each format mean.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/image/label_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageWriter.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <numbers>

#include "incise/io/files/input_file.h"
#include "tests/io/image_samples.h"
#include "tests/io/reader_samples.h"

namespace incise::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Eigen::Matrix3d no_rotation = Eigen::Matrix3d::Identity();
/// Axes along y, -x and z.
const Eigen::Matrix3d quarter_turn = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();

void expect_image(const LabelImage& image, const Eigen::Matrix3d& directions, const Vec3& origin,
                  double tolerance = 1e-15) {
    EXPECT_THAT(image.dimensions, ElementsAre(2, 3, 4));
    EXPECT_EQ(image.labels, sample_labels());
    EXPECT_LE((image.spacing - Vec3(1, 2, 3)).norm(), tolerance) << image.spacing;
    EXPECT_LE((image.directions - directions).norm(), tolerance) << image.directions;
    EXPECT_LE((image.origin - origin).norm(), tolerance) << image.origin;
    EXPECT_THAT(image.warnings, IsEmpty());
}

/// Labels 0 to 23.
vtkSmartPointer<vtkImageData> vtk_image() {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(2, 3, 4);
    image->SetSpacing(1, 2, 3);
    image->AllocateScalars(VTK_SHORT, 1);
    auto* values = static_cast<short*>(image->GetScalarPointer());
    for (short v = 0; v < 24; ++v) values[v] = v;
    return image;
}

TEST(LabelImage, ReadsNiftiWrittenByVtk) {
    const support::TemporaryFolder folder;
    vtkNew<vtkMatrix4x4> pose;
    const double elements[] = {0, -1, 0, -10, 1, 0, 0, 5, 0, 0, 1, 7, 0, 0, 0, 1};
    pose->DeepCopy(elements);
    for (const auto* name : {"a.nii", "a.nii.gz"})
        for (const bool is_sform : {false, true}) {
            vtkNew<vtkNIFTIImageWriter> writer;
            writer->SetInputData(vtk_image());
            writer->SetFileName((folder / name).c_str());
            is_sform ? writer->SetSFormMatrix(pose) : writer->SetQFormMatrix(pose);
            writer->Write();
            expect_image(read_label_image(folder / name), quarter_turn, {-10, 5, 7}, 1e-7);
        }
}

TEST(LabelImage, ReadsMetaImageWrittenByVtk) {
    const support::TemporaryFolder folder;
    for (const auto* name : {"a.mha", "a.mhd"})
        for (const bool is_packed : {false, true}) {
            auto image = vtk_image();
            image->SetOrigin(-10, 5, 7);
            vtkNew<vtkMetaImageWriter> writer;
            writer->SetInputData(image);
            writer->SetFileName((folder / name).c_str());
            writer->SetCompression(is_packed);
            writer->Write();
            expect_image(read_label_image(folder / name), no_rotation, {-10, 5, 7});
        }
}

TEST(LabelImage, ReadsNiftiOfBothVersionsAndByteOrders) {
    for (const bool is_second : {false, true})
        for (const bool is_big : {false, true}) {
            Nifti nifti;
            nifti.is_second = is_second;
            nifti.is_big = is_big;
            nifti.datatype = 4;
            nifti.data = bytes_of<std::int16_t>(sample_labels(), is_big);
            nifti.sform_code = 1;
            nifti.srow = {0, -2, 0, -10, 1, 0, 0, 5, 0, 0, 3, 7};
            for (const auto& bytes : {nifti.bytes(), gzipped(nifti.bytes())})
                expect_image(read_image("a.nii", bytes), quarter_turn, {-10, 5, 7});
        }
}

TEST(LabelImage, TakesNiftisSformElseItsQform) {
    Nifti nifti;
    const double half = std::numbers::sqrt2 / 2;
    nifti.qform_code = 1;
    nifti.quaternion_and_offset = {0, 0, half, -10, 5, 7};
    expect_image(read_image("a.nii", nifti.bytes()), quarter_turn, {-10, 5, 7}, 1e-7);

    // About x: y goes to z.
    nifti.quaternion_and_offset = {half, 0, 0, -10, 5, 7};
    const Eigen::Matrix3d about_x = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
    expect_image(read_image("a.nii", nifti.bytes()), about_x, {-10, 5, 7}, 1e-7);

    nifti.sform_code = 2;
    nifti.srow = {0, -2, 0, 1, 1, 0, 0, 2, 0, 0, 3, 3};
    expect_image(read_image("a.nii", nifti.bytes()), quarter_turn, {1, 2, 3});
}

TEST(LabelImage, LeavesNiftisLeftHandedAxesLeftHanded) {
    Nifti nifti;
    const Eigen::Matrix3d mirror = Vec3(1, 1, -1).asDiagonal();
    nifti.qform_code = 1;
    nifti.pixdim[0] = -1;
    nifti.quaternion_and_offset = {0, 0, 0, -10, 5, 7};
    expect_image(read_image("a.nii", nifti.bytes()), mirror, {-10, 5, 7});

    nifti.sform_code = 1;
    nifti.srow = {-1, 0, 0, -10, 0, 2, 0, 5, 0, 0, 3, 7};
    expect_image(read_image("a.nii", nifti.bytes()), Vec3(-1, 1, 1).asDiagonal(), {-10, 5, 7});
}

TEST(LabelImage, WarnsOfAnOddOrMissingPose) {
    Nifti nifti;
    auto image = read_image("a.nii", nifti.bytes());
    EXPECT_THAT(image.warnings, ElementsAre(HasSubstr("neither sform nor qform")));
    EXPECT_EQ(image.spacing, Vec3(1, 2, 3));
    EXPECT_EQ(image.directions, no_rotation);
    EXPECT_EQ(image.origin, Vec3::Zero());

    nifti.sform_code = 1;
    nifti.srow = {1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 3, 0};
    nifti.units = 1;
    image = read_image("a.nii", nifti.bytes());
    EXPECT_THAT(image.warnings,
                ElementsAre("along axis 2 the voxel size is 2, but the sform steps by 4; the sform "
                            "is used",
                            "its lengths are in metres, not in millimetres; they are left so"));
    EXPECT_EQ(image.spacing, Vec3(1, 4, 3));

    image = read_image("a.mha", replaced(meta_image(), "ElementSpacing = 1 2 3\n", ""));
    EXPECT_THAT(image.warnings, ElementsAre("states no ElementSpacing; 1 is taken"));
    image = read_image("a.nrrd",
                       replaced(nrrd(), "space directions: (0,1,0) (-2,0,0) (0, 0, 3)\n", ""));
    EXPECT_THAT(image.warnings,
                ElementsAre("states neither space directions nor spacings; 1 is taken"));
    EXPECT_EQ(image.spacing, Vec3::Ones());
}

TEST(LabelImage, RescalesNiftisValuesAsItsHeaderSays) {
    Nifti nifti;
    nifti.scl = {2, -1};
    nifti.sform_code = 1;
    nifti.srow = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0};
    const auto labels = read_image("a.nii", nifti.bytes()).labels;
    for (int v = 0; v < 24; ++v) EXPECT_EQ(labels[static_cast<std::size_t>(v)], 2 * v - 1);
}

TEST(LabelImage, ReadsAllNumberTypes) {
    const auto expect_type = [](int nifti_type, const std::string& meta_type,
                                const std::string& nrrd_type, auto value) {
        using T = decltype(value);
        auto labels = sample_labels();
        if (std::is_signed_v<T>) labels[5] = -7;
        if (sizeof(T) > 1) labels[6] = 300;
        for (const bool is_big : {false, true}) {
            SCOPED_TRACE(nrrd_type + (is_big ? " big" : " little"));
            Nifti nifti;
            nifti.datatype = nifti_type;
            nifti.is_big = is_big;
            nifti.data = bytes_of<T>(labels, is_big);
            EXPECT_EQ(read_image("a.nii", nifti.bytes()).labels, labels);
            auto meta = replaced(meta_image_header("LOCAL"), "MET_UCHAR", meta_type);
            if (is_big) meta = replaced(meta, "MSB = False", "MSB = True");
            EXPECT_EQ(read_image("a.mha", meta + nifti.data).labels, labels);
            auto header = replaced(nrrd_header(), "unsigned char", nrrd_type);
            if (is_big) header = replaced(header, "little", "big");
            EXPECT_EQ(read_image("a.nrrd", header + "\n" + nifti.data).labels, labels);
        }
    };
    expect_type(256, "MET_CHAR", "int8", std::int8_t{});
    expect_type(2, "MET_UCHAR", "uchar", std::uint8_t{});
    expect_type(4, "MET_SHORT", "short", std::int16_t{});
    expect_type(512, "MET_USHORT", "unsigned short", std::uint16_t{});
    expect_type(8, "MET_INT", "int", std::int32_t{});
    expect_type(768, "MET_UINT", "uint32_t", std::uint32_t{});
    expect_type(1024, "MET_LONG_LONG", "long long", std::int64_t{});
    expect_type(1280, "MET_ULONG_LONG", "uint64", std::uint64_t{});
    expect_type(16, "MET_FLOAT", "float", float{});
    expect_type(64, "MET_DOUBLE", "double", double{});
}

TEST(LabelImage, ReadsMetaImageInItsPose) {
    expect_image(read_image("a.mha", meta_image()), quarter_turn, {-10, 5, 7});
    auto text = replaced(meta_image_header("LOCAL"), "BinaryData = True", "BinaryData = False");
    for (const int label : sample_labels()) text += std::to_string(label) + "\n";
    expect_image(read_image("a.mha", text), quarter_turn, {-10, 5, 7});
    // The names of old files, told by the content.
    const auto old =
        replaced(replaced(meta_image(), "Offset", "Position"), "TransformMatrix", "Orientation");
    expect_image(read_image("a.img", old), quarter_turn, {-10, 5, 7});
}

TEST(LabelImage, ReadsMetaImageDataFromAnotherFile) {
    const support::TemporaryFolder folder;
    const auto data = bytes_of<std::uint8_t>(sample_labels());
    write_bytes(folder / "my data.raw", "xyz" + data);
    for (const auto* size : {"3", "-1"}) {
        write_bytes(folder / "a.mhd",
                    "HeaderSize = " + std::string(size) + "\n" + meta_image_header("my data.raw"));
        expect_image(read_label_image(folder / "a.mhd"), quarter_turn, {-10, 5, 7});
    }
    // Labels that look like a mark of byte order.
    write_bytes(folder / "my data.raw", "\xEF\xBB\xBF" + data.substr(3));
    write_bytes(folder / "a.mhd", meta_image_header("my data.raw"));
    const auto labels = read_label_image(folder / "a.mhd").labels;
    EXPECT_EQ(labels[0], 0xEF);
    EXPECT_EQ(labels[2], 0xBF);
    EXPECT_EQ(labels[23], 23);
}

TEST(LabelImage, WarnsOfBytesBehindTheValues) {
    const support::TemporaryFolder folder;
    write_bytes(folder / "a.raw", bytes_of<std::uint8_t>(sample_labels()) + "xyz");
    write_bytes(folder / "a.mhd", meta_image_header("a.raw"));
    write_bytes(folder / "a.nhdr", nrrd_header() + "data file: a.raw\n");
    write_bytes(folder / "a.gz", gzipped(bytes_of<std::uint8_t>(sample_labels()) + "xyz"));
    write_bytes(folder / "b.nhdr", replaced(nrrd_header(), "raw", "gzip") + "data file: a.gz\n");
    for (const auto* name : {"a.mhd", "a.nhdr", "b.nhdr"}) {
        const auto image = read_label_image(folder / name);
        EXPECT_EQ(image.labels, sample_labels());
        EXPECT_THAT(image.warnings, ElementsAre(HasSubstr("has 3 bytes behind the values")));
    }
}

TEST(LabelImage, ReadsNrrdInAllItsEncodings) {
    const auto data = bytes_of<std::uint8_t>(sample_labels());
    std::string text, hex;
    for (const int label : sample_labels()) {
        text += std::to_string(label) + " ";
        hex += "0123456789aBcDeF"[label / 16];
        hex += "0123456789aBcDeF"[label % 16];
        if (label % 5 == 0) hex += '\n';
    }
    for (const auto& [encoding, values] : {std::pair<std::string, std::string>{"raw", data},
                                           {"txt", text},
                                           {"ascii", text},
                                           {"hex", hex},
                                           {"gzip", gzipped(data)},
                                           {"gz", gzipped(data)}}) {
        SCOPED_TRACE(encoding);
        const auto header = replaced(nrrd_header(), "encoding: raw", "encoding: " + encoding);
        expect_image(read_image("a.nrrd", header + "\n" + values), quarter_turn, {-10, 5, 7});
    }
    const auto members = gzipped(data.substr(0, 10)) + gzipped(data.substr(10));
    expect_image(read_image("a.nrrd", replaced(nrrd_header(), "raw", "gzip") + "\n" + members),
                 quarter_turn, {-10, 5, 7});
}

TEST(LabelImage, ReadsNrrdDataFromAnotherFile) {
    const support::TemporaryFolder folder;
    const auto data = bytes_of<std::uint8_t>(sample_labels());
    write_bytes(folder / "a.raw", "first\nsecond\nxyz" + data);
    write_bytes(folder / "a.nhdr",
                nrrd_header() + "data file: a.raw\nline skip: 2\nbyte skip: 3\n");
    expect_image(read_label_image(folder / "a.nhdr"), quarter_turn, {-10, 5, 7});
    write_bytes(folder / "a.nhdr", nrrd_header() + "datafile: a.raw\nbyte skip: -1\n");
    expect_image(read_label_image(folder / "a.nhdr"), quarter_turn, {-10, 5, 7});
    write_bytes(folder / "a.raw", gzipped("xyz" + data));
    write_bytes(folder / "a.nhdr",
                replaced(nrrd_header(), "raw", "gzip") + "data file: a.raw\nbyte skip: 3\n");
    expect_image(read_label_image(folder / "a.nhdr"), quarter_turn, {-10, 5, 7});
    write_bytes(folder / "a.nhdr",
                replaced(nrrd_header(), "raw", "gzip") + "data file: a.raw\nbyte skip: -1\n");
    expect_image(read_label_image(folder / "a.nhdr"), quarter_turn, {-10, 5, 7});
}

TEST(LabelImage, ReadsPackedValuesAtTheEndOfManyBytes) {
    const support::TemporaryFolder folder;
    const std::string before(200000, 'x');
    write_bytes(folder / "a.gz", gzipped(before + bytes_of<std::uint8_t>(sample_labels())));
    for (const auto* skip : {"-1", "200000"}) {
        write_bytes(folder / "a.nhdr", replaced(nrrd_header(), "raw", "gzip") +
                                           "data file: a.gz\nbyte skip: " + skip + "\n");
        expect_image(read_label_image(folder / "a.nhdr"), quarter_turn, {-10, 5, 7});
    }
}

TEST(LabelImage, ReadsNrrdOfSpacingsAlone) {
    const auto bytes = replaced(
        replaced(nrrd(), "space directions: (0,1,0) (-2,0,0) (0, 0, 3)", "spacings: 1 2 3"),
        "space: left-posterior-superior\n", "");
    expect_image(read_image("a.nrrd", bytes), no_rotation, {-10, 5, 7});
}

TEST(LabelImage, TakesTheLengthOfDirectionsIntoTheSpacing) {
    const auto image =
        read_image("a.mha", replaced(meta_image(), "0 1 0 -1 0 0 0 0 1", "0 2 0 -1 0 0 0 0 1"));
    EXPECT_EQ(image.spacing, Vec3(2, 2, 3));
    EXPECT_EQ(image.directions, quarter_turn);
}

}  // namespace
}  // namespace incise::io
