// An X display to draw on: VTK's windows, hidden ones too, abort the program where there is none.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <sys/types.h>

namespace incise::render {

/// Makes sure that $DISPLAY names a display with OpenGL while this lives: the user's own if it can
/// be opened, else a virtual one (Xvfb), which ends with this object or with the program, however
/// that ends. To be made before any window, by the main thread.
/// Throws InputError that says what to install if there can be none.
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
