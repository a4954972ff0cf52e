// Energies, momenta and other sums over a body, and the work that it has exchanged.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/archive.h"
#include "incise/physics/body/boundary.h"
#include "incise/physics/body/node_sums.h"
#include "incise/physics/body/structure.h"

namespace incise::physics {

/// Sums over the body.
struct Totals {
    double mass = 0.0;                     ///< kg
    double rest_volume = 0.0;              ///< m3
    double kinetic_energy = 0.0;           ///< J, of the current velocities
    double elastic_energy = 0.0;           ///< J; of viscous elements that of the long-time moduli
    double gravity_energy = 0.0;           ///< J, zero at the origin
    Vec3 momentum = Vec3::Zero();          ///< kg m/s
    Vec3 angular_momentum = Vec3::Zero();  ///< kg m2/s, about the origin
    Vec3 centre_of_mass = Vec3::Zero();    ///< m
    static void archive(auto& ar, auto& self) {
        ar(self.mass, self.rest_volume, self.kinetic_energy, self.elastic_energy,
           self.gravity_energy, self.momentum, self.angular_momentum, self.centre_of_mass);
    }
};

/// The sums over a body in its present state, and the work since the start.
/// @thread One thread at a time.
class Energetics {
  public:
    /// @lifetime All arguments must outlive it.
    Energetics(const Structure& structure, const State& state, const Boundary& boundary,
               const Workers& workers)
        : structure_(structure), state_(state), boundary_(boundary), workers_(workers) {}

    /// Returns the sums over the body. Cost: O(#nodes + #elements) after a motion. After an edit
    /// without motion, only the touched ranges of nodes and blocks of elements are computed again.
    Totals totals() const;
    /// Returns the elastic energy, J; of viscous elements that of the long-time moduli.
    double elastic_energy() const;
    /// Returns the least volume ratio of all elements. Cost as for totals().
    double min_volume_ratio() const;
    /// Returns current volume / rest volume - 1. Not a number without elements.
    double volume_change() const;

    /// Returns the work of gravity, loads, added terms and constraints since the start, J.
    double external_work() const { return external_work_; }
    /// Returns the energy that damping, viscosity and the rules of implicit steps and statics have
    /// taken since the start, J. Energy that viscous elements can still return counts as dissipated
    /// until they return it.
    double dissipated_energy() const { return dissipated_energy_; }
    /// Adds to external_work() and dissipated_energy(), J.
    void record_work(double external_work, double dissipated_energy) {
        external_work_ += external_work;
        dissipated_energy_ += dissipated_energy;
    }

    /// Returns the work of the impulses of the last step, J, with what they do on prescribed
    /// components; see ExplicitStep::give_impulses().
    double impulse_work() const { return impulse_work_; }
    void set_impulse_work(double work) { impulse_work_ = work; }

    /// Follows an edit: forgets the sums with the given nodes.
    void forget(std::span<const NodeId> nodes);

    void save(ArchiveWriter& ar) const { ar(external_work_, dissipated_energy_); }
    void restore(ArchiveReader& ar) { ar(external_work_, dissipated_energy_); }

  private:
    NodeSums sums_of(NodeRange range) const;

    const Structure& structure_;
    const State& state_;
    const Boundary& boundary_;
    const Workers& workers_;
    mutable KeptNodeSums node_sums_;
    double external_work_ = 0.0, dissipated_energy_ = 0.0;
    double impulse_work_ = 0.0;
};

}  // namespace incise::physics
