// What elements remember, through edits of the mesh: parts inherit it, copies of nodes share it,
// and a body built anew has the same.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::ChangeSet;
using topology::Mesh;
using topology::MeshEdit;

using Memory = std::vector<double>;

/// A body of elastic material and of both rules of viscosity, with a past.
struct BodyWithPast {
    MaterialTable table;
    Mesh mesh;
    Model model;
    double time = 0.0;

    explicit BodyWithPast(std::uint64_t seed)
        : table(materials()),
          mesh(Mesh::build(with_regions(test::jittered_cube(2, 0.2, 3), table.materials.size()))
                   .mesh),
          model(mesh, table) {
        test::Random random(seed);
        set_state(model, random_state(mesh, random, 0.03, 0.5));
        for (int i = 0; i < 20; ++i) step(model, time, 0.3 * model.stable_step());
        model.compute_forces(time);
    }
    static MaterialTable materials() {
        MaterialTable table;
        const auto add = [&](const std::vector<PronyTerm>& series, PronyRule rule) {
            table.of_region[static_cast<int>(table.materials.size())] = table.materials.size();
            table.materials.push_back(
                {1000.0, HyperElasticLinks{NeoHookean{1923.0, 5769.0}, 0.4, series, rule}});
        };
        add({}, PronyRule::stress);
        for (const PronyRule rule : {PronyRule::stress, PronyRule::nodal}) {
            add({{0.5, 0.1}}, rule);
            add({{0.3, 0.2}, {0.4, 5.0}}, rule);
        }
        return table;
    }
    Memory history() const {
        return {model.state().history().values().begin(), model.state().history().values().end()};
    }
    std::vector<Vec3> forces() {
        model.compute_forces(time);
        return {model.elastic_forces().begin(), model.elastic_forces().end()};
    }
};

double largest(const std::vector<Vec3>& forces) {
    double size = 0.0;
    for (const Vec3& f : forces) size = std::max(size, f.norm());
    return size;
}

// A node's memory goes to its copies with the elements that made it: none is lost, none doubled.
TEST(ViscousEdits, ShareTheMemoryAmongCopiesOfANode) {
    BodyWithPast body(3);
    const std::vector<Vec3> before = body.forces();
    MeshEdit edit(body.mesh);
    for (const CellId e : living_elements(body.mesh))
        for (int f = 0; f < body.mesh.num_faces(e); ++f)
            if (body.mesh.neighbor({e, f}).is_valid()) edit.open({e, f});
    const ChangeSet changes = edit.commit();
    ASSERT_GT(changes.nodes_added.size(), 50u);
    follow(body.model, changes);
    std::vector<Vec3> after = body.forces();
    for (auto record = changes.nodes_added.rbegin(); record != changes.nodes_added.rend(); ++record)
        after[record->sources[0].node.index()] += after[record->id.index()];
    for (std::size_t n = 0; n < before.size(); ++n)
        EXPECT_LE((after[n] - before[n]).norm(), 1e-13 * largest(before));
}

TEST(ViscousEdits, MatchFreshBodiesAndCanBeUndone) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        BodyWithPast body(seed);
        test::Random random(seed);
        for (int i = 0; i < 20 && body.mesh.num_elements() > 0; ++i) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", edit " << i);
            const std::vector<Vec3> before = body.forces();
            const Memory history = body.history();
            const ChangeSet changes = test::random_edit(body.mesh, random);
            const BodyEdit done = follow(body.model, changes);
            const std::vector<Vec3> after = body.forces();
            const Memory history_after = body.history();
            take_back(body.mesh, body.model, done);
            EXPECT_EQ(body.forces(), before);
            EXPECT_EQ(body.history(), history);
            replay(body.mesh, changes);
            body.model.apply(body.model.mesh(), changes);
            EXPECT_EQ(body.forces(), after);
            EXPECT_EQ(body.history(), history_after);

            Model fresh(body.mesh, body.model.fragments(), body.table);
            set_state(fresh, state_of(body.model));
            fresh.state().change().history.set_values(body.model.state().history().values());
            fresh.compute_forces(body.time);
            const double dt = 0.05 * std::min(body.model.stable_step(), 1.0);
            for (Model* model : {&body.model, &fresh}) {
                double time = body.time;
                for (int k = 0; k < 3; ++k) step(*model, time, dt);
                model->compute_forces(time);
            }
            EXPECT_EQ(state_of(body.model), state_of(fresh));
            EXPECT_TRUE(std::ranges::equal(body.model.elastic_forces(), fresh.elastic_forces()));
            for (const ElementId e : living_elements(body.model.fragments()))
                EXPECT_TRUE(std::ranges::equal(body.model.state().history().of(e),
                                               fresh.state().history().of(e)));
        }
    }
}

}  // namespace
}  // namespace incise::physics
