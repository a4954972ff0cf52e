// Measurement of how fast this machine computes forces, steps and edits, on generated meshes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/bench/contact_speed.h"

namespace incise::bench {

/// The machine and its limits.
struct MachineSpeed {
    std::string processor;          ///< as the system names it
    std::string_view instructions;  ///< those of the fast kernels: plain, avx2, avx512
    int num_cores = 0;
    /// The limits of several threads together.
    struct Limit {
        double gigaflops = 0.0;             ///< additions and multiplications of doubles, fused
        double gigabytes_per_second = 0.0;  ///< read from memory, 256 MiB
    };
    std::map<int, Limit> limits;  ///< by number of threads
};

/// The speed of steps for one body and one number of threads. Times are the best of many, in
/// nanoseconds per element.
struct StepRate {
    std::string_view method, law;  ///< as in scenarios; no law for hybmss
    std::size_t elements = 0;
    int num_threads = 1;
    double forces = 0.0;                    ///< one evaluation of elastic forces
    double step = 0.0;                      ///< forces and integration
    double single_forces = 0.0;             ///< `forces` in single precision
    double single_step = 0.0;               ///< `step` in single precision
    std::optional<double> reference;        ///< forces by the reference kernels, one thread
    std::optional<double> reference_ratio;  ///< a step with the reference kernels over `step`
    /// The arithmetic of forces alone, one thread: measure_arithmetic().
    std::optional<double> arithmetic;
    double steps_per_second = 0.0;
    double real_time_factor = 0.0;      ///< simulated over wall time at 0.9 of the stable step
    double gigaflops = 0.0;             ///< of `forces`
    double gigabytes_per_second = 0.0;  ///< data of the elements that `forces` reads
    /// `gigaflops` and `gigabytes_per_second` over the limits of as many threads.
    double share_of_peak = 0.0, share_of_bandwidth = 0.0;
};

/// The time of edits, with the search for their elements and the updates of body and boxes. It is
/// the processor time per item in microseconds, the best of three passes, each on a new body.
struct EditRate {
    std::string_view method;   ///< heml: of tetrahedra; hybmss: of hexahedra, without split
    std::string_view kind;     ///< split, separate, carve; or remove, which needs no search
    std::string_view item;     ///< element crossed, face opened, element removed
    std::size_t elements = 0;  ///< of the body
    std::size_t items = 0;
    double microseconds = 0.0;
};

/// The time of one evaluation of forces on one thread, in ns per living element: before edits,
/// after edits, and of a body built anew from the edited mesh. The last two differ by the disorder
/// that edits leave in memory. Removing elements at random leaves more nodes per element, since
/// nodes are divided where elements no longer share faces.
struct EditedRate {
    std::string_view method;
    std::string_view edits;  ///< "half removed": each element with probability 1/2; "split"
    std::size_t elements_before = 0, elements = 0;
    std::size_t nodes_before = 0, nodes = 0;
    double forces_before = 0.0, forces = 0.0, forces_built_anew = 0.0;
};

/// All results of a measurement.
struct Throughput {
    MachineSpeed machine;
    std::string_view tissue;  ///< gives the stiffness of the bodies, which are cubes of 10 cm
    std::vector<StepRate> steps;
    std::vector<EditRate> edits;
    std::vector<EditedRate> edited;
    std::vector<ContactRate> contact;
};

/// The plan of a measurement. Bodies have about the given numbers of elements.
struct ThroughputPlan {
    std::vector<std::size_t> tetrahedra = {5'000, 20'000, 100'000, 500'000};
    std::vector<std::size_t> hexahedra = {1'000, 27'000, 125'000};
    std::vector<std::size_t> edited_tetrahedra = tetrahedra, edited_hexahedra = hexahedra;
    std::vector<std::size_t> touching_tetrahedra = {20'000};
    double seconds = 0.3;  ///< minimum time for each figure
    int num_threads = 0;   ///< measured besides one thread; 0: the number of cores
};

/// Measures by the plan. `report` is called before each part, with the share of the work that is
/// done, 0 to 1, and the name of the part.
Throughput measure_throughput(const ThroughputPlan& plan,
                              const std::function<void(double, const std::string&)>& report);

}  // namespace incise::bench
