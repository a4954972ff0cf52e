// How fast this machine computes forces, steps and edits, on meshes made for it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise::bench {

/// What the machine itself can do.
struct MachineSpeed {
    std::string processor;          ///< as the system names it
    std::string_view instructions;  ///< what the fast kernels use of it: plain, avx2, avx512
    int num_cores = 0;
    /// Of so many threads together, by their number.
    struct Limit {
        double gigaflops = 0.0;             ///< additions and multiplications of doubles, fused
        double gigabytes_per_second = 0.0;  ///< read from memory, 256 MiB
    };
    std::map<int, Limit> limits;
};

/// One body and one number of threads. Times are the best of many, nanoseconds an element.
struct StepRate {
    std::string_view method, law;  ///< as in scenarios; no law for hybmss
    std::size_t elements = 0;
    int num_threads = 1;
    double forces = 0.0;         ///< one evaluation of elastic forces
    double step = 0.0;           ///< forces and integration
    double single_forces = 0.0;  ///< both in single precision
    double single_step = 0.0;
    std::optional<double> reference;        ///< forces by the plain formulas, one thread
    std::optional<double> reference_ratio;  ///< a step with those over a step
    /// Of forces the arithmetic by itself, one thread: physics::measure_arithmetic.
    std::optional<double> arithmetic;
    double steps_per_second = 0.0;
    double real_time_factor = 0.0;      ///< simulated over wall time at the automatic step
    double gigaflops = 0.0;             ///< of the forces
    double gigabytes_per_second = 0.0;  ///< that the elements' own data take, of the forces
    /// These over the limits of as many threads.
    double share_of_peak = 0.0, share_of_bandwidth = 0.0;
};

/// An edit with the search for what it takes, and body and boxes following: microseconds of one
/// thread for each item, the best of some passes through bodies that are new.
struct EditRate {
    std::string_view method;   ///< heml: of tetrahedra; hybmss: of hexahedra, which nothing splits
    std::string_view kind;     ///< split, separate, carve; or remove, where nothing is searched for
    std::string_view item;     ///< element crossed, face opened, element removed
    std::size_t elements = 0;  ///< of the body
    std::size_t items = 0;
    double microseconds = 0.0;
};

/// One evaluation of forces of a body before edits, after them, and of a body built anew as it is
/// then; on one thread, ns per element that is there. The last two differ by what the edits have
/// left of disorder. Where elements are removed at random there are more nodes to each: those that
/// share no face any more share no node.
struct EditedRate {
    std::string_view method;
    std::string_view edits;  ///< "half removed": each element with a chance of one half; "split"
    std::size_t elements_before = 0, elements = 0;
    std::size_t nodes_before = 0, nodes = 0;
    double forces_before = 0.0, forces = 0.0, forces_built_anew = 0.0;
};

struct Throughput {
    MachineSpeed machine;
    std::string_view tissue;  ///< the stiffness of the bodies; cubes of 10 cm
    std::vector<StepRate> steps;
    std::vector<EditRate> edits;
    std::vector<EditedRate> edited;
};

/// What to measure; numbers of elements are met approximately.
struct ThroughputPlan {
    std::vector<std::size_t> tetrahedra = {5'000, 20'000, 100'000, 500'000};
    std::vector<std::size_t> hexahedra = {1'000, 27'000, 125'000};
    std::vector<std::size_t> edited_tetrahedra = tetrahedra, edited_hexahedra = hexahedra;
    double seconds = 0.3;  ///< for each figure, at least
    int num_threads = 0;   ///< besides one thread; 0: as many as there are cores
};

/// @param tell  called before each part with its share of the work, 0 to 1, and its name
Throughput measure_throughput(const ThroughputPlan& plan,
                              const std::function<void(double, const std::string&)>& tell);

}  // namespace incise::bench
