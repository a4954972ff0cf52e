// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/downloads.h"

#include <exception>
#include <map>
#include <utility>

#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"

namespace incise::live {

void Downloads::answer() {
    const auto begin = Clock::now();
    if (waiting_.empty() || begin < next_) return;
    std::map<std::string, File> files;
    for (const Request& request : std::exchange(waiting_, {})) {
        const auto [file, is_new] = files.try_emplace(request.text);
        try {
            if (is_new) file->second = make(request.text);
        } catch (const std::exception& error) {
            server_.fail(request.page, std::string("the file cannot be made: ") + error.what());
            files.erase(file);
            continue;
        }
        server_.answer(request.page, file->second.content, file->second.type, file->second.name);
    }
    const auto end = Clock::now();
    next_ = end + 20 * (end - begin);
}

Downloads::File Downloads::make(const std::string& path) const {
    const std::string name = session_.simulation().scenario().name;
    if (path == "/recording.jsonl") return {recorder_.text(), "application/jsonl", name + ".jsonl"};
    const sim::World& world = session_.world();
    const auto forces = world.contact_forces();
    runner::FrameBuilder builder(world.model(), world.time(),
                                 session_.simulation().scenario().output.fields,
                                 forces ? &*forces : nullptr);
    return {io::vtu_text(builder.finish(), io::Compression::zlib), "application/octet-stream",
            name + ".vtu"};
}

}  // namespace incise::live
