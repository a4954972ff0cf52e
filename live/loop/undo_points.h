// The points that a live session can go back to.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "incise/live/session.h"

namespace incise::live {

/// The points before the last strokes of a session, and some of the last seconds, for when the
/// body blows up. The memory of all is bounded: the oldest ones are forgotten.
class UndoPoints {
  public:
    /// Keeps the point before a stroke.
    void keep_stroke(Session::UndoPoint point) { keep(strokes_, std::move(point), 64, 512u << 20); }
    bool has_stroke() const { return !strokes_.empty(); }
    /// True if the last stroke began after so many ticks.
    bool is_stroke_at(std::uint64_t num_ticks) const {
        return has_stroke() && strokes_.back().num_ticks == num_ticks;
    }
    /// Returns the point before the last stroke, and forgets it.
    Session::UndoPoint take_stroke() { return take(strokes_); }

    /// Keeps a point of now and then.
    void keep_good(Session::UndoPoint point) { keep(good_, std::move(point), 5, 256u << 20); }
    bool has_good() const { return !good_.empty(); }
    /// Returns the newest point of now and then, and forgets it.
    Session::UndoPoint take_good() { return take(good_); }

    /// Forgets all that is after a number of ticks: the session went back.
    void forget_after(std::uint64_t num_ticks) {
        const auto is_after = [&](const auto& point) { return point.num_ticks > num_ticks; };
        std::erase_if(strokes_, is_after);
        std::erase_if(good_, is_after);
    }
    void forget_all() {
        strokes_.clear();
        good_.clear();
    }

  private:
    using List = std::deque<Session::UndoPoint>;
    static Session::UndoPoint take(List& list) {
        Session::UndoPoint point = std::move(list.back());
        list.pop_back();
        return point;
    }
    static void keep(List& list, Session::UndoPoint point, std::size_t most,
                     std::size_t most_bytes) {
        list.push_back(std::move(point));
        std::size_t bytes = 0;
        constexpr std::size_t of_tool = 512;  // with its definition, about
        const auto size_of = [](const Session::UndoPoint& kept) {
            return kept.state.world.num_bytes() + kept.state.run.size() +
                   of_tool * kept.tools.size();
        };
        for (const auto& kept : list) bytes += size_of(kept);
        const sim::UndoPoint& last = list.back().state.world;
        while (list.size() > 1 &&
               (list.size() > most ||
                bytes + last.num_bytes_since(list.front().state.world) > most_bytes)) {
            bytes -= size_of(list.front());
            list.pop_front();
        }
    }

    List strokes_, good_;
};

}  // namespace incise::live
