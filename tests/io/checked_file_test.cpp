// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/checked_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "incise/base/checksum.h"
#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/output_folder.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

using support::count_entries;
using support::read_text;

TEST(Checksum, IsThatOfXz) {
    EXPECT_EQ(checksum("123456789"), 0x995DC9BBDF1939FAu);  // the catalogue's check value
    EXPECT_EQ(checksum("56789", checksum("1234")), checksum("123456789"));
}

TEST(CheckedFile, GivesTheBytesBack) {
    const support::TemporaryFolder folder;
    for (const std::string& bytes :
         {std::string(), std::string("a\0b\n", 4), std::string(9999, 'x')}) {
        write_checked_file(folder / "file", bytes);
        EXPECT_EQ(read_checked_file(folder / "file"), bytes);
    }
}

TEST(CheckedFile, FindsEveryFlippedBitAndEveryCut) {
    const support::TemporaryFolder folder;
    write_checked_file(folder / "file", "some bytes, not many");
    const std::string whole = read_text(folder / "file");
    const auto expect_refused = [&](const std::string& bytes, std::size_t where) {
        write_file(folder / "file", bytes);
        EXPECT_THROW(read_checked_file(folder / "file"), InputError) << where;
    };
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string damaged = whole;
        damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
        expect_refused(damaged, bit);
    }
    for (std::size_t size = 0; size < whole.size(); ++size)
        expect_refused(whole.substr(0, size), size);
    expect_refused(whole + '\0', whole.size());
    expect_refused(std::string(whole.size(), '\0'), 0);
    EXPECT_THROW(read_checked_file(folder / "missing"), InputError);
}

TEST(OutputFolder, IsOnesOwnUntilItGoes) {
    const support::TemporaryFolder folder;
    const auto path = folder / "a/b";
    {
        const OutputFolder ours(path);
        EXPECT_THROW(OutputFolder{path}, InputError);
        EXPECT_NO_THROW(OutputFolder{folder / "a"});
    }
    EXPECT_NO_THROW(OutputFolder{path});
    EXPECT_EQ(count_entries(path), 0u);  // the lock leaves nothing behind
}

TEST(OutputFolder, RemovesFilesOfKilledProcessesDespiteReusedIds) {
    const support::TemporaryFolder folder;
    for (const pid_t process : {::getpid(), ::getppid(), 1})
        write_file(folder / (".summary.json.tmp" + std::to_string(process) + "-0"), "x");
    const auto others = {".hidden", ".x.tmp", ".x.tmp1", ".x.tmp1-", ".x.tmp1-a", "x.tmp1-0"};
    for (const auto* name : others) write_file(folder / name, "x");
    const OutputFolder ours(folder.path());
    EXPECT_EQ(count_entries(folder.path()), others.size());
    for (const auto* name : others) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

}  // namespace
}  // namespace incise::io
