// Work without the lock of the interpreter.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <thread>

namespace incise::python {

/// Lets other threads of Python run during its lifetime.
///
/// While Python ends, a thread that takes the lock again is ended, in the middle of C++. So the end
/// waits for all such work of other threads, and no more of theirs begins: the constructor, and
/// stop_at_end(), raise SystemExit then, which ends a thread without a word. The thread that ends
/// Python goes on: functions of atexit and __del__ work. All is called with the lock held.
class Unlocked {
  public:
    static void stop_at_end() {
        if (!is_ending_ || std::this_thread::get_id() == ending_) return;
        PyErr_SetNone(PyExc_SystemExit);
        throw pybind11::error_already_set();
    }
    /// Has Python call wait_for_all() at its end.
    static void register_end();

  private:
    static void wait_for_all();
    static void forget_all();

    struct Counted {
        Counted() {
            stop_at_end();
            ++count_;
        }
        ~Counted() { --count_; }
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;
    };
    static inline bool is_ending_ = false;
    static inline std::thread::id ending_ = {};  // the thread that ends Python
    static inline int count_ = 0;

    Counted counted_;  // until after the lock is taken again
    pybind11::gil_scoped_release release_;
};

}  // namespace incise::python
