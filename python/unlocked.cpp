// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/unlocked.h"

#include <chrono>
#include <thread>

namespace incise::python {

void Unlocked::register_end() {
    const auto at_end = pybind11::module_::import("atexit");
    at_end.attr("register")(pybind11::cpp_function(&Unlocked::wait_for_all));
}

void Unlocked::wait_for_all() {
    is_ending_ = true;
    while (count_ > 0) {
        const pybind11::gil_scoped_release release;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

}  // namespace incise::python
