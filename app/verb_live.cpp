// incise live: simulates a scenario in real time, with hands in the browser.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "incise/app/live_devices.h"
#include "incise/app/messages.h"
#include "incise/app/shell_word.h"
#include "incise/app/stop_signals.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/live/loop/live_loop.h"
#include "incise/live/page/page_parts.h"
#include "incise/live/recording.h"
#include "incise/physics/elements/workers.h"
#include "incise/scenario/body_problems.h"

namespace incise::app {

namespace {

/// Opens an address in the browser of the desktop, if there is one. All users of the machine can
/// read the address.
void open_in_browser(const std::string& address) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
    std::string program = "xdg-open", argument = address;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t silence;
    posix_spawn_file_actions_init(&silence);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&silence, stream, "/dev/null", O_RDWR, 0);
    pid_t child = 0;
    if (posix_spawnp(&child, program.c_str(), &silence, nullptr, arguments, environ) == 0)
        std::thread([child] { waitpid(child, nullptr, 0); }).detach();
    posix_spawn_file_actions_destroy(&silence);
}

/// Refuses what the recording could not be written to, before anything else is done.
void require_writable(const std::filesystem::path& recording, bool may_replace) {
    const std::filesystem::path folder = recording.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw InputError(recording.string() + ": there is no folder " + folder.string());
    if (!may_replace && std::filesystem::exists(recording))
        throw InputError(recording.string() +
                         ": is there already; give the recording another name, or replace it with "
                         "--force");
}

std::string json_text(const nlohmann::json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Builds the session. Pages that are open already see how far it is, or what is wrong.
std::unique_ptr<live::Session> build(const scenario::Scenario& scenario, double tick,
                                     live::Server& server) {
    const auto tell = [&](const std::string& stage) {
        const std::string message = json_text({{"type", "progress"}, {"text", stage}});
        server.greet_with(message);
        server.send_to_all(message);
    };
    try {
        constexpr auto no_end = std::numeric_limits<std::uint64_t>::max();
        auto session = std::make_unique<live::Session>(scenario, tick, no_end, tell);
        server.greet_with({});
        return session;
    } catch (const std::exception& error) {
        server.send_to_all(
            json_text({{"type", "message"}, {"level", "error"}, {"text", error.what()}}));
        // Long enough for a page on this machine to show it.
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        throw;
    }
}

}  // namespace

int live(const LiveOptions& options) {
    const StopSignals signals(options.scenario.string() + ": stopped before it began");
    if (options.record) require_writable(*options.record, options.force);
    const scenario::Scenario scenario = load_scenario(options.scenario, options.overrides);
    live::Server server({.host = options.host,
                         .port = options.port,
                         .files = live::page_files(),
                         .downloads = {"/recording.jsonl", "/frame.vtu"}});
    const auto device = open_device(options, scenario.name);
    std::cerr << scenario.name << ": open " << server.address() << '\n';
    if (options.open) open_in_browser(server.address_for_once());

    const auto built = [&] {
        try {
            return build(scenario, options.tick, server);
        } catch (const scenario::BodyError& error) {
            for (const std::string& warning : error.warnings) print_warning(warning);
            throw;
        } catch (const InputError& error) {
            throw InputError(prefixed(options.scenario.string() + ": ", error.what()));
        }
    }();
    live::Session& session = *built;
    require_tools(options, session);
    session.simulation().set_num_threads(options.num_threads > 0 ? options.num_threads
                                                                 : physics::Workers::num_cores());
    for (const std::string& warning : session.simulation().warnings()) print_warning(warning);
    live::Recorder recorder(session, options.overrides, INCISE_VERSION, options.record);
    signals.note_only();

    live::LiveLoop loop(session, recorder, server);
    if (device) loop.add_device(*device);
    loop.on_message = [](std::string_view level, const std::string& text) {
        if (level == "error")
            print_error(text);
        else if (level == "warning")
            print_warning(text);
        else
            std::cerr << text << '\n';
    };
    loop.run([&] { return signals.noted() != 0; });
    std::cerr << scenario.name << ": ended at t = " << session.world().time() << " s, "
              << session.simulation().edits().size() << " edits\n";
    if (options.record)
        std::cerr << "The same again: incise run " << shell_word(options.scenario.string())
                  << " --replay " << shell_word(options.record->string()) << '\n';
    return 128 + signals.noted();
}

}  // namespace incise::app
