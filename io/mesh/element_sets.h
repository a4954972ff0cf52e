// Named sets of elements, as Abaqus and CalculiX have them, and the regions that they make.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise::io {

class ElementSets {
  public:
    /// What tells regions apart, best first: sets that have a material; sets given with the
    /// elements; all other sets, save those that programs make for themselves.
    enum class Role : std::uint8_t { of_section, of_elements, of_list, internal };

    /// Elements numbered first, first + step, ... up to `last`.
    struct Range {
        std::int64_t first, last, step;
    };

    /// The index of the set of this name, to which elements are added next. Of the roles that a
    /// set is given, the best one counts.
    std::size_t define(const std::string& name, Role role);
    /// The index of a set that byte `place` of the file refers to; it is defined somewhere.
    std::size_t refer(const std::string& name, std::size_t place, Role role = Role::internal);

    /// @pre 1 <= step, first <= last
    void add(std::size_t set, Range range);
    void add_subset(std::size_t set, std::size_t subset) { sets_[set].subsets.push_back(subset); }

    struct Unknown {
        std::string name;
        std::size_t place;
    };
    /// The first set that is referred to, but nowhere defined.
    std::optional<Unknown> first_unknown() const;

    struct Regions {
        std::vector<int> of_element;
        std::vector<std::string> warnings;
    };
    /// The regions of the elements with these numbers, which ascend. Of the sets of the best role
    /// that there is, an element belongs to the first that holds it. Sets named REGION_<n> are
    /// region n, others are numbered from 1 in the order of the file, which a warning tells;
    /// elements in no set have region 0. Sets that hold themselves through others are warned of.
    Regions regions(std::span<const std::int64_t> elements) const;

  private:
    struct Set {
        std::string name;
        Role role = Role::internal;
        bool is_defined = false;
        std::size_t place = 0;  ///< of the first reference
        std::vector<Range> ranges;
        std::vector<std::size_t> subsets;
    };

    static constexpr std::size_t nobody = static_cast<std::size_t>(-1);

    struct Owners {
        std::vector<std::size_t> of_element;  ///< indices of sets, or nobody
        bool are_shared = false;              ///< an element is in several sets
    };
    Owners find_owners(std::span<const std::int64_t> elements) const;
    std::vector<int> number_sets(const Owners& owners, std::vector<std::string>& warnings) const;
    std::size_t find_or_add(const std::string& name);
    /// Sets of which each holds the next, and the last one the first; none if there are no such.
    std::vector<std::size_t> find_circle() const;

    std::vector<Set> sets_;
    std::map<std::string, std::size_t> index_of_;
};

}  // namespace incise::io
