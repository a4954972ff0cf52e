// The exceptions of the module.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/error.h"
#include "incise/python/handle.h"

namespace incise::python {

namespace {

/// Creates an exception class of the module. It lives as long as the process.
PyObject* new_exception(py::module_& module, const char* name, const char* text,
                        const py::tuple& bases) {
    const std::string full = std::string("incise.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), text, bases.ptr(), nullptr);
    if (!type) throw py::error_already_set();
    module.add_object(name, py::reinterpret_borrow<py::object>(type));
    return type;
}

PyObject *base_error = nullptr, *input_error = nullptr, *physics_error = nullptr,
         *output_error = nullptr;

/// Sets an exception of Python. Bytes of file names that are not UTF-8 are replaced.
void set(PyObject* type, const char* text) {
    PyObject* message =
        PyUnicode_DecodeUTF8(text, static_cast<py::ssize_t>(std::strlen(text)), "replace");
    if (!message) return;
    PyErr_SetObject(type, message);
    Py_DECREF(message);
}

}  // namespace

void register_errors(py::module_& module) {
    const auto with = [](PyObject* base, PyObject* other) {
        return other ? py::make_tuple(py::handle(base), py::handle(other))
                     : py::make_tuple(py::handle(base));
    };
    base_error = new_exception(
        module, "Error",
        "The base of the errors of Incise. Its message names the thing, its value, its place and\n"
        "what to do, as the message of the command line does. Raised itself if two threads use\n"
        "one world at the same time.",
        with(PyExc_Exception, nullptr));
    input_error = new_exception(
        module, "InputError",
        "A wrong file, scenario or argument. The world is as it was, unless a tool has met\n"
        "something that it cannot cut: then the world has failed (World.has_failed).",
        with(base_error, PyExc_ValueError));
    physics_error = new_exception(
        module, "PhysicsError",
        "The motion was lost: a step that is too large, or a state that is not finite. The world\n"
        "has failed (World.has_failed): it can be read and restored, but not stepped.",
        with(base_error, nullptr));
    output_error = new_exception(module, "OutputError", "A file that cannot be written.",
                                 with(base_error, PyExc_OSError));
    // Its type is that of pybind11. NOLINTNEXTLINE(performance-unnecessary-value-param)
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const InputError& error) {
            set(input_error, error.what());
        } catch (const PhysicsError& error) {
            set(physics_error, error.what());
        } catch (const OutputError& error) {
            set(output_error, error.what());
        } catch (const MemoryError& error) {
            set(PyExc_MemoryError, error.what());
        } catch (const UsageError& error) {
            set(base_error, error.what());
        }
    });
}

}  // namespace incise::python
