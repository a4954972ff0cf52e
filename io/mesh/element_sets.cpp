// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/element_sets.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

/// The positions that are not taken yet, linked so that long runs of taken positions are skipped at
/// once (disjoint sets with path halving).
class FreePositions {
  public:
    explicit FreePositions(std::size_t count) : next_(count + 1) {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
    }
    /// Returns the first free position at or after `position`, or the end.
    std::size_t first_from(std::size_t position) {
        while (next_[position] != position) {
            next_[position] = next_[next_[position]];
            position = next_[position];
        }
        return position;
    }
    void take(std::size_t position) { next_[position] = position + 1; }

  private:
    std::vector<std::size_t> next_;  ///< by position: itself if free, else a later position
};

std::optional<int> number_in(std::string_view name) {
    constexpr std::string_view prefix = "REGION_";
    return name.starts_with(prefix) ? parse_number<int>(name.substr(prefix.size())) : std::nullopt;
}

}  // namespace

std::size_t ElementSets::find_or_add(const std::string& name) {
    const auto [row, is_new] = index_of_.try_emplace(name, sets_.size());
    if (is_new) sets_.push_back({.name = name, .ranges = {}, .subsets = {}});
    return row->second;
}

std::size_t ElementSets::define(const std::string& name, Role role) {
    const auto index = find_or_add(name);
    auto& set = sets_[index];
    set.role = std::min(set.role, role);
    set.is_defined = true;
    return index;
}

std::size_t ElementSets::refer(const std::string& name, std::size_t place, Role role) {
    const auto index = find_or_add(name);
    auto& set = sets_[index];
    set.role = std::min(set.role, role);
    if (set.place == 0) set.place = place;
    return index;
}

void ElementSets::add(std::size_t set, Range range) {
    auto& ranges = sets_[set].ranges;
    const bool goes_on = !ranges.empty() && range.step == 1 && ranges.back().step == 1 &&
                         ranges.back().last < range.first && ranges.back().last + 1 == range.first;
    if (goes_on)
        ranges.back().last = range.last;
    else
        ranges.push_back(range);
}

std::optional<ElementSets::Unknown> ElementSets::first_unknown() const {
    const Set* first = nullptr;
    for (const auto& set : sets_)
        if (!set.is_defined && (first == nullptr || set.place < first->place)) first = &set;
    if (first == nullptr) return std::nullopt;
    return Unknown{first->name, first->place};
}

ElementSets::Owners ElementSets::find_owners(std::span<const std::int64_t> elements) const {
    Owners owners{std::vector<std::size_t>(elements.size(), nobody)};
    auto role = Role::internal;
    for (const auto& set : sets_) role = std::min(role, set.role);
    if (role == Role::internal) return owners;

    FreePositions free(elements.size());
    const auto is_taken_by_another = [&](std::size_t position, std::size_t owner) {
        return owners.of_element[position] != nobody && owners.of_element[position] != owner;
    };
    const auto take = [&](const Range& range, std::size_t owner) {
        const auto position_of = [&](auto bound) {
            return static_cast<std::size_t>(bound - elements.begin());
        };
        const auto begin = position_of(std::ranges::lower_bound(elements, range.first));
        const auto end = position_of(std::ranges::upper_bound(elements, range.last));
        const auto is_in = [&](std::size_t p) {
            return (elements[p] - range.first) % range.step == 0;
        };
        for (auto p = begin; p < end; ++p) {
            // Of a run of elements that are taken, only the first is examined.
            if (is_in(p) && is_taken_by_another(p, owner)) owners.are_shared = true;
            p = free.first_from(p);
            if (p >= end || !is_in(p)) continue;
            owners.of_element[p] = owner;
            free.take(p);
        }
    };

    std::vector<std::size_t> owner_of_set(sets_.size(), nobody);
    std::vector<std::size_t> stack;
    for (std::size_t owner = 0; owner < sets_.size(); ++owner) {
        if (sets_[owner].role != role) continue;
        stack.assign(1, owner);
        while (!stack.empty()) {
            const auto set = stack.back();
            stack.pop_back();
            // If the set has an owner, its elements have that owner too.
            if (owner_of_set[set] != nobody && owner_of_set[set] != owner) owners.are_shared = true;
            if (owner_of_set[set] != nobody) continue;
            owner_of_set[set] = owner;
            for (const auto& range : sets_[set].ranges) take(range, owner);
            stack.insert(stack.end(), sets_[set].subsets.begin(), sets_[set].subsets.end());
        }
    }
    return owners;
}

std::vector<int> ElementSets::number_sets(const Owners& owners,
                                          std::vector<std::string>& warnings) const {
    std::vector<bool> has_elements(sets_.size(), false);
    bool has_others = false;
    for (const auto owner : owners.of_element)
        owner == nobody ? has_others = true : has_elements[owner] = true;

    std::vector<int> number_of(sets_.size(), 0);
    std::set<int> numbers = {0};
    for (std::size_t s = 0; s < sets_.size(); ++s)
        if (has_elements[s])
            if (const auto number = number_in(sets_[s].name))
                numbers.insert(number_of[s] = *number);

    constexpr int most_listed = 20;
    int next = 0, num_numbered = 0;
    std::string list;
    for (std::size_t s = 0; s < sets_.size(); ++s) {
        if (!has_elements[s] || number_in(sets_[s].name)) continue;
        while (numbers.contains(next)) ++next;
        number_of[s] = next++;
        if (++num_numbered > most_listed) continue;
        list += (list.empty() ? "" : ", ") + std::to_string(number_of[s]) + " is " +
                in_quotes(sets_[s].name);
    }
    if (num_numbered > most_listed)
        list += " and so on to " + std::to_string(next - 1) + ", in the order of the file";
    if (!list.empty())
        warnings.push_back("element sets are taken as regions: region " + list +
                           (has_others ? "; region 0 is in none of them" : ""));
    if (owners.are_shared)
        warnings.emplace_back(
            "some elements are in several sets that are regions; each belongs to the first");
    return number_of;
}

std::vector<std::size_t> ElementSets::find_circle() const {
    enum class State : std::uint8_t { not_seen, on_path, done };
    struct Step {
        std::size_t set, num_followed;  // of its subsets
    };
    std::vector<State> states(sets_.size(), State::not_seen);
    std::vector<Step> path;
    const auto enter = [&](std::size_t set) {
        states[set] = State::on_path;
        path.push_back({set, 0});
    };
    for (std::size_t first = 0; first < sets_.size(); ++first) {
        if (states[first] == State::not_seen) enter(first);
        while (!path.empty()) {
            auto& [set, num_followed] = path.back();
            if (num_followed == sets_[set].subsets.size()) {
                states[set] = State::done;
                path.pop_back();
                continue;
            }
            const auto subset = sets_[set].subsets[num_followed++];
            if (states[subset] == State::on_path) {
                std::vector<std::size_t> circle;
                for (auto step = std::ranges::find(path, subset, &Step::set); step != path.end();
                     ++step)
                    circle.push_back(step->set);
                return circle;
            }
            if (states[subset] == State::not_seen) enter(subset);
        }
    }
    return {};
}

ElementSets::Regions ElementSets::regions(std::span<const std::int64_t> elements) const {
    const auto owners = find_owners(elements);
    Regions result{std::vector<int>(elements.size(), 0), {}};
    if (const auto circle = find_circle(); circle.size() == 1) {
        result.warnings.push_back("element set " + in_quotes(sets_[circle[0]].name) +
                                  " holds itself");
    } else if (!circle.empty()) {
        constexpr std::size_t most_listed = 5;
        std::string list;
        for (std::size_t i = 0; i < std::min(circle.size(), most_listed); ++i)
            list += (list.empty() ? "" : ", ") + in_quotes(sets_[circle[i]].name);
        result.warnings.push_back("element sets hold themselves, each the next one: " + list +
                                  (circle.size() > most_listed ? ", ..." : "") +
                                  "; all of them hold the same elements");
    }
    const auto number_of = number_sets(owners, result.warnings);
    for (std::size_t e = 0; e < elements.size(); ++e)
        if (owners.of_element[e] != nobody) result.of_element[e] = number_of[owners.of_element[e]];
    return result;
}

}  // namespace incise::io
