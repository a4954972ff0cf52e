// An X display for VTK. Without one, VTK windows abort the program, even for off-screen rendering.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <sys/types.h>

namespace incise::render {

/// A guard that makes $DISPLAY name a display with OpenGL during its lifetime. This is the display
/// of the user if it can be opened, otherwise a virtual one (Xvfb). The virtual display ends with
/// the guard or with the program, even if the program is killed.
///
/// The constructor throws InputError if no display can be opened. The message says what to install.
/// @pre  no window exists when the guard is created
/// @thread  create it on the main thread
class DisplayGuard {
  public:
    DisplayGuard();
    ~DisplayGuard();
    DisplayGuard(const DisplayGuard&) = delete;
    DisplayGuard& operator=(const DisplayGuard&) = delete;

  private:
    pid_t server_ = -1;
};

}  // namespace incise::render
