// VTK's writer of unstructured grids and its compressors, with a defined failure if memory is
// exhausted. VTK's own classes free uninitialized pointers or write through a null pointer. The
// classes here throw std::bad_alloc. They are also faster, for runs that write many frames.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <SMP/Common/vtkSMPToolsAPI.h>
#include <libdeflate.h>
#include <vtkObject.h>
#include <vtkOutputStream.h>
#include <vtkSmartPointer.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkZLibDataCompressor.h>

#include <cstddef>
#include <cstring>
#include <ios>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/files/base64.h"
#include "incise/io/vtk/packed_blocks.h"

namespace incise::io {

/// An object that disables VTK's printed warnings during its lifetime. Errors are exceptions here.
class SilentVtk {
  public:
    SilentVtk() : before_(vtkObject::GetGlobalWarningDisplay()) {
        vtkObject::GlobalWarningDisplayOff();
    }
    ~SilentVtk() { vtkObject::SetGlobalWarningDisplay(before_); }
    SilentVtk(const SilentVtk&) = delete;
    SilentVtk& operator=(const SilentVtk&) = delete;

  private:
    int before_;
};

/// An object that keeps VTK from creating threads during its lifetime. The other cores are for the
/// simulation, and VTK fails if it cannot create a thread.
class SequentialVtk {
  public:
    SequentialVtk() : before_(vtk_threads().GetBackend()) {
        vtk_threads().SetBackend("Sequential");
    }
    ~SequentialVtk() { vtk_threads().SetBackend(before_.c_str()); }
    SequentialVtk(const SequentialVtk&) = delete;
    SequentialVtk& operator=(const SequentialVtk&) = delete;

  private:
    // The functions that vtkSMPTools calls. The header of vtkSMPTools does not compile as C++20.
    static vtk::detail::smp::vtkSMPToolsAPI& vtk_threads() {
        return vtk::detail::smp::vtkSMPToolsAPI::GetInstance();
    }
    std::string before_;
};

/// A replacement for VTK's base64 stream, which writes only four digits at a time.
class FastBase64Stream final : public vtkOutputStream {
  public:
    static vtkSmartPointer<FastBase64Stream> make() {
        auto made = vtkSmartPointer<FastBase64Stream>::Take(new FastBase64Stream);
        made->InitializeObjectBase();
        return made;
    }
    int StartWriting() override {
        waiting_.clear();
        return 1;
    }
    int Write(const void* data, std::size_t size) override {
        waiting_.append(static_cast<const char*>(data), size);
        const std::size_t count = waiting_.size() / 3 * 3;  // padding only at the end of an array
        const int is_written = encode(std::string_view(waiting_).substr(0, count));
        waiting_.erase(0, count);
        return is_written;
    }
    int EndWriting() override { return encode(waiting_); }

  private:
    int encode(std::string_view bytes) {
        text_.clear();
        append_base64(bytes, text_);
        return WriteStream(text_.data(), text_.size());
    }
    std::string waiting_, text_;
};

/// A grid writer that throws if its stream in memory fails.
class ThrowingGridWriter final : public vtkXMLUnstructuredGridWriter {
  public:
    static vtkSmartPointer<ThrowingGridWriter> make() {
        auto made = vtkSmartPointer<ThrowingGridWriter>::Take(new ThrowingGridWriter);
        made->InitializeObjectBase();
        made->SetDataStream(FastBase64Stream::make());
        return made;
    }

  protected:
    // Called after the stream is created and before any array is written.
    int WriteHeader() override {
        Stream->exceptions(std::ios::badbit);
        return vtkXMLUnstructuredGridWriter::WriteHeader();
    }
};

/// A compressor of VTK that throws std::bad_alloc if it fails. Its buffer is large enough, so that
/// it fails only for lack of memory. It keeps VTK's class name, which is written to files.
template <class VtkCompressor>
class ThrowingCompressor final : public VtkCompressor {
  public:
    /// Makes a compressor.
    /// @param level  the compression level of VTK
    /// @param known  blocks that need not be compressed again, or null
    /// @lifetime  `known` must outlive the compressor
    static vtkSmartPointer<ThrowingCompressor> make(int level, PackedBlocks* known) {
        auto made = vtkSmartPointer<ThrowingCompressor>::Take(new ThrowingCompressor(known));
        made->InitializeObjectBase();
        made->SetCompressionLevel(level);
        return made;
    }

  protected:
    std::size_t CompressBuffer(const unsigned char* data, std::size_t size, unsigned char* packed,
                               std::size_t space) override {
        if (!packed) throw std::bad_alloc();
        const auto compress = [&] {
            const auto num_packed = VtkCompressor::CompressBuffer(data, size, packed, space);
            if (num_packed == 0) throw std::bad_alloc();
            return num_packed;
        };
        if (!known_) return compress();
        const std::string_view block(reinterpret_cast<const char*>(data), size);
        const auto bytes = known_->packed(
            block, [&] { return std::string(reinterpret_cast<char*>(packed), compress()); });
        std::memcpy(packed, bytes.data(), bytes.size());
        return bytes.size();
    }

  private:
    explicit ThrowingCompressor(PackedBlocks* known) : known_(known) {}

    PackedBlocks* known_;
};

/// A compressor of zlib streams with libdeflate, which takes half the time of VTK's. It keeps VTK's
/// class name, which is written to files.
class FastZlibCompressor : public vtkZLibDataCompressor {
  protected:
    std::size_t CompressBuffer(const unsigned char* data, std::size_t size, unsigned char* packed,
                               std::size_t space) override {
        if (!compressor_) compressor_.reset(libdeflate_alloc_compressor(CompressionLevel));
        if (!compressor_) throw std::bad_alloc();
        // libdeflate requires a buffer some bytes larger than VTK's, but does not fill it.
        bytes_.resize(libdeflate_zlib_compress_bound(compressor_.get(), size));
        const auto num_packed =
            libdeflate_zlib_compress(compressor_.get(), data, size, bytes_.data(), bytes_.size());
        if (num_packed == 0 || num_packed > space)
            return vtkZLibDataCompressor::CompressBuffer(data, size, packed, space);
        std::memcpy(packed, bytes_.data(), num_packed);
        return num_packed;
    }

  private:
    struct Free {
        void operator()(libdeflate_compressor* compressor) const {
            libdeflate_free_compressor(compressor);
        }
    };
    std::unique_ptr<libdeflate_compressor, Free> compressor_;
    std::vector<unsigned char> bytes_;
};

}  // namespace incise::io
