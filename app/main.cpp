// The incise command: the one place where exceptions become messages and exit statuses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "incise/app/command_line.h"
#include "incise/app/messages.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/physics/elements/workers.h"

namespace {

using namespace incise;

int fail(app::Status status, std::string_view text) {
    app::print_error(text);
    return status;
}

int fail_by_fault(std::string_view text) {
    return fail(app::program_at_fault,
                "a fault of the program, please report it: " + std::string(text));
}

/// Needs no memory.
int fail_for_memory() {
    std::cerr << "incise: out of memory: the mesh is too large for this machine\n";
    return app::out_of_memory;
}

/// Gives descriptors that the caller has closed to nobody else: the first files of a run would be
/// its standard output otherwise. Writing there still fails.
void occupy_standard_descriptors() {
    int file = 0;
    do {
        file = ::open("/dev/null", O_RDONLY);
    } while (file >= 0 && file <= STDERR_FILENO);
    if (file >= 0) ::close(file);
}

int fail_for_threads() {
    return fail(app::out_of_memory,
                "out of memory or of processes: the system gives no further thread; raise the "
                "limits (ulimit -v, ulimit -u), or let a run have --threads 1");
}

/// Prints what the exception says; returns the status that it stands for.
int report(const std::exception_ptr& exception) {
    if (!exception) return fail_by_fault("it has given up");
    try {
        std::rethrow_exception(exception);
    } catch (const InputError& error) {
        return fail(app::input_at_fault, error.what());
    } catch (const PhysicsError& error) {
        return fail(app::physics_went_wrong, error.what());
    } catch (const OutputError& error) {
        return fail(app::output_failed, error.what());
    } catch (const MemoryError& error) {
        return fail(app::out_of_memory, error.what());
    } catch (const std::bad_alloc&) {
        return fail_for_memory();
    } catch (const std::length_error&) {
        return fail_for_memory();
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::not_enough_memory) return fail_for_memory();
        if (error.code() == std::errc::resource_unavailable_try_again) return fail_for_threads();
        return fail_by_fault(error.what());
    } catch (const std::exception& error) {
        if (physics::Workers::is_refused_thread(error)) return fail_for_threads();
        return fail_by_fault(error.what());
    } catch (...) {
        return fail_by_fault("it has given up");
    }
}

/// Of several threads that fail at the same time one tells; the others wait for the end.
int report_once(const std::exception_ptr& exception) {
    static std::atomic_flag is_told;
    thread_local bool is_telling = false;
    if (is_telling) return fail_for_memory();  // nothing else can fail about that
    while (is_told.test_and_set()) ::pause();
    is_telling = true;
    try {
        return report(exception);
    } catch (...) {
        return fail_for_memory();
    }
}

}  // namespace

int main(int argc, char** argv) {
    occupy_standard_descriptors();
    // A limit on file sizes or a closed pipe is then an error of writing like any other.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    // In the threads of libraries there is nobody to catch.
    std::set_terminate([] { std::_Exit(report_once(std::current_exception())); });
    try {
        const int status = app::dispatch(argc, argv);
        std::cout.flush();
        if (!std::cout) throw OutputError("standard output: cannot be written");
        return status;
    } catch (...) {
        return report_once(std::current_exception());
    }
}
