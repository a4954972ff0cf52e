// A soft block for hands to work on, as a scenario in a folder of its own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/live/session.h"
#include "incise/scenario/scenario_reader.h"
#include "support/temporary_folder.h"

namespace incise::live {

/// soft_block.toml, with a carver that passes from 0.02 to 0.1 s.
inline const std::string soft_block =
    support::read_text(INCISE_DATA_DIR "/../tests/live/soft_block.toml") + R"([[tool]]
kind = "carver"
shape = { sphere = { radius = 0.02 } }
path = [{ time = 0.02, at = [0.1, 0.1, 0.08] }, { time = 0.1, at = [0.1, 0.1, 0.04] }]
)";

class BlockFolder {
  public:
    explicit BlockFolder(const std::string& text = soft_block) { std::ofstream(path()) << text; }
    std::filesystem::path path() const { return folder_ / "block.toml"; }
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    scenario::Scenario scenario() const {
        auto report = scenario::read_scenario(path());
        if (!report.errors.empty()) throw std::runtime_error(report.errors.front());
        return std::move(report.scenario);
    }

  private:
    support::TemporaryFolder folder_;
};

/// Orders as the page and recordings write them.
inline Order order(const std::string& json) { return order_from_json(json); }

inline std::string at(double x, double y, double z) {
    return R"("at":[)" + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) +
           "]";
}
inline Order add_blade(const std::string& name, double x, double y, double z) {
    return order(R"({"add":")" + name +
                 R"(","tool":{"kind":"blade","edge":[[0,0,0.03],[0,0,-0.02]]},)" + at(x, y, z) +
                 "}");
}
inline Order add_ball(const std::string& kind, const std::string& name, double x, double y,
                      double z) {
    return order(R"({"add":")" + name + R"(","tool":{"kind":")" + kind +
                 R"(","shape":{"sphere":{"radius":0.012}}},)" + at(x, y, z) + "}");
}
inline Order add_suture(const std::string& name, double x, double y) {
    return order(R"({"add":")" + name + R"(","tool":{"kind":"suture","stiffness":20,"points":[[)" +
                 std::to_string(x) + "," + std::to_string(y) + ",0.05],[" +
                 std::to_string(0.1 - x) + "," + std::to_string(y) + R"(,0.05]]},"at":[0,0,0]})");
}
inline Order move(const std::string& name, double x, double y, double z) {
    return order(R"({"move":")" + name + "\"," + at(x, y, z) + "}");
}

}  // namespace incise::live
