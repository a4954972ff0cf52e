// Random blades that cross each other in bodies at rest, as tests of contact and of the cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "support/mesh_families.h"

namespace incise::sim {

/// A body of some 5 cm that nothing loads, and blades that cross it at the same time.
class CutsAtRest {
  public:
    explicit CutsAtRest(std::uint64_t seed) : random_(seed), world_(body_of(seed)) {
        size_ = topology::mean_element_length(world_.mesh());
        const std::size_t num_blades = 2 + random_.below(3);
        for (std::size_t i = 0; i < num_blades; ++i) add_blade();
    }

    static constexpr int num_steps = 44;

    const StepReport& step(int i) {
        StepInputs inputs;
        for (Stroke& stroke : strokes_) {
            if (i == stroke.begin) world_.place_tool(stroke.tool, {stroke.rotation, stroke.from});
            if (i < stroke.begin || i >= stroke.end) continue;
            const double part = (i + 1.0 - stroke.begin) / (stroke.end - stroke.begin);
            inputs.move(stroke.tool,
                        {stroke.rotation, stroke.from + part * (stroke.to - stroke.from)});
            if (i + 1 == stroke.end) inputs.withdraw(stroke.tool);
        }
        return world_.step(0.8 * world_.stable_step(), inputs);
    }

    const World& world() const { return world_; }
    double size() const { return size_; }  ///< of an element, m
    const std::string& name() const { return name_; }

  private:
    struct Stroke {
        ToolId tool;
        int begin, end;
        Vec3 from, to;
        Eigen::Quaterniond rotation;
    };

    World body_of(std::uint64_t seed) {
        WorldDef def;
        topology::MeshData data;
        const auto& families = test::tetrahedral_families();
        const std::size_t which = seed % (families.size() + 3);
        if (which < families.size()) {
            name_ = families[which]->name;
            data = families[which]->data;
        } else {
            name_ = "box";
            const auto cells = [&] { return 2 + static_cast<int>(random_.below(4)); };
            const Vec3 sizes = Vec3::Constant(1.0) + random_.vector(0.4);
            const int x = cells(), y = cells(), z = cells();
            data =
                topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), sizes, {x, y, z});
        }
        for (const Vec3& x : data.points) box_.extend(x);
        const double scale = 0.05 / box_.sizes().maxCoeff();
        const Vec3 middle = box_.center();
        for (Vec3& x : data.points) x = scale * (x - middle);
        box_ = Box(scale * (box_.min() - middle), scale * (box_.max() - middle));
        def.mesh = std::move(data);
        using namespace physics;
        const std::vector<Law> laws = {NeoHookean{2000.0, 8000.0},
                                       StableNeoHookean::of_rest_moduli(8000.0, 2000.0),
                                       MooneyRivlin{1346.0, 577.0, 13462.0}};
        def.materials = {{1000.0, HyperElasticLinks{laws[random_.below(laws.size())]}}};
        def.contact.friction = random_.below(2) == 0 ? 0.0 : 0.4;
        return World(std::move(def));
    }

    void add_blade() {
        cutting::Blade blade;
        const Vec3 along = random_.vector(1.0).normalized();
        blade.edge = {-0.06 * along, 0.06 * along};
        if (random_.below(2) == 0) blade.snap = 0.0;
        const Vec3 ahead = along.cross(random_.vector(1.0)).normalized();
        const Vec3 through(random_.uniform(-0.25, 0.25) * box_.sizes().x(),
                           random_.uniform(-0.25, 0.25) * box_.sizes().y(),
                           random_.uniform(-0.25, 0.25) * box_.sizes().z());
        const int begin = static_cast<int>(random_.below(15));
        strokes_.push_back({world_.add_tool({"blade" + std::to_string(strokes_.size()), blade}),
                            begin, begin + 10 + static_cast<int>(random_.below(15)),
                            through - random_.uniform(0.02, 0.05) * ahead,
                            through + random_.uniform(0.0, 0.05) * ahead + random_.vector(0.01),
                            Eigen::Quaterniond::Identity()});
    }

    test::Random random_;
    std::string name_;
    Box box_;
    World world_;
    double size_ = 0.0;
    std::vector<Stroke> strokes_;
};

/// A cut that is made at rest leaves no overlap, whatever other cuts it crosses, and no force.
inline void expect_rest(std::uint64_t seed) {
    CutsAtRest program(seed);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << program.name());
    for (int i = 0; i < CutsAtRest::num_steps; ++i) {
        const StepReport& report = program.step(i);
        ASSERT_EQ(report.contact.num_points, 0u) << "in step " << i;
        ASSERT_LE(report.contact.max_penetration, 1e-10 * program.size()) << "in step " << i;
    }
    const physics::Totals totals = program.world().ledger().body_totals().totals;
    EXPECT_LT(totals.kinetic_energy, 1e-20);  // J; rounding leaves some 1e-31
}

}  // namespace incise::sim
