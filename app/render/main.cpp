// incise-render: draws pictures of a finished run, off screen. It is a separate program: the solver
// needs neither a display nor the rendering of VTK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <signal.h>
#include <unistd.h>
#include <vtkObject.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "incise/app/render/coloring.h"
#include "incise/app/render/display.h"
#include "incise/app/render/film.h"
#include "incise/app/render/frame_list.h"
#include "incise/app/render/frame_reader.h"
#include "incise/app/render/options.h"
#include "incise/app/render/scene.h"
#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"

namespace incise::render {
namespace {

namespace fs = std::filesystem;

volatile sig_atomic_t stop_signal = 0;

struct Stopped {};

void stop_if_asked() {
    if (stop_signal != 0) throw Stopped{};
}

/// A display of progress on stderr: one line that is overwritten on a terminal, otherwise a line
/// after each tenth.
class Progress {
  public:
    Progress(const char* doing, std::size_t total) : doing_(doing), total_(total) {}
    ~Progress() {
        if (is_terminal_ && is_shown_) std::fputs("\r\033[K", stderr);
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(std::size_t done) {
        if (total_ < 2) return;
        const std::size_t tenth = std::max<std::size_t>(1, total_ / 10);
        if (is_terminal_)
            std::fprintf(stderr, "\r%s frame %zu of %zu\033[K", doing_, done, total_);
        else if (done % tenth == 0 || done == total_)
            std::fprintf(stderr, "%s frame %zu of %zu\n", doing_, done, total_);
        std::fflush(stderr);
        is_shown_ = true;
    }

  private:
    const char* doing_;
    std::size_t total_;
    bool is_terminal_ = ::isatty(STDERR_FILENO) != 0;
    bool is_shown_ = false;
};

/// Returns the numbers of the frames to draw.
std::vector<std::size_t> choose_frames(const FrameList& list, const Options& options) {
    const auto count = list.frames.size();
    if (options.is_all) {
        std::vector<std::size_t> all(count);
        for (std::size_t i = 0; i < count; ++i) all[i] = i;
        return all;
    }
    for (const auto frame : options.frames)
        if (frame >= count)
            throw InputError(options.input.string() + ": has no frame " + std::to_string(frame) +
                             "; there are " + std::to_string(count) + ", numbered 0 to " +
                             std::to_string(count - 1));
    return options.frames.empty() ? std::vector{count - 1} : options.frames;
}

std::string six_digits(std::size_t number) {
    auto digits = std::to_string(number);
    return digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
}

/// The destination of the pictures: one file, or a folder with numbered files.
struct Destination {
    fs::path file;  ///< if empty, numbered files in the folder
    fs::path folder;
    std::string name;

    fs::path path(std::size_t frame) const {
        return file.empty() ? folder / (name + "_" + six_digits(frame) + ".png") : file;
    }
};

Destination choose_destination(const FrameList& list, const Options& options) {
    const bool names_file = options.out.extension() == ".png";
    if (names_file && (options.is_all || options.frames.size() > 1))
        throw InputError(
            "--out " + options.out.string() + ": " +
            (options.is_all ? "--all makes many pictures" : "there are several frames") +
            "; name a folder");
    if (names_file) return {options.out, {}, {}};
    if (!options.out.empty()) return {{}, options.out, list.name};
    if (!list.is_run) return {list.folder / (list.name + ".png"), {}, {}};
    return {{}, list.folder / "pictures", list.name};
}

/// Returns the number of decimals that is needed to distinguish the times of the frames.
int time_digits(const FrameList& list) {
    double shortest = 1;
    for (std::size_t i = 1; i < list.frames.size(); ++i) {
        const auto before = list.frames[i - 1].time, after = list.frames[i].time;
        if (before && after && *after > *before) shortest = std::min(shortest, *after - *before);
    }
    constexpr int fewest = 3, most = 9;
    return std::clamp(static_cast<int>(std::ceil(-std::log10(shortest))), fewest, most);
}

std::string caption_of(const FrameFile& file, vtkUnstructuredGrid& grid, int digits) {
    const auto time = file.time ? file.time : time_of(grid);
    if (!time) return "";
    char text[64];
    std::snprintf(text, sizeof text, "t = %.*f s", digits, *time);
    return text;
}

/// Reads a frame and adds the values of `field`. If `field` is not set, chooses it first by
/// `wanted`.
vtkSmartPointer<vtkUnstructuredGrid> read_colored(const fs::path& path,
                                                  const std::optional<std::string>& wanted,
                                                  std::optional<ColorField>& field) {
    const auto grid = read_frame(path);
    try {
        if (!field) field = choose_color_field(*grid, wanted);
        add_color_values(*grid, *field);
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
    return grid;
}

/// Returns how many frames a second of the run has, as far as a film can show them.
double pictures_a_second(const FrameList& list) {
    const auto &first = list.frames.front().time, &last = list.frames.back().time;
    constexpr double fewest = 1.0, most = 60.0;
    if (!first || !last || !(*last > *first)) return 25.0;
    const double rate = static_cast<double>(list.frames.size() - 1) / (*last - *first);
    return std::clamp(rate, fewest, most);
}

/// Returns what values are beyond the colours: an empty text if there are none.
std::string note_of(const SceneSettings& settings) {
    if (settings.field.place == ColorField::Place::none || settings.range.is_categorical())
        return "";
    const auto [lowest, highest] = settings.range.extremes();
    char text[96] = "";
    if (lowest < settings.limits.first && highest > settings.limits.second)
        std::snprintf(text, sizeof text, "values from %.3g\nto %.3g", lowest, highest);
    else if (highest > settings.limits.second)
        std::snprintf(text, sizeof text, "values up to\n%.3g", highest);
    else if (lowest < settings.limits.first)
        std::snprintf(text, sizeof text, "values down to\n%.3g", lowest);
    return text;
}

/// Returns the title of a run, as its summary has it, or its name.
std::string title_of(const FrameList& list) {
    if (!list.is_run) return list.name;
    std::ifstream file(list.folder / "summary.json");
    const auto summary = nlohmann::json::parse(file, nullptr, false);
    const bool has_title = summary.is_object() && summary.contains("title") &&
                           summary["title"].is_string() && summary.contains("scenario") &&
                           summary["scenario"] == list.name;
    return has_title ? summary["title"].get<std::string>() : list.name;
}

/// Returns the plane. Throws InputError if all of the body is in front of it, so that the pictures
/// would be empty: most often the numbers are in millimetres.
SectionPlane plane_through(const Section& section, const SceneSettings& settings) {
    const SectionPlane plane = place(section, settings.bounds, settings.view);
    Vec3 low, high;
    settings.bounds.GetMinPoint(low.data());
    settings.bounds.GetMaxPoint(high.data());
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                          (i & 4 ? high : low).z());
        if ((corner - plane.point).dot(plane.normal) < 0.0) return plane;
    }
    std::ostringstream text;
    text.precision(4);
    text << "--section: the whole body is in front of the plane; it reaches from "
         << low.transpose() << " to " << high.transpose() << " m";
    throw InputError(text.str());
}

/// Reads all frames to be drawn and returns the settings that their pictures share.
SceneSettings survey(const FrameList& list, const std::vector<std::size_t>& frames,
                     const Options& options) {
    SceneSettings settings;
    settings.size = options.size;
    settings.view = options.view;
    settings.has_edges = options.has_edges;
    settings.title = title_of(list);
    std::optional<ColorField> field;
    Progress progress("looking through", frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        stop_if_asked();
        const auto grid = read_colored(list.frames[frames[i]].path, options.color, field);
        if (grid->GetNumberOfPoints() > 0) settings.bounds.AddBounds(grid->GetBounds());
        settings.range.include(*grid, *field);
        progress.show(i + 1);
    }
    settings.field = *field;
    if (!settings.bounds.IsValid()) settings.bounds.SetBounds(0, 1, 0, 1, 0, 1);
    if (options.section) settings.section = plane_through(*options.section, settings);
    settings.limits = options.range.value_or(settings.range.limits());
    settings.note = note_of(settings);
    return settings;
}

void run(const Options& options) {
    const auto list = list_frames(options.input);
    const auto frames = choose_frames(list, options);
    const auto destination = choose_destination(list, options);
    const auto settings = survey(list, frames, options);
    if (destination.file.empty()) io::make_output_folder(destination.folder);

    const DisplayGuard display;
    Scene scene(settings);
    const int digits = time_digits(list);
    std::optional<ColorField> field = settings.field;
    Progress progress("drawing", frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        stop_if_asked();
        const auto& file = list.frames[frames[i]];
        const auto grid = read_colored(file.path, options.color, field);
        const auto path = destination.path(frames[i]);
        io::write_file(path, scene.png(*grid, caption_of(file, *grid, digits)));
        if (!(std::cout << path.string() << std::endl))
            throw OutputError("stdout: cannot be written");
        progress.show(i + 1);
    }
    if (options.film.empty()) return;
    make_film({destination.folder, destination.name, pictures_a_second(list)}, options.film);
    std::cout << options.film.string() << std::endl;
}

}  // namespace
}  // namespace incise::render

int main(int argc, char** argv) {
    using namespace incise;
    enum Exit { done = 0, bad_input = 2, output_failed = 4, out_of_memory = 5 };

    struct sigaction action {};
    action.sa_handler = [](int number) { render::stop_signal = number; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal ends the process at once
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    vtkObject::GlobalWarningDisplayOff();  // errors are reported once, with our messages

    const auto fail = [](int status, const char* text) {
        std::cerr << "incise-render: " << text << "\n";
        return status;
    };
    try {
        const auto parsed = render::parse_options(argc, argv);
        if (const auto* status = std::get_if<int>(&parsed)) return *status;
        render::run(std::get<render::Options>(parsed));
        return done;
    } catch (const render::Stopped&) {
        return 128 + render::stop_signal;
    } catch (const InputError& error) {
        return fail(bad_input, error.what());
    } catch (const OutputError& error) {
        return fail(output_failed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(out_of_memory, "out of memory");
    } catch (const std::exception& error) {
        return fail(output_failed, error.what());
    }
}
