// The reader of scenarios.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/scenario_reader.h"
#include "tests/fuzz/findings.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/written_file.h"

namespace incise::fuzz {

void scenario(std::string_view bytes) {
    const WrittenFile file("fuzz.toml", bytes);
    read_or_refuse(file.name(), [&] {
        for (const auto& error : scenario::read_scenario(file.path()).errors)
            if (!error.starts_with(file.name())) require_none("not named: " + error);
    });
}

}  // namespace incise::fuzz
