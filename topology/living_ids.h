// Loops over the living nodes or elements of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <iterator>

namespace incise::topology {

/// The ids of the living nodes or elements of a mesh, in ascending order, as a range.
/// Source: Mesh::nodes, Mesh::elements.
template <class Id, class Mesh>
class LivingIds {
  public:
    class Iterator {
      public:
        using value_type = Id;
        using difference_type = std::ptrdiff_t;
        using iterator_category = std::forward_iterator_tag;

        Iterator() = default;
        Iterator(const Mesh& mesh, std::size_t index, std::size_t end)
            : mesh_(&mesh), index_(index), end_(end) {
            skip_dead();
        }
        Id operator*() const { return Id(index_); }
        Iterator& operator++() {
            ++index_;
            skip_dead();
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        bool operator==(const Iterator& other) const { return index_ == other.index_; }

      private:
        void skip_dead() {
            while (index_ < end_ && !mesh_->is_alive(Id(index_))) ++index_;
        }

        const Mesh* mesh_ = nullptr;
        std::size_t index_ = 0, end_ = 0;
    };

    /// @param mesh      must outlive the range
    /// @param capacity  one more than the highest id
    LivingIds(const Mesh& mesh, std::size_t capacity) : mesh_(&mesh), capacity_(capacity) {}

    Iterator begin() const { return {*mesh_, 0, capacity_}; }
    Iterator end() const { return {*mesh_, capacity_, capacity_}; }

  private:
    const Mesh* mesh_;
    std::size_t capacity_;
};

}  // namespace incise::topology
