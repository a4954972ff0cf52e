// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/frame_reader.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"

namespace incise::render {

namespace {

/// Throws InputError if the file is truncated, or if its counts are larger than the file can hold.
/// The reader of VTK does not check this.
void check_whole(const io::InputFile& file) {
    const std::string_view text = file.bytes;
    constexpr std::size_t longest_tail = 64;  // with blanks and line ends
    const auto tail = text.substr(text.size() - std::min(text.size(), longest_tail));
    if (tail.find("</VTKFile>") == tail.npos)
        throw InputError(file.name() + ": is cut short, or no .vtu file");

    // No method compresses a mesh to less than a thousandth.
    const auto most = static_cast<std::int64_t>(1000 * text.size());
    for (const std::string_view attribute : {"NumberOfPoints=\"", "NumberOfCells=\""})
        for (auto at = text.find(attribute); at != text.npos; at = text.find(attribute, at)) {
            at += attribute.size();
            const auto number = text.substr(at, text.find('"', at) - at);
            const auto count = io::parse_number<std::int64_t>(number);
            if (!count || *count < 0 || *count > most)
                throw InputError(file.name() + ":" + std::to_string(file.line_of(at)) + ": " +
                                 std::string(attribute) + std::string(number.substr(0, 40)) +
                                 "\" is more than the file can hold, or no count");
        }
}

void check_corners(vtkUnstructuredGrid& grid, const std::filesystem::path& path) {
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
        grid.GetCellPoints(c, corners);
        for (const auto corner : *corners)
            if (corner < 0 || corner >= grid.GetNumberOfPoints())
                throw InputError(path.string() + ": cell " + std::to_string(c) + ": node index " +
                                 std::to_string(corner) + " is out of range (" +
                                 std::to_string(grid.GetNumberOfPoints()) + " points)");
    }
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> read_frame(const std::filesystem::path& path) {
    const auto file = io::load_input_file(path);
    check_whole(file);
    bool has_failed = false;
    vtkNew<vtkCallbackCommand> on_error;
    on_error->SetClientData(&has_failed);
    on_error->SetCallback(
        [](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->AddObserver(vtkCommand::ErrorEvent, on_error);
    reader->ReadFromInputStringOn();
    reader->SetInputString(file.bytes);
    reader->Update();
    if (has_failed || reader->GetErrorCode() != vtkErrorCode::NoError)
        throw InputError(path.string() + ": is damaged, or not an unstructured grid");
    vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
    check_corners(*grid, path);
    return grid;
}

std::optional<double> time_of(vtkUnstructuredGrid& grid) {
    auto* array = grid.GetFieldData()->GetArray("TimeValue");
    if (!array || array->GetNumberOfValues() < 1) return std::nullopt;
    return array->GetComponent(0, 0);
}

}  // namespace incise::render
