// The named element sets of Abaqus and CalculiX, and the regions that they define.
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

/// A collection of named element sets, each of which holds elements and other sets.
class ElementSets {
  public:
    /// How a set is used in the file, in the order of preference for regions: sets that have a
    /// material, sets given with the elements, other sets. Internal sets, which programs make for
    /// their own use, are no regions.
    enum class Role : std::uint8_t { of_section, of_elements, of_list, internal };

    /// The elements with the numbers first, first + step, ... up to `last`.
    struct Range {
        std::int64_t first, last, step;
    };

    /// Defines a set, if it is not defined yet, and returns its index. If a set has several roles,
    /// the most preferred one counts.
    std::size_t define(const std::string& name, Role role);
    /// Returns the index of a set to which byte `place` of the file refers. The set may be defined
    /// before or after.
    std::size_t refer(const std::string& name, std::size_t place, Role role = Role::internal);

    /// Adds elements to a set.
    /// @pre  1 <= step, first <= last
    void add(std::size_t set, Range range);
    void add_subset(std::size_t set, std::size_t subset) { sets_[set].subsets.push_back(subset); }

    struct Unknown {
        std::string name;
        std::size_t place;
    };
    /// Returns the first reference to a set that is not defined, if there is one.
    std::optional<Unknown> first_unknown() const;

    struct Regions {
        std::vector<int> of_element;
        std::vector<std::string> warnings;
    };
    /// Returns the regions of the elements with these numbers. Regions are the sets of the most
    /// preferred role that occurs. An element belongs to the first of these sets that holds it, or
    /// to region 0 if none does. A set REGION_<n> is region n. Other sets are numbered from 1 in
    /// the order of the file, with a warning. Sets that hold themselves, also through other sets,
    /// cause a warning.
    /// @pre  the numbers are in ascending order
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
        bool are_shared = false;              ///< true if an element is in several sets
    };
    Owners find_owners(std::span<const std::int64_t> elements) const;
    std::vector<int> number_sets(const Owners& owners, std::vector<std::string>& warnings) const;
    std::size_t find_or_add(const std::string& name);
    /// Returns sets of which each holds the next and the last holds the first. Returns an empty
    /// list if there are none.
    std::vector<std::size_t> find_circle() const;

    std::vector<Set> sets_;
    std::map<std::string, std::size_t> index_of_;
};

}  // namespace incise::io
