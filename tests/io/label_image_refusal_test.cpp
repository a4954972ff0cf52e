// What is refused in a label image, and how it is told.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "incise/io/files/input_file.h"
#include "incise/io/files/memory.h"
#include "incise/io/image/label_image.h"
#include "tests/io/image_samples.h"
#include "tests/io/reader_samples.h"
#include "tests/support/mutation.h"

namespace incise::io {
namespace {

using testing::HasSubstr;

/// The message, without the folder.
std::string image_refusal(const std::string& name, const std::string& bytes) {
    const support::TemporaryFolder folder;
    write_bytes(folder / name, bytes);
    try {
        read_label_image(folder / name);
    } catch (const InputError& error) {
        std::string text = error.what();
        const auto prefix = folder.path().string() + "/";
        for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
            text.erase(at, prefix.size());
        return text;
    }
    ADD_FAILURE() << name << " was read";
    return {};
}

TEST(LabelImage, RefusesHeadersThatNameThemselvesAsTheData) {
    EXPECT_THAT(image_refusal("a.mhd", meta_image_header("./a.mhd")),
                HasSubstr("a.mhd:12: names itself as the file of the data"));
    EXPECT_THAT(image_refusal("a.nhdr", nrrd_header() + "data file: a.nhdr\n"),
                HasSubstr("a.nhdr:13: names itself as the file of the data"));
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

TEST(LabelImage, RefusesDamagedNifti) {
    const auto refused = [](auto change) {
        Nifti nifti;
        nifti.qform_code = 1;
        change(nifti);
        return image_refusal("a.nii", nifti.bytes());
    };
    const auto whole = Nifti().bytes();
    EXPECT_EQ(image_refusal("a.nii", whole.substr(0, whole.size() - 1)),
              "a.nii: ends too early: its header announces 24 bytes of values, and there are 23; "
              "get it anew");
    EXPECT_EQ(image_refusal("a.nii", whole.substr(0, 100)),
              "a.nii: ends within the header of a NIfTI image; get it anew");
    EXPECT_THAT(image_refusal("a.nii", std::string(400, 'x')),
                HasSubstr("does not begin as a NIfTI image"));
    const auto packed = gzipped(whole);
    EXPECT_THAT(image_refusal("a.nii.gz", packed.substr(0, packed.size() - 12)),
                HasSubstr("the packed data are damaged, or end before 376 bytes"));
    auto damaged = packed;
    damaged[damaged.size() - 6] ^= 1;  // the sum of checks
    EXPECT_THAT(image_refusal("a.nii.gz", damaged), HasSubstr("the packed data are damaged"));

    EXPECT_EQ(refused([](Nifti& n) {
                  n.dim = {2, 4, 6};
              }),
              "a.nii: is an image of 2 axes; a mesh takes one of three, with one label a voxel");
    EXPECT_EQ(refused([](Nifti& n) {
                  n.dim = {4, 2, 3, 2, 2};
              }),
              "a.nii: has 2 images in time; save one of them");
    EXPECT_THAT(refused([](Nifti& n) { n.dim = {5, 2, 3, 2, 1, 2}; }),
                HasSubstr("more than one component a voxel (2)"));
    EXPECT_THAT(refused([](Nifti& n) { n.datatype = 128; }), HasSubstr("more than one component"));
    EXPECT_THAT(refused([](Nifti& n) { n.datatype = 1; }), HasSubstr("data type 1 is not known"));
    EXPECT_THAT(refused([](Nifti& n) {
                    n.dim = {3, 2, -3, 4};
                }),
                HasSubstr("has -3 voxels along axis 2"));
    EXPECT_THAT(refused([](Nifti& n) { n.dim = {9, 2, 3, 4}; }), HasSubstr("has 9 axes"));
    EXPECT_THAT(refused([](Nifti& n) {
                    n.dim = {3, 32767, 32767, 32767};
                }),
                HasSubstr("more than 2147483647 voxels"));
    EXPECT_THAT(refused([](Nifti& n) {
                    n.dim = {3, 1000, 1000, 1000};
                }),
                HasSubstr("announces 1000000000 bytes of values, and there are 24"));
    EXPECT_EQ(refused([](Nifti& n) { n.pixdim[2] = 0; }),
              "a.nii: the spacing of voxels along axis 2 is 0; it must be above 0 and finite");
    EXPECT_THAT(refused([](Nifti& n) { n.pixdim[3] = -1; }), HasSubstr("along axis 3 is -1;"));
    EXPECT_THAT(refused([](Nifti& n) { n.pixdim[1] = std::nan(""); }), HasSubstr("is nan;"));
    EXPECT_THAT(refused([](Nifti& n) { n.quaternion_and_offset[4] = INFINITY; }),
                HasSubstr("the origin has inf"));
    EXPECT_THAT(refused([](Nifti& n) {
                    n.sform_code = 1;
                    n.srow = {1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 3, 0};
                }),
                HasSubstr("the directions of its three axes lie in a plane"));
    auto pair = whole;
    pair.replace(344, 3, "ni1");
    EXPECT_THAT(image_refusal("a.hdr", pair), HasSubstr("no NIfTI image in one file"));
}

TEST(LabelImage, RefusesDamagedMetaImage) {
    const auto refused = [](const std::string& from, const std::string& to) {
        return image_refusal("a.mha", replaced(meta_image(), from, to));
    };
    EXPECT_EQ(image_refusal("a.mha", meta_image().substr(0, meta_image().size() - 14)),
              "a.mha: ends too early: its header announces 24 bytes of values, and there are 10; "
              "get it anew");
    EXPECT_EQ(image_refusal("a.mhd", meta_image_header("none.raw")),
              "a.mhd: its data: none.raw: no such file; check the path");
    EXPECT_THAT(refused("CompressedData = False", "CompressedData = True"),
                HasSubstr("the packed data are damaged"));
    EXPECT_THAT(refused("ElementDataFile", "DataFile"), HasSubstr("a.mha:"));
    EXPECT_THAT(image_refusal("a.mha", meta_image_header("x").substr(0, 150)),
                HasSubstr("no ElementDataFile"));
    EXPECT_EQ(refused("NDims = 3", "NDims = 2"), "a.mha:10: expected 2 numbers, found '2 3 4'");
    EXPECT_THAT(image_refusal("a.mha", replaced(replaced(meta_image(), "NDims = 3", "NDims = 2"),
                                                "2 3 4", "4 6")),
                HasSubstr("is an image of 2 axes"));
    EXPECT_EQ(refused("ElementType", "ElementNumberOfChannels = 3\nElementType"),
              "a.mha:11: has more than one component a voxel (3); give an image of one label a "
              "voxel");
    EXPECT_THAT(refused("MET_UCHAR", "MET_UCHAR_ARRAY"),
                HasSubstr("a.mha:11: ElementType 'MET_UCHAR_ARRAY' is not one number"));
    EXPECT_THAT(refused("Spacing = 1 2 3", "Spacing = 0 2 3"), HasSubstr("along axis 1 is 0;"));
    EXPECT_THAT(refused("Spacing = 1 2 3", "Spacing = 1 -2 3"), HasSubstr("along axis 2 is -2;"));
    EXPECT_THAT(refused("Spacing = 1 2 3", "Spacing = 1 2 nan"), HasSubstr("axis 3 is nan;"));
    EXPECT_EQ(refused("Spacing = 1 2 3", "Spacing = 1 2 x"),
              "a.mha:9: expected a number, found 'x'");
    EXPECT_THAT(refused("0 1 0 -1 0 0 0 0 1", "0 1 0 0 1 0 0 0 1"), HasSubstr("lie in a plane"));
    EXPECT_THAT(refused("0 1 0 -1 0 0 0 0 1", "0 1 0 0 0 0 0 0 1"),
                HasSubstr("the direction along axis 2 has the length 0"));
    EXPECT_THAT(refused("0 1 0 -1 0 0 0 0 1", "0 1 0 -1 0 0 0 0 inf"), HasSubstr("axis 3"));
    EXPECT_THAT(refused("LOCAL", "LIST"), HasSubstr("list of files"));
    EXPECT_THAT(refused("LOCAL", "a%03d.raw 0 3 1"), HasSubstr("list of files"));
    EXPECT_THAT(refused("ObjectType = Image", "ObjectType = Tube"), HasSubstr("not an image"));
    EXPECT_THAT(refused("DimSize = 2 3 4", "DimSize = 2 3 0"), HasSubstr("has 0 voxels"));
    EXPECT_THAT(refused("DimSize = 2 3 4\n", ""), HasSubstr("no DimSize"));
}

TEST(LabelImage, RefusesDamagedNrrd) {
    const auto refused = [](const std::string& from, const std::string& to) {
        return image_refusal("a.nrrd", replaced(nrrd(), from, to));
    };
    EXPECT_EQ(image_refusal("a.nrrd", nrrd().substr(0, nrrd().size() - 1)),
              "a.nrrd: ends too early: its header announces 24 bytes of values, and there are 23; "
              "get it anew");
    EXPECT_THAT(image_refusal("a.nrrd", replaced(nrrd_header(), "raw", "txt") + "\n1 2 3"),
                HasSubstr("announces 24 values, and there are 3"));
    EXPECT_THAT(image_refusal("a.nrrd", replaced(nrrd_header(), "raw", "txt") + "\n1 2 x"),
                HasSubstr("voxel (0, 1, 0): expected a number, found 'x'"));
    EXPECT_THAT(image_refusal("a.nrrd", replaced(nrrd_header(), "raw", "hex") + "\n0g"),
                HasSubstr("expected hexadecimal digits, found 'g'"));
    EXPECT_THAT(image_refusal("a.nrrd", replaced(nrrd_header(), "raw", "gzip") + "\nxyz"),
                HasSubstr("the packed data are damaged"));
    EXPECT_THAT(image_refusal("a.nhdr", nrrd_header() + "data file: none.raw\n"),
                HasSubstr("a.nhdr: its data: none.raw: no such file"));
    EXPECT_THAT(image_refusal("a.nhdr", nrrd_header() + "data file: LIST\na.raw\n"),
                HasSubstr("expected FIELD: VALUE, found 'a.raw'"));
    EXPECT_THAT(refused("encoding: raw", "encoding: bzip2"),
                HasSubstr("a.nrrd:10: encoding 'bzip2' is not read here"));
    EXPECT_THAT(refused("domain domain domain", "vector domain domain"),
                HasSubstr("an axis 'vector' that is not of space"));
    EXPECT_THAT(refused("(0,1,0)", "none"), HasSubstr("an axis 'none' that is not of space"));
    EXPECT_THAT(refused("unsigned char", "block"), HasSubstr("type 'block' is not one number"));
    EXPECT_THAT(refused("sizes: 2 3 4", "sizes: 2 3"), HasSubstr("expected 3 values"));
    EXPECT_THAT(refused("(0,1,0) (-2", "(0,1) (-2"), HasSubstr("vectors of three numbers"));
    EXPECT_THAT(refused("(0,1,0) (-2", "(0,0,0) (-2"), HasSubstr("along axis 1 is 0;"));
    EXPECT_THAT(refused("(0,1,0) (-2,0,0)", "(0,1,0) (0,2,0)"), HasSubstr("lie in a plane"));
    EXPECT_THAT(refused("space directions: (0,1,0) (-2,0,0) (0, 0, 3)", "spacings: 1 -2 3"),
                HasSubstr("along axis 2 is -2;"));
    EXPECT_THAT(refused("unsigned char\n", "short\n").substr(0, 8), "a.nrrd: ");
    EXPECT_THAT(image_refusal("a.nrrd", replaced(replaced(nrrd(), "endian: little\n", ""),
                                                 "unsigned char", "short")),
                HasSubstr("no field 'endian'"));
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

TEST(LabelImage, ReadsOrRefusesDamagedFiles) {
    Nifti nifti;
    nifti.sform_code = nifti.qform_code = 1;
    nifti.srow = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0};
    auto second = nifti;
    second.is_second = true;
    const std::pair<std::string, std::string> samples[] = {
        {"a.nii", nifti.bytes()},
        {"b.nii", second.bytes()},
        {"a.nii.gz", gzipped(nifti.bytes())},
        {"a.mha", meta_image()},
        {"a.nrrd", nrrd()},
        {"b.nrrd", replaced(nrrd_header(), "raw", "gzip") + "\n" +
                       gzipped(bytes_of<std::uint8_t>(sample_labels()))}};
    const support::TemporaryFolder folder;
    for (const auto& [name, bytes] : samples) {
        std::mt19937 random(12345);
        int num_refused = 0;
        for (int i = 0; i < 500; ++i) {
            write_bytes(folder / name, support::mutated(bytes, random));
            try {
                const auto image = read_label_image(folder / name);
                const auto [x, y, z] = image.dimensions;
                EXPECT_EQ(image.labels.size(), static_cast<std::size_t>(x * y * z));
                EXPECT_TRUE(image.spacing.minCoeff() > 0.0 && image.directions.allFinite());
            } catch (const InputError&) {
                ++num_refused;
            } catch (const std::exception& error) {
                FAIL() << name << ", mutation " << i << ": " << error.what();
            }
        }
        EXPECT_GT(num_refused, 50) << name;
    }
}

}  // namespace
}  // namespace incise::io
