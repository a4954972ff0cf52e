// The incise command: the one place where exceptions become messages and exit statuses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>

#include "app/command_line.h"
#include "app/messages.h"
#include "app/verbs.h"
#include "topology/error.h"

int main(int argc, char** argv) {
    using namespace incise;
    const auto fail = [](app::Status status, std::string_view text) {
        app::print_error(text);
        return static_cast<int>(status);
    };
    // A limit on file sizes or a closed pipe is then an error of writing like any other.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        const int status = app::dispatch(argc, argv);
        std::cout.flush();
        if (!std::cout) throw OutputError("standard output: cannot be written");
        return status;
    } catch (const InputError& error) {
        return fail(app::input_at_fault, error.what());
    } catch (const PhysicsError& error) {
        return fail(app::physics_went_wrong, error.what());
    } catch (const OutputError& error) {
        return fail(app::output_failed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(app::out_of_memory, "out of memory: the mesh is too large for this machine");
    } catch (const std::length_error&) {
        return fail(app::out_of_memory, "out of memory: the mesh is too large for this machine");
    } catch (const std::exception& error) {
        return fail(app::program_at_fault,
                    std::string("a fault of the program, please report it: ") + error.what());
    }
}
