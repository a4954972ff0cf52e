// A step takes no memory once the body moves, and nothing is cut: this program counts what it asks
// the C library for. Not built for the sanitizers, which have their own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "incise/physics/elements/element_states.h"
#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"
#include "run_folder.h"

namespace {

std::atomic<std::size_t> num_allocations = 0;  // by malloc
std::atomic<std::size_t> num_news = 0;         // by operator new

void* counted(void* memory) {
    ++num_news;
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

// The C library's own: the search for the original would itself ask for memory.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

void* malloc(std::size_t size) {
    ++num_allocations;
    return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
    ++num_allocations;
    return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
    ++num_allocations;
    return __libc_realloc(memory, size);
}
}

// Those of arrays, and those that do not throw, call these.
void* operator new(std::size_t size) { return counted(std::malloc(size > 0 ? size : 1)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    ++num_allocations;
    const auto a = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(a, (std::max<std::size_t>(size, 1) + a - 1) / a * a));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace incise::runner {
namespace {

std::string cube(int cells, const std::string& element) {
    const std::string n = std::to_string(cells);
    return "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [" + n + ", " + n + ", " + n +
           "], element = \"" + element + "\" }\n";
}

/// Both of more than three blocks of elements, which is what several threads are woken for.
const std::string tetrahedra = cube(7, "tet"), hexahedra = cube(12, "hex");

std::string material(const std::string& more = "") {
    return "[[material]]\ndensity = 1000\nyoung = 1000\npoisson = 0.4\n" + more;
}

const std::string mass_springs =
    "[[material]]\nmethod = \"mass-spring\"\ndensity = 1000\nyoung = 1000\n";

const std::string prony =
    "prony = [{ alpha = 0.4, tau = 0.02 }, { alpha = 0.2, tau = 0.3 }]\nprony_rule = ";

const std::string boundary_conditions = three_loads + R"(
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[constraint]]
name = "lid"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 10, by = [0.005, 0, 0.02] }]
rotate = [{ time = 0, angle = 0 }, { time = 10, angle = 0.2 }]
about = { point = [0.05, 0.05, 0.1], axis = [0, 0, 1] }
[[load]]
where = { half_space = { point = [0, 0, 0], normal = [-1, 0, 0] } }
traction = [0, 10, 0]
[output]
interval = 0
)";

std::string motion(const std::string& precision) {
    return dynamics(100,
                    "gravity = [0, 0, -9.81]\ndamping = 2\nprecision = \"" + precision + "\"\n");
}

/// How often some steps ask for memory, after as many. Buffers of the search for contact grow when
/// the surface has first moved by a part of an element.
std::size_t allocations_of_steps(const std::string& text, int num_threads, int num_steps = 250,
                                 const std::atomic<std::size_t>& count = num_allocations) {
    Simulation simulation(scenario_of(text));
    simulation.set_num_threads(num_threads);
    simulation.start();
    for (int i = 0; i < num_steps; ++i) simulation.step();
    const std::size_t before = count;
    for (int i = 0; i < num_steps; ++i) simulation.step();
    return count - before;
}

struct Body {
    const char* name;
    std::string text;
};

/// For bodies that fold so far that their surface touches itself: the search takes memory then.
const std::string no_contact = "[contact]\nenabled = false\n";

const Body bodies[] = {
    {"neo-Hookean", tetrahedra + material()},
    {"another law", tetrahedra + no_contact + material("law = \"saint-venant-kirchhoff\"\n")},
    {"viscous by stress", tetrahedra + material(prony + "\"stress\"\n")},
    {"viscous by node", tetrahedra + material(prony + "\"nodal\"\n")},
    {"HybMSS", hexahedra + no_contact + material("method = \"hybmss\"\n")},
    {"mass springs", tetrahedra + no_contact + mass_springs},
};

TEST(SteadyState, AllocatesNothing) {
    for (const auto& [name, body] : bodies)
        for (const char* precision : {"double", "single"}) {
            if (body.ends_with(mass_springs) && precision == std::string("single")) continue;
            SCOPED_TRACE(testing::Message() << name << " in " << precision);
            EXPECT_EQ(allocations_of_steps(body + boundary_conditions + motion(precision), 1), 0u);
        }
}

// A thread has a buffer for positions, two for the stable step, and one more for positions before
// if the body is viscous. It takes them when it first gets work: it may come to that in any step.
// TBB takes memory of its own, not by operator new, for tasks that go to the other thread.
TEST(SteadyState, AllocatesOnlyTheSecondThreadsBuffers) {
    for (const auto& [name, body] : bodies) {
        SCOPED_TRACE(name);
        const bool is_viscous = body.find("prony") != std::string::npos;
        EXPECT_LE(
            allocations_of_steps(body + boundary_conditions + motion("double"), 2, 250, num_news),
            is_viscous ? 4u : 3u);
    }
}

// Which block a thread gets first is chance: a small one must not cost memory again later.
TEST(SteadyState, AllocatesABufferOnceWhateverBlockComesFirst) {
    std::size_t first = 0, later = 0;
    std::thread([&] {
        const auto count = [](std::size_t num_groups) {
            const std::size_t before = num_news;
            (void)physics::room_for<physics::ElementEnergies>(num_groups);
            return num_news - before;
        };
        first = count(1);
        later = count(physics::most_elements_of_block / physics::elements_together);
    }).join();
    EXPECT_EQ(first, 1u);
    EXPECT_EQ(later, 0u);
}

TEST(SteadyState, OfSolvedStepsAllocatesNothing) {
    const std::string modes[] = {
        dynamics(100, "integrator = \"implicit-euler\"\ntime_step = 0.01\ndamping = 2\n"),
        dynamics(100, "mode = \"static\"\nsteps = 1000\n")};
    constexpr int num_steps = 5;
    for (const auto& [name, text] : bodies)
        for (const std::string& mode : modes) {
            std::string body = text;  // smaller, as factors are dear
            if (body.starts_with(hexahedra)) body.replace(0, hexahedra.size(), cube(4, "hex"));
            if (body.starts_with(tetrahedra)) body.replace(0, tetrahedra.size(), cube(6, "tet"));
            SCOPED_TRACE(testing::Message() << name << " in " << mode);
            // A list of free buffers grows where a tangent is refused for the first time.
            EXPECT_LE(allocations_of_steps(body + boundary_conditions + mode, 1, num_steps), 1u);
        }
}

const char* const tools_away = R"(
[[tool]]
kind = "blade"
name = "scalpel"
edge = [[0, -1, 1.05], [0, 0.03, 1.053], [0, 0.2, 1.058]]
path = [{ time = 0, at = [-0.02, 0, 0] }, { time = 1000, at = [0.2, 0, 0] }]
[[tool]]
kind = "blade"
name = "spatula"
mode = "separate"
edge = [[0, -1, 1.05], [0, 0.2, 1.05]]
path = [{ time = 0, at = [-0.02, 0, 0] }, { time = 1000, at = [0.2, 0, 0] }]
[[tool]]
kind = "carver"
name = "burr"
shape = { sphere = { radius = 0.01 } }
path = [{ time = 0, at = [0.05, 0.05, 0.2] }, { time = 1000, at = [0.06, 0.05, 0.2] }]
)";

TEST(SteadyState, AllocatesNothingForToolsAway) {
    EXPECT_EQ(allocations_of_steps(
                  tetrahedra + material() + tools_away + boundary_conditions + motion("double"), 1),
              0u);
}

/// Returns the bytes that the program holds.
std::size_t num_bytes() {
    const auto of_heap = mallinfo2();
    return of_heap.uordblks + of_heap.hblkhd;
}

TEST(Memory, OfTetrahedraIsFewBytesAnElement) {
    const std::size_t before = num_bytes();
    sim::WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(),
                                  {20, 20, 20});
    def.materials = {{.density = 1000.0,
                      .method = physics::HyperElasticLinks{physics::NeoHookean{1000.0, 20000.0}}}};
    def.contact.enabled = false;
    sim::World world(std::move(def));
    world.step(world.stable_step());
    const auto taken = static_cast<double>(num_bytes() - before);
    // docs/measurements/memory.md: 450 bytes, and more for the nodes of the surface of small
    // bodies.
    EXPECT_LT(taken / static_cast<double>(world.mesh().num_elements()), 475.0);
}

}  // namespace
}  // namespace incise::runner
