// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/sparse_factor.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "incise/physics/solve/elimination_tree.h"

namespace incise::physics {

namespace {

/// Eliminates the first columns of a front, with several threads if there are workers.
/// @param packed_values  scratch of FrontKernels::eliminate()
bool eliminate_columns(const DenseFront& front, std::size_t num_columns, const Workers* workers,
                       const FrontKernels& kernels, double* packed_values, PivotRange& pivots) {
    for (std::size_t first = 0; first < num_columns; first += columns_together) {
        const std::size_t last = std::min(first + columns_together, num_columns);
        if (!kernels.eliminate(front, first, last, packed_values, pivots)) return false;
        if (last == front.size) break;
        const PackedColumns packed{packed_values, last, last - first};
        kernels.pack(front, first, packed);
        const std::size_t num_strips =
            (front.size - last + kernels.rows_of_strip - 1) / kernels.rows_of_strip;
        const auto subtract = [&](std::size_t strip) { kernels.subtract(front, packed, strip); };
        if (workers)
            workers->for_each(num_strips, subtract);
        else
            for (std::size_t strip = 0; strip < num_strips; ++strip) subtract(strip);
    }
    return true;
}

}  // namespace

void SparseFactor::analyse(const Matrix& lower, std::vector<Group> groups) {
    fronts_.clear();
    later_rows_.clear();
    children_.assign(groups.size(), {});
    std::vector<std::size_t> seen_by(static_cast<std::size_t>(lower.rows()), groups.size());
    std::vector<std::int32_t> rows;
    std::size_t num_values = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto& [begin, end, parent] = groups[g];
        rows.clear();
        const auto take = [&, end = end](std::int32_t row) {
            if (row < end || std::exchange(seen_by[static_cast<std::size_t>(row)], g) == g) return;
            rows.push_back(row);
        };
        for (std::int32_t column = begin; column < end; ++column)
            for (Matrix::InnerIterator it(lower, column); it; ++it) take(it.index());
        for (const std::size_t child : children_[g])
            for (const std::int32_t row : later_rows(fronts_[child])) take(row);
        std::sort(rows.begin(), rows.end());
        fronts_.push_back({begin, end, parent, later_rows_.size(), rows.size(), num_values});
        later_rows_.insert(later_rows_.end(), rows.begin(), rows.end());
        num_values += fronts_.back().num_own() * fronts_.back().size();
        if (parent != EliminationTree::no_parent) children_[parent].push_back(g);
    }
    num_values_ = num_values;
    if (values_.capacity() < num_values) values_ = NumberBuffer(num_values);
    updates_.clear();
    updates_.resize(groups.size());
    find_subtrees();
}

// Subtrees of about a sixteenth of the work. Their number must not depend on the threads.
void SparseFactor::find_subtrees() {
    std::vector<double> work(fronts_.size(), 0.0);  // of the subtree of each front
    double total = 0.0;
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        const auto n = static_cast<double>(fronts_[f].size()),
                   k = static_cast<double>(fronts_[f].num_own());
        const double own = k * n * n;
        total += own;
        work[f] += own;
        if (fronts_[f].parent != EliminationTree::no_parent) work[fronts_[f].parent] += work[f];
    }
    subtrees_.clear();
    rest_.clear();
    constexpr double share = 1.0 / 16.0;
    std::vector<std::size_t> first(fronts_.size());  // of the subtree of each front
    for (std::size_t f = 0; f < fronts_.size(); ++f)
        first[f] = children_[f].empty() ? f : first[children_[f].front()];
    for (std::size_t f = 0; f < fronts_.size(); ++f) {
        const std::size_t parent = fronts_[f].parent;
        const bool is_small = work[f] <= share * total;
        const bool is_in_small =
            parent != EliminationTree::no_parent && work[parent] <= share * total;
        if (!is_small)
            rest_.push_back(f);
        else if (!is_in_small)
            subtrees_.emplace_back(first[f], f + 1);
    }
}

void SparseFactor::assemble(const Matrix& lower, std::size_t f, const DenseFront& front) {
    const Front& info = fronts_[f];
    const std::size_t num_own = info.num_own();
    const auto later = later_rows(info);
    for (std::size_t j = 0; j < front.size; ++j)
        std::fill(front.column(j) + j, front.column(j) + front.stride(), 0.0);
    // Rows of a column ascend, as those of the front do.
    for (std::size_t j = 0; j < num_own; ++j) {
        double* const column = front.column(j);
        std::size_t place = 0;
        for (Matrix::InnerIterator it(lower, info.begin + static_cast<std::int32_t>(j)); it; ++it) {
            if (it.index() < info.end) {
                column[it.index() - info.begin] = it.value();
            } else {
                while (later[place] != it.index()) ++place;
                column[num_own + place] = it.value();
            }
        }
    }
    thread_local std::vector<std::size_t> places;  // so that memory is taken once
    for (const std::size_t child : children_[f]) {
        const auto rows = later_rows(fronts_[child]);
        places.clear();
        std::size_t place = 0;
        for (const std::int32_t row : rows) {
            if (row < info.end) {
                places.push_back(static_cast<std::size_t>(row - info.begin));
            } else {
                while (later[place] != row) ++place;
                places.push_back(num_own + place);
            }
        }
        const double* from = updates_[child].data();
        for (std::size_t j = 0; j < rows.size(); ++j) {
            double* const column = front.column(places[j]);
            for (std::size_t i = j; i < rows.size(); ++i) column[places[i]] += *from++;
        }
        buffers_.give(std::move(updates_[child]));
    }
}

bool SparseFactor::eliminate(const Matrix& lower, std::size_t f, const Workers* workers,
                             const FrontKernels& kernels, PivotRange& pivots) {
    const Front& info = fronts_[f];
    const std::size_t num_own = info.num_own(), size = info.size();
    if (size == 0) return true;  // it passes nothing on
    NumberBuffer values = buffers_.take(DenseFront::num_values(size)),
                 packed = buffers_.take(PackedColumns::num_values(size, columns_together));
    const DenseFront front{values.data(), size};
    assemble(lower, f, front);
    const bool is_positive =
        eliminate_columns(front, num_own, workers, kernels, packed.data(), pivots);
    if (is_positive) {
        double* to = values_.data() + info.values;
        for (std::size_t j = 0; j < num_own; ++j, to += size)
            std::copy_n(front.column(j), size, to);
        if (info.num_later > 0) {
            updates_[f] = buffers_.take(info.num_later * (info.num_later + 1) / 2);
            to = updates_[f].data();
            for (std::size_t j = num_own; j < size; ++j)
                to = std::copy_n(front.column(j) + j, size - j, to);
        }
    }
    buffers_.give(std::move(values));
    buffers_.give(std::move(packed));
    return is_positive;
}

bool SparseFactor::factorise(const Matrix& lower, const Workers& workers, Processor processor) {
    const FrontKernels& kernels = front_kernels_for(processor);
    // Left by a factorisation that was given up.
    for (NumberBuffer& update : updates_) buffers_.give(std::move(update));
    pivots_.assign(subtrees_.size() + 1, {});
    std::atomic<bool> is_positive = true;
    workers.for_each(subtrees_.size(), [&](std::size_t s) {
        for (std::size_t f = subtrees_[s].first; f < subtrees_[s].second; ++f)
            if (!is_positive || !eliminate(lower, f, nullptr, kernels, pivots_[s])) {
                is_positive = false;
                return;
            }
    });
    for (const std::size_t f : rest_)
        if (!is_positive || !eliminate(lower, f, &workers, kernels, pivots_.back())) return false;
    PivotRange all;
    for (const PivotRange& range : pivots_) {
        all.smallest = std::min(all.smallest, range.smallest);
        all.largest = std::max(all.largest, range.largest);
    }
    // A smaller pivot may be the result of rounding only.
    constexpr double smallest = 1e-14;
    return is_positive && all.smallest > smallest * all.largest;
}

void SparseFactor::solve(Eigen::VectorXd& side) const {
    thread_local std::vector<double> part;
    const auto gather = [&](const Front& front) {
        part.assign(side.data() + front.begin, side.data() + front.end);
        for (const std::int32_t row : later_rows(front)) part.push_back(side[row]);
    };
    for (const Front& front : fronts_) {  // L y = b
        gather(front);
        const double* column = values_.data() + front.values;
        for (std::size_t j = 0; j < front.num_own(); ++j, column += front.size()) {
            part[j] /= column[j];
            for (std::size_t i = j + 1; i < front.size(); ++i) part[i] -= column[i] * part[j];
        }
        std::copy_n(part.begin(), front.num_own(), side.data() + front.begin);
        const double* from = part.data() + front.num_own();
        for (const std::int32_t row : later_rows(front)) side[row] = *from++;
    }
    for (std::size_t f = fronts_.size(); f-- > 0;) {  // L^T x = y
        const Front& front = fronts_[f];
        gather(front);
        for (std::size_t j = front.num_own(); j-- > 0;) {
            const double* const column = values_.data() + front.values + j * front.size();
            // Four sums at a time, since one waits for itself.
            std::array<double, 4> sums{part[j], 0.0, 0.0, 0.0};
            for (std::size_t i = j + 1; i < front.size(); ++i)
                sums[(i - j - 1) % 4] -= column[i] * part[i];
            part[j] = ((sums[0] + sums[1]) + (sums[2] + sums[3])) / column[j];
        }
        std::copy_n(part.begin(), front.num_own(), side.data() + front.begin);
    }
}

}  // namespace incise::physics
