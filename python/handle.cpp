// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/handle.h"

#include <cstring>

#include "incise/base/error.h"
#include "incise/scenario/diagnostics.h"

namespace incise::python {

const Handle::Rows& Handle::rows() {
    const topology::Mesh& mesh = driver.world().mesh();
    const std::uint64_t version = driver.topology_version();
    if (rows_.version == version) return rows_;
    rows_ = {};
    rows_.version = version;
    rows_.are_ids = mesh.num_nodes() == mesh.node_capacity();
    if (rows_.are_ids) return rows_;
    rows_.of_node.assign(mesh.node_capacity(), -1);
    for (const VertexId n : mesh.nodes()) {
        rows_.of_node[n.index()] = static_cast<std::int64_t>(rows_.nodes.size());
        rows_.nodes.push_back(n);
    }
    return rows_;
}

WorldDriver& driver_of(const World& world) {
    if (!world) throw UsageError("this world was never made: call World(...)");
    if (world->is_busy)
        throw UsageError("another thread uses this world: only one thread at a time may");
    return world->driver;
}

void require_no_views(const World& world) {
    driver_of(world);
    if (world->num_exports > 0)
        throw py::buffer_error(
            "a view of this world is open, or an array of one is still in use: leave the with "
            "statement and drop the arrays, or keep copies of them");
}

void pass_warning(const std::string& text) {
    const py::object category = py::module_::import("incise").attr("InciseWarning");
    if (PyErr_WarnEx(category.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

void pass_warnings(const World& world) {
    // The number is counted first: a warning that is an error is passed once.
    while (world->num_warned < world->driver.warnings().size())
        pass_warning(std::string(world->driver.warnings()[world->num_warned++]));
}

py::array_t<double> matrix_of(std::span<const Vec3> points) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
    if (!points.empty())
        std::memcpy(array.mutable_data(), points.front().data(), points.size_bytes());
    return array;
}

py::array_t<double> array_of(const Vec3& v) {
    py::array_t<double> array(3);
    std::memcpy(array.mutable_data(), v.data(), 3 * sizeof(double));
    return array;
}

namespace {
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

Doubles doubles_from(const py::handle& object, const std::string& name) {
    Doubles array = Doubles::ensure(object);
    if (!array) {
        PyErr_Clear();
        throw py::type_error(name + " must be numbers");
    }
    return array;
}
}  // namespace

Vec3 vector_from(const py::handle& object, const std::string& name) {
    const Doubles array = doubles_from(object, name);
    if (array.ndim() != 1 || array.shape(0) != 3) throw InputError(name + " must be three numbers");
    return {array.at(0), array.at(1), array.at(2)};
}

std::vector<Vec3> points_from(const py::handle& object, const std::string& name) {
    const Doubles array = doubles_from(object, name);
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw InputError(name + " must have the shape (N, 3)");
    std::vector<Vec3> points(static_cast<std::size_t>(array.shape(0)));
    if (!points.empty())
        std::memcpy(static_cast<void*>(points.data()), array.data(), points.size() * sizeof(Vec3));
    return points;
}

void refuse_unknown(const py::kwargs& unknown, const char* function,
                    std::initializer_list<const char*> known) {
    if (unknown.empty()) return;
    const auto name = py::str(unknown.begin()->first).cast<std::string>();
    std::string text = std::string(function) + "() has no argument '" + name + "'";
    for (const char* meant : known)
        if (scenario::is_misspelt(name, meant))
            throw py::type_error(text + "; did you mean '" + meant + "'?");
    text += ". Known are:";
    for (const char* one : known) text += std::string(" ") + one;
    throw py::type_error(text);
}

Pose given_pose(const py::handle& object) {
    if (!py::isinstance<Pose>(object))
        throw py::type_error("a pose must be an incise.Pose, such as incise.Pose([0, 0, 0.1])");
    return object.cast<Pose>();
}

std::vector<VertexId> nodes_of(Handle& handle, const py::object& rows) {
    const py::array given = py::array::ensure(rows);
    if (!given || given.ndim() != 1 ||
        (given.size() > 0 && given.dtype().kind() != 'i' && given.dtype().kind() != 'u')) {
        PyErr_Clear();
        const bool is_mask = given && given.dtype().kind() == 'b';
        throw py::type_error(
            std::string("nodes must be a list of whole numbers, rows of positions") +
            (is_mask ? ": of a mask, numpy.flatnonzero(mask)" : ""));
    }
    const auto array =
        py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!array) throw py::error_already_set();
    const Handle::Rows& known = handle.rows();
    const auto num_rows = static_cast<std::int64_t>(handle.driver.world().mesh().num_nodes());
    std::vector<VertexId> nodes;
    for (py::ssize_t i = 0; i < array.size(); ++i) {
        const std::int64_t row = array.at(i);
        if (row < 0 || row >= num_rows)
            throw InputError("there is no node " + std::to_string(row) + ": the world has " +
                             std::to_string(num_rows));
        nodes.push_back(known.are_ids ? VertexId(static_cast<std::size_t>(row))
                                      : known.nodes[static_cast<std::size_t>(row)]);
    }
    return nodes;
}

std::filesystem::path path_from(const py::handle& object) {
    const py::object path = py::reinterpret_steal<py::object>(PyOS_FSPath(object.ptr()));
    if (!path) throw py::error_already_set();
    PyObject* bytes = nullptr;
    if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) throw py::error_already_set();
    return std::string(py::reinterpret_steal<py::bytes>(bytes));
}

std::filesystem::path file_from(const py::handle& object, const std::string& name,
                                const std::string& kind) {
    std::filesystem::path path = path_from(object);
    if (path.empty()) throw InputError(name + " is empty: name a " + kind);
    return path;
}

}  // namespace incise::python
