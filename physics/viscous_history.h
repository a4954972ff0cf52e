// What viscous elements remember of their past, by element id; it follows the mesh through edits.
// Source: HEML 2015, section 3.5, on stress instead of nodal forces: docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "topology/change_set.h"
#include "topology/types.h"

namespace incise::physics {

using topology::ElementId;

/// A symmetric tensor by its components 11, 22, 33, 12, 23, 31.
using SymmetricTensor = Eigen::Matrix<double, 6, 1>;

/// For each element the second Piola-Kirchhoff stress S after the last step, without viscosity, and
/// the stress H_i of each term of its material's Prony series, pascals in the frame of rest; zero
/// for elements that were never strained. Slots of dead elements keep their last values, so that an
/// undone edit finds them again. Memory: 48 bytes for each element and each of S and the H_i of the
/// longest series, for all elements of a body in which any material is viscous; else none.
class ViscousHistory {
  public:
    /// @param num_terms of the longest series of the body; 0: nothing is kept
    ViscousHistory(std::size_t num_terms, std::size_t num_elements)
        : stride_(num_terms == 0 ? 0 : num_terms + 1) {
        resize(num_elements);
    }

    /// Whether there is nothing to remember: no material is viscous.
    bool is_empty() const { return stride_ == 0; }

    /// S, then the H_i; more of them than the element's material has terms, if another has more.
    std::span<const SymmetricTensor> of(ElementId e) const {
        return std::span(values_).subspan(e.index() * stride_, stride_);
    }
    std::span<SymmetricTensor> of(ElementId e) {
        return std::span(values_).subspan(e.index() * stride_, stride_);
    }

    /// All of it in the order of ids, for copies and comparison.
    std::span<const SymmetricTensor> values() const { return values_; }
    /// @pre values.size() is that of values()
    void set_values(std::span<const SymmetricTensor> values) {
        assert(values.size() == values_.size());
        values_.assign(values.begin(), values.end());
    }

    /// Parts of a divided element inherit what it remembers as it is: S and H_i are densities in
    /// the frame of rest, which the parts share with the whole. Elements that come back find what
    /// they had. Cost: proportional to the elements added.
    void apply(const topology::ChangeSet& changes);

  private:
    void resize(std::size_t num_elements) {
        values_.resize(num_elements * stride_, SymmetricTensor::Zero());
    }

    std::size_t stride_;
    std::vector<SymmetricTensor> values_;  // by element id
};

}  // namespace incise::physics
