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

/// The encoding of the arrays of a file.
struct VtkXmlEncoding {
    bool swap_bytes = false;
    ScalarType header_type = ScalarType::uint32;  ///< of the byte counts before binary data
    Compressor compressor = Compressor::none;
    std::string_view appended;  ///< the data after the underscore of AppendedData
    bool is_appended_raw = false;
};

/// A reader of the DataArray elements of one file.
class VtkXmlArrays {
  public:
    /// @lifetime  the file, and the data of `encoding.appended`, must outlive this object
    VtkXmlArrays(const InputFile& file, VtkXmlEncoding encoding)
        : file_(file), encoding_(encoding) {}

    /// Returns the `count` values of an array of numbers. Throws InputError if the
    /// array has another number of values, or is damaged. The memory is bounded by the size of the
    /// file.
    std::vector<double> reals(pugi::xml_node array, std::size_t count) const;
    /// The same for an array of whole numbers.
    std::vector<std::int64_t> integers(pugi::xml_node array, std::size_t count) const;

    /// Returns the value of an attribute that is a count. Throws InputError if it is missing.
    std::size_t count_attribute(pugi::xml_node element, const char* name) const;
    /// Returns NumberOfComponents, or 1 if it is missing.
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
