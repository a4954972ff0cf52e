// The state of a world as arrays of numpy: copies, and views of its memory.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "incise/python/handle.h"

namespace incise::python {

/// Returns values at the living nodes, in the rows of Python. Shape (N, 3).
py::array_t<double> at_nodes(const World& world, std::span<const Vec3> values);
/// Returns the mass at each node, kg. Shape (N,).
py::array_t<double> masses(const World& world);
/// Returns the force of contact on each node in the last step, N. Shape (N, 3).
py::array_t<double> contact_forces(const World& world);
/// Returns the labels of the nodes. Shape (N,).
py::array_t<std::int64_t> node_ids(const World& world);

/// Return objects that are made anew after edits only: arrays, or dicts of them by kind of element;
/// the connected component of each node, shape (N,); an incise.Elements; an incise.Surface.
py::object cells(const World& world);
py::object regions(const World& world);
py::object components(const World& world);
py::object elements(const World& world);
py::object surface(const World& world);

/// Returns the Cauchy stress of each element, Pa, shape (M, 3, 3), and its volume over that at
/// rest, shape (M,); dicts of them by kind in a mixed mesh.
py::object stress(const World& world);
py::object volume_ratio(const World& world);
/// Returns an incise.Physics.
py::object physics(const World& world);
/// Returns an incise.View.
py::object view(const World& world);

void register_elements(py::module_& module);
void register_physics(py::module_& module);
void register_surface(py::module_& module);
void register_view(py::module_& module);

}  // namespace incise::python
