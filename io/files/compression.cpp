// The compressions of VTK's XML files: zlib, LZ4 blocks, and LZMA in xz containers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/compression.h"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <limits>
#include <new>

namespace incise::io {

std::optional<Compressor> compressor_of(std::string_view vtk_class_name) {
    if (vtk_class_name.empty()) return Compressor::none;
    if (vtk_class_name == "vtkZLibDataCompressor") return Compressor::zlib;
    if (vtk_class_name == "vtkLZ4DataCompressor") return Compressor::lz4;
    if (vtk_class_name == "vtkLZMADataCompressor") return Compressor::lzma;
    return std::nullopt;
}

std::size_t max_expansion(Compressor compressor) {
    switch (compressor) {
        case Compressor::none:
            return 1;
        case Compressor::zlib:
            return 1032;  // 258 bytes for two bits (zlib, "Technical Details")
        case Compressor::lz4:
            return 256;  // a length byte stands for at most 255 bytes
        case Compressor::lzma:
            return 10000;  // about 7000 measured on zeros
    }
    return 1;
}

namespace {

bool decompress_zlib(std::string_view packed, std::span<char> unpacked) {
    auto size = static_cast<uLongf>(unpacked.size());
    const int status = uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &size,
                                  reinterpret_cast<const Bytef*>(packed.data()),
                                  static_cast<uLong>(packed.size()));
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    return status == Z_OK && size == unpacked.size();
}

bool decompress_lz4(std::string_view packed, std::span<char> unpacked) {
    constexpr auto longest = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (packed.size() > longest || unpacked.size() > longest) return false;
    const auto size = static_cast<int>(unpacked.size());
    return LZ4_decompress_safe(packed.data(), unpacked.data(), static_cast<int>(packed.size()),
                               size) == size;
}

bool decompress_lzma(std::string_view packed, std::span<char> unpacked) {
    std::uint64_t memory_limit = std::uint64_t{80} << 20;  // preset 9, the largest, needs 65 MiB
    std::size_t packed_position = 0;
    std::size_t unpacked_position = 0;
    const auto status = lzma_stream_buffer_decode(
        &memory_limit, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()),
        &packed_position, packed.size(), reinterpret_cast<std::uint8_t*>(unpacked.data()),
        &unpacked_position, unpacked.size());
    if (status == LZMA_MEM_ERROR) throw std::bad_alloc();
    return status == LZMA_OK && unpacked_position == unpacked.size();
}

}  // namespace

bool decompress(Compressor compressor, std::string_view packed, std::span<char> unpacked) {
    switch (compressor) {
        case Compressor::none:
            return false;
        case Compressor::zlib:
            return decompress_zlib(packed, unpacked);
        case Compressor::lz4:
            return decompress_lz4(packed, unpacked);
        case Compressor::lzma:
            return decompress_lzma(packed, unpacked);
    }
    return false;
}

}  // namespace incise::io
