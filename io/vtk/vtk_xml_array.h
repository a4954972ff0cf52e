// The DataArray elements of VTK's XML files, in every encoding.
// Source: "VTK XML Formats", VTK wiki; vtkXMLDataParser of VTK 9.1.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/compression.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/scalar_type.h"

namespace incise::io {

/// How the arrays of one file are laid down.
struct VtkXmlEncoding {
    bool swap_bytes = false;
    ScalarType header_type = ScalarType::uint32;  ///< of the byte counts before binary data
    Compressor compressor = Compressor::none;
    std::string_view appended;  ///< what follows the underscore of AppendedData
    bool is_appended_raw = false;
};

class VtkXmlArrays {
  public:
    /// The file, and what `encoding` points to, must outlive this.
    VtkXmlArrays(const InputFile& file, VtkXmlEncoding encoding)
        : file_(file), encoding_(encoding) {}

    /// Exactly `count` values of the array, real or whole. Throws InputError if it holds another
    /// number of them, or is damaged; nothing is allocated that the file cannot fill.
    std::vector<double> reals(pugi::xml_node array, std::size_t count) const;
    std::vector<std::int64_t> integers(pugi::xml_node array, std::size_t count) const;

    /// An attribute that counts something; a missing one is an error.
    std::size_t count_attribute(pugi::xml_node element, const char* name) const;
    /// NumberOfComponents, 1 if not given.
    std::size_t num_components(pugi::xml_node array) const;

    /// Throws InputError with the line and the name of the element.
    [[noreturn]] void fail(pugi::xml_node element, const std::string& message) const;

  private:
    template <class T>
    std::vector<T> values(pugi::xml_node array, std::size_t count) const;
    template <class T>
    std::vector<T> parse_text(pugi::xml_node array, std::size_t count) const;
    std::string binary(pugi::xml_node array, std::size_t num_bytes) const;
    std::string decode_first(pugi::xml_node array, std::string_view text, bool is_raw,
                             std::size_t count) const;
    std::uint64_t header_word(const std::string& bytes, std::size_t index) const;
    std::string read_plain(pugi::xml_node array, std::string_view text, bool is_raw,
                           std::size_t num_bytes) const;
    std::string read_blocks(pugi::xml_node array, std::string_view text, bool is_raw,
                            std::size_t num_bytes) const;

    const InputFile& file_;
    VtkXmlEncoding encoding_;
};

}  // namespace incise::io
