// Cells as arrays of numpy: one array, or for several kinds of cells a dict of arrays.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "incise/topology/cell_kind.h"

namespace incise::python {

namespace py = pybind11;

/// Rows of numbers by kind of cell.
template <class Number>
class CellRows {
  public:
    /// @param for_corners  a row has a number for each corner of the cell
    /// @param shape        otherwise the shape of a row; empty for one number
    explicit CellRows(bool for_corners, std::vector<py::ssize_t> shape = {})
        : for_corners_(for_corners), shape_(std::move(shape)) {}

    std::vector<Number>& of(topology::CellKind kind) {
        return values_[static_cast<std::size_t>(kind)];
    }

    /// Returns the array of the only kind, or a dict by the name of the kind. Polyhedra are always
    /// in a dict, as their list is no array of corners. The arrays are read-only if `are_frozen`.
    py::object object(bool are_frozen) const {
        py::dict by_kind;
        py::object last;
        for (std::size_t k = 0; k < values_.size(); ++k) {
            if (values_[k].empty()) continue;
            const topology::CellTraits& traits = topology::cell_traits[k];
            const bool is_list = for_corners_ && traits.num_corners == 0;  // of polyhedra
            py::array_t<Number> array(is_list ? std::vector{std::ssize(values_[k])}
                                              : shape_of(values_[k].size(), traits.num_corners));
            std::copy(values_[k].begin(), values_[k].end(), array.mutable_data());
            if (are_frozen) array.attr("setflags")(py::arg("write") = false);
            by_kind[traits.name] = array;
            last = array;
        }
        if (by_kind.size() == 1 && values_.back().empty()) return last;
        if (!by_kind.empty()) return by_kind;
        return py::array_t<Number>(shape_of(0, 4));
    }

  private:
    std::vector<py::ssize_t> shape_of(std::size_t num_values, int num_corners) const {
        std::vector<py::ssize_t> shape{0};
        if (for_corners_) shape.push_back(num_corners);
        shape.insert(shape.end(), shape_.begin(), shape_.end());
        py::ssize_t width = 1;
        for (std::size_t i = 1; i < shape.size(); ++i) width *= shape[i];
        shape[0] = static_cast<py::ssize_t>(num_values) / width;
        return shape;
    }

    bool for_corners_;
    std::vector<py::ssize_t> shape_;
    std::array<std::vector<Number>, topology::num_cell_kinds + 1> values_;
};

using CellArrays = CellRows<std::int64_t>;

}  // namespace incise::python
