// The promise on which all else rests: a model that has followed an edit is, to the bit, the model
// built afresh on the edited mesh; and an edit keeps what it has to keep.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <string_view>

#include "incise/base/error.h"
#include "incise/fragments/validate.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"
#include "tests/physics/balance.h"
#include "tests/physics/descent.h"
#include "tests/physics/model_snapshot.h"

namespace incise::physics {
namespace {

using test::MeshSnapshot;
using topology::ChangeSet;
using topology::Mesh;

const std::vector<std::string> no_violations;

/// Everything that acts in these tests but loads on nodes, whose division among copies a fresh
/// model cannot know (constraints_loads_test.cpp has them; so has UndoneLeaveTheMotionAsItWas
/// below).
BoundaryConditions boundary_conditions(const Selections& selected) {
    BoundaryConditions s;
    s.gravity = {0.3, 0.2, -9.81};
    s.damping = 2.0;
    const Constraint held = holding("held", VertexSet(selected.held));
    Constraint moved = holding("moved", VertexSet(selected.moved), {false, true, true});
    moved.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.1, 0.2, 0.3)}});
    moved.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, 0.5}});
    s.constraints = {held, moved};
    s.loads = {{"traction", TractionLoad{selected.loaded_faces, {1.0, 2.0, 3.0}}, {}},
               {"pressure", PressureLoad{selected.loaded_faces, 5.0}, {}},
               {"body force", BodyLoad{selected.loaded_elements, {0.0, 4.0, 0.0}}, {}}};
    return s;
}

/// A body that is edited at random while it moves, and checked after each edit. Every other one has
/// forces in single precision.
class EditedBody {
  public:
    EditedBody(const topology::MeshData& data, std::uint64_t seed)
        : table_(table_for(
              data, seed % 2 == 0 ? Precision::single_precision : Precision::double_precision)),
          mesh_(Mesh::build(with_regions(data, table_.materials.size(), seed)).mesh),
          selections_(selections(mesh_)),
          descent_(mesh_, selections_),
          model_(mesh_, table_, boundary_conditions(selections_)),
          random_(seed) {
        shake();
    }

    bool is_used_up() const { return mesh_.num_elements() == 0; }

    /// Strains the body as a whole, shakes the nodes it had at first and puts those on constraints
    /// where these want them. Later nodes lie by their sources, shaken but little: so the strain of
    /// parts is that of the first elements, however small they are.
    void shake() {
        const fragments::FragmentMesh& fragments = model_.fragments();
        BodyState state = random_state(fragments, random_, 0.02, 1.0);
        put_on_constraints(model_, time, state);
        const double room = shortest_edge();
        for (const auto& record : nodes_born_) {
            Vec3 x = random_.vector(0.01 * room);
            for (int s = 0; s < record.num_sources; ++s) {
                const auto& source = record.sources[static_cast<std::size_t>(s)];
                x += source.weight * state.positions[source.node.index()];
            }
            state.positions[record.id.index()] = x;
        }
        set_state(model_, state, time);
    }

    /// An edit that changes something: of nothing there is nothing to check. Not of a used up body.
    void edit_and_check() {
        const Balance before(model_);
        std::vector<Carried> carried(mesh_.element_capacity());
        for (const CellId e : living_elements(mesh_)) carried[e.index()] = carried_by(model_, e);
        const MeshSnapshot mesh_before(mesh_);
        const ModelSnapshot model_before(model_, time);

        edit_and_take_back();
        ChangeSet changes = test::random_edit(mesh_, random_);
        while (changes.is_empty()) changes = test::random_edit(mesh_, random_);
        ASSERT_EQ(topology::validate(mesh_), no_violations);
        compute_ahead();
        const BodyEdit done = follow(model_, changes);
        ASSERT_EQ(fragments::validate(model_.fragments(), mesh_), no_violations);
        expect_balance(before, model_, done, carried);
        const MeshSnapshot mesh_after(mesh_);
        const ModelSnapshot model_after(model_, time);

        take_back(mesh_, model_, done);
        EXPECT_EQ(MeshSnapshot(mesh_), mesh_before);
        expect_equal(ModelSnapshot(model_, time), model_before);
        replay(mesh_, changes);
        model_.apply(model_.mesh(), changes);
        EXPECT_EQ(MeshSnapshot(mesh_), mesh_after);
        expect_equal(ModelSnapshot(model_, time), model_after);

        descent_.follow(changes);
        const auto& born = done.physics.mesh.nodes_added;
        nodes_born_.insert(nodes_born_.end(), born.begin(), born.end());
        expect_equal_to_a_fresh_model(model_after);
    }

  private:
    /// As a run does, which has not looked at the body as it is.
    void compute_ahead() {
        model_.state().change().history.set_values(
            model_.state().history().values());  // nothing is known any more
        model_.compute_totals_and_forces();
    }

    // So that the ids of the next edit have been others' before.
    void edit_and_take_back() {
        const BodyEdit done = follow(model_, test::random_edit(mesh_, random_));
        compute_ahead();
        take_back(mesh_, model_, done);
    }

    // Also after a step, in which constraints and loads show, and which lets copies part.
    void expect_equal_to_a_fresh_model(const ModelSnapshot& expected) {
        MaterialTable table = table_;
        table.fibres = expected.fibres;
        Model fresh(mesh_, model_.fragments(), table, boundary_conditions(descent_.now(mesh_)));
        set_state(fresh, expected.state, time);
        fresh.state().change().history.set_values(expected.history);
        expect_equal(ModelSnapshot(fresh, time), expected);
        const double dt = short_step();
        ExplicitStep().move(model_, time, dt);
        ExplicitStep().move(fresh, time, dt);
        expect_equal(ModelSnapshot(model_, time + dt), ModelSnapshot(fresh, time + dt));
        EXPECT_EQ(model_.energetics().min_volume_ratio(), fresh.energetics().min_volume_ratio());
        for (std::size_t i = 0; i < model_.boundary().constraints().size(); ++i)
            EXPECT_EQ(model_.boundary().reactions()[i].force,
                      fresh.boundary().reactions()[i].force);
    }

    /// So short that no node leaves the body, however stiff the strain has made its law.
    double short_step() const {
        double fastest = 0.0;  // m/s2
        for (const NodeId n : model_.fragments().nodes())
            fastest = std::max(
                fastest, model_.elastic_forces()[n.index()].norm() / model_.masses()[n.index()]);
        return std::min(0.05 * std::min(model_.stable_step(), 1.0), std::sqrt(1e-4 / fastest));
    }

    double shortest_edge() const {
        double shortest = std::numeric_limits<double>::infinity();
        for (const CellId e : living_elements(mesh_))
            for (const VertexId a : mesh_.corners(e))
                for (const VertexId b : mesh_.corners(e))
                    if (a < b)
                        shortest = std::min(
                            shortest, (mesh_.rest_position(a) - mesh_.rest_position(b)).norm());
        return shortest;
    }

    static constexpr double time = 0.3;
    MaterialTable table_;
    Mesh mesh_;
    Selections selections_;  // of the first mesh
    Descent descent_;
    Model model_;
    std::vector<fragments::NodeRecord> nodes_born_;
    test::Random random_;
};

struct EditProgram {
    std::string_view family;
    int num_edits;
};
void PrintTo(const EditProgram& program, std::ostream* out) {
    *out << program.num_edits << " edits of " << program.family;
}

constexpr EditProgram edit_programs[] = {
    {"one tetrahedron", 200}, {"two by a face", 900}, {"two by an edge", 600}, {"cube", 1700},
    {"ring", 1700},           {"ball", 1700},         {"organ", 200}};
constexpr EditProgram hexahedral_edit_programs[] = {{"hexahedra", 1500}, {"voxels", 1500}};
// Of the joined one few: later ones would bisect edges at polyhedra, which random_edit() does not
// see while faces there are open.
constexpr EditProgram mixed_edit_programs[] = {{"mixed", 300}, {"joined", 10}};

constexpr int total_edits(const auto& programs) {
    return std::accumulate(std::begin(programs), std::end(programs), 0,
                           [](int sum, const EditProgram& p) { return sum + p.num_edits; });
}
static_assert(total_edits(edit_programs) + total_edits(hexahedral_edit_programs) >= 10'000,
              "edits, each of which changes something");

class RandomEdits : public testing::TestWithParam<EditProgram> {};

TEST_P(RandomEdits, MatchFreshModelsAndCanBeUndone) {
    const std::string name(GetParam().family);
    const int num_edits = test::is_sanitized ? GetParam().num_edits / 50 : GetParam().num_edits;
    for (const auto& of_all : test::mesh_families()) {
        const auto* family = &of_all;
        if (family->name != name) continue;
        auto body = std::make_unique<EditedBody>(family->data, 1);
        int num_bodies = 1;
        for (int i = 0; i < num_edits; ++i) {
            SCOPED_TRACE("edit " + std::to_string(i) + " of " + name);
            if (body->is_used_up() || i % 100 == 99) {
                body = std::make_unique<EditedBody>(family->data,
                                                    static_cast<std::uint64_t>(++num_bodies));
            }
            if (i % 10 == 0) body->shake();
            body->edit_and_check();
            if (HasFailure()) return;
        }
        return;
    }
    FAIL() << "no family " << name;
}

std::string name_of(const testing::TestParamInfo<EditProgram>& program) {
    std::string name(program.param.family);
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}
INSTANTIATE_TEST_SUITE_P(OfTetrahedra, RandomEdits, testing::ValuesIn(edit_programs), name_of);
INSTANTIATE_TEST_SUITE_P(OfHexahedra, RandomEdits, testing::ValuesIn(hexahedral_edit_programs),
                         name_of);
INSTANTIATE_TEST_SUITE_P(OfMixtures, RandomEdits, testing::ValuesIn(mixed_edit_programs), name_of);

TEST(RandomEdits, OnEveryFamilyAreTested) {
    if (test::is_sanitized) GTEST_SKIP() << "the lists hold the smaller families only";
    EXPECT_EQ(test::tetrahedral_families().size(), std::size(edit_programs));
    EXPECT_EQ(test::families_of(topology::CellKind::hexahedron).size(),
              std::size(hexahedral_edit_programs));
    EXPECT_EQ(test::mesh_families().size(), std::size(edit_programs) +
                                                std::size(hexahedral_edit_programs) +
                                                std::size(mixed_edit_programs));
}

// Many edits in a row, undone in reverse: constraints, loads on nodes and all else are back, so
// that the body moves on as if nothing had been.
TEST(RandomEdits, UndoneLeaveTheMotionAsItWas) {
    auto families = test::tetrahedral_families();
    for (const auto* family : test::families_of(topology::CellKind::hexahedron))
        families.push_back(family);
    for (const auto* family : families) {
        SCOPED_TRACE(family->name);
        const auto table = table_for(family->data);
        const auto data = with_regions(family->data, table.materials.size());
        Mesh mesh = Mesh::build(data).mesh;
        const Mesh untouched = Mesh::build(data).mesh;
        BoundaryConditions all = boundary_conditions(selections(mesh));
        std::vector<VertexId> loaded = nodes_where(mesh, [](const Vec3& x) { return x.z() > 0.5; });
        all.loads.push_back({"nodes", NodalLoad{VertexSet(loaded), {1.0, -2.0, 3.0}, {}}, {}});
        Model model(mesh, table, all), reference(untouched, table, all);
        test::Random random(5);
        const BodyState state = random_state(mesh, random, 0.0, 0.1);

        std::vector<BodyEdit> history;
        for (int i = 0; i < 40 && mesh.num_elements() > 0; ++i)
            history.push_back(follow(model, test::random_edit(mesh, random)));
        for (; !history.empty(); history.pop_back()) take_back(mesh, model, history.back());
        set_state(model, state);
        set_state(reference, state);
        const double dt = 0.2 * reference.stable_step();
        double time = 0.0, time_of_reference = 0.0;
        for (int i = 0; i < 20; ++i) {
            step(model, time, dt);
            step(reference, time_of_reference, dt);
        }
        expect_equal(ModelSnapshot(model, time), ModelSnapshot(reference, time));
        for (std::size_t i = 0; i < model.boundary().constraints().size(); ++i)
            EXPECT_EQ(model.boundary().reactions()[i].force,
                      reference.boundary().reactions()[i].force);
    }
}

// The mesh alone, of all kinds of cells.
TEST(RandomEdits, OfOtherCellsAreSoundAndReversible) {
    for (const char* name : {"mixed"}) {
        const auto& families = test::mesh_families();
        const auto family = std::find_if(families.begin(), families.end(),
                                         [&](const auto& f) { return f.name == name; });
        ASSERT_NE(family, families.end());
        test::Random random(21);
        Mesh mesh = Mesh::build(family->data).mesh;
        for (int i = 0; i < 1000; ++i) {
            SCOPED_TRACE("edit " + std::to_string(i) + " of " + name);
            if (mesh.num_elements() == 0) mesh = Mesh::build(family->data).mesh;
            const MeshSnapshot before(mesh);
            const ChangeSet changes = test::random_edit(mesh, random);
            ASSERT_EQ(topology::validate(mesh), no_violations);
            const MeshSnapshot after(mesh);
            replay(mesh, inverse(changes));
            ASSERT_EQ(topology::validate(mesh), no_violations);
            ASSERT_EQ(MeshSnapshot(mesh), before);
            replay(mesh, changes);
            ASSERT_EQ(MeshSnapshot(mesh), after);
        }
    }
}

TEST(ModelApply, RefusesAnEditOutOfTurn) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    Model model(mesh, table_of_one_law(NeoHookean{1e3, 1e3}));
    const ModelSnapshot before(model, 0.0);
    const auto remove = [&](std::size_t e) {
        topology::MeshEdit edit(mesh);
        edit.remove(CellId(e));
        return edit.commit();
    };
    const ChangeSet first = remove(0), second = remove(1);
    EXPECT_THROW(model.apply(model.mesh(), second), InputError);  // the first is missing
    EXPECT_THROW(model.apply(model.mesh(), first), InputError);   // the mesh is further on
    replay(mesh, inverse(second));
    const BodyEdit done = follow(model, first);
    EXPECT_THROW(model.apply(model.mesh(), first), InputError);  // a second time
    EXPECT_THROW(model.apply(mesh, inverse(done)), InputError);  // the mesh has not gone back
    replay(mesh, inverse(first));
    EXPECT_THROW(model.apply(mesh, inverse(first)), InputError);  // a BodyEdit is for that
    model.apply(mesh, inverse(done));
    expect_equal(ModelSnapshot(model, 0.0), before);
}

TEST(ModelApply, LeavesEmptyEditsAlone) {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 1)).mesh;
    Model model(mesh, table_of_one_law(NeoHookean{1e3, 1e3}));
    const ModelSnapshot before(model, 0.0);
    topology::MeshEdit edit(mesh);
    const ChangeSet nothing = edit.commit();
    model.apply(model.mesh(), nothing);
    model.apply(model.mesh(), nothing);
    expect_equal(ModelSnapshot(model, 0.0), before);
}

// Opens all inner faces whose nodes lie at x at rest.
ChangeSet open_plane(Mesh& mesh, double x) {
    topology::MeshEdit edit(mesh);
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            bool is_chosen = mesh.neighbor({e, f}).is_valid();
            for (int p = 0; p < mesh.face_size({e, f}); ++p)
                is_chosen &= mesh.rest_position(mesh.face_corner({e, f}, p)).x() == x;
            if (is_chosen) edit.open({e, f});
        }
    return edit.commit();
}

// Two halves of a bar that have moved apart, and move, are joined again.
TEST(ModelApply, JoiningKeepsMassMomentumAndCentreOfMass) {
    Mesh mesh = Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                               {2, 1, 1}, {4, 2, 2}))
                    .mesh;
    const auto table = table_of_one_law(NeoHookean{1e3, 1e3});
    Model model(mesh, table);
    const ChangeSet opened = open_plane(mesh, 1.0);
    model.apply(model.mesh(), opened);
    ASSERT_EQ(topology::components(mesh).count, 2);
    const auto pieces = topology::components(mesh).of_element;
    BodyState state = rest_state(mesh);
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
        const int piece = pieces[mesh.incident_element(VertexId(n)).index()];
        state.positions[n] += (piece == 0 ? 1.0 : -2.0) * Vec3(0.1, 0.02, 0.03);
        state.velocities[n] = (piece == 0 ? 1.0 : -0.5) * Vec3(1.0, 2.0, -1.0);
    }
    set_state(model, state);

    const auto moment_of_mass = [&] {
        Vec3 sum = Vec3::Zero();
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            sum += model.masses()[n] * model.positions()[n];
        return sum;
    };
    const Balance before(model);
    const Vec3 moment_before = moment_of_mass();
    topology::MeshEdit edit(mesh);
    for (const auto& pair : opened.faces_opened) edit.close(pair.a, pair.b);
    model.apply(model.mesh(), edit.commit());
    ASSERT_EQ(topology::components(mesh).count, 1);
    const Totals after = model.energetics().totals();
    EXPECT_NEAR(after.mass, before.totals.mass, round_off * after.mass);
    EXPECT_LE((after.momentum - before.totals.momentum).norm(), round_off * before.momentum_scale);
    EXPECT_LE((moment_of_mass() - moment_before).norm(), round_off * after.mass * 3.0);
    EXPECT_LT(after.kinetic_energy, before.totals.kinetic_energy);  // an inelastic collision
}

}  // namespace
}  // namespace incise::physics
