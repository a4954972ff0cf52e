// What a block asks of its kernel: the members that some kernels have.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/types.h"
#include "incise/physics/elements/element_result.h"
#include "incise/physics/elements/local_nodes.h"

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

/// A kernel of whose elements a block stores only a part, `Kernel::Stored`: the others of their
/// values follow from the corners at rest.
template <class Kernel>
concept IsRestored = requires {
    typename Kernel::Stored;
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

}  // namespace incise::physics
