// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/checksum.h"

#include <lzma.h>

namespace incise {

std::uint64_t checksum(std::string_view bytes, std::uint64_t before) {
    return lzma_crc64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), before);
}

}  // namespace incise
