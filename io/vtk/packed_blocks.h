// Compressed blocks that one file has and the next may have again.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace incise::io {

/// Much of a frame is that of the frame before, to the byte, and compressing takes far longer than
/// comparing: so the blocks of the last file are kept, as they are and compressed. Memory: that of
/// the arrays of a file, and of the file.
class PackedBlocks {
  public:
    /// What comes now belongs to the next file.
    void begin_file() { last_ = std::exchange(these_, {}); }

    /// The block compressed: by pack(), unless this file or the last had it.
    /// @param pack gives the same for the same block
    template <class Pack>
    std::string_view packed(std::string_view block, Pack pack) {
        if (const auto found = these_.find(block); found != these_.end()) return found->second;
        if (const auto found = last_.find(block); found != last_.end())
            return these_.insert(last_.extract(found)).position->second;
        return these_.emplace(block, pack()).first->second;
    }

  private:
    struct Hash {
        using is_transparent = void;  // looks up a view without a copy
        /// Of a part, which tells blocks apart well enough: those found are compared anyway.
        std::size_t operator()(std::string_view block) const {
            return std::hash<std::string_view>()(block.substr(block.size() / 2, 512));
        }
    };
    using Blocks = std::unordered_map<std::string, std::string, Hash, std::equal_to<>>;

    Blocks last_, these_;
};

}  // namespace incise::io
