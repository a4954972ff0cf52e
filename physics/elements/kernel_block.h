// Implementation of a block of elements with one kernel, and the requirements on kernels.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <utility>

#include "incise/base/sum.h"
#include "incise/physics/elements/element_block.h"
#include "incise/physics/elements/element_tangent.h"

namespace incise::physics {

/// A kernel whose elements have a viscous history, such as ViscousKernel.
template <class Kernel>
concept HasHistory = requires(Kernel& kernel) {
    kernel.begin_step(0.0);
};

/// A kernel that needs the direction of fibres.
template <class Kernel>
concept TakesFibre = requires(const Kernel& kernel, typename Kernel::Corners X, Vec3 fibre) {
    kernel.precompute(X, fibre);
};

/// A kernel whose elements have tetrahedra of which a fragment has shares.
template <class Kernel>
concept TakesPartShares = requires(const Kernel& kernel, typename Kernel::Corners X,
                                   std::span<const double> shares) {
    kernel.precompute(X, Vec3(), shares);
};

/// A kernel whose elements do not give the same mass to each corner.
template <class Kernel>
concept HasMassFractions = requires(const Kernel& kernel, const typename Kernel::Element& e) {
    kernel.mass_fractions(e);
};

/// A kernel whose elements can be inverted in a part alone, such as VirtualCentreKernel.
template <class Kernel>
concept HasLeastVolumeRatio = requires(const Kernel& kernel, const typename Kernel::Element& e,
                                       const typename Kernel::Corners& x) {
    kernel.least_volume_ratio(e, x);
};

/// A kernel with a SIMD version `Kernel::Lanes`, such as SimdHemlElements, which computes the
/// elastic forces of all elements of a block. The viscous forces come from `Kernel::MemoryLanes`
/// if there are any, else from the kernel.
template <class Kernel>
concept HasLanes = requires {
    typename Kernel::Lanes;
};

/// A kernel whose SIMD version also computes energies, volumes and stresses, in double precision.
template <class Kernel>
concept HasLanesOfResults = HasLanes<Kernel> &&
    requires(const typename Kernel::Lanes& lanes, const Kernel& kernel, const LocalVector* x) {
    lanes.state(kernel, x);
    lanes.set_results(kernel, x, std::span<ElementResult>());
};

/// A kernel with a SIMD version of its history, `Kernel::MemoryLanes`, such as SimdViscousElements.
/// It advances the history and computes the viscous forces of all elements of a block.
template <class Kernel>
concept HasMemoryLanes = requires {
    typename Kernel::MemoryLanes;
};

/// A kernel whose SIMD version also computes the stiffening of all elements.
template <class Kernel>
concept HasLanesOfStiffening = HasLanes<Kernel> &&
    requires(const typename Kernel::Lanes& lanes, const Kernel& kernel, const LocalVector* x) {
    lanes.set_stiffening(kernel, x, std::span<double>());
};

/// A block whose elements all use one kernel. A kernel must have the members of MassSpringKernel,
/// and an overload of element_tangent(). ViscousKernel shows the further members of a kernel with
/// history. docs/architecture.md, A kernel, lists the places to change for a new one.
template <class Kernel>
class KernelBlock final : public ElementBlock {
  public:
    static constexpr std::size_t num_corners = Kernel::num_corners;
    using Corners = std::array<Vec3, num_corners>;

    KernelBlock(const Kernel& kernel, double density)
        : ElementBlock(num_corners), kernel_(kernel), density_(density) {}

    std::shared_ptr<ElementBlock> clone() const override {
        return std::make_shared<KernelBlock>(*this);
    }

    void compute_forces(std::span<const LocalVector> positions,
                        [[maybe_unused]] const ViscousHistory& history,
                        std::span<LocalVector> forces,
                        [[maybe_unused]] std::span<const std::byte> next) const override {
        assert(is_numbered_ && forces.size() > nodes_.size());
        std::fill(forces.begin(), forces.end(), LocalVector{});
        if constexpr (HasMemoryLanes<Kernel>) {
            lanes_.add_forces(kernel_, positions.data(), forces.data(), memory_lanes_.bytes());
            memory_lanes_.add_forces(kernel_, history, positions.data(), forces.data(), next);
            return;
        }
        if constexpr (HasLanes<Kernel>)
            lanes_.add_forces(kernel_, positions.data(), forces.data(), next);
        if constexpr (!HasLanes<Kernel> || HasHistory<Kernel>)
            for (std::size_t s = 0; s < elements_.size(); ++s) {
                const Corners x = gather(s, positions);
                Corners f;
                if constexpr (HasHistory<Kernel>)
                    f = kernel_.forces_of_memory(row(s).rest, x, history.of(elements_[s]));
                else
                    f = kernel_.forces(row(s).rest, x);
                for (std::size_t k = 0; k < num_corners; ++k)
                    forces[local_corners(s)[k]].vector() += row(s).share * f[k];
            }
    }

    std::span<const std::byte> bytes_of_elements() const override {
        if constexpr (HasLanes<Kernel>)
            return lanes_.bytes();
        else
            return {};
    }

    void add_forces(const EndOfStep& end, std::span<Vec3> forces) const override {
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            const Corners f = at_end_of_step(s, end, [&](const auto&... state) {
                return kernel_.forces(row(s).rest, state...);
            });
            for (std::size_t k = 0; k < num_corners; ++k)
                forces[row(s).nodes[k]] += row(s).share * f[k];
        }
    }

    double potential(const EndOfStep& end) const override {
        Sum sum;
        for (std::size_t s = 0; s < elements_.size(); ++s)
            sum += row(s).share * at_end_of_step(s, end, [&](const auto&... state) {
                       if constexpr (HasHistory<Kernel>)
                           return kernel_.potential(row(s).rest, state...);
                       else
                           return kernel_.energy(row(s).rest, state...);
                   });
        return sum.value();
    }

    void visit_tangents(const EndOfStep& end, TangentKind kind, TangentSink& sink) const override {
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            auto K = at_end_of_step(s, end, [&](const auto&... state) {
                return element_tangent(kernel_, row(s).rest, state...);
            });
            if (kind == TangentKind::positive) K = positive_part(K);
            K *= row(s).share;
            sink.add(row(s).nodes, {K.data(), static_cast<std::size_t>(K.size())});
        }
    }

    bool has_history() const override { return HasHistory<Kernel>; }

    double advance(std::span<const LocalVector> before, std::span<const LocalVector> positions,
                   double dt, ViscousHistory& history) override {
        assert(is_numbered_);
        double energy = 0.0;
        if constexpr (HasHistory<Kernel>) {
            // Other threads may read this block if it is shared. They do not read the values that
            // begin_step() sets, which only this function uses.
            kernel_.begin_step(dt);
            const auto advance_one = [&](std::size_t s) {
                return row(s).share * kernel_.advance(row(s).rest, gather(s, before),
                                                      gather(s, positions),
                                                      history.of(elements_[s]));
            };
            if constexpr (HasMemoryLanes<Kernel>)
                energy = memory_lanes_.advance(kernel_, before.data(), positions.data(), history,
                                               advance_one);
            else
                for (std::size_t s = 0; s < elements_.size(); ++s) energy += advance_one(s);
        }
        return energy;
    }

    bool set_excess_stiffness(std::span<const LocalVector> positions,
                              std::span<double> excess) const override {
        assert(is_numbered_ && excess.size() >= nodes_.size());
        const std::span<double> factors = room_for<double>(elements_.size());
        if constexpr (HasLanesOfStiffening<Kernel>)
            lanes_.set_stiffening(kernel_, positions.data(), factors);
        else
            for (std::size_t s = 0; s < elements_.size(); ++s)
                factors[s] = kernel_.stiffening(row(s).rest, gather(s, positions));
        // Rounding of the factors at rest, in floats.
        constexpr double rounding = 1e-3;
        if (std::ranges::all_of(factors, [](double f) { return f <= 1.0 + rounding; }))
            return false;
        std::ranges::fill(excess, 0.0);
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            if (factors[s] <= 1.0 + rounding) continue;
            const auto corners = local_corners(s);
            for (std::size_t k = 0; k < num_corners; ++k)
                excess[corners[k]] += (factors[s] - 1.0) * double{rest_stiffness_[s][k]};
        }
        return true;
    }

    BlockState state(std::span<const Vec3> positions) const override {
        assert(is_numbered_);
        if constexpr (HasLanesOfResults<Kernel>) {
            const LocalVector* x = local_positions(positions).data();
            BlockState state =
                lanes_in_doubles([&](const auto& lanes) { return lanes.state(kernel_, x); });
            if constexpr (HasHistory<Kernel>)
                state.elastic_energy = kernel_.long_time_share * state.elastic_energy;
            return state;
        }
        BlockState state;
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            const Corners x = gather(s, positions);
            state.elastic_energy += row(s).share * kernel_.energy(row(s).rest, x);
            state.min_volume_ratio = std::min(state.min_volume_ratio, least_volume_ratio(s, x));
        }
        return state;
    }

    Sum rest_volume() const override {
        assert(is_numbered_);
        return rest_volume_;
    }

    double stiffness_energy() const override {
        double sum = 0.0;
        for (std::size_t s = 0; s < elements_.size(); ++s)
            sum += row(s).share * kernel_.stiffness_energy(row(s).rest);
        return sum;
    }

    ElementResult result(ElementId e, std::span<const Vec3> positions,
                         const ViscousHistory& history) const override {
        return result_of(slot_of(e), positions, history);
    }

    void results(std::span<const Vec3> positions, const ViscousHistory& history,
                 std::span<ElementResult> results) const override {
        assert(results.size() == elements_.size());
        if constexpr (HasLanesOfResults<Kernel> && !HasHistory<Kernel>) {
            for (std::size_t s = 0; s < elements_.size(); ++s)
                results[s].volume = row(s).rest.volume;
            const LocalVector* x = local_positions(positions).data();
            lanes_in_doubles([&](const auto& lanes) { lanes.set_results(kernel_, x, results); });
            for (std::size_t s = 0; s < elements_.size(); ++s) {
                results[s].volume *= row(s).share;
                results[s].energy *= row(s).share;
            }
            return;
        }
        for (std::size_t s = 0; s < elements_.size(); ++s)
            results[s] = result_of(s, positions, history);
    }

    double stiffening(ElementId e, std::span<const Vec3> positions) const override {
        const std::size_t s = slot_of(e);
        return std::max(kernel_.stiffening(row(s).rest, gather(s, positions)), 1.0);
    }

    double least_volume_ratio(ElementId e, std::span<const Vec3> positions) const override {
        const std::size_t s = slot_of(e);
        return least_volume_ratio(s, gather(s, positions));
    }

    const NodalContributions& contributions(ElementId e) const override {
        return row(slot_of(e)).contributions;
    }
    double rest_volume(ElementId e) const override { return volume_of(slot_of(e)); }

    void insert(ElementId e, const ElementInput& input) override {
        const std::size_t s = add_slot(e);
        const auto offset = static_cast<std::ptrdiff_t>(s);
        row_of_.insert(row_of_.begin() + offset, static_cast<std::uint32_t>(rows_.size()));
        rows_.push_back(make_row(input));
        rest_volumes_.insert(rest_volumes_.begin() + offset, volume_of(s));
        rest_stiffness_.insert(rest_stiffness_.begin() + offset, stiffness_of(s));
    }

    void replace(ElementId e, const ElementInput& input) override {
        const std::size_t s = slot_of(e);
        rows_[row_of_[s]] = make_row(input);
        rest_volumes_[s] = volume_of(s);
        rest_stiffness_[s] = stiffness_of(s);
        change_slot(s);
    }

    void erase(ElementId e) override {
        const std::size_t s = slot_of(e);
        // The last row replaces the erased one.
        const auto last = static_cast<std::uint32_t>(rows_.size() - 1);
        rows_[row_of_[s]] = rows_[last];
        *std::find(row_of_.begin(), row_of_.end(), last) = row_of_[s];
        rows_.pop_back();
        row_of_.erase(row_of_.begin() + static_cast<std::ptrdiff_t>(s));
        rest_volumes_.erase(rest_volumes_.begin() + static_cast<std::ptrdiff_t>(s));
        rest_stiffness_.erase(rest_stiffness_.begin() + static_cast<std::ptrdiff_t>(s));
        remove_slot(s);
    }

  protected:
    std::span<const std::uint32_t> corners_of(std::size_t s) const override { return row(s).nodes; }

    void use_numbers(std::span<const std::size_t> changed) override {
        rest_volume_ = {};
        for (const double volume : rest_volumes_) rest_volume_ += volume;
        if constexpr (HasLanes<Kernel>)
            update(lanes_, changed,
                   [&](std::size_t s) { lanes_.set(s, row(s).rest, row(s).share); });
        if constexpr (HasMemoryLanes<Kernel>)
            update(memory_lanes_, changed, [&](std::size_t s) {
                memory_lanes_.set(s, elements_[s], row(s).rest, row(s).share);
            });
    }

  private:
    struct Row {
        std::array<std::uint32_t, num_corners> nodes;
        typename Kernel::Element rest;
        double share;
        NodalContributions contributions;
    };

    struct NoLanes {};
    template <class K>
    struct LanesOf {
        using Type = NoLanes;
    };
    template <HasLanes K>
    struct LanesOf<K> {
        using Type = typename K::Lanes;
    };
    template <class K>
    struct MemoryLanesOf {
        using Type = NoLanes;
    };
    template <HasMemoryLanes K>
    struct MemoryLanesOf<K> {
        using Type = typename K::MemoryLanes;
    };

    const Row& row(std::size_t s) const { return rows_[row_of_[s]]; }

    /// Sets all elements by calls of set(s), which sets the element in slot s.
    template <class Lanes, class Set>
    void fill(Lanes& lanes, const Kernel& kernel, Set set) const {
        lanes.assign(elements_.size(), kernel);
        for (std::size_t s = 0; s < elements_.size(); ++s) set(s);
        lanes.set_nodes(local_corners_, static_cast<std::uint16_t>(nodes_.size()));
    }
    /// Sets the changed elements, or all elements if some are in other slots than before.
    template <class Lanes, class Set>
    void update(Lanes& lanes, std::span<const std::size_t> changed, Set set) const {
        if (have_moved_) return fill(lanes, kernel_, set);
        for (const std::size_t s : changed) set(s);
        lanes.set_nodes(local_corners_, static_cast<std::uint16_t>(nodes_.size()));
    }

    /// Returns use(lanes), with lanes in doubles. They are built for this call if those for forces
    /// are in floats.
    template <class Use>
    auto lanes_in_doubles(Use use) const {
        if (kernel_.precision == Precision::double_precision) return use(lanes_);
        Kernel in_doubles = kernel_;
        in_doubles.precision = Precision::double_precision;
        typename LanesOf<Kernel>::Type lanes;
        fill(lanes, in_doubles, [&](std::size_t s) { lanes.set(s, row(s).rest, row(s).share); });
        return use(lanes);
    }

    double least_volume_ratio(std::size_t s, const Corners& x) const {
        if constexpr (HasLeastVolumeRatio<Kernel>)
            return kernel_.least_volume_ratio(row(s).rest, x);
        else
            return kernel_.volume_ratio(row(s).rest, x);
    }

    std::array<float, num_corners> stiffness_of(std::size_t s) const {
        std::array<float, num_corners> of_corners;
        for (std::size_t k = 0; k < num_corners; ++k)
            of_corners[k] = static_cast<float>(row(s).contributions.stiffness[k]);
        return of_corners;
    }
    double volume_of(std::size_t s) const { return row(s).share * row(s).rest.volume; }

    Row make_row(const ElementInput& input) const {
        assert(input.corners.size() == num_corners);
        Row row;
        row.share = input.share;
        Corners X;
        for (std::size_t k = 0; k < num_corners; ++k) {
            row.nodes[k] = static_cast<std::uint32_t>(input.corners[k].index());
            X[k] = input.rest_positions[input.corners[k].index()];
        }
        if constexpr (TakesPartShares<Kernel>) {
            // The shares of the tetrahedra over that of the whole, which the block applies.
            std::array<double, Kernel::num_parts> relative;
            assert(input.part_shares.empty() || input.part_shares.size() == relative.size());
            for (std::size_t t = 0; t < input.part_shares.size(); ++t)
                relative[t] = input.part_shares[t] / input.share;
            row.rest = kernel_.precompute(X, input.fibre,
                                          std::span(relative).first(input.part_shares.size()),
                                          input.diagonals);
        } else if constexpr (TakesFibre<Kernel>) {
            row.rest = kernel_.precompute(X, input.fibre);
        } else {
            row.rest = kernel_.precompute(X);
        }
        if constexpr (HasMassFractions<Kernel>) {
            const auto fractions = kernel_.mass_fractions(row.rest);
            for (std::size_t k = 0; k < num_corners; ++k)
                row.contributions.mass[k] = row.share * density_ * row.rest.volume * fractions[k];
        } else {
            std::fill_n(
                row.contributions.mass.begin(), num_corners,
                row.share * (density_ * row.rest.volume / static_cast<double>(num_corners)));
        }
        const auto stiffness = kernel_.stiffness_bounds(row.rest, X);
        for (std::size_t k = 0; k < num_corners; ++k)
            row.contributions.stiffness[k] = row.share * stiffness[k];
        return row;
    }

    /// Returns evaluate(corners). For a kernel with history it returns evaluate(corners, end), with
    /// the end of the step of this kernel.
    template <class Evaluate>
    auto at_end_of_step(std::size_t s, const EndOfStep& end, Evaluate evaluate) const {
        if constexpr (HasHistory<Kernel>)
            return evaluate(gather(s, end.positions),
                            kernel_.end_of_step(end.history.of(elements_[s]), end.dt));
        else
            return evaluate(gather(s, end.positions));
    }

    ElementResult result_of(std::size_t s, std::span<const Vec3> positions,
                            const ViscousHistory& history) const {
        const Corners x = gather(s, positions);
        ElementResult result;
        result.volume = row(s).rest.volume;
        result.volume_ratio = kernel_.volume_ratio(row(s).rest, x);
        result.energy = kernel_.energy(row(s).rest, x);
        const Corners f = forces_of(s, x, history);
        Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();
        for (std::size_t k = 1; k < num_corners; ++k) virial += f[k] * (x[k] - x[0]).transpose();
        result.set_stress(virial);
        result.volume *= row(s).share;
        result.energy *= row(s).share;
        return result;
    }

    Corners forces_of(std::size_t s, const Corners& x,
                      [[maybe_unused]] const ViscousHistory& history) const {
        if constexpr (HasHistory<Kernel>)
            return kernel_.forces(row(s).rest, x, history.of(elements_[s]));
        else
            return kernel_.forces(row(s).rest, x);
    }

    Corners gather(std::size_t s, std::span<const Vec3> positions) const {
        Corners x;
        for (std::size_t k = 0; k < num_corners; ++k) x[k] = positions[row(s).nodes[k]];
        return x;
    }
    /// Returns the corners from positions by local number.
    Corners gather(std::size_t s, std::span<const LocalVector> positions) const {
        Corners x;
        for (std::size_t k = 0; k < num_corners; ++k)
            x[k] = positions[local_corners(s)[k]].vector();
        return x;
    }

    Kernel kernel_;
    double density_;
    std::vector<Row> rows_;              // in no order
    std::vector<std::uint32_t> row_of_;  // by slot
    std::vector<double> rest_volumes_;   // by slot, m3
    // By slot and corner, N/m: the contributions again, in fewer bytes for the loop over all.
    std::vector<std::array<float, num_corners>> rest_stiffness_;
    typename LanesOf<Kernel>::Type lanes_;
    typename MemoryLanesOf<Kernel>::Type memory_lanes_;
    Sum rest_volume_;
};

}  // namespace incise::physics
