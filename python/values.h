// Conversion of dicts to the documents that scenarios are read from.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "incise/scenario/document.h"

namespace incise::python {

/// Returns a value of Python as a value of a scenario: bool, int, float, str, os.PathLike, lists,
/// tuples, dicts, and scalars and arrays of numpy. Entries of dicts that are None are left out.
/// Throws TypeError that names the key for other values, and InputError for numbers and depths that
/// no scenario has.
scenario::Value value_from(const pybind11::handle& object, const std::string& name);

/// Returns a value of a scenario as a new object of Python.
pybind11::object object_from(const scenario::Value& value);

}  // namespace incise::python
