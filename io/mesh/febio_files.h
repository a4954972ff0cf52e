// The file of a FEBio model that has the mesh: the model itself, or a file that it names.
// Source: FEBio User Manual 2.9, 3.6 and 4.4, chapter 3, "Include" and the attribute "from".
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "incise/io/files/input_file.h"

namespace incise::io {

/// A FEBio file as XML.
class FebioFile {
  public:
    /// Parses the file. Throws InputError for what is no XML, and for versions that are not known.
    /// @lifetime  a file that is not given away must outlive this object
    explicit FebioFile(const InputFile& file);
    explicit FebioFile(std::unique_ptr<InputFile> file);
    FebioFile(const FebioFile&) = delete;
    FebioFile& operator=(const FebioFile&) = delete;

    const std::string& name() const { return name_; }
    bool is_version_2() const { return is_version_2_; }
    pugi::xml_node root() const { return document_.child("febio_spec"); }
    /// The name of the section with nodes and elements.
    const char* mesh_name() const { return is_version_2_ ? "Geometry" : "Mesh"; }
    /// Returns that section, or an empty node.
    pugi::xml_node mesh() const { return root().child(mesh_name()); }

    std::string location_of(pugi::xml_node node) const;
    /// Throws InputError with the location of a node and the message.
    [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;

    /// Returns the path of a file that this one names.
    std::filesystem::path path_of(std::string_view name) const;

  private:
    void parse();

    std::unique_ptr<InputFile> owned_;
    const InputFile& file_;
    std::string name_;
    pugi::xml_document document_;
    bool is_version_2_ = false;
};

/// Returns the file with the elements of a model: the model itself, or a file that its mesh names
/// by the attribute `from`, or one that it names by Include, or that one of these names. Names are
/// relative to the folder of the file that has them. Throws InputError as FebioFile does, and for
/// files that cannot be read, several of them with elements, and models without a mesh.
/// @lifetime  the model must outlive the result
std::unique_ptr<FebioFile> febio_file_with_mesh(const InputFile& model);

}  // namespace incise::io
