// A cache of compressed blocks, which consecutive files have in common.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace incise::io {

/// A cache of the blocks of the last file, unpacked and compressed. Consecutive frames have many
/// equal blocks, and to compress a block takes far longer than to compare it. Memory: that of the
/// arrays of a file, and of the file.
class PackedBlocks {
  public:
    /// Begins the next file. Blocks from the file before the last one are dropped.
    void begin_file() { last_ = std::exchange(these_, {}); }

    /// Returns the compressed block. Calls pack() only if neither this file nor the last one had
    /// the block.
    /// @param block  the unpacked block
    /// @param pack   must return the same result for the same block
    /// @lifetime  the result is valid until the next begin_file()
    template <class Pack>
    std::string_view packed(std::string_view block, Pack pack) {
        if (const auto found = these_.find(block); found != these_.end()) return found->second;
        if (const auto found = last_.find(block); found != last_.end())
            return these_.insert(last_.extract(found)).position->second;
        return these_.emplace(block, pack()).first->second;
    }

  private:
    struct Hash {
        using is_transparent = void;  // to look up a view without a copy
        /// Returns the hash of 512 bytes. Blocks with the same hash are compared completely.
        std::size_t operator()(std::string_view block) const {
            return std::hash<std::string_view>()(block.substr(block.size() / 2, 512));
        }
    };
    using Blocks = std::unordered_map<std::string, std::string, Hash, std::equal_to<>>;

    Blocks last_, these_;
};

}  // namespace incise::io
