// A world as Python holds it: with a mark while a thread uses it, and a count of its views.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "incise/python/unlocked.h"
#include "incise/python/world_driver.h"

namespace incise::python {

namespace py = pybind11;

/// A use of a world that another use forbids. It becomes incise.Error.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A world with what Python needs to know of it. All members are used with the GIL held, except
/// the driver while `is_busy` is set.
struct Handle {
    explicit Handle(const scenario::Scenario& scenario) : driver(scenario) {}

    WorldDriver driver;
    bool is_busy = false;         ///< a thread uses the driver without the GIL
    std::size_t num_exports = 0;  ///< open views, and arrays that show memory of the world
    int num_threads = 1;
    std::size_t num_warned = 0;             ///< of the warnings of the driver
    std::shared_ptr<UndoPoint> last_point;  ///< that undo_point() has returned

    /// The living nodes, in ascending order: row r of the arrays of Python is node nodes[r].
    struct Rows {
        std::uint64_t version = std::numeric_limits<std::uint64_t>::max();
        bool are_ids = true;                ///< all nodes live: rows are ids
        std::vector<VertexId> nodes;        ///< empty if rows are ids
        std::vector<std::int64_t> of_node;  ///< by id; -1 for dead nodes; empty if rows are ids
        std::int64_t row(VertexId n) const { return are_ids ? n.value : of_node[n.index()]; }
    };
    const Rows& rows();

    /// Objects that are made anew after edits only.
    struct Kept {
        std::uint64_t version = std::numeric_limits<std::uint64_t>::max();
        py::object value;
    };
    Kept surface, cells, regions, elements, components;

  private:
    Rows rows_;
};

using World = std::shared_ptr<Handle>;

/// Returns the driver. Throws UsageError while another thread uses it.
WorldDriver& driver_of(const World& world);

/// Throws BufferError if views of the world are open.
void require_no_views(const World& world);

/// Runs a function on the driver without the GIL. No other thread can use the world meanwhile.
template <class Function>
auto without_gil(const World& world, Function function) {
    WorldDriver& driver = driver_of(world);
    struct Lease {
        Handle& handle;
        explicit Lease(Handle& h) : handle(h) { handle.is_busy = true; }
        ~Lease() { handle.is_busy = false; }
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
    } lease(*world);
    const Unlocked unlocked;
    return function(driver);
}

/// Passes warnings that are new to Python's warnings. Throws if these are errors there.
void pass_warnings(const World& world);
void pass_warning(const std::string& text);

/// Wraps a member function of Python given as f(const T&, ...), so that it takes the holder of the
/// object: pybind11 then refuses an object that was never made, as by T.__new__(T). It would pass a
/// reference to memory without contents.
template <class Result, class T, class... Arguments>
auto held(Result (*f)(const T&, Arguments...)) {
    return [f](const std::shared_ptr<T>& self, Arguments... arguments) -> Result {
        if (!self) throw py::type_error("None is no object of this class");
        return f(*self, std::forward<Arguments>(arguments)...);
    };
}
/// Returns a function that reads a member.
template <class T, class Member>
auto held(Member T::*member) {
    return [member](const std::shared_ptr<T>& self) -> Member {
        if (!self) throw py::type_error("None is no object of this class");
        return (*self).*member;
    };
}
/// Lets copy and pickle refuse objects of a class. The __reduce__ of object would make an instance
/// of the common base class of pybind11, which throws through the interpreter.
template <class Class>
void forbid_copies(Class& type, const char* remedy) {
    const auto refuse = [remedy](const py::object& self) {
        throw py::type_error("incise." + py::type::of(self).attr("__name__").cast<std::string>() +
                             " cannot be copied or pickled: " + remedy);
    };
    constexpr const char* text = "Raise TypeError: objects of this class cannot be copied.";
    type.def(
        "__reduce__", [refuse](const py::object& self) { refuse(self); }, text);
    type.def(
        "__reduce_ex__", [refuse](const py::object& self, int) { refuse(self); },
        py::arg("protocol"), text);
}

/// Returns points as an array of shape (N, 3).
py::array_t<double> matrix_of(std::span<const Vec3> points);
py::array_t<double> array_of(const Vec3& v);
/// Throws TypeError that names an argument that the function does not have, and the one that may be
/// meant.
void refuse_unknown(const py::kwargs& unknown, const char* function,
                    std::initializer_list<const char*> known);
/// Returns the pose that Python passed. Throws TypeError for anything else.
Pose given_pose(const py::handle& object);
/// Returns rows of an array of points as nodes of a world. Throws InputError for other rows.
std::vector<VertexId> nodes_of(Handle& handle, const py::object& rows);
/// Returns a vector from any three numbers. Throws TypeError or InputError, with the name.
Vec3 vector_from(const py::handle& object, const std::string& name);
/// Returns points from anything of shape (N, 3).
std::vector<Vec3> points_from(const py::handle& object, const std::string& name);
/// Makes an array read-only, and returns it.
template <class Array>
Array frozen(Array array) {
    array.attr("setflags")(py::arg("write") = false);
    return array;
}
/// Returns the path that a str or an os.PathLike names. It can be empty.
std::filesystem::path path_from(const py::handle& object);
/// Returns the path of a file. Throws InputError, with the name of the argument and the kind of the
/// file, if it is empty.
std::filesystem::path file_from(const py::handle& object, const std::string& name,
                                const std::string& kind);

void register_cut(py::module_& module);
void register_errors(py::module_& module);
void register_pose(py::module_& module);
void register_mesh(py::module_& module);
void register_report(py::module_& module);
void register_tools(py::module_& module);
void register_world(py::module_& module);
/// Adds to incise.World what adds tools, constraints and loads to a world, and changes it.
void register_world_parts(py::class_<Handle, World>& type);

}  // namespace incise::python
