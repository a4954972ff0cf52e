// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/unlocked.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace incise::python {

void Unlocked::register_end() {
    const auto at_end = pybind11::module_::import("atexit");
    at_end.attr("register")(pybind11::cpp_function(&Unlocked::wait_for_all));
    // The threads of a process do not live on in its child.
    pybind11::module_::import("os").attr("register_at_fork")(
        pybind11::arg("after_in_child") = pybind11::cpp_function(&Unlocked::forget_all));
}

void Unlocked::wait_for_all() {
    ending_ = std::this_thread::get_id();
    is_ending_ = true;
    while (count_ > 0) {
        {
            const pybind11::gil_scoped_release release;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        if (PyErr_CheckSignals() != 0) std::_Exit(128 + SIGINT);  // some calls take long
    }
}

void Unlocked::forget_all() { count_ = 0; }

}  // namespace incise::python
