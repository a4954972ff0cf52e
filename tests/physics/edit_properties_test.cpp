// Generated programs of edits on generated bodies: what must hold whatever they are. Bodies are
// small and edits simple, so that a program that fails can be shrunk to a few words; edges are
// divided anywhere, edits given up half-way, undone and made again in any order; nodes are held,
// moved and loaded, faces and regions loaded.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <optional>
#include <ostream>

#include "incise/base/error.h"
#include "incise/fragments/validate.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/generated_body.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"
#include "tests/physics/balance.h"
#include "tests/physics/generated_boundary_conditions.h"
#include "tests/physics/model_snapshot.h"

namespace incise::physics {
namespace {

using test::GeneratedBody;
using test::MeshSnapshot;
using topology::ChangeSet;
using topology::FacePair;
using topology::Mesh;
using topology::MeshEdit;

enum class Act { remove, open, close, divide };

/// Numbers that choose among what is there at the time, counted on past the last.
struct Operation {
    Act act;
    std::size_t which;
    std::size_t edge;  ///< to be divided
    int eighths;       ///< along it
};

enum class Fate { commit, abandon, undo, redo };

struct Step {
    Fate fate;
    std::vector<Operation> operations;  ///< of an edit; undone and made again is one as a whole
};

struct Program {
    GeneratedBody body;
    std::vector<Step> steps;
};

std::ostream& operator<<(std::ostream& out, const Operation& operation) {
    switch (operation.act) {
        case Act::remove:
            return out << "remove element " << operation.which;
        case Act::open:
            return out << "open inner face " << operation.which;
        case Act::close:
            return out << "close open pair " << operation.which;
        case Act::divide:
            return out << "divide element " << operation.which << " at " << operation.eighths
                       << "/8 of edge " << operation.edge;
    }
    return out;
}

std::ostream& operator<<(std::ostream& out, const Step& step) {
    if (step.fate == Fate::undo) return out << "undo the last edit";
    if (step.fate == Fate::redo) return out << "make the last edit undone again";
    out << (step.fate == Fate::commit ? "edit:" : "edit that is given up:");
    for (const Operation& operation : step.operations) out << ' ' << operation << ';';
    return out;
}

void print_steps(std::ostream& out, const std::vector<Step>& steps) {
    for (std::size_t i = 0; i < steps.size(); ++i) out << "\n  " << i + 1 << ". " << steps[i];
}

std::ostream& operator<<(std::ostream& out, const Program& program) {
    out << program.body;
    print_steps(out, program.steps);
    return out;
}

rc::Gen<Program> programs(const std::vector<const test::MeshFamily*>& families) {
    using rc::gen::inRange;
    const auto operations = rc::gen::apply(
        [](int act, std::size_t which, std::size_t edge, int eighths) {
            return Operation{static_cast<Act>(act), which, edge, eighths};
        },
        inRange(0, 4), inRange<std::size_t>(0, 100), inRange<std::size_t>(0, 6), inRange(2, 7));
    const auto steps = rc::gen::apply(
        [](int fate, std::vector<Operation> of_edit) {
            // Most are carried out.
            return Step{static_cast<Fate>(std::max(fate - 5, 0)), std::move(of_edit)};
        },
        inRange(0, 9), test::up_to(6, operations));
    return rc::gen::apply(
        [](GeneratedBody body, std::vector<Step> all) {
            return Program{std::move(body), std::move(all)};
        },
        test::generated_bodies(families, 24), test::up_to(12, steps));
}

template <class T>
const T* chosen(const std::vector<T>& from, std::size_t which) {
    return from.empty() ? nullptr : &from[which % from.size()];
}

/// Whether all elements are tetrahedra at the corners of this one.
bool is_among_tetrahedra(const Mesh& mesh, CellId e) {
    const auto corners = mesh.corners(e);
    return std::all_of(corners.begin(), corners.end(), [&](VertexId n) {
        std::vector<CellId> star;
        mesh.star(n, star);
        return std::all_of(star.begin(), star.end(), [&](CellId other) {
            return mesh.kind(other) == topology::CellKind::tetrahedron;
        });
    });
}

/// What there is nothing of is left out.
void carry_out(const Operation& operation, const Mesh& mesh, MeshEdit& edit,
               std::size_t num_old_elements) {
    const auto is_old = [&](CellId e) { return e.index() < num_old_elements; };
    std::vector<CellId> elements = living_elements(mesh);
    switch (operation.act) {
        case Act::remove: {
            std::erase_if(elements, [&](CellId e) { return !is_old(e); });
            if (const auto* e = chosen(elements, operation.which)) edit.remove(*e);
            return;
        }
        case Act::open: {
            const auto faces = test::inner_faces(mesh);
            if (const auto* f = chosen(faces, operation.which)) edit.open(*f);
            return;
        }
        case Act::close: {
            auto pairs = test::open_pairs(mesh);
            std::erase_if(pairs, [&](const FacePair& pair) {
                return !is_old(pair.a.cell) || !is_old(pair.b.cell) || pair.a.cell == pair.b.cell;
            });
            if (const auto* pair = chosen(pairs, operation.which)) edit.close(pair->a, pair->b);
            return;
        }
        case Act::divide: {
            std::erase_if(elements, [&](CellId e) { return !is_among_tetrahedra(mesh, e); });
            const auto* e = chosen(elements, operation.which);
            if (!e) return;
            const auto [a, b] = topology::traits(mesh.kind(*e)).edges[operation.edge];
            const auto corner = [&](int k) {
                return mesh.corners(*e)[static_cast<std::size_t>(k)];
            };
            const VertexId from = corner(a), to = corner(b);
            edit.bisect(*e, from, to, operation.eighths / 8.0);
            return;
        }
    }
}

/// A mesh, and what it was before each of its edits.
class EditedMesh {
  public:
    explicit EditedMesh(const topology::MeshData& data) : mesh_(Mesh::build(data).mesh) {}

    const Mesh& mesh() const { return mesh_; }

    /// What the step did; nothing if the mesh is as it was.
    std::optional<ChangeSet> carry_out(const Step& step) {
        std::optional<ChangeSet> done;
        const MeshSnapshot before(mesh_);
        if (step.fate == Fate::undo) {
            if (done_.empty()) return {};
            done = inverse(done_.back());
            replay(mesh_, *done);
            EXPECT_EQ(MeshSnapshot(mesh_), before_.back());
            undone_.push_back(done_.back());
            done_.pop_back();
            before_.pop_back();
        } else if (step.fate == Fate::redo) {
            if (undone_.empty()) return {};
            done = undone_.back();
            replay(mesh_, *done);
            note(*done, before);
            undone_.pop_back();
        } else {
            done = edit(step);
            if (!done) {
                EXPECT_EQ(MeshSnapshot(mesh_), before);
                return {};
            }
            note(*done, before);
            undone_.clear();
        }
        EXPECT_EQ(topology::validate(mesh_), std::vector<std::string>{});
        return done;
    }

    bool has_edits() const { return !done_.empty(); }

  private:
    std::optional<ChangeSet> edit(const Step& step) {
        MeshEdit edit(mesh_);
        const std::size_t num_old_elements = mesh_.element_capacity();
        for (const Operation& operation : step.operations)
            physics::carry_out(operation, mesh_, edit, num_old_elements);
        if (step.fate == Fate::abandon) return {};
        ChangeSet changes = edit.commit();
        if (changes.is_empty()) return {};
        return changes;
    }

    void note(const ChangeSet& changes, const MeshSnapshot& before) {
        done_.push_back(changes);
        before_.push_back(before);
    }

    Mesh mesh_;
    std::vector<ChangeSet> done_, undone_;
    std::vector<MeshSnapshot> before_;  // each of those done
};

TEST(EditPrograms, LeaveValidMeshesAndUndoExactly) {
    std::vector<const test::MeshFamily*> families;
    for (const auto& family : test::mesh_families()) families.push_back(&family);
    test::expect_for_all(test::num_cases(5000), programs(families), [](const Program& program) {
        EditedMesh body(program.body.mesh());
        const MeshSnapshot first(body.mesh());
        for (const Step& step : program.steps) body.carry_out(step);
        while (body.has_edits()) body.carry_out({Fate::undo, {}});
        EXPECT_EQ(MeshSnapshot(body.mesh()), first);
    });
}

/// Whether an edit divides an element and removes one of the parts: of what went there is no record
/// then.
bool removes_parts(const ChangeSet& changes) {
    return std::any_of(
        changes.elements_added.begin(), changes.elements_added.end(), [&](const auto& part) {
            return std::any_of(changes.elements_removed.begin(), changes.elements_removed.end(),
                               [&](const auto& gone) { return gone.id == part.parent; });
        });
}

struct ActedProgram {
    Program program;
    GeneratedBoundaryConditions acting;
};

std::ostream& operator<<(std::ostream& out, const ActedProgram& acted) {
    out << acted.program.body << acted.acting;
    print_steps(out, acted.program.steps);
    return out;
}

constexpr double now_time = 0.5, short_step = 1e-8;  // s

/// What a step does to a body, which is left as it was.
struct StepOf {
    BodyState state;
    std::vector<Vec3> reactions;

    StepOf(Model& model, const ModelSnapshot& before) {
        ExplicitStep().move(model, now_time, short_step);
        state = state_of(model);
        for (std::size_t s = 0; s < model.boundary().constraints().size(); ++s) {
            reactions.push_back(model.boundary().reactions()[s].force);
            reactions.push_back(model.boundary().reactions()[s].torque);
        }
        set_state(model, before.state, now_time);
        model.state().change().history.set_values(before.history);
    }
};

/// A body in motion that follows the edits of its mesh.
class FollowingBody {
  public:
    FollowingBody(const GeneratedBody& body, const GeneratedBoundaryConditions& acting)
        : table_(table_for(body.mesh())),
          mesh_(with_regions(body.mesh(), table_.materials.size(), body.first_cell)),
          acting_(mesh_.mesh(), acting),
          model_(mesh_.mesh(), table_, acting_.at_start()) {
        test::Random random(3);
        BodyState state = random_state(model_.fragments(), random, 0.0005, 1.0);
        // From afar they would come to their offsets faster than a body may.
        put_on_constraints(model_, now_time, state);
        set_state(model_, state, now_time);
    }

    ModelSnapshot now() { return {model_, now_time}; }
    bool has_edits() const { return mesh_.has_edits(); }

    void carry_out(const Step& step) {
        const Balance before(model_);
        const ModelSnapshot snapshot = now();
        std::vector<Carried> carried(mesh_.mesh().element_capacity());
        for (const CellId e : living_elements(mesh_.mesh()))
            carried[e.index()] = carried_by(model_, e);

        const auto changes = mesh_.carry_out(step);
        if (!changes) return;
        // As a run does, which has not looked at the body as it is.
        model_.state().change().history.set_values(
            model_.state().history().values());  // nothing is known any more
        model_.compute_totals_and_forces();
        if (step.fate == Fate::undo) {
            model_.apply(mesh_.mesh(), inverse(followed_.back()));
            followed_.pop_back();
        } else {
            followed_.push_back(follow(model_, *changes));
        }
        EXPECT_EQ(fragments::validate(model_.fragments(), mesh_.mesh()),
                  std::vector<std::string>{});
        acting_.follow(mesh_.mesh(), *changes);
        if (step.fate == Fate::undo) {
            expect_equal(now(), before_.back());
            before_.pop_back();
        } else {
            before_.push_back(snapshot);
            if (!removes_parts(*changes))
                expect_balance(before, model_, followed_.back(), carried, 1e-8);
        }
        expect_equal_to_a_fresh_model();
    }

  private:
    void expect_equal_to_a_fresh_model() {
        const ModelSnapshot followed = now();
        MaterialTable table = table_;
        table.fibres = followed.fibres;
        Model fresh(mesh_.mesh(), model_.fragments(), table,
                    acting_.now(mesh_.mesh(), model_.structure().mesh_masses()));
        set_state(fresh, followed.state, now_time);
        fresh.state().change().history.set_values(followed.history);
        expect_equal(ModelSnapshot(fresh, now_time), followed);
        const StepOf one(model_, followed), other(fresh, followed);
        EXPECT_EQ(one.state, other.state);
        EXPECT_EQ(one.reactions, other.reactions);
    }

    MaterialTable table_;
    EditedMesh mesh_;
    Acting acting_;
    Model model_;
    std::vector<ModelSnapshot> before_;  // each edit that is done
    std::vector<BodyEdit> followed_;     // these edits
};

TEST(EditPrograms, KeepBodiesBalancedAndEqualToFreshOnes) {
    auto families = test::tetrahedral_families();
    for (const auto* family : test::families_of(topology::CellKind::hexahedron))
        families.push_back(family);
    const auto acted = rc::gen::apply(
        [](Program program, GeneratedBoundaryConditions acting) {
            return ActedProgram{std::move(program), std::move(acting)};
        },
        programs(families), generated_boundary_conditions());
    test::expect_for_all(test::num_cases(1500), acted, [](const ActedProgram& one) {
        FollowingBody body(one.program.body, one.acting);
        const ModelSnapshot first = body.now();
        for (const Step& step : one.program.steps) body.carry_out(step);
        while (body.has_edits()) body.carry_out({Fate::undo, {}});
        expect_equal(body.now(), first);
    });
}

}  // namespace
}  // namespace incise::physics
