// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/recording.h"

#include <charconv>
#include <fstream>
#include <sstream>

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/live/json_values.h"

namespace incise::live {

namespace {

constexpr int format = 1;

std::string hex(std::uint64_t value) {
    std::array<char, 17> text;
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

std::uint64_t number_of_hex(const std::string& text) {
    std::uint64_t value = 0;
    const auto end = text.data() + text.size();
    if (std::from_chars(text.data(), end, value, 16).ptr != end || text.empty())
        throw InputError("'" + text + "' is no checksum");
    return value;
}

std::uint64_t tick_in(const Json& line, const char* key) {
    const Json& value = member(line, key);
    if (!value.is_number_unsigned())
        throw InputError("'" + std::string(key) + "': is no number of ticks");
    return value.get<std::uint64_t>();
}

RecordedScenario read_header(const Json& line) {
    if (!line.contains("incise_recording"))
        throw InputError(
            "this is no recording of incise live: its first line has no "
            "incise_recording");
    if (line["incise_recording"] != format)
        throw InputError("this recording has format " + line["incise_recording"].dump() +
                         "; this version of the program reads format " + std::to_string(format));
    RecordedScenario header;
    header.name = text_in(line, "scenario");
    header.hash = text_in(line, "hash");
    header.fingerprint = text_in(line, "body");
    header.version = text_in(line, "version");
    header.tick = number_in(line, "tick_length");
    if (!(header.tick > 0.0)) throw InputError("'tick_length': must be above 0");
    const Json& overrides = member(line, "set");
    if (!overrides.is_array()) throw InputError("'set': must be a list of texts");
    for (const Json& text : overrides) {
        if (!text.is_string()) throw InputError("'set': must be a list of texts");
        header.overrides.push_back(text.get<std::string>());
    }
    return header;
}

/// Reads a line after the first.
void read_line(const Json& line, Recording& recording) {
    if (line.contains("back_to")) {
        const std::uint64_t tick = tick_in(line, "back_to");
        if (tick > recording.num_ticks)
            throw InputError("goes back to tick " + std::to_string(tick) +
                             ", which is yet to come");
        recording.orders.erase(recording.orders.lower_bound(tick), recording.orders.end());
        recording.checksums.erase(recording.checksums.upper_bound(tick), recording.checksums.end());
        recording.num_ticks = tick;
        return;
    }
    const std::uint64_t tick = tick_in(line, "tick");
    if (tick != recording.num_ticks)
        throw InputError("is of tick " + std::to_string(tick) + ", not of tick " +
                         std::to_string(recording.num_ticks) + ": lines are missing");
    if (line.contains("orders")) {
        if (!line["orders"].is_array()) throw InputError("'orders': must be a list");
        for (const Json& order : line["orders"]) {
            if (!order.is_object()) throw InputError("'orders': must be a list of objects");
            recording.orders[tick].push_back(order_of(order));
        }
    }
    recording.num_ticks = tick + 1;
    if (line.contains("state"))  // not in what was written by hand
        recording.checksums[tick + 1] = number_of_hex(text_in(line, "state"));
}

}  // namespace

Recording read_recording(const std::filesystem::path& file) {
    const std::string text = io::load_input_file(file).bytes;
    Recording recording;
    std::size_t begin = 0;
    for (int number = 1; begin < text.size(); ++number) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string::npos && number > 1) break;  // cut off by a kill
        const std::string line = text.substr(begin, end - begin);
        try {
            const Json json = parse_object(line);
            if (number == 1)
                recording.scenario = read_header(json);
            else
                read_line(json, recording);
        } catch (const InputError& error) {
            throw InputError(file.string() + ":" + std::to_string(number) + ": " + error.what());
        }
        if (end == std::string::npos) break;
        begin = end + 1;
    }
    if (recording.scenario.hash.empty())
        throw InputError(file.string() +
                         ": is empty; a recording is what incise live --record "
                         "writes");
    return recording;
}

Recorder::Recorder(const Session& session, const std::vector<std::string>& overrides,
                   const std::string& version, std::optional<std::filesystem::path> file)
    : path_(std::move(file)) {
    if (path_) file_.emplace(*path_);
    const scenario::Scenario& scenario = session.simulation().scenario();
    append(text_of(Json{{"incise_recording", format},
                        {"scenario", scenario.name},
                        {"hash", scenario.hash},
                        {"set", overrides},
                        {"body", hex(session.simulation().fingerprint())},
                        {"version", version},
                        {"tick_length", session.tick_length()}}));
}

void Recorder::append(const std::string& line) {
    text_ += line + '\n';
    if (!file_) return;
    try {
        file_->append(line);
    } catch (const OutputError&) {
        file_.reset();  // it is whole up to here, and would have a gap
        throw;
    }
}

void Recorder::note_tick(const Session& session) {
    std::string line = "{\"tick\":" + std::to_string(session.num_ticks() - 1);
    if (const auto orders = session.orders_of_last_tick(); !orders.empty()) {
        line += ",\"orders\":[";
        for (const Order& order : orders)
            line += (&order == &orders.front() ? "" : ",") + to_json(order);
        line += ']';
    }
    append(line + ",\"state\":\"" + hex(session.checksum()) + "\"}");
}

void Recorder::note_return(const Session& session) {
    append("{\"back_to\":" + std::to_string(session.num_ticks()) + "}");
}

Replay::Replay(const scenario::Scenario& scenario, Recording recording, bool may_differ)
    : recording_(std::move(recording)),
      session_(scenario, recording_.scenario.tick, recording_.num_ticks) {
    if (recording_.num_ticks == 0)
        throw InputError("the recording has no tick: the session ended before anything moved");
    if (may_differ) return;
    const auto require = [&](const std::string& recorded, const std::string& now,
                             const char* what) {
        if (recorded == now) return;
        if (recording_.scenario.name != scenario.name)
            throw InputError("the recording is of " + recording_.scenario.name + ", and this is " +
                             scenario.name);
        throw InputError("the recording is of " + recording_.scenario.name +
                         " as it was then: since then " + what +
                         " was changed; change it back, or play it nevertheless with a --set");
    };
    require(recording_.scenario.hash, scenario.hash, "the scenario");
    require(recording_.scenario.fingerprint, hex(session_.simulation().fingerprint()),
            "the mesh or a surface");
}

void Replay::tick() {
    const std::uint64_t tick = session_.num_ticks();
    if (const auto orders = recording_.orders.find(tick); orders != recording_.orders.end()) {
        for (const Order& order : orders->second) {
            try {
                session_.execute(order);
            } catch (const InputError& error) {
                throw InputError("tick " + std::to_string(tick) +
                                 " of the recording: " + error.what());
            }
        }
    }
    session_.tick();
    const auto recorded = recording_.checksums.find(tick + 1);
    if (!first_difference_ && recorded != recording_.checksums.end() &&
        recorded->second != session_.checksum())
        first_difference_ = tick;
}

}  // namespace incise::live
