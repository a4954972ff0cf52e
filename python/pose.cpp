// incise.Pose.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/pose.h"

#include <cmath>
#include <sstream>

#include "incise/base/error.h"
#include "incise/python/handle.h"

namespace incise::python {

namespace {

/// Returns the pose with a rotation of length 1.
Pose pose_from(const py::object& position, const py::object& rotation) {
    Pose pose;
    pose.position = vector_from(position, "the position of a pose");
    if (!rotation.is_none()) {
        const auto numbers =
            py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(rotation);
        if (!numbers) {
            PyErr_Clear();
            throw py::type_error("the rotation of a pose must be numbers");
        }
        if (numbers.ndim() != 1 || numbers.shape(0) != 4)
            throw InputError(
                "the rotation of a pose must be a quaternion of four numbers: x, y, z, w");
        pose.rotation.coeffs() << numbers.at(0), numbers.at(1), numbers.at(2), numbers.at(3);
        const double length = pose.rotation.norm();
        if (!(length > 0.0 && std::isfinite(length)))
            throw InputError("the rotation of a pose must be finite and not zero");
        // A rotation that has length 1 already keeps its bits.
        if (std::abs(length - 1.0) > 1e-15) pose.rotation.coeffs() /= length;
    }
    if (!pose.position.allFinite()) throw InputError("the position of a pose must be finite");
    if (!pose.is_sound()) throw InputError("the rotation of a pose must be finite and not zero");
    return pose;
}

std::string text_of(const Pose& pose) {
    const auto& q = pose.rotation.coeffs();
    std::ostringstream text;
    text.precision(6);
    text << "incise.Pose([" << pose.position.x() << ", " << pose.position.y() << ", "
         << pose.position.z() << "], [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w()
         << "])";
    return text.str();
}

py::tuple state_of(const Pose& pose) {
    const auto& q = pose.rotation.coeffs();
    return py::make_tuple(array_of(pose.position), py::make_tuple(q.x(), q.y(), q.z(), q.w()));
}

}  // namespace

void register_pose(py::module_& module) {
    py::class_<Pose> type(module, "Pose",
                          R"(Where a tool or a gripper is: a position and a rotation.

A point p of the tool's own frame is at rotation * p + position in the world. Poses do not change.

>>> pose = incise.Pose([0.05, 0.0, 0.06])
>>> pose.rotation.tolist()
[0.0, 0.0, 0.0, 1.0])");
    type.attr("__module__") = "incise";
    type.def(py::init(&pose_from), py::arg("position") = py::make_tuple(0.0, 0.0, 0.0),
             py::arg("rotation") = py::none(),
             R"(position: three numbers, m, in the frame of the world.
rotation: a quaternion x, y, z, w of any length above 0. None: no rotation.
Raises InputError for numbers that are not finite.)")
        .def_static(
            "turned",
            [](const py::object& position, const py::object& axis, double angle) {
                const Vec3 direction = vector_from(axis, "the axis of a pose");
                if (!(direction.norm() > 0.0 && direction.allFinite() && std::isfinite(angle)))
                    throw InputError(
                        "the axis of a pose must be finite and not zero, its angle "
                        "finite");
                Pose pose = pose_from(position, py::none());
                pose.rotation = Eigen::AngleAxisd(angle, direction.normalized());
                return pose;
            },
            py::arg("position"), py::arg("axis"), py::arg("angle"),
            R"(Return a pose that is turned about an axis.

position: three numbers, m.  axis: three numbers, a direction of any length above 0.
angle: rad, anticlockwise as seen against the axis.

>>> incise.Pose.turned([0, 0, 0], axis=[0, 0, 1], angle=0.0).rotation.tolist()
[0.0, 0.0, 0.0, 1.0])")
        .def_property_readonly(
            "position", [](const Pose& pose) { return array_of(pose.position); },
            "Where the origin of the tool is, m. Shape (3,), a copy.")
        .def_property_readonly(
            "rotation",
            [](const Pose& pose) {
                py::array_t<double> array(4);
                for (int i = 0; i < 4; ++i) array.mutable_at(i) = pose.rotation.coeffs()[i];
                return array;
            },
            "The rotation as a quaternion x, y, z, w of length 1. Shape (4,), a copy.")
        .def(
            "to_world",
            [](const Pose& pose, const py::object& points) {
                std::vector<Vec3> moved = points_from(points, "points");
                for (Vec3& x : moved) x = pose.to_world(x);
                return matrix_of(moved);
            },
            py::arg("points"),
            R"(Return points of the tool's frame in the frame of the world, m. Shape (N, 3).

>>> incise.Pose([1, 0, 0]).to_world([[0, 0, 2]]).tolist()
[[1.0, 0.0, 2.0]])")
        .def(
            "__eq__",
            [](const Pose& a, const py::object& b) -> py::object {
                if (!py::isinstance<Pose>(b))
                    return py::reinterpret_borrow<py::object>(Py_NotImplemented);
                const Pose& other = b.cast<const Pose&>();
                return py::bool_(a.position == other.position &&
                                 a.rotation.coeffs() == other.rotation.coeffs());
            },
            py::arg("other"), "True if position and rotation are the same numbers.")
        .def("__repr__", &text_of, "Return the pose as text.")
        .def(py::pickle(&state_of,
                        [](const py::tuple& state) {
                            if (state.size() != 2) throw InputError("this is no state of a pose");
                            return pose_from(state[0], state[1]);
                        }))
        // The protocols 0 and 1 would use the __reduce__ of object: see forbid_copies().
        .def(
            "__reduce__",
            [](const py::object& self) {
                return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"),
                                      py::make_tuple(py::type::of(self)),
                                      state_of(self.cast<const Pose&>()));
            },
            "Return how to make the pose anew, for copy and pickle.");
}

}  // namespace incise::python
