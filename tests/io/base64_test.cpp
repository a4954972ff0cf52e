// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/base64.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace incise::io {
namespace {

std::string encoded(std::string_view bytes) {
    std::string text;
    append_base64(bytes, text);
    return text;
}

TEST(Base64, HasTheDigitsAndPaddingOfTheStandard) {
    // RFC 4648, section 10.
    for (const auto& [bytes, text] : {std::pair{"", ""},
                                      {"f", "Zg=="},
                                      {"fo", "Zm8="},
                                      {"foo", "Zm9v"},
                                      {"foob", "Zm9vYg=="},
                                      {"fooba", "Zm9vYmE="},
                                      {"foobar", "Zm9vYmFy"}}) {
        EXPECT_EQ(encoded(bytes), text);
        EXPECT_EQ(decode_base64(text, 6), bytes);
    }
    std::string text = "before ";
    append_base64("foo", text);
    EXPECT_EQ(text, "before Zm9v");
}

TEST(Base64, BringsBackAllBytes) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(decode_base64(encoded(bytes), bytes.size()), bytes);
        bytes += static_cast<char>((i * 37 + i / 7) & 0xFF);
    }
}

}  // namespace
}  // namespace incise::io
