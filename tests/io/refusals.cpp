// SPDX-License-Identifier: LGPL-3.0-or-later
#include "tests/io/refusals.h"

#include <gtest/gtest.h>

#include <fstream>

#include "incise/base/error.h"
#include "tests/io/reader_samples.h"
#include "tests/support/temporary_folder.h"

namespace incise::io {
namespace {

bool is_quoted_as(std::string_view text, std::string_view quotation) {
    constexpr std::string_view gap = "...";
    const auto end = quotation.find(gap);
    if (end == quotation.npos) return text == quotation;
    if (!text.starts_with(quotation.substr(0, end))) return false;
    const auto rest = quotation.substr(end + gap.size());
    for (auto at = end; at <= text.size(); ++at)
        if (is_quoted_as(text.substr(at), rest)) return true;
    return false;
}

}  // namespace

std::string refusal_by(const std::function<void(const std::filesystem::path&)>& read,
                       const std::string& name, std::string_view bytes) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    try {
        read(folder / name);
    } catch (const InputError& error) {
        std::string message = error.what();
        const auto prefix = (folder / "").string();
        EXPECT_TRUE(message.starts_with(prefix + name + ":")) << message;
        for (auto at = message.find(prefix); at != message.npos; at = message.find(prefix))
            message.erase(at, prefix.size());
        return message;
    }
    ADD_FAILURE() << name << " was not refused";
    return {};
}

void expect_refusals(const RefusalOf& refusal_of, const std::string& name, const std::string& text,
                     const std::vector<Fault>& faults) {
    for (const auto& [from, to, expected] : faults) {
        SCOPED_TRACE(from.empty() ? expected
                                  : testing::PrintToString(to) + " in place of " +
                                        testing::PrintToString(from));
        const auto message = refusal_of(name, from.empty() ? to : replaced(text, from, to));
        EXPECT_TRUE(is_quoted_as(message, expected))
            << "message:  " << message << "\nexpected: " << expected;
    }
}

void expect_refusals(const std::string& name, const std::string& text,
                     const std::vector<Fault>& faults) {
    expect_refusals([](const auto& file, const auto& bytes) { return refusal(file, bytes); }, name,
                    text, faults);
}

}  // namespace incise::io
