// The history of viscous elements: their stored stresses, by element id, which follow edits.
// Source: HEML 2015, section 3.5, on stress instead of nodal forces: docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/change_set.h"

namespace incise::physics {

/// The stresses that each element stores: that of the law after the last step, then that of each
/// term of the Prony series of its material, Pa. The kernel defines which stress tensors these are
/// (viscous_kernel.h, nodal_viscous_kernel.h). They are zero for an element that was never
/// strained.
///
/// Dead elements keep their values, so that an edit can be undone. All elements of a body have the
/// same number of values, as many as the material with the most terms needs. A body without viscous
/// material stores nothing.
class ViscousHistory {
  public:
    /// Sets all values to zero. `size` is the number of values of an element; 0: nothing is stored.
    ViscousHistory(std::size_t size, std::size_t num_elements) : size_(size) {
        resize(num_elements);
    }

    /// True if nothing is stored, as no material is viscous.
    bool is_empty() const { return size_ == 0; }

    /// Returns the values of an element. There may be more than its material needs; those at the
    /// end are then unused.
    std::span<const double> of(ElementId e) const {
        return std::span(values_).subspan(e.index() * size_, size_);
    }
    std::span<double> of(ElementId e) {
        return std::span(values_).subspan(e.index() * size_, size_);
    }

    /// Returns all values in the order of element ids, for copies and comparison.
    std::span<const double> values() const { return values_; }
    /// Replaces all values.
    /// @pre  there are as many as values() has
    void set_values(std::span<const double> values) {
        assert(values.size() == values_.size());
        values_.assign(values.begin(), values.end());
    }

    /// Follows an edit. Parts of a divided element inherit its values unchanged, since a linear
    /// element has the same stress everywhere. Elements that an undo brings back still have their
    /// values. Cost: proportional to the elements added.
    void apply(const fragments::FragmentMesh& fragments,
               const fragments::FragmentMeshChanges& changes);

  private:
    void resize(std::size_t num_elements) { values_.resize(num_elements * size_, 0.0); }

    std::size_t size_;
    std::vector<double> values_;  // by element id
};

}  // namespace incise::physics
