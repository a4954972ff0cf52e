// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/stop_signals.h"

#include <unistd.h>

#include <csignal>
#include <cstddef>

#include "incise/app/messages.h"

namespace incise::app {

namespace {

// Global, because signal handlers have no other access to data.
volatile std::sig_atomic_t noted_signal = 0;
std::string last_words;

constexpr int stop_signals[] = {SIGINT, SIGTERM};

void handle_by(void (*handler)(int)) {
    for (const int signal : stop_signals) std::signal(signal, handler);
}

/// Prints the farewell and ends the process. Makes only calls that are allowed in signal handlers.
void end(int signal) {
    const auto written = ::write(STDERR_FILENO, last_words.data(), last_words.size());
    static_cast<void>(written);
    ::_exit(128 + signal);
}

}  // namespace

StopSignals::StopSignals(const std::string& farewell) {
    noted_signal = 0;
    last_words = prefixed("incise: ", farewell) + '\n';
    handle_by(end);
}

StopSignals::~StopSignals() { handle_by(SIG_DFL); }

void StopSignals::note_only() const {
    handle_by([](int signal) { noted_signal = signal; });
}

int StopSignals::noted() const { return noted_signal; }

}  // namespace incise::app
