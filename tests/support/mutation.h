// Files with small faults, as disks, transfers and text editors leave them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>

namespace incise::support {

/// One to four bytes changed, inserted, removed or copied; one in eight texts is cut short.
inline std::string mutated(std::string bytes, std::mt19937& random) {
    constexpr std::string_view usual = "0123456789-.e \n<\"(,[=";
    const auto below = [&](std::size_t n) { return random() % std::max<std::size_t>(n, 1); };
    if (below(8) == 0) bytes.resize(below(bytes.size()));
    for (auto left = 1 + below(4); left > 0 && !bytes.empty(); --left) {
        const auto position = below(bytes.size());
        switch (below(5)) {
            case 0:
                bytes[position] = static_cast<char>(below(256));
                break;
            case 1:
                bytes[position] = usual[below(usual.size())];
                break;
            case 2:
                bytes[position] = static_cast<char>(bytes[position] ^ (1 << below(8)));
                break;
            case 3:
                bytes.erase(position, 1 + below(6));
                break;
            case 4:
                bytes.insert(position, bytes.substr(below(bytes.size()), 1 + below(6)));
                break;
        }
    }
    return bytes;
}

}  // namespace incise::support
