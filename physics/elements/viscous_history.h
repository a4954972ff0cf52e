// What viscous elements remember of their past, by element id; it follows the mesh through edits.
// Source: HEML 2015, section 3.5, on stress instead of nodal forces: docs/theory.md, Viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// For each element its stress after the last step, without viscosity, and that of each term of its
/// material's Prony series, pascals, per volume at rest; what tensors these are is the kernel's
/// affair (viscous_kernel.h, nodal_viscous_kernel.h). Zero for elements that were never strained.
/// Slots of dead elements keep their last values, so that an undone edit finds them again. Memory:
/// the longest of its materials' for all elements of a body in which any is viscous; else none.
class ViscousHistory {
  public:
    /// @param size the most numbers that an element remembers; 0: nothing is kept
    ViscousHistory(std::size_t size, std::size_t num_elements) : size_(size) {
        resize(num_elements);
    }

    /// Whether there is nothing to remember: no material is viscous.
    bool is_empty() const { return size_ == 0; }

    /// More numbers than the element's material needs, if another needs more.
    std::span<const double> of(ElementId e) const {
        return std::span(values_).subspan(e.index() * size_, size_);
    }
    std::span<double> of(ElementId e) {
        return std::span(values_).subspan(e.index() * size_, size_);
    }

    /// All of it in the order of ids, for copies and comparison.
    std::span<const double> values() const { return values_; }
    /// @pre values.size() is that of values()
    void set_values(std::span<const double> values) {
        assert(values.size() == values_.size());
        values_.assign(values.begin(), values.end());
    }

    /// Parts of a divided element inherit what it remembers as it is: stresses are densities, which
    /// the parts share with the whole. Elements that come back find what
    /// they had. Cost: proportional to the elements added.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

  private:
    void resize(std::size_t num_elements) { values_.resize(num_elements * size_, 0.0); }

    std::size_t size_;
    std::vector<double> values_;  // by element id
};

}  // namespace incise::physics
