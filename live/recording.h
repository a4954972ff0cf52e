// What hands did in a session, as a file that can be played again.
// docs/live.md describes the file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/io/files/line_file.h"
#include "incise/live/order.h"
#include "incise/live/session.h"

namespace incise::live {

/// The scenario of a recording.
struct RecordedScenario {
    std::string name;                    ///< for messages
    std::string hash;                    ///< scenario::Scenario::hash
    std::vector<std::string> overrides;  ///< of the command line
    std::string fingerprint;             ///< of the body at the start
    std::string version;                 ///< of the program
    double tick = usual_tick;            ///< s
};

/// What hands did, tick by tick.
struct Recording {
    RecordedScenario scenario;
    /// By tick, the orders that were executed before it, in their order.
    std::map<std::uint64_t, std::vector<Order>> orders;
    /// By number of ticks, Session::checksum() after them.
    std::map<std::uint64_t, std::uint64_t> checksums;
    std::uint64_t num_ticks = 0;
};

/// Reads a recording. What was undone in the session is left out. A last line that is cut off is
/// left out, as after a kill.
/// Throws InputError that names the file, the line and the problem.
Recording read_recording(const std::filesystem::path& file);

/// Writes a recording while a session goes on. Each tick is a line, which is in the file at once:
/// a kill loses nothing of it.
class Recorder {
  public:
    /// @param session    before its first tick
    /// @param overrides  of the scenario, from the command line
    /// @param version    of the program
    /// @param file       to write; if not set, the lines are only kept in memory
    /// Throws OutputError.
    Recorder(const Session& session, const std::vector<std::string>& overrides,
             const std::string& version, std::optional<std::filesystem::path> file);

    /// Notes a tick of the session, with the orders before it. Throws OutputError if the file
    /// cannot be written: from then on the lines are kept in memory only.
    void note_tick(const Session& session);
    /// Notes that the session went back. Throws OutputError.
    void note_return(const Session& session);

    /// Returns the lines so far.
    const std::string& text() const { return text_; }
    const std::optional<std::filesystem::path>& file() const { return path_; }

  private:
    void append(const std::string& line);

    std::optional<std::filesystem::path> path_;
    std::optional<io::LineFile> file_;
    std::string text_;
};

/// A session that does what was recorded.
class Replay {
  public:
    /// Builds the body. Throws as Session, and InputError if the body or the scenario is another
    /// than that of the recording, unless `may_differ`, or if nothing was recorded.
    Replay(const scenario::Scenario& scenario, Recording recording, bool may_differ);

    /// Makes the next tick. Throws as Session::tick(), and InputError with the number of the tick
    /// if an order is refused.
    void tick();
    bool is_finished() const { return session_.is_finished(); }
    const Session& session() const { return session_; }
    Session& session() { return session_; }
    /// Returns the first tick after which the bits are not those that were recorded, if any.
    std::optional<std::uint64_t> first_difference() const { return first_difference_; }

  private:
    Recording recording_;
    Session session_;
    std::optional<std::uint64_t> first_difference_;
};

}  // namespace incise::live
