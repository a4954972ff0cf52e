// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/frame_list.h"

#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <algorithm>
#include <system_error>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"

namespace incise::render {

namespace fs = std::filesystem;

namespace {

fs::path find_index(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->path().extension() == ".pvd") found.push_back(entry->path());
    if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
    if (found.empty())
        throw InputError(folder.string() +
                         ": holds no .pvd file; give the folder that a run left, or a .vtu file");
    if (found.size() > 1) {
        std::sort(found.begin(), found.end());
        std::string list;
        for (const auto& path : found)
            list += (list.empty() ? "" : ", ") + path.filename().string();
        throw InputError(folder.string() + ": holds several runs (" + list +
                         "); name one of these files");
    }
    return found.front();
}

std::vector<FrameFile> read_index(const fs::path& path) {
    vtkNew<vtkXMLDataParser> parser;
    parser->SetFileName(path.c_str());
    const auto* root = parser->Parse() ? parser->GetRootElement() : nullptr;
    auto* collection =
        root ? const_cast<vtkXMLDataElement*>(root)->FindNestedElementWithName("Collection")
             : nullptr;
    if (!collection)
        throw InputError(path.string() + ": is no readable .pvd file; run again, or open a .vtu");

    std::vector<FrameFile> frames;
    for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
        auto* element = collection->GetNestedElement(i);
        const char* file = element->GetAttribute("file");
        const char* time = element->GetAttribute("timestep");
        if (!file) continue;
        frames.push_back(
            {path.parent_path() / file, time ? io::parse_number<double>(time) : std::nullopt});
    }
    if (frames.empty())
        throw InputError(path.string() +
                         ": lists no frames; give a .vtu file, or run again with "
                         "output.interval above 0");
    return frames;
}

}  // namespace

FrameList list_frames(const fs::path& path) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status))
        throw InputError(path.string() + ": no such file or folder; give the folder of a run");
    const auto file = fs::is_directory(status) ? find_index(path) : path;

    FrameList list;
    list.name = file.stem().string();
    list.folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (file.extension() == ".pvd") {
        list.is_run = true;
        list.frames = read_index(file);
    } else if (file.extension() == ".vtu") {
        list.frames = {{file, std::nullopt}};
    } else {
        throw InputError(path.string() +
                         ": is no folder of a run, no .pvd and no .vtu file; other meshes become "
                         ".vtu by: incise convert IN OUT.vtu");
    }
    return list;
}

}  // namespace incise::render
