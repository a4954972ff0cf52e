// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/run_pictures.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "incise/app/companion.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"

namespace incise::app {

namespace {

namespace fs = std::filesystem;

/// A folder for the pictures until they are in the page.
class PictureFolder {
  public:
    PictureFolder() {
        std::error_code none;  // a TMPDIR that is no folder is reported below
        fs::path parent = fs::temp_directory_path(none);
        if (none) parent = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp";
        auto pattern = (parent / "incise-report-XXXXXX").string();
        if (!::mkdtemp(pattern.data()))
            throw OutputError(pattern + ": cannot be made (" + std::strerror(errno) +
                              "); let TMPDIR name a folder that can be written");
        path_ = pattern;
    }
    ~PictureFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    PictureFolder(const PictureFolder&) = delete;
    PictureFolder& operator=(const PictureFolder&) = delete;

    fs::path operator/(const char* name) const { return path_ / name; }

  private:
    fs::path path_;
};

std::string text_of_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the message of the program: what follows its name, after the lines of its progress.
std::string message_of(std::string text) {
    while (text.ends_with('\n')) text.pop_back();
    const std::string name = "incise-render: ";
    const auto at = text.rfind(name);
    return at == text.npos ? text : text.substr(at + name.size());
}

/// True if the message is about a word that the user gave, and may correct.
bool names_a_word_of(const PictureOptions& options, const std::string& message) {
    return (!options.color.empty() && message.find("'" + options.color + "'") != message.npos) ||
           (!options.view.empty() && message.find("--view") != message.npos);
}

std::vector<std::size_t> evenly_spread(std::size_t num_frames, std::size_t count) {
    if (count >= num_frames) count = num_frames;
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < count; ++i)
        frames.push_back(count == 1 ? num_frames - 1
                                    : (i * (num_frames - 1) + (count - 1) / 2) / (count - 1));
    return frames;
}

std::vector<std::string> words_for(const report::RunRecord& run, const PictureOptions& options,
                                   const std::vector<std::size_t>& frames, const fs::path& out) {
    std::string numbers;
    for (const std::size_t frame : frames)
        numbers += (numbers.empty() ? "" : ",") + std::to_string(frame);
    std::vector<std::string> words = {(run.folder / (run.name + ".pvd")).string(),
                                      "--frame=" + numbers, "--out=" + out.string(),
                                      "--size=960x720"};
    if (!options.color.empty()) words.push_back("--color=" + options.color);
    if (!options.view.empty()) words.push_back("--view=" + options.view);
    return words;
}

}  // namespace

report::Pictures draw_run(const report::RunRecord& run, const PictureOptions& options) {
    report::Pictures pictures;
    if (run.frame_times.empty()) {
        pictures.note = "The run has written no frames.";
        return pictures;
    }
    const auto frames =
        evenly_spread(run.frame_times.size(), static_cast<std::size_t>(options.count));
    if (frames.empty()) return pictures;
    const PictureFolder folder;
    const fs::path out = folder / "pictures", complaint = folder / "stderr";
    std::string reason;
    try {
        const int status =
            run_companion("incise-render", words_for(run, options, frames, out),
                          "it is built and installed together with incise: build again",
                          {folder / "stdout", complaint});
        if (status == done) {
            for (const std::size_t frame : frames) {
                auto digits = std::to_string(frame);
                digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
                pictures.items.push_back(
                    {frame, text_of_file(out / (run.name + "_" + digits + ".png"))});
            }
            return pictures;
        }
        reason = message_of(text_of_file(complaint));
        if (status == input_at_fault && names_a_word_of(options, reason)) throw InputError(reason);
        if (reason.empty()) reason = "incise-render ended with status " + std::to_string(status);
    } catch (const MemoryError&) {
        reason = "incise-render was killed, perhaps for lack of memory";
    } catch (const InputError& error) {
        if (!reason.empty()) throw;
        reason = error.what();
    }
    pictures.note = "There are no pictures: " + reason + ".";
    return pictures;
}

}  // namespace incise::app
