// Cells as arrays of numpy: one array, or for several kinds of cells a dict of arrays.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <vector>

#include "incise/topology/cell_kind.h"

namespace incise::python {

namespace py = pybind11;

/// Rows of whole numbers by kind of cell.
class CellArrays {
  public:
    /// @param for_corners  rows have a number for each corner; if false, one number
    explicit CellArrays(bool for_corners) : for_corners_(for_corners) {}

    std::vector<std::int64_t>& of(topology::CellKind kind) {
        return values_[static_cast<std::size_t>(kind)];
    }

    /// Returns the array of the only kind, or a dict by the name of the kind. The arrays are
    /// read-only if `are_frozen`.
    py::object object(bool are_frozen) const {
        py::dict by_kind;
        py::object last;
        for (std::size_t k = 0; k < values_.size(); ++k) {
            if (values_[k].empty()) continue;
            const topology::CellTraits& traits = topology::cell_traits[k];
            const auto width = for_corners_ ? py::ssize_t{traits.num_corners} : py::ssize_t{1};
            const auto rows = static_cast<py::ssize_t>(values_[k].size()) / width;
            py::array_t<std::int64_t> array(for_corners_ ? std::vector<py::ssize_t>{rows, width}
                                                         : std::vector<py::ssize_t>{rows});
            std::copy(values_[k].begin(), values_[k].end(), array.mutable_data());
            if (are_frozen) array.attr("setflags")(py::arg("write") = false);
            by_kind[traits.name] = array;
            last = array;
        }
        if (by_kind.size() == 1) return last;
        if (by_kind.size() > 1) return by_kind;
        return py::array_t<std::int64_t>(for_corners_ ? std::vector<py::ssize_t>{0, 4}
                                                      : std::vector<py::ssize_t>{0});
    }

  private:
    bool for_corners_;
    std::array<std::vector<std::int64_t>, topology::num_cell_kinds> values_;
};

}  // namespace incise::python
