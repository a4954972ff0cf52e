// Measures what a live session costs beside the ticks: pictures, the surface after an edit, states
// to go back to, checksums of a recording.
//   live_bench SCENARIO.toml
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "incise/live/loop/picture_maker.h"
#include "incise/live/recording.h"
#include "incise/live/session.h"
#include "incise/scenario/scenario_reader.h"

using namespace incise;

namespace {

double microseconds(auto&& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
        .count();
}

void print(const char* what, std::vector<double> times) {
    std::ranges::sort(times);
    if (times.empty()) return;
    std::printf("%-44s %4zu times, median %8.1f us, p99 %8.1f us\n", what, times.size(),
                times[times.size() / 2], times[times.size() * 99 / 100]);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    auto report = scenario::read_scenario(argv[1]);
    for (const std::string& error : report.errors) std::fprintf(stderr, "%s\n", error.c_str());
    if (!report.errors.empty()) return 2;
    live::Session session(std::move(report.scenario));
    live::PictureMaker pictures(session);
    Eigen::AlignedBox3d box;
    for (const Vec3& x : session.world().mesh().rest_positions()) box.extend(x);
    std::printf("%zu elements, %zu nodes\n", session.world().mesh().num_elements(),
                session.world().mesh().num_nodes());

    // A blade goes through the middle of the body within a second.
    const double far = box.diagonal().norm();
    const std::string edge = std::to_string(far);
    const auto at = [&](double part) {
        Pose pose;
        pose.position = box.center();
        pose.position.x() += (part - 0.5) * 1.2 * box.sizes().x();
        return pose;
    };
    std::vector<double> still, valued, edited, states, checksums, ticks;
    const auto run = [&](int num_ticks, bool cuts) {
        for (int i = 1; i <= num_ticks; ++i) {
            if (cuts) session.execute(live::MoveTool{"blade", at(i / double(num_ticks))});
            const auto num_edits = session.simulation().edits().size();
            ticks.push_back(microseconds([&] { session.tick(); }));
            checksums.push_back(microseconds([&] { session.checksum(); }));
            pictures.show("none");
            const bool is_edited = session.simulation().edits().size() > num_edits;
            (is_edited ? edited : still).push_back(microseconds([&] { pictures.make(session); }));
            pictures.show("von_mises");
            pictures.make(session);
            valued.push_back(microseconds([&] { pictures.make(session); }));
            if (i % 20 == 0) states.push_back(microseconds([&] { session.moment(); }));
        }
    };
    run(60, false);
    const live::Session::Moment before = session.moment();
    session.execute(live::order_from_json(
        R"({"add":"blade","tool":{"kind":"blade","edge":[[0,0,)" + edge + "],[0,0,-" + edge +
        R"(]]},"at":[)" + std::to_string(at(0).position.x()) + "," +
        std::to_string(at(0).position.y()) + "," + std::to_string(at(0).position.z()) + "]}"));
    run(60, true);
    run(60, false);
    print("a tick", ticks);
    print("a picture", still);
    print("a picture after edits, with the topology", edited);
    print("a picture with a field of elements", valued);
    print("a moment to go back to", states);
    print("the undo of the stroke", {microseconds([&] { session.undo(before); })});
    print("the checksum of a tick", checksums);
}
