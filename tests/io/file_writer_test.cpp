// Files are whole or not there, and a failure says what, why and what to do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "incise/base/checksum.h"
#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/checked_file.h"
#include "incise/io/files/file_descriptor.h"
#include "incise/io/files/line_file.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

namespace fs = std::filesystem;
using support::count_entries;
using support::read_text;
using support::TemporaryFolder;
using testing::HasSubstr;

/// The text of the OutputError that `action` throws, or what else happens.
std::string output_error(const std::function<void()>& action) {
    try {
        action();
    } catch (const OutputError& error) {
        return error.what();
    }
    return "no error";
}

/// Lets no file grow beyond `bytes`, as a full disk would, while it lives.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        former_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &former_);
        const rlimit limit{bytes, former_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &former_);
        std::signal(SIGXFSZ, former_handler_);
    }

  private:
    rlimit former_{};
    void (*former_handler_)(int) = nullptr;
};

TEST(WriteFile, WritesAndReplaces) {
    const TemporaryFolder folder;
    const std::string bytes("a\0b\n", 4);
    write_file(folder / "file", "former contents");
    write_file(folder / "file", bytes);
    EXPECT_EQ(read_text(folder / "file"), bytes);
    EXPECT_EQ(count_entries(folder.path()), 1U);
}

TEST(WriteFile, TakesTheLongestNamesThatThereAre) {
    const TemporaryFolder folder;
    const std::string name(255, 'n');
    write_file(folder / name, "contents");
    EXPECT_EQ(read_text(folder / name), "contents");
    EXPECT_THAT(output_error([&] { write_file(folder / (name + "n"), ""); }),
                HasSubstr("choose a shorter name"));
}

TEST(WriteFile, KeepsOnlyTheFormerContentsOnFailure) {
    const TemporaryFolder folder;
    write_file(folder / "file", "former contents");
    {
        const FileSizeLimit limit(1000);
        const auto text =
            output_error([&] { write_file(folder / "file", std::string(5000, 'x')); });
        EXPECT_THAT(text, HasSubstr((folder / "file").string() + ": cannot be written: "));
        EXPECT_THAT(text, HasSubstr("file too large"));
    }
    EXPECT_EQ(read_text(folder / "file"), "former contents");
    EXPECT_EQ(count_entries(folder.path()), 1U);
}

TEST(RemoveUnfinishedFiles, LeavesWhatIsBeingWritten) {
    const TemporaryFolder folder;
    // Another process removes files while this one is in the midst of the writing.
    static int to_other[2], from_other[2];
    ASSERT_TRUE(::pipe(to_other) == 0 && ::pipe(from_other) == 0);
    char turn = 0;
    const pid_t other = ::fork();
    if (other == 0) {
        if (::read(to_other[0], &turn, 1) == 1) {
            remove_unfinished_files(folder.path());
            turn = static_cast<char>(count_entries(folder.path()));
            if (::write(from_other[1], &turn, 1) == 1) ::_exit(0);
        }
        ::_exit(1);
    }
    ASSERT_GT(other, 0);
    static volatile std::sig_atomic_t num_left;
    num_left = -1;
    const FileSizeLimit limit(1000);
    std::signal(SIGXFSZ, [](int) {
        char byte = 0;
        if (::write(to_other[1], &byte, 1) == 1 && ::read(from_other[0], &byte, 1) == 1)
            num_left = byte;
    });
    EXPECT_NE(output_error([&] { write_file(folder / "file", std::string(5000, 'x')); }),
              "no error");
    EXPECT_EQ(num_left, 1);
    EXPECT_EQ(count_entries(folder.path()), 0U);
    for (const int end : {to_other[0], to_other[1], from_other[0], from_other[1]}) ::close(end);
    EXPECT_EQ(::waitpid(other, nullptr, 0), other);
}

TEST(WriteFile, DefersSignalsThatWouldLeaveHiddenFiles) {
    const TemporaryFolder folder;
    static std::string watched;
    static volatile std::sig_atomic_t is_empty;
    watched = folder.path().string();
    is_empty = -1;
    // Only an empty folder can be removed, and a handler may call this.
    const auto former =
        std::signal(SIGTERM, [](int) { is_empty = ::rmdir(watched.c_str()) == 0 ? 1 : 0; });
    {
        const FileSizeLimit limit(1000);
        std::signal(SIGXFSZ, [](int) { ::raise(SIGTERM); });  // in the midst of the writing
        EXPECT_NE(output_error([&] { write_file(folder / "file", std::string(5000, 'x')); }),
                  "no error");
    }
    std::signal(SIGTERM, former);
    EXPECT_EQ(is_empty, 1);
}

TEST(RequireWritable, ThrowsWhatWritingWouldAndChangesNothing) {
    const TemporaryFolder folder;
    write_file(folder / "file", "contents");
    fs::create_symlink("missing/target", folder / "link");
    const std::size_t before = count_entries(folder.path());
    for (const auto* name : {"new", "file", "missing/file", "file/below", ".", "link", "/proc/file",
                             "/proc/version", "/dev/null", ""}) {
        const fs::path path = *name == '\0' ? fs::path() : folder / name;
        const auto told = output_error([&] { require_writable(path); });
        EXPECT_EQ(count_entries(folder.path()), before) << name;
        EXPECT_EQ(read_text(folder / "file"), "contents");
        if (path == folder / "file" || path == folder / "new")
            EXPECT_EQ(told, "no error");
        else
            EXPECT_EQ(told, output_error([&] { write_file(path, ""); }));
    }
}

TEST(RequireWritable, DoesNotEndAPipeForItsReader) {
    const TemporaryFolder folder;
    const auto pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const FileDescriptor reader(pipe, O_RDONLY | O_NONBLOCK);
    require_writable(pipe);
    // Once someone has opened the pipe for writing and closed it again, its reader is at the end.
    pollfd waiting{reader.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&waiting, 1, 0), 0);
}

TEST(WriteFile, ReportsAFullDiskAndLeavesTheDevice) {
    EXPECT_EQ(output_error([] { write_file("/dev/full", "x"); }),
              "/dev/full: cannot be written: no space left on device; make room there, or write "
              "to another disk");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    write_file("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(WriteFile, DoesNotWaitForAPipesReader) {
    const TemporaryFolder folder;
    const auto pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(output_error([&] { write_file(pipe, "x"); }), HasSubstr("cannot be written"));
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WriteFile, SaysWhyThereCanBeNoFile) {
    const TemporaryFolder folder;
    write_file(folder / "file", "");
    const auto error_at = [&](const char* name) {
        return output_error([&] { write_file(folder / name, "x"); });
    };
    EXPECT_THAT(error_at("missing/file"), HasSubstr("no such file or directory; make the folder"));
    EXPECT_THAT(error_at("file/below"), HasSubstr("not a directory"));
    EXPECT_THAT(error_at("."), HasSubstr("is a directory; name a file in that folder, or remove"));
    EXPECT_THAT(output_error([] { write_file("", "x"); }), HasSubstr("cannot be written"));
}

TEST(WriteFile, FollowsLinks) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "other");
    fs::create_symlink("other/target", folder / "link");
    for (const auto* contents : {"new", "newer"}) {  // the target is missing at first
        write_file(folder / "link", contents);
        EXPECT_TRUE(fs::is_symlink(folder / "link"));
        EXPECT_EQ(read_text(folder / "other/target"), contents);
    }
    EXPECT_EQ(count_entries(folder / "other"), 1U);
}

TEST(WriteFile, GivesThePermissionsOfAnyNewFile) {
    const TemporaryFolder folder;
    const auto former_mask = ::umask(0027);
    write_file(folder / "file", "");
    ::umask(former_mask);
    EXPECT_EQ(fs::status(folder / "file").permissions(), fs::perms(0640));
}

TEST(MakeOutputFolder, MakesParentsAndRefusesImpossiblePaths) {
    const TemporaryFolder folder;
    make_output_folder(folder / "a/b");
    make_output_folder(folder / "a/b");
    EXPECT_EQ(count_entries(folder / "a/b"), 0U);
    write_file(folder / "file", "");
    EXPECT_THAT(output_error([&] { make_output_folder(folder / "file"); }), HasSubstr("file"));
    EXPECT_THAT(output_error([&] { make_output_folder(folder / "file/below"); }),
                HasSubstr("not a directory; a file is in the place of a folder"));
    EXPECT_THAT(output_error([] { make_output_folder("/proc/incise"); }),
                HasSubstr("/proc/incise: cannot be written: "));
}

TEST(LineFile, HoldsEveryLineOnceItIsAppended) {
    const TemporaryFolder folder;
    LineFile file(folder / "history.csv");
    std::string expected;
    for (const auto* line : {"time,mass", "0,1", ""}) {
        file.append(line);
        expected += std::string(line) + "\n";
        EXPECT_EQ(read_text(folder / "history.csv"), expected);
        EXPECT_EQ(file.written().size, expected.size());
        EXPECT_EQ(file.written().checksum, checksum(expected));
    }
    file.sync();
}

TEST(LineFile, BeginsAnewOrGoesOnFromFormerLines) {
    const TemporaryFolder folder;
    BytesWritten lines;
    {
        LineFile file(folder / "lines");
        file.append("kept");
        lines = file.written();
        file.append("written after the checkpoint");
    }
    {
        require_begins_with(folder / "lines", lines);
        LineFile file(folder / "lines", lines);
        file.append("resumed");
        EXPECT_EQ(file.written().checksum, checksum("kept\nresumed\n"));
    }
    EXPECT_EQ(read_text(folder / "lines"), "kept\nresumed\n");
    EXPECT_THAT(output_error([&] {
                    LineFile(folder / "lines", {1000, 0});
                }),
                HasSubstr("has 13 bytes"));
    EXPECT_EQ(read_text(folder / "lines"), "kept\nresumed\n");
    LineFile(folder / "lines");
    EXPECT_EQ(read_text(folder / "lines"), "");
}

TEST(LineFile, TakesBackALineThatFails) {
    const TemporaryFolder folder;
    LineFile file(folder / "lines");
    file.append("whole");
    {
        const FileSizeLimit limit(20);
        EXPECT_THAT(output_error([&] { file.append(std::string(100, 'x')); }),
                    HasSubstr("lines: cannot be written: file too large"));
    }
    EXPECT_EQ(read_text(folder / "lines"), "whole\n");
    file.append("next");
    EXPECT_EQ(read_text(folder / "lines"), "whole\nnext\n");
}

TEST(LineFile, SaysThatADiskIsFull) {
    LineFile file("/dev/full");
    EXPECT_THAT(output_error([&] { file.append("line"); }),
                HasSubstr("/dev/full: cannot be written: no space left on device"));
    EXPECT_THAT(output_error([] { LineFile("/dev/full/below"); }), HasSubstr("not a directory"));
}

}  // namespace
}  // namespace incise::io
