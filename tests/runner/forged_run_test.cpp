// Folders of stopped and finished runs in which somebody has changed something: each is refused
// with one clear message, or goes on; nothing else.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/checked_file.h"
#include "incise/io/files/input_file.h"
#include "incise/topology/mesh_edit.h"
#include "run_folder.h"
#include "support/mesh_families.h"

namespace incise::runner {
namespace {

namespace fs = std::filesystem;
using support::read_text;
using test::Random;

/// The message with which it refuses; empty if it does not.
std::string refusal_of(const std::function<void()>& function) {
    try {
        function();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Of a body of tetrahedra, or of other cells, which become polyhedra where they are cut.
class ForgedRun : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        Simulation simulation(scenario_);
        RunWriter writer(simulation, out_);
        simulation.add_observer(writer);
        simulation.start();
        while (simulation.num_steps() < num_steps) simulation.step();
        ASSERT_GE(simulation.edits().size(), 2u);
        writer.take_checkpoint(simulation, CheckpointKind::of_a_stop);
        for (const auto& entry : fs::directory_iterator(out_ / "checkpoints"))
            checkpoint_ = entry.path();
        good_ = io::read_checked_file(checkpoint_);
        edits_ = simulation.edits();
    }

    /// Goes on for a few steps from a checkpoint of these bytes, whose checksum is right.
    void resume(const std::string& bytes) {
        io::write_checked_file(checkpoint_, bytes);
        std::vector<std::string> warnings;
        const Checkpoint checkpoint = Checkpoint::newest(out_, warnings);
        EXPECT_EQ(warnings, std::vector<std::string>{});
        checkpoint.require_same(scenario_);
        Simulation simulation(scenario_);
        checkpoint.restore(simulation);
        RunWriter writer(simulation, io::OutputFolder(out_), checkpoint.written());
        simulation.add_observer(writer);
        for (int i = 0; i < 5 && !simulation.is_finished(); ++i) simulation.step();
        num_resumed_ += 1;
    }

    /// Names the file, and what to do.
    void expect_clear(const std::string& message) const {
        EXPECT_EQ(message.find(out_.string() + "/"), 0u) << message;
        EXPECT_NE(message.find(": "), std::string::npos) << message;
        EXPECT_NE(message.find("begin anew without --resume"), std::string::npos) << message;
        EXPECT_EQ(io::printable(message), message);
    }

    static constexpr std::uint64_t num_steps = 12;
    RunFolder folder_;
    Scenario scenario_ = folder_.scenario(GetParam() + R"(
[[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0, at = [0.05, 0.05, 0.13] }, { time = 0.02, at = [0.05, 0.05, 0.09] }]
[[tool]]
kind = "blade"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0.001, at = [-0.02, 0, 0] }, { time = 0.06, at = [0.09, 0, 0.01] }]
[output]
interval = 0.004
compression = "none"
checkpoint_interval = 0
)" + dynamics(0.06, "gravity = [0, 0, -9.81]\nsafety = 0.3\n"));
    const fs::path out_ = folder_ / "out";
    fs::path checkpoint_;
    std::string good_;
    std::vector<EditRecord> edits_;
    int num_resumed_ = 0;
};

TEST_P(ForgedRun, IsNotWhatItSeemsToBe) {
    resume(good_);
    EXPECT_EQ(num_resumed_, 1);
    const std::string again = good_;
    SetUp();
    EXPECT_TRUE(good_ == again);
}

TEST_P(ForgedRun, IsRefusedOrGoesOnWhateverBytesChange) {
    Random random(4);
    int num_refused = 0;
    for (int i = 0; i < 400; ++i) {
        SCOPED_TRACE(i);
        std::string bytes = good_;
        const auto count = 1 + random.below(3);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t location = random.below(bytes.size() - 8);
            switch (random.below(5)) {
                case 0:
                    bytes[location] = static_cast<char>(random.below(256));
                    break;
                case 1:  // absurd counts, ids and numbers
                    bytes.replace(location, 8, std::string(8, random.below(2) ? '\xff' : '\x7f'));
                    break;
                case 2: {
                    const double value = random.below(2) ? 1e300 : -1.0;
                    std::memcpy(&bytes[location], &value, sizeof value);
                    break;
                }
                case 3:  // an id, or a number, of somewhere else
                    bytes.replace(location, 4, bytes.substr(random.below(bytes.size() - 4), 4));
                    break;
                default:
                    bytes.erase(location, 1 + random.below(16));
            }
        }
        std::string message;
        try {
            message = refusal_of([&] { resume(bytes); });
        } catch (const PhysicsError& error) {
            EXPECT_NE(std::string(error.what()), "");  // forces beyond all measure
            continue;
        }
        if (message.empty()) continue;
        ++num_refused;
        expect_clear(message);
    }
    EXPECT_GT(num_refused, 50);
    EXPECT_GT(num_resumed_, 25);  // other positions and velocities, say
}

TEST_P(ForgedRun, IsRefusedWhereRecordsContradictItsCheckpoint) {
    io::write_file(out_ / "summary.json", "{}");
    for (const char* name : {"history.csv", "edits.jsonl", "frames/scene_000001.vtu"}) {
        SCOPED_TRACE(name);
        const std::string text = read_text(out_ / name);
        ASSERT_FALSE(text.empty());
        std::string other = text;
        other[text.size() / 2] ^= 1;
        for (const auto& [forged, why] :
             {std::pair{other, "been changed"}, std::pair{text.substr(1), "become shorter"},
              std::pair{std::string(), "become shorter"}}) {
            io::write_file(out_ / name, forged);
            const std::string message = refusal_of([&] { resume(good_); });
            EXPECT_EQ(message.find((out_ / name).string() + ": has " + why), 0u) << message;
            EXPECT_EQ(read_text(out_ / name), forged);  // nothing has been touched
            EXPECT_TRUE(fs::exists(out_ / "summary.json"));
        }
        fs::remove(out_ / name);
        fs::create_directory(out_ / name);
        EXPECT_NE(refusal_of([&] { resume(good_); }).find("has gone"), std::string::npos);
        fs::remove(out_ / name);
        io::write_file(out_ / name, text);
    }
    // A frame of another run.
    const std::string frame = read_text(out_ / "frames/scene_000000.vtu");
    fs::copy_file(out_ / "frames/scene_000001.vtu", out_ / "frames/scene_000000.vtu",
                  fs::copy_options::overwrite_existing);
    EXPECT_NE(refusal_of([&] { resume(good_); }).find("scene_000000.vtu: has be"),
              std::string::npos);
    io::write_file(out_ / "frames/scene_000000.vtu", frame);
    // Indexes are written anew, whatever has become of them.
    const std::string index = read_text(out_ / "scene.pvd");
    io::write_file(out_ / "scene.pvd", "<rubbish");
    resume(good_);
    EXPECT_EQ(read_text(out_ / "scene.pvd").find(index.substr(0, index.find("  </Coll"))), 0u);
}

TEST_P(ForgedRun, IsRefusedIfAnotherVersionHasWrittenIt) {
    std::string bytes = good_, version = ArchiveReader(good_).read<std::string>();
    bytes[sizeof(std::uint64_t)] = version[0] = '9';  // the text is behind its length
    const std::string message = refusal_of([&] { resume(bytes); });
    EXPECT_NE(message.find("was written by version '" + version + "'"), std::string::npos)
        << message;
    EXPECT_NE(message.find("resume with that one, or begin anew"), std::string::npos) << message;
}

TEST_P(ForgedRun, IsRefusedIfAnotherBuildHasWrittenIt) {
    std::string bytes = good_;
    const auto version = ArchiveReader(good_).read<std::string>();
    ++bytes[sizeof(std::uint64_t) + version.size()];  // the format is behind it
    const std::string message = refusal_of([&] { resume(bytes); });
    EXPECT_NE(message.find("was written by another build of version "), std::string::npos);
    EXPECT_NE(message.find("resume with that one, or begin anew"), std::string::npos) << message;
}

TEST_P(ForgedRun, IsRefusedWhereItsLedgerContradictsItsEdits) {
    using Forge = std::function<void(EditRecord&)>;
    const auto refusal = [&](const Forge& forge) {
        const auto bytes_of = [](const EditRecord& edit) {
            ArchiveWriter ar;
            ar(edit);
            return ar.bytes();
        };
        EditRecord edit = edits_.back();
        const std::string true_bytes = bytes_of(edit);
        const std::size_t location = good_.find(true_bytes);
        EXPECT_NE(location, good_.npos);
        forge(edit);
        std::string bytes = good_;
        bytes.replace(location, true_bytes.size(), bytes_of(edit));
        const std::string message = refusal_of([&] { resume(bytes); });
        expect_clear(message);
        return message;
    };
    for (const Forge& forge : {Forge([](EditRecord& e) { e.elements_removed += 1; }),
                               Forge([](EditRecord& e) { e.elements_added += 1; }),
                               Forge([](EditRecord& e) { e.nodes_added += 1; }),
                               Forge([](EditRecord& e) { e.nodes_removed += 1; }),
                               Forge([](EditRecord& e) { e.mass_removed += 1e-9; }),
                               Forge([](EditRecord& e) { e.after.nodes -= 1; }),
                               Forge([](EditRecord& e) { e.after.elements -= 1; }),
                               Forge([](EditRecord& e) { e.elements_split += 1; }),
                               Forge([](EditRecord& e) { e.cut_area = -1.0; }),
                               Forge([](EditRecord& e) { e.tool[0] = '\xff'; })})
        EXPECT_NE(refusal(forge).find("edits.jsonl: its edits are not those of the checkpoint"),
                  std::string::npos);
    resume(good_);
    EXPECT_EQ(num_resumed_, 1);
}

class ForgedSummary : public testing::Test {
  protected:
    void SetUp() override { run(scenario_, folder_ / "out"); }
    std::string refusal(const std::string& text) {
        io::write_file(path_, text);
        return refusal_of([&] { finished_quantities(folder_ / "out", scenario_); });
    }

    RunFolder folder_;
    Scenario scenario_ =
        folder_.scenario(soft_cube + dynamics(0.01) + "[expect]\nmass_error = { max = 1e-12 }\n");
    const fs::path path_ = folder_ / "out/summary.json";
};

TEST_F(ForgedSummary, IsRefusedWithThePlaceAndTheValue) {
    const std::string good = read_text(path_);
    const auto with = [&](const std::string& entry, const std::string& forged) {
        std::string text = good;
        const auto begin = text.find('"' + entry + "\":"), end = text.find('\n', begin);
        EXPECT_NE(begin, text.npos);
        return text.replace(begin, end - begin, forged);
    };
    for (const auto& [text, why] : std::vector<std::pair<std::string, std::string>>{
             {"", "is empty"},
             {"[]", "is not the summary of a run"},
             {good.substr(0, good.size() / 2), "is not the summary of a run"},
             {std::string("\x00\xff\xfe\x01", 4), "is not the summary of a run"},
             {std::string(100'000, '['), "is not the summary of a run"},
             {with("status", "\"status\": 3,"), "'status' is '3', and should be a text"},
             {with("status", "\"status\": null,"), "'status' is 'null', and should be a text"},
             {with("status", ""), "has no entry 'status'"},
             {with("scenario_hash", "\"scenario_hash\": [],"), "'scenario_hash' is '[]'"},
             {with("mass_error", ""), "has no entry 'mass_error'"},
             {with("mass_error", "\"mass_error\": \"small\","), "'mass_error' is '\"small\"'"},
             {with("mass_error", "\"mass_error\": 1e999,"), "is not the summary of a run"}}) {
        SCOPED_TRACE(text.substr(0, 200));
        const std::string message = refusal(text);
        EXPECT_EQ(message.find(path_.string() + ": "), 0u) << message;
        EXPECT_NE(message.find(why), std::string::npos) << message;
        EXPECT_NE(message.find("begin anew without --resume"), std::string::npos) << message;
    }
    EXPECT_EQ(refusal(good), "");
    EXPECT_EQ(refusal(with("mass_error", "\"mass_error\": null,")), "");
    EXPECT_FALSE(
        failed_expectations(scenario_, *finished_quantities(folder_ / "out", scenario_)).empty());
}

TEST_F(ForgedSummary, IsRefusedOrReadWhateverBytesAreChanged) {
    const std::string good = read_text(path_);
    Random random(9);
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(i);
        std::string text = good;
        for (std::size_t k = random.below(4); k < 4; ++k) {
            const std::size_t location = random.below(text.size());
            if (random.below(3) == 0)
                text.erase(location, 1 + random.below(30));
            else
                text[location] = "{}[]\",:0-e\\n\x80 "[random.below(14)];
        }
        const std::string message = refusal(text);
        if (message.empty()) {
            const auto quantities = finished_quantities(folder_ / "out", scenario_);
            if (quantities) failed_expectations(scenario_, *quantities);
        } else {
            EXPECT_EQ(message.find(path_.string() + ": "), 0u) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

std::string soft_hexahedra() {
    std::string text = soft_cube;
    return text.insert(text.find("cells = "), "element = \"hex\", ");
}

INSTANTIATE_TEST_SUITE_P(OfTetrahedra, ForgedRun, testing::Values(soft_cube));
INSTANTIATE_TEST_SUITE_P(OfHexahedra, ForgedRun, testing::Values(soft_hexahedra()));

}  // namespace
}  // namespace incise::runner
