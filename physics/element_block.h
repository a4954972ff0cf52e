// Elements of one kind and one material, a few hundred at a time: what the force loop walks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/viscous_history.h"
#include "topology/types.h"

namespace incise::physics {

using topology::NodeId;

/// What one element does at a given state; for output and diagnosis, not for the force loop.
struct ElementResult {
    double energy = 0.0;                                      ///< J
    double volume = 0.0;                                      ///< rest, m3
    double volume_ratio = 1.0;                                ///< J
    Eigen::Matrix3d cauchy_stress = Eigen::Matrix3d::Zero();  ///< Pa
};

/// What one element brings to its corners for good; a pure function of its rest shape.
struct ElementShares {
    double mass = 0.0;                  ///< kg, to each corner alike
    std::array<double, 8> stiffness{};  ///< N/m, by corner: part of the nodal bound
};

/// Interface of a block; one virtual call serves a whole block. Elements stand in ascending
/// order of their ids, so that a block's sums do not depend on how it came about.
class ElementBlock {
  public:
    virtual ~ElementBlock() = default;

    std::span<const ElementId> elements() const { return elements_; }

    /// Adds elastic forces (N) at `positions` (m, by node id) to `forces` (by node id), with those
    /// of viscosity as far as the history goes.
    virtual void add_forces(std::span<const Vec3> positions, const ViscousHistory& history,
                            std::span<Vec3> forces) const = 0;
    /// Brings the history of the elements from the positions `before` to `positions`, dt later
    /// (s). Returns the energy that viscosity took, J; 0 if the material has none.
    virtual double advance(std::span<const Vec3> before, std::span<const Vec3> positions, double dt,
                           ViscousHistory& history) = 0;
    /// Appends the elastic energy of each element, J.
    virtual void append_energies(std::span<const Vec3> positions,
                                 std::vector<double>& energies) const = 0;
    /// Sum over the elements of modulus times rest volume, J.
    virtual double stiffness_energy() const = 0;
    virtual double min_volume_ratio(std::span<const Vec3> positions) const = 0;
    virtual ElementResult result(ElementId e, std::span<const Vec3> positions,
                                 const ViscousHistory& history) const = 0;
    virtual ElementShares shares(ElementId e) const = 0;
    virtual double rest_volume(ElementId e) const = 0;

    /// Takes the element in and precomputes it from the rest positions (by node id).
    /// @param fibre  direction of its fibres at rest; of no account without fibres
    virtual void insert(ElementId e, std::span<const NodeId> corners,
                        std::span<const Vec3> rest_positions, const Vec3& fibre) = 0;
    /// Recomputes an element that it has, with other corners.
    virtual void replace(ElementId e, std::span<const NodeId> corners,
                         std::span<const Vec3> rest_positions, const Vec3& fibre) = 0;
    virtual void erase(ElementId e) = 0;

  protected:
    std::size_t slot_of(ElementId e) const {
        const auto place = std::lower_bound(elements_.begin(), elements_.end(), e);
        assert(place != elements_.end() && *place == e);
        return static_cast<std::size_t>(place - elements_.begin());
    }
    std::vector<ElementId> elements_;
};

/// A kernel whose elements have a history: ViscousKernel.
template <class Kernel>
concept HasHistory = requires(Kernel& kernel) {
    kernel.begin_step(0.0);
};

/// A kernel that has to know the direction of fibres.
template <class Kernel>
concept TakesFibre = requires(const Kernel& kernel, typename Kernel::Corners X, Vec3 fibre) {
    kernel.precompute(X, fibre);
};

/// A block whose elements all use one kernel: HemlKernel or MassSpringKernel (which see for what
/// a kernel has to have), or ViscousKernel for what it has besides.
template <class Kernel>
class KernelBlock final : public ElementBlock {
  public:
    static constexpr std::size_t num_corners = Kernel::num_corners;
    using Corners = std::array<Vec3, num_corners>;

    KernelBlock(const Kernel& kernel, double density) : kernel_(kernel), density_(density) {}

    void add_forces(std::span<const Vec3> positions, const ViscousHistory& history,
                    std::span<Vec3> forces) const override {
        for (std::size_t s = 0; s < rows_.size(); ++s) {
            const Corners f = forces_of(s, gather(s, positions), history);
            for (std::size_t k = 0; k < num_corners; ++k) forces[rows_[s].nodes[k]] += f[k];
        }
    }

    double advance(std::span<const Vec3> before, std::span<const Vec3> positions, double dt,
                   ViscousHistory& history) override {
        double energy = 0.0;
        if constexpr (HasHistory<Kernel>) {
            kernel_.begin_step(dt);
            for (std::size_t s = 0; s < rows_.size(); ++s)
                energy += kernel_.advance(rows_[s].rest, gather(s, before), gather(s, positions),
                                          history.of(elements_[s]));
        }
        return energy;
    }

    void append_energies(std::span<const Vec3> positions,
                         std::vector<double>& energies) const override {
        for (std::size_t s = 0; s < rows_.size(); ++s)
            energies.push_back(kernel_.energy(rows_[s].rest, gather(s, positions)));
    }

    double stiffness_energy() const override {
        double sum = 0.0;
        for (const Row& row : rows_) sum += kernel_.stiffness_energy(row.rest);
        return sum;
    }

    double min_volume_ratio(std::span<const Vec3> positions) const override {
        double lowest = std::numeric_limits<double>::infinity();
        for (std::size_t s = 0; s < rows_.size(); ++s)
            lowest = std::min(lowest, kernel_.volume_ratio(rows_[s].rest, gather(s, positions)));
        return lowest;
    }

    /// The Cauchy stress is the virial of the element's own forces, -sum of f_i x_i^T over its
    /// volume: exact for linear elements, and the mean stress for springs.
    ElementResult result(ElementId e, std::span<const Vec3> positions,
                         const ViscousHistory& history) const override {
        const std::size_t s = slot_of(e);
        const Corners x = gather(s, positions);
        ElementResult result;
        result.energy = kernel_.energy(rows_[s].rest, x);
        result.volume = rows_[s].rest.volume;
        result.volume_ratio = kernel_.volume_ratio(rows_[s].rest, x);
        const Corners f = forces_of(s, x, history);
        for (std::size_t k = 1; k < num_corners; ++k)
            result.cauchy_stress -= f[k] * (x[k] - x[0]).transpose();
        const double volume = result.volume * result.volume_ratio;
        if (volume == 0.0)  // flat: no volume to spread the stress over
            result.cauchy_stress.setZero();
        else
            result.cauchy_stress /= volume;
        return result;
    }

    ElementShares shares(ElementId e) const override { return rows_[slot_of(e)].shares; }
    double rest_volume(ElementId e) const override { return rows_[slot_of(e)].rest.volume; }

    void insert(ElementId e, std::span<const NodeId> corners, std::span<const Vec3> rest_positions,
                const Vec3& fibre) override {
        const auto place = std::lower_bound(elements_.begin(), elements_.end(), e);
        rows_.insert(rows_.begin() + (place - elements_.begin()),
                     make_row(corners, rest_positions, fibre));
        elements_.insert(place, e);
    }

    void replace(ElementId e, std::span<const NodeId> corners, std::span<const Vec3> rest_positions,
                 const Vec3& fibre) override {
        rows_[slot_of(e)] = make_row(corners, rest_positions, fibre);
    }

    void erase(ElementId e) override {
        const auto s = static_cast<std::ptrdiff_t>(slot_of(e));
        rows_.erase(rows_.begin() + s);
        elements_.erase(elements_.begin() + s);
    }

  private:
    struct Row {
        std::array<std::uint32_t, num_corners> nodes;
        typename Kernel::Element rest;
        ElementShares shares;
    };

    Row make_row(std::span<const NodeId> corners, std::span<const Vec3> rest_positions,
                 [[maybe_unused]] const Vec3& fibre) const {
        assert(corners.size() == num_corners);
        Row row;
        Corners X;
        for (std::size_t k = 0; k < num_corners; ++k) {
            row.nodes[k] = static_cast<std::uint32_t>(corners[k].index());
            X[k] = rest_positions[corners[k].index()];
        }
        if constexpr (TakesFibre<Kernel>)
            row.rest = kernel_.precompute(X, fibre);
        else
            row.rest = kernel_.precompute(X);
        row.shares.mass = density_ * row.rest.volume / static_cast<double>(num_corners);
        const auto stiffness = kernel_.stiffness_bounds(row.rest, X);
        std::copy(stiffness.begin(), stiffness.end(), row.shares.stiffness.begin());
        return row;
    }

    Corners forces_of(std::size_t s, const Corners& x,
                      [[maybe_unused]] const ViscousHistory& history) const {
        if constexpr (HasHistory<Kernel>)
            return kernel_.forces(rows_[s].rest, x, history.of(elements_[s]));
        else
            return kernel_.forces(rows_[s].rest, x);
    }

    Corners gather(std::size_t s, std::span<const Vec3> positions) const {
        Corners x;
        for (std::size_t k = 0; k < num_corners; ++k) x[k] = positions[rows_[s].nodes[k]];
        return x;
    }

    Kernel kernel_;
    double density_;
    std::vector<Row> rows_;
};

}  // namespace incise::physics
