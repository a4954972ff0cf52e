// What is refused in a label image, and how it is told.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "incise/io/files/input_file.h"
#include "incise/io/files/memory.h"
#include "incise/io/image/label_image.h"
#include "tests/io/image_samples.h"
#include "tests/io/reader_samples.h"
#include "tests/io/refusals.h"

namespace incise::io {
namespace {

using testing::HasSubstr;

std::string image_refusal(const std::string& name, std::string_view bytes) {
    return refusal_by([](const auto& path) { read_label_image(path); }, name, bytes);
}

TEST(LabelImage, RefusesHeadersThatNameThemselvesAsTheData) {
    EXPECT_THAT(image_refusal("a.mhd", meta_image_header("./a.mhd")),
                HasSubstr("a.mhd:12: names itself as the file of the data"));
    for (const auto& name : {std::string(5000, 'a'), std::string("\x1b[31m")}) {
        const auto message = image_refusal("a.mhd", meta_image_header(name));
        EXPECT_THAT(message, HasSubstr("a.mhd:12: the name of the data file, '"));
        EXPECT_LT(message.size(), 200u);
        EXPECT_EQ(message, printable(message));
    }
}

TEST(LabelImage, RefusesFewerPackedBytesThanTheHeaderStates) {
    const auto packed = gzipped(bytes_of<std::uint8_t>(sample_labels()));
    const auto image = [&](const std::string& size) {
        return replaced(meta_image_header("LOCAL"), "CompressedData = False",
                        "CompressedData = True\nCompressedDataSize = " + size) +
               packed;
    };
    EXPECT_EQ(read_image("a.mha", image(std::to_string(packed.size()))).labels, sample_labels());
    for (const auto& [size, shown_size] :
         {std::pair<std::string, std::string>{"99999999999", "99999999999"}, {"nan", "nan"}})
        EXPECT_EQ(image_refusal("a.mha", image(size)),
                  "a.mha: ends too early: its header announces " + shown_size +
                      " bytes of packed values, and there are " + std::to_string(packed.size()) +
                      "; get it anew");
}

/// A MetaImage of 32-bit numbers in a row.
std::string row_of(const std::vector<int>& values) {
    return replaced(replaced(meta_image_header("LOCAL"), "MET_UCHAR", "MET_INT"), "2 3 4",
                    std::to_string(values.size()) + " 1 1") +
           bytes_of<std::int32_t>(values);
}

TEST(LabelImage, RefusesScansUnlessToldThatTheyHaveLabels) {
    std::vector<int> many(257);
    std::iota(many.begin(), many.end(), 1000);
    const std::vector<int> few(many.begin(), many.end() - 1);
    const std::string remedy =
        "; give a segmentation of it, or, if each value is a label, set "
        "LabelImageOptions::has_labels";
    EXPECT_EQ(image_refusal("a.mha", row_of(many)),
              "a.mha: looks like a scan, an image of grey values: it has more than 256 different "
              "values, from 1000 to 1256" +
                  remedy);
    EXPECT_EQ(image_refusal("a.mha", row_of({0, 3, -7, 0})),
              "a.mha: looks like a scan, an image of grey values: it has values below 0, the "
              "lowest -7" +
                  remedy);
    const support::TemporaryFolder folder;
    write_bytes(folder / "few.mha", row_of(few));
    EXPECT_EQ(read_label_image(folder / "few.mha").labels, few);
    for (const auto& values : {many, std::vector<int>{0, 3, -7, 0}}) {
        write_bytes(folder / "a.mha", row_of(values));
        EXPECT_EQ(read_label_image(folder / "a.mha", {.has_labels = true}).labels, values);
    }
}

// Values of a byte, as many scans have: from voxel to voxel, and in blocks as labels lie.
TEST(LabelImage, TellsScansOfAByteFromManyLabels) {
    std::vector<int> scan(20000), labels(20000);
    for (std::size_t v = 0; v < scan.size(); ++v) {
        scan[v] = static_cast<int>(v * 37 % 200);
        labels[v] = static_cast<int>(v / 100);
    }
    EXPECT_EQ(image_refusal("a.mha", row_of(scan)),
              "a.mha: looks like a scan, an image of grey values: it has 200 different values, "
              "which change from voxel to voxel; give a segmentation of it, or, if each value is a "
              "label, set LabelImageOptions::has_labels");
    const support::TemporaryFolder folder;
    write_bytes(folder / "a.mha", row_of(labels));
    EXPECT_EQ(read_label_image(folder / "a.mha").labels, labels);
}

/// All but the last bytes.
std::string cut(const std::string& bytes, std::size_t num_less) {
    return bytes.substr(0, bytes.size() - num_less);
}

const std::vector<Fault> nifti_faults = {
    {"", cut(Nifti().bytes(), 1),
     "a.nii: ends too early: its header announces 24 bytes of values, and there are 23; get it "
     "anew"},
    {"", Nifti().bytes().substr(0, 100),
     "a.nii: ends within the header of a NIfTI image; get it anew"},
    {"", std::string(400, 'x'), "...does not begin as a NIfTI image..."},
    // Dimensions and types.
    {"", Nifti{.dim = {2, 4, 6}}.bytes(),
     "a.nii: is an image of 2 axes; a mesh takes one of three, with one label a voxel"},
    {"", Nifti{.dim = {4, 2, 3, 2, 2}}.bytes(), "a.nii: has 2 images in time; save one of them"},
    {"", Nifti{.dim = {5, 2, 3, 2, 1, 2}}.bytes(), "...more than one component a voxel (2)..."},
    {"", Nifti{.dim = {3, 2, -3, 4}}.bytes(), "...has -3 voxels along axis 2..."},
    {"", Nifti{.dim = {9, 2, 3, 4}}.bytes(), "...has 9 axes..."},
    {"", Nifti{.dim = {3, 32767, 32767, 32767}}.bytes(), "...more than 2147483647 voxels..."},
    {"", Nifti{.dim = {3, 1000, 1000, 1000}}.bytes(),
     "...announces 1000000000 bytes of values, and there are 24..."},
    {"", Nifti{.datatype = 128}.bytes(), "...more than one component..."},
    {"", Nifti{.datatype = 1}.bytes(), "...data type 1 is not known..."},
    // Spacing and pose.
    {"", Nifti{.pixdim = {1, 1, 0, 3}}.bytes(),
     "a.nii: the spacing of voxels along axis 2 is 0; it must be above 0 and finite"},
    {"", Nifti{.pixdim = {1, 1, 2, -1}}.bytes(), "...along axis 3 is -1;..."},
    {"", Nifti{.pixdim = {1, std::nan(""), 2, 3}}.bytes(), "...is nan;..."},
    {"", Nifti{.qform_code = 1, .quaternion_and_offset = {0, 0, 0, 0, INFINITY}}.bytes(),
     "...the origin has inf..."},
    {"", Nifti{.sform_code = 1, .srow = {1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 3, 0}}.bytes(),
     "...the directions of its three axes lie in a plane..."},
};

TEST(LabelImage, RefusesDamagedNifti) {
    expect_refusals(image_refusal, "a.nii", Nifti().bytes(), nifti_faults);
    EXPECT_THAT(image_refusal("a.hdr", replaced(Nifti().bytes(), "n+1", "ni1")),
                HasSubstr("no NIfTI image in one file"));
    const auto packed = gzipped(Nifti().bytes());
    EXPECT_THAT(image_refusal("a.nii.gz", cut(packed, 12)),
                HasSubstr("the packed data are damaged, or end before 376 bytes"));
    auto damaged = packed;
    damaged[damaged.size() - 6] ^= 1;  // the sum of checks
    EXPECT_THAT(image_refusal("a.nii.gz", damaged), HasSubstr("the packed data are damaged"));
}

const std::vector<Fault> meta_image_faults = {
    {"", cut(meta_image(), 14),
     "a.mha: ends too early: its header announces 24 bytes of values, and there are 10; get it "
     "anew"},
    {"", meta_image_header("x").substr(0, 150), "...no ElementDataFile..."},
    {"CompressedData = False", "CompressedData = True", "...the packed data are damaged..."},
    {"ElementDataFile", "DataFile", "a.mha:13: expected KEY = VALUE..."},
    {"NDims = 3", "NDims = 2", "a.mha:10: expected 2 numbers, found '2 3 4'"},
    {"", replaced(replaced(meta_image(), "NDims = 3", "NDims = 2"), "2 3 4", "4 6"),
     "...is an image of 2 axes..."},
    {"ElementType", "ElementNumberOfChannels = 3\nElementType",
     "a.mha:11: has more than one component a voxel (3); give an image of one label a voxel"},
    {"MET_UCHAR", "MET_UCHAR_ARRAY",
     "...a.mha:11: ElementType 'MET_UCHAR_ARRAY' is not one number..."},
    {"Spacing = 1 2 3", "Spacing = 0 2 3", "...along axis 1 is 0;..."},
    {"Spacing = 1 2 3", "Spacing = 1 -2 3", "...along axis 2 is -2;..."},
    {"Spacing = 1 2 3", "Spacing = 1 2 nan", "...axis 3 is nan;..."},
    {"Spacing = 1 2 3", "Spacing = 1 2 x", "a.mha:9: expected a number, found 'x'"},
    {"0 1 0 -1 0 0 0 0 1", "0 1 0 0 1 0 0 0 1", "...lie in a plane..."},
    {"0 1 0 -1 0 0 0 0 1", "0 1 0 0 0 0 0 0 1",
     "...the direction along axis 2 has the length 0..."},
    {"0 1 0 -1 0 0 0 0 1", "0 1 0 -1 0 0 0 0 inf", "...axis 3 has the length inf..."},
    {"LOCAL", "LIST", "...list of files..."},
    {"LOCAL", "a%03d.raw 0 3 1", "...list of files..."},
    {"ObjectType = Image", "ObjectType = Tube", "...not an image..."},
    {"DimSize = 2 3 4", "DimSize = 2 3 0", "...has 0 voxels..."},
    {"DimSize = 2 3 4\n", "", "...no DimSize..."},
};

TEST(LabelImage, RefusesDamagedMetaImage) {
    expect_refusals(image_refusal, "a.mha", meta_image(), meta_image_faults);
    EXPECT_EQ(image_refusal("a.mhd", meta_image_header("none.raw")),
              "a.mhd: its data: none.raw: no such file; check the path");
}

const std::vector<Fault> nrrd_faults = {
    {"encoding: raw", "encoding: bzip2", "...a.nrrd:10: encoding 'bzip2' is not read here..."},
    {"domain domain domain", "vector domain domain", "...an axis 'vector' that is not of space..."},
    {"(0,1,0)", "none", "...an axis 'none' that is not of space..."},
    {"unsigned char", "block", "...type 'block' is not one number..."},
    {"sizes: 2 3 4", "sizes: 2 3", "...expected 3 values..."},
    {"(0,1,0) (-2", "(0,1) (-2", "...vectors of three numbers..."},
    {"(0,1,0) (-2", "(0,0,0) (-2", "...along axis 1 is 0;..."},
    {"(0,1,0) (-2,0,0)", "(0,1,0) (0,2,0)", "...lie in a plane..."},
    {"space directions: (0,1,0) (-2,0,0) (0, 0, 3)", "spacings: 1 -2 3",
     "...along axis 2 is -2;..."},
    {"unsigned char\n", "short\n", "a.nrrd: ends too early..."},
    {"", replaced(replaced(nrrd(), "endian: little\n", ""), "unsigned char", "short"),
     "...no field 'endian'..."},
    {"", cut(nrrd(), 1),
     "a.nrrd: ends too early: its header announces 24 bytes of values, and there are 23; get it "
     "anew"},
    {"", replaced(nrrd_header(), "raw", "txt") + "\n1 2 3",
     "...announces 24 values, and there are 3..."},
    {"", replaced(nrrd_header(), "raw", "txt") + "\n1 2 x",
     "...voxel (0, 1, 0): expected a number, found 'x'..."},
    {"", replaced(nrrd_header(), "raw", "hex") + "\n0g",
     "...expected hexadecimal digits, found 'g'..."},
    {"", replaced(nrrd_header(), "raw", "gzip") + "\nxyz", "...the packed data are damaged..."},
};

const std::vector<Fault> nrrd_file_faults = {
    {"", nrrd_header() + "data file: none.raw\n", "a.nhdr: its data: none.raw: no such file..."},
    {"", nrrd_header() + "data file: LIST\na.raw\n", "...expected FIELD: VALUE, found 'a.raw'..."},
    {"", nrrd_header() + "data file: a.nhdr\n",
     "a.nhdr:13: names itself as the file of the data..."},
};

TEST(LabelImage, RefusesDamagedNrrd) {
    expect_refusals(image_refusal, "a.nrrd", nrrd(), nrrd_faults);
    expect_refusals(image_refusal, "a.nhdr", nrrd_header(), nrrd_file_faults);
    auto flat = replaced(replaced(nrrd(), "dimension: 3", "dimension: 2"), "2 3 4", "4 6");
    flat = replaced(flat, "kinds: domain domain domain\n", "");
    EXPECT_THAT(image_refusal("a.nrrd", flat), HasSubstr("is an image of 2 axes"));
}

TEST(LabelImage, RefusesValuesThatAreNoLabels) {
    const auto refused = [](int datatype, const std::string& last) {
        Nifti nifti;
        nifti.datatype = datatype;
        nifti.dim = {3, 2, 1, 1};
        nifti.data = std::string(last.size(), '\0') + last;
        return image_refusal("a.nii", nifti.bytes());
    };
    EXPECT_EQ(refused(16, bytes_of(1.5F)),
              "a.nii: voxel (1, 0, 0) has the value 1.5, and labels are whole numbers; give a "
              "segmentation, not an image of intensities");
    EXPECT_THAT(refused(64, bytes_of(std::nan(""))), HasSubstr("has the value nan"));
    EXPECT_THAT(refused(64, bytes_of(-HUGE_VAL)), HasSubstr("has the value -inf"));
    EXPECT_THAT(refused(64, bytes_of(3e9)), HasSubstr("has the label 3e+09, beyond the range"));
    EXPECT_THAT(refused(768, bytes_of(3000000000U)), HasSubstr("has the label 3000000000"));
    EXPECT_THAT(refused(1024, bytes_of(std::int64_t{-3000000000})), HasSubstr("-3000000000"));
    EXPECT_THAT(refused(1280, bytes_of(std::numeric_limits<std::uint64_t>::max())),
                HasSubstr("18446744073709551615"));
    EXPECT_EQ(refused(2, bytes_of(std::uint8_t{0})), "a.nii: no voxel with a label: all are 0");
    EXPECT_EQ(refused(64, bytes_of(0.0)), "a.nii: no voxel with a label: all are 0");
}

TEST(LabelImage, RefusesRescaledValuesThatAreNoLabels) {
    Nifti nifti;
    nifti.scl = {0.5, 0};
    EXPECT_THAT(image_refusal("a.nii", nifti.bytes()),
                HasSubstr("voxel (1, 0, 0) has the value 0.5"));
}

TEST(LabelImage, NamesTheFirstVoxelThatIsNoLabel) {
    Nifti nifti;
    nifti.datatype = 16;
    nifti.data = bytes_of<float>(sample_labels());
    nifti.data.replace(4 * 17, 4, bytes_of(0.25F));  // 17 = 1 + 2 (2 + 3 * 2)
    nifti.data.replace(4 * 20, 4, bytes_of(0.75F));
    EXPECT_THAT(image_refusal("a.nii", nifti.bytes()),
                HasSubstr("voxel (1, 2, 2) has the value 0.25"));
}

TEST(LabelImage, RefusesWhatIsNoImage) {
    EXPECT_EQ(
        image_refusal("a.png", "\x89PNG and more"),
        "a.png: begins like no image format known here; convert an image to one of: NIfTI (.nii, "
        ".nii.gz), MetaImage (.mha, .mhd), NRRD (.nrrd, .nhdr), and a surface to STL, PLY, OFF "
        "or OBJ");
    EXPECT_THAT(image_refusal("a.nrrd", "nonsense"), HasSubstr("does not begin as a NRRD image"));
    EXPECT_THAT(image_refusal("a.mha", "nonsense"), HasSubstr("expected KEY = VALUE"));
    EXPECT_THAT(image_refusal("a.nii.gz", gzipped("nonsense")),
                HasSubstr("ends within the header"));
    EXPECT_THAT(image_refusal("a.nii", ""), HasSubstr("the file is empty"));
    const support::TemporaryFolder folder;
    EXPECT_THROW(read_label_image(folder / "none.nii"), InputError);
    EXPECT_THROW(read_label_image(folder.path()), InputError);
}

TEST(LabelImage, RefusesMoreThanTheMemoryOfTheMachine) {
    EXPECT_NO_THROW(require_memory(1.0, "a.nii: the image", "crop it"));
    try {
        require_memory(1e18, "a.nii: the image", "crop it");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a.nii: the image takes 1e+09 GB of memory, and this"));
        EXPECT_THAT(error.what(), HasSubstr(" GB; crop it"));
    }
}

}  // namespace
}  // namespace incise::io
