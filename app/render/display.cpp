// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/render/display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <string>
#include <system_error>

#include "incise/base/error.h"

namespace incise::render {

namespace {

constexpr int exit_not_found = 127;  // the same as in shells

/// True if $DISPLAY can be opened and has OpenGL, which a forwarded display may lack.
bool has_usable_display() {
    ::Display* const display = XOpenDisplay(nullptr);
    if (!display) return false;
    int opcode = 0, event = 0, error = 0;
    const bool has_opengl = XQueryExtension(display, "GLX", &opcode, &event, &error) != 0;
    XCloseDisplay(display);
    return has_opengl;
}

/// Replaces the child process by an Xvfb on a free display. Xvfb writes the number of the display
/// to `number_pipe`. `pipe_text` is this descriptor as text, because nothing may be allocated
/// between fork and exec.
[[noreturn]] void become_server(int number_pipe, const char* pipe_text, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends also if the parent is killed
    if (::getppid() != parent) ::_exit(1);
    ::setsid();  // Ctrl+C reaches only the parent, which ends the child
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        ::dup2(nowhere, descriptor);
    ::fcntl(number_pipe, F_SETFD, 0);
    ::execlp("Xvfb", "Xvfb", "-displayfd", pipe_text, "-screen", "0", "1280x1024x24", "-nolisten",
             "tcp", "-noreset", static_cast<char*>(nullptr));
    ::_exit(exit_not_found);
}

/// Returns the first line from the pipe, or nothing if none comes within `patience`.
std::optional<std::string> read_line(int pipe, std::chrono::milliseconds patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::string line;
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            deadline - std::chrono::steady_clock::now());
        if (left.count() <= 0) return std::nullopt;
        pollfd poll_entry{pipe, POLLIN, 0};
        const int ready = ::poll(&poll_entry, 1, static_cast<int>(left.count()));
        if (ready < 0 && errno == EINTR) continue;
        char c = 0;
        if (ready <= 0 || ::read(pipe, &c, 1) != 1) return std::nullopt;
        if (c == '\n') return line;
        line += c;
    }
}

/// Ends a server and returns its status from waitpid().
int stop_server(pid_t server) {
    int status = 0;
    ::kill(server, SIGTERM);
    for (int waited_ms = 0; waited_ms < 2000; waited_ms += 10) {
        if (::waitpid(server, &status, WNOHANG) != 0) return status;
        ::usleep(10'000);
    }
    ::kill(server, SIGKILL);
    ::waitpid(server, &status, 0);
    return status;
}

}  // namespace

DisplayGuard::DisplayGuard() {
    if (has_usable_display()) return;

    // Two servers that start at the same time may choose the same number. One then fails, and its
    // start is repeated.
    constexpr int attempts = 3;
    constexpr std::chrono::seconds patience{20};
    for (int attempt = 0; attempt < attempts; ++attempt) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe");
        const auto pipe_text = std::to_string(ends[1]);
        const pid_t parent = ::getpid();
        server_ = ::fork();
        if (server_ == 0) become_server(ends[1], pipe_text.c_str(), parent);
        ::close(ends[1]);
        if (server_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
        const auto number = read_line(ends[0], patience);
        ::close(ends[0]);
        if (number && !number->empty()) {
            ::setenv("DISPLAY", (":" + *number).c_str(), 1);
            ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);  // Xvfb has no other; avoids a search
            if (has_usable_display()) return;
        }
        const int status = stop_server(server_);
        server_ = -1;
        if (WIFEXITED(status) && WEXITSTATUS(status) == exit_not_found)
            throw InputError(
                "there is no display to draw on, and no Xvfb to make one: apt-get install xvfb "
                "libgl1-mesa-dri");
    }
    throw InputError(
        "there is no display to draw on, and Xvfb does not start or has no OpenGL: apt-get "
        "install xvfb libgl1-mesa-dri, or set DISPLAY to a display with OpenGL");
}

DisplayGuard::~DisplayGuard() {
    if (server_ > 0) stop_server(server_);
}

}  // namespace incise::render
