// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/febio_files.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/scanner.h"

namespace incise::io {

namespace {

/// A place where a model names a file that may have the mesh.
struct NamedFile {
    pugi::xml_node node;
    std::string_view name;
};

std::vector<NamedFile> named_files(const FebioFile& model) {
    const auto mesh = model.mesh();
    if (const auto from = mesh.attribute("from")) return {{mesh, from.value()}};
    std::vector<NamedFile> files;
    for (const auto include : model.root().children("Include"))
        files.push_back({include, trimmed(include.child_value())});
    return files;
}

/// Returns the file with elements, or null. `depth` counts the files that name each other.
std::unique_ptr<FebioFile> with_elements(std::unique_ptr<FebioFile> model, int depth) {
    constexpr int deepest = 20;
    const auto mesh = model->mesh();
    if (mesh.child("Elements") && !mesh.attribute("from")) return model;
    std::unique_ptr<FebioFile> found;
    for (const auto& [node, name] : named_files(*model)) {
        const auto refuse = [&model, place = node](const std::string& message) {
            model->fail(place, std::string(place.name()) + ": " + message);
        };
        if (depth == deepest)
            refuse("more than " + std::to_string(deepest) +
                   " files name each other; put the nodes and elements into one file");
        if (name.empty()) refuse("names no file");
        auto file = std::make_unique<InputFile>();
        try {
            *file = load_input_file(model->path_of(name));
        } catch (const InputError& fault) {
            refuse(fault.what());
        }
        auto inner = with_elements(std::make_unique<FebioFile>(std::move(file)), depth + 1);
        if (inner && found)
            refuse("a second file with elements; put all nodes and elements into one file");
        if (inner) found = std::move(inner);
    }
    if (found && mesh.child("Nodes"))
        model->fail(mesh, "its nodes are here and its elements in " + found->name() +
                              "; put all nodes and elements into one file");
    return found;
}

}  // namespace

FebioFile::FebioFile(const InputFile& file) : file_(file), name_(file.name()) { parse(); }

FebioFile::FebioFile(std::unique_ptr<InputFile> file)
    : owned_(std::move(file)), file_(*owned_), name_(file_.name()) {
    parse();
}

void FebioFile::parse() {
    const auto parsed = document_.load_buffer(file_.bytes.data(), file_.bytes.size(),
                                              pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
        throw InputError(name_ + ":" +
                         std::to_string(file_.line_of(static_cast<std::size_t>(parsed.offset))) +
                         ": not well-formed XML (" + parsed.description() +
                         "); the file is cut short or damaged");
    if (!root()) {
        const std::string first = document_.document_element().name();
        throw InputError(
            name_ + ": is XML, but has no febio_spec element: its first element is " +
            in_quotes(first) +
            (first.starts_with("febio_")
                 ? ", which tells FEBio what to do with a model, and has no mesh; give "
                   "the file of the model"
                 : "; give the file of a model of FEBio"));
    }
    const std::string_view version = root().attribute("version").value();
    is_version_2_ = version.starts_with("2.");
    if (!is_version_2_ && !version.starts_with("3.") && !version.starts_with("4."))
        fail(root(), "version " + in_quotes(version) +
                         " cannot be read; save the model as version 2.5, 3.0 or 4.0");
}

std::string FebioFile::location_of(pugi::xml_node node) const {
    const auto byte = std::max(node.offset_debug(), std::ptrdiff_t{0});
    return name_ + ":" + std::to_string(file_.line_of(static_cast<std::size_t>(byte)));
}

void FebioFile::fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(location_of(node) + ": " + message);
}

std::filesystem::path FebioFile::path_of(std::string_view name) const {
    return file_.path.parent_path() / name;
}

std::unique_ptr<FebioFile> febio_file_with_mesh(const InputFile& model) {
    if (auto found = with_elements(std::make_unique<FebioFile>(model), 0)) return found;
    auto file = std::make_unique<FebioFile>(model);
    const auto mesh = file->mesh();
    if (mesh.attribute("from"))
        file->fail(mesh, std::string(file->mesh_name()) + " is taken from the file " +
                             in_quotes(mesh.attribute("from").value()) +
                             ", which has no elements; name the file with the mesh");
    if (!mesh)
        file->fail(file->root(), std::string("has no section ") + file->mesh_name() +
                                     ", and so no mesh; give the file of the model that has one");
    return file;
}

}  // namespace incise::io
