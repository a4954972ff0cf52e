// The main function of incise, which turns exceptions into messages and exit statuses.
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

/// Reports that memory is exhausted. Allocates none.
int fail_for_memory() {
    std::cerr << "incise: out of memory: the mesh is too large for this machine\n";
    return app::out_of_memory;
}

/// Occupies the standard descriptors that the caller has closed. Otherwise the first files of a run
/// would get these descriptors and receive standard output. Writing to them still fails.
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

/// Prints the message of the exception and returns its exit status.
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

/// Reports an exception once: if several threads fail, the first one reports and the others wait
/// for the end of the process.
int report_once(const std::exception_ptr& exception) {
    static std::atomic_flag is_told;
    thread_local bool is_telling = false;
    if (is_telling) return fail_for_memory();  // only lack of memory can make a report fail
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
    // Makes a limit on file sizes and a closed pipe ordinary errors of writing.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    // For exceptions in threads of libraries, which nothing catches.
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
