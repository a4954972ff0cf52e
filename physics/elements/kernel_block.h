// Implementation of a block of elements with one kernel.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <type_traits>
#include <utility>

#include "incise/base/sum.h"
#include "incise/physics/elements/element_block.h"
#include "incise/physics/elements/element_tangent.h"
#include "incise/physics/elements/kernel_concepts.h"

namespace incise::physics {

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
                    f = kernel_.forces_of_memory(rest(s), x, history.of(elements_[s]));
                else
                    f = kernel_.forces(rest(s), x);
                for (std::size_t k = 0; k < num_corners; ++k)
                    forces[local_corners(s)[k]].vector() += share(s) * f[k];
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
            const Corners f = at_end_of_step(
                s, end, [&](const auto&... state) { return kernel_.forces(rest(s), state...); });
            const auto nodes = nodes_of(s);
            for (std::size_t k = 0; k < num_corners; ++k) forces[nodes[k]] += share(s) * f[k];
        }
    }

    double potential(const EndOfStep& end) const override {
        Sum sum;
        for (std::size_t s = 0; s < elements_.size(); ++s)
            sum += share(s) * at_end_of_step(s, end, [&](const auto&... state) {
                       if constexpr (HasHistory<Kernel>)
                           return kernel_.potential(rest(s), state...);
                       else
                           return kernel_.energy(rest(s), state...);
                   });
        return sum.value();
    }

    void visit_tangents(const EndOfStep& end, TangentKind kind, TangentSink& sink) const override {
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            auto K = at_end_of_step(s, end, [&](const auto&... state) {
                return element_tangent(kernel_, rest(s), state...);
            });
            if (kind == TangentKind::positive) K = positive_part(K);
            K *= share(s);
            sink.add(nodes_of(s), {K.data(), static_cast<std::size_t>(K.size())});
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
                return share(s) * kernel_.advance(rest(s), gather(s, before), gather(s, positions),
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
                factors[s] = kernel_.stiffening(rest(s), gather(s, positions));
        // Rounding of the factors at rest, in floats.
        constexpr double rounding = 1e-3;
        if (std::ranges::all_of(factors, [](double f) { return f <= 1.0 + rounding; }))
            return false;
        std::ranges::fill(excess, 0.0);
        for (std::size_t s = 0; s < elements_.size(); ++s) {
            if (factors[s] <= 1.0 + rounding) continue;
            const auto corners = local_corners(s);
            // In floats: the last digits of the stable step have always been those.
            for (std::size_t k = 0; k < num_corners; ++k)
                excess[corners[k]] +=
                    (factors[s] - 1.0) * double{static_cast<float>(row(s).stiffness[k])};
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
            state.elastic_energy += share(s) * kernel_.energy(rest(s), x);
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
            sum += share(s) * kernel_.stiffness_energy(rest(s));
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
            for (std::size_t s = 0; s < elements_.size(); ++s) results[s].volume = volumes_[s];
            const LocalVector* x = local_positions(positions).data();
            lanes_in_doubles([&](const auto& lanes) { lanes.set_results(kernel_, x, results); });
            for (std::size_t s = 0; s < elements_.size(); ++s) {
                results[s].volume *= share(s);
                results[s].energy *= share(s);
            }
            return;
        }
        for (std::size_t s = 0; s < elements_.size(); ++s)
            results[s] = result_of(s, positions, history);
    }

    double stiffening(ElementId e, std::span<const Vec3> positions) const override {
        const std::size_t s = slot_of(e);
        return std::max(kernel_.stiffening(rest(s), gather(s, positions)), 1.0);
    }

    double least_volume_ratio(ElementId e, std::span<const Vec3> positions) const override {
        const std::size_t s = slot_of(e);
        return least_volume_ratio(s, gather(s, positions));
    }

    NodalContributions contributions(ElementId e) const override {
        const std::size_t s = slot_of(e);
        NodalContributions of_corners;
        std::ranges::copy(row(s).stiffness, of_corners.stiffness.begin());
        if constexpr (HasMassFractions<Kernel>)
            std::ranges::copy(row(s).masses, of_corners.mass.begin());
        else
            std::fill_n(of_corners.mass.begin(), num_corners,
                        share(s) * (density_ * volumes_[s] / static_cast<double>(num_corners)));
        return of_corners;
    }
    double rest_volume(ElementId e) const override { return volume_of(slot_of(e)); }

    void insert(ElementId e, const ElementInput& input) override {
        const std::size_t s = add_slot(e, input.corners);
        const auto offset = static_cast<std::ptrdiff_t>(s);
        row_of_.insert(row_of_.begin() + offset, static_cast<std::uint16_t>(rows_.size()));
        rows_.emplace_back();
        if (stores_fibres()) fibres_.emplace_back();
        volumes_.insert(volumes_.begin() + offset, 0.0);
        if (!shares_.empty()) shares_.insert(shares_.begin() + offset, 1.0);
        set(s, input);
    }

    void replace(ElementId e, const ElementInput& input) override {
        const std::size_t s = slot_of(e);
        change_slot(s, input.corners);
        set(s, input);
    }

    void erase(ElementId e) override {
        const std::size_t s = slot_of(e);
        // The last row replaces the erased one.
        const auto last = static_cast<std::uint16_t>(rows_.size() - 1);
        rows_[row_of_[s]] = rows_[last];
        rows_.pop_back();
        if (stores_fibres()) {
            fibres_[row_of_[s]] = fibres_[last];
            fibres_.pop_back();
        }
        *std::find(row_of_.begin(), row_of_.end(), last) = row_of_[s];
        const auto offset = static_cast<std::ptrdiff_t>(s);
        row_of_.erase(row_of_.begin() + offset);
        volumes_.erase(volumes_.begin() + offset);
        if (!shares_.empty()) shares_.erase(shares_.begin() + offset);
        remove_slot(s);
    }

  protected:
    void use_numbers(std::span<const std::size_t> changed,
                     std::span<const Vec3> rest_positions) override {
        rest_volume_ = {};
        for (std::size_t s = 0; s < elements_.size(); ++s) rest_volume_ += volume_of(s);
        if constexpr (IsRestored<Kernel>) {
            rest_positions_.resize(nodes_.size());
            for (std::size_t i = 0; i < nodes_.size(); ++i)
                rest_positions_[i] = rest_positions[nodes_[i]];
        }
        if constexpr (HasLanes<Kernel>)
            update(lanes_, changed, [&](std::size_t s) { lanes_.set(s, for_lanes(s), share(s)); });
        if constexpr (HasMemoryLanes<Kernel>)
            update(memory_lanes_, changed, [&](std::size_t s) {
                memory_lanes_.set(s, elements_[s], for_lanes(s), share(s));
            });
    }

  private:
    template <class K>
    struct StoredOf {
        using Type = typename K::Element;
    };
    template <IsRestored K>
    struct StoredOf<K> {
        using Type = typename K::Stored;
    };
    /// The mass at each corner, kg. Without fractions, each has the same.
    struct SameMasses {};
    using Masses =
        std::conditional_t<HasMassFractions<Kernel>, std::array<double, num_corners>, SameMasses>;
    struct Row {
        typename StoredOf<Kernel>::Type rest;
        std::array<double, num_corners> stiffness;  // see NodalContributions
        [[no_unique_address]] Masses masses;
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
    double share(std::size_t s) const { return shares_.empty() ? 1.0 : shares_[s]; }
    /// Returns the values of an element at rest, by value if they are restored.
    decltype(auto) rest(std::size_t s) const {
        if constexpr (IsRestored<Kernel>)
            return kernel_.restored(row(s).rest, rest_corners(s), volumes_[s], fibre(s));
        else
            return (row(s).rest);
    }
    /// Returns what the lanes need of rest().
    decltype(auto) for_lanes(std::size_t s) const {
        if constexpr (IsRestored<Kernel>)
            return kernel_.for_lanes(row(s).rest, rest_corners(s), volumes_[s], fibre(s));
        else
            return (row(s).rest);
    }
    Vec3 fibre(std::size_t s) const {
        return fibres_.empty() ? Vec3(Vec3::Zero()) : fibres_[row_of_[s]];
    }
    bool stores_fibres() const {
        if constexpr (IsRestored<Kernel>)
            return has_fibres(kernel_.law);
        else
            return false;
    }

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
        fill(lanes, in_doubles, [&](std::size_t s) { lanes.set(s, for_lanes(s), share(s)); });
        return use(lanes);
    }

    double least_volume_ratio(std::size_t s, const Corners& x) const {
        if constexpr (HasLeastVolumeRatio<Kernel>)
            return kernel_.least_volume_ratio(rest(s), x);
        else
            return kernel_.volume_ratio(rest(s), x);
    }

    double volume_of(std::size_t s) const { return share(s) * volumes_[s]; }

    typename Kernel::Element precompute(const ElementInput& input, const Corners& X) const {
        if constexpr (TakesPartShares<Kernel>) {
            // The shares of the tetrahedra over that of the whole, which the block applies.
            std::array<double, Kernel::num_parts> relative;
            assert(input.part_shares.empty() || input.part_shares.size() == relative.size());
            for (std::size_t t = 0; t < input.part_shares.size(); ++t)
                relative[t] = input.part_shares[t] / input.share;
            return kernel_.precompute(X, input.fibre,
                                      std::span(relative).first(input.part_shares.size()),
                                      input.diagonals);
        } else if constexpr (TakesFibre<Kernel>) {
            return kernel_.precompute(X, input.fibre);
        } else {
            return kernel_.precompute(X);
        }
    }

    /// Precomputes the element in slot s.
    void set(std::size_t s, const ElementInput& input) {
        assert(input.corners.size() == num_corners);
        Corners X;
        for (std::size_t k = 0; k < num_corners; ++k)
            X[k] = input.rest_positions[input.corners[k].index()];
        const typename Kernel::Element element = precompute(input, X);
        Row& row = rows_[row_of_[s]];
        volumes_[s] = element.volume;
        if (shares_.empty() && input.share != 1.0) shares_.assign(elements_.size(), 1.0);
        if (!shares_.empty()) shares_[s] = input.share;
        if constexpr (HasMassFractions<Kernel>) {
            const auto fractions = kernel_.mass_fractions(element);
            for (std::size_t k = 0; k < num_corners; ++k)
                row.masses[k] = input.share * density_ * element.volume * fractions[k];
        }
        const auto stiffness = kernel_.stiffness_bounds(element, X);
        for (std::size_t k = 0; k < num_corners; ++k) row.stiffness[k] = input.share * stiffness[k];
        if constexpr (IsRestored<Kernel>) {
            row.rest = kernel_.stored(element);
            if (stores_fibres()) fibres_[row_of_[s]] = element.fibre;
        } else {
            row.rest = element;
        }
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
        result.volume = volumes_[s];
        result.volume_ratio = kernel_.volume_ratio(rest(s), x);
        result.energy = kernel_.energy(rest(s), x);
        const Corners f = forces_of(s, x, history);
        Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();
        for (std::size_t k = 1; k < num_corners; ++k) virial += f[k] * (x[k] - x[0]).transpose();
        result.set_stress(virial);
        result.volume *= share(s);
        result.energy *= share(s);
        return result;
    }

    Corners forces_of(std::size_t s, const Corners& x,
                      [[maybe_unused]] const ViscousHistory& history) const {
        if constexpr (HasHistory<Kernel>)
            return kernel_.forces(rest(s), x, history.of(elements_[s]));
        else
            return kernel_.forces(rest(s), x);
    }

    /// Returns the ids of the nodes of an element.
    std::array<std::uint32_t, num_corners> nodes_of(std::size_t s) const {
        std::array<std::uint32_t, num_corners> nodes;
        for (std::size_t k = 0; k < num_corners; ++k) nodes[k] = nodes_[local_corners(s)[k]];
        return nodes;
    }
    /// Returns the corners from positions by node id.
    Corners gather(std::size_t s, std::span<const Vec3> positions) const {
        const auto nodes = nodes_of(s);
        Corners x;
        for (std::size_t k = 0; k < num_corners; ++k) x[k] = positions[nodes[k]];
        return x;
    }
    /// Returns the corners at rest.
    Corners rest_corners(std::size_t s) const {
        Corners X;
        for (std::size_t k = 0; k < num_corners; ++k) X[k] = rest_positions_[local_corners(s)[k]];
        return X;
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
    std::vector<std::uint16_t> row_of_;  // by slot
    std::vector<double> volumes_;        // by slot, of the whole element at rest, m3
    std::vector<double> shares_;         // by slot; empty if all elements are whole
    std::vector<Vec3> fibres_;           // by row, of restored elements; see stores_fibres()
    std::vector<Vec3> rest_positions_;   // by local number, m; empty unless elements are restored
    typename LanesOf<Kernel>::Type lanes_;
    typename MemoryLanesOf<Kernel>::Type memory_lanes_;
    Sum rest_volume_;
};

}  // namespace incise::physics
