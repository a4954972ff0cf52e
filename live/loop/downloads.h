// Files that pages load down: the body as it is, and the recording.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "incise/live/recording.h"
#include "incise/live/server/server.h"
#include "incise/live/session.h"

namespace incise::live {

/// Answers requests for files. They are made between two ticks, so they cost the session time: a
/// twentieth of it at most, however many pages ask.
class Downloads {
  public:
    /// @lifetime  all must outlive the object
    Downloads(const Session& session, const Recorder& recorder, Server& server)
        : session_(session), recorder_(recorder), server_(server) {}

    void add(const Request& request) { waiting_.push_back(request); }
    /// Answers those that wait, if it is time: those of one kind with the same file.
    void answer();

  private:
    using Clock = std::chrono::steady_clock;
    struct File {
        std::string content, type, name;
    };
    File make(const std::string& path) const;

    const Session& session_;
    const Recorder& recorder_;
    Server& server_;
    std::vector<Request> waiting_;
    Clock::time_point next_ = {};
};

}  // namespace incise::live
