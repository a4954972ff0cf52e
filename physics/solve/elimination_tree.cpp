// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/elimination_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace incise::physics {

namespace {

constexpr std::size_t few_vertices = 24;  // are eliminated together, without a search for zeros

class Dissection {
  public:
    Dissection(const Graph& graph, std::span<const Vec3> points)
        : graph_(graph), points_(points), halves_(graph.num_vertices(), neither) {
        tree_.order.resize(graph.num_vertices());
        std::iota(tree_.order.begin(), tree_.order.end(), 0u);
        divide(0, tree_.order.size());
    }
    EliminationTree result() && { return std::move(tree_); }

  private:
    static constexpr char neither = 0, lower = 1, upper = 2;

    /// Groups the vertices at some places of the order, and returns their last group.
    std::size_t divide(std::size_t begin, std::size_t end) {
        const auto at = [&](std::size_t place) {
            return tree_.order.begin() + static_cast<std::ptrdiff_t>(place);
        };
        std::size_t num_upper = 0, num_lower = 0;
        if (end - begin > few_vertices) {
            const Separator best = separate(begin, end);
            // Separators go to the end, and the lower half to the beginning.
            mark(begin, end, best.axis);
            const auto separates = [&](std::uint32_t v) {
                return halves_[v] == best.half && joins_halves(v);
            };
            separator_.clear();
            for (auto v = at(begin); v != at(end); ++v)
                if (separates(*v)) separator_.push_back(*v);
            for (const std::uint32_t v : separator_) halves_[v] = neither;
            const auto rest = std::stable_partition(
                at(begin), at(end), [&](std::uint32_t v) { return halves_[v] != neither; });
            const auto second = std::stable_partition(
                at(begin), rest, [&](std::uint32_t v) { return halves_[v] == lower; });
            num_lower = static_cast<std::size_t>(second - at(begin));
            num_upper = static_cast<std::size_t>(rest - second);
            std::for_each(at(begin), at(end), [&](std::uint32_t v) { halves_[v] = neither; });
        }
        if (num_lower == 0 || num_upper == 0) {
            tree_.groups.push_back({begin, end, EliminationTree::no_parent});
            return tree_.groups.size() - 1;
        }
        const std::size_t middle = begin + num_lower, behind = middle + num_upper;
        const std::size_t first = divide(begin, middle), second = divide(middle, behind);
        tree_.groups.push_back({behind, end, EliminationTree::no_parent});
        const std::size_t last = tree_.groups.size() - 1;
        tree_.groups[first].parent = tree_.groups[second].parent = last;
        return last;
    }

    struct Separator {
        std::size_t size;
        int axis;
        char half;  ///< the one that it belongs to
    };

    /// Returns the smallest of the separators across the three axes, on either side of the plane.
    Separator separate(std::size_t begin, std::size_t end) {
        Separator best{std::numeric_limits<std::size_t>::max(), 0, upper};
        for (int axis = 0; axis < 3; ++axis) {
            mark(begin, end, axis);
            std::size_t num_lower = 0, num_upper = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t v = tree_.order[i];
                if (joins_halves(v)) ++(halves_[v] == lower ? num_lower : num_upper);
            }
            if (num_lower < best.size) best = {num_lower, axis, lower};
            if (num_upper < best.size) best = {num_upper, axis, upper};
        }
        for (std::size_t i = begin; i < end; ++i) halves_[tree_.order[i]] = neither;
        return best;
    }

    /// Marks the half of each vertex. All vertices at the height of the one in the middle are in
    /// the same half, if that leaves a quarter for the other one: planes of a grid stay whole.
    void mark(std::size_t begin, std::size_t end, int axis) {
        const auto vertices = std::span(tree_.order).subspan(begin, end - begin);
        const std::size_t middle = vertices.size() / 2;
        heights_.clear();
        for (const std::uint32_t v : vertices) heights_.emplace_back(points_[v][axis], v);
        const auto in_middle = heights_.begin() + static_cast<std::ptrdiff_t>(middle);
        std::nth_element(heights_.begin(), in_middle, heights_.end());
        const Height limit = *in_middle;
        const auto count = static_cast<std::size_t>(std::count_if(
            heights_.begin(), in_middle, [&](const Height& h) { return h.first < limit.first; }));
        const bool stays_whole = count >= vertices.size() / 4;
        for (const Height& h : heights_) {
            const bool is_lower = stays_whole ? h.first < limit.first : h < limit;
            halves_[h.second] = is_lower ? lower : upper;
        }
    }

    bool joins_halves(std::uint32_t v) const {
        const char other = halves_[v] == lower ? upper : lower;
        const auto neighbours = graph_.neighbours_of(v);
        return std::any_of(neighbours.begin(), neighbours.end(),
                           [&](std::uint32_t n) { return halves_[n] == other; });
    }

    using Height = std::pair<double, std::uint32_t>;
    const Graph& graph_;
    std::span<const Vec3> points_;
    EliminationTree tree_;
    std::vector<char> halves_;  // by vertex; `neither` for those that are not being divided
    std::vector<Height> heights_;
    std::vector<std::uint32_t> separator_;
};

}  // namespace

EliminationTree dissect(const Graph& graph, std::span<const Vec3> points) {
    return Dissection(graph, points).result();
}

}  // namespace incise::physics
