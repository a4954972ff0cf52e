// Generated programs of cuts on generated bodies: what must hold whatever they are. Cuts pass
// through points of a coarse grid, in few directions, so that they meet nodes, edges, faces and
// each other exactly, which cuts at random never do; and a program that fails can be shrunk to a
// few small numbers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>

#include "cut_balance.h"
#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/surfaces/triangle_surface.h"
#include "incise/fragments/validate.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "split_body.h"
#include "support/generated_body.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using physics::Model;
using test::GeneratedBody;
using test::MeshSnapshot;
using topology::ChangeSet;
using topology::Mesh;

using Grid = std::array<int, 3>;

enum class Kind { plane, blade, sphere };

/// Places are in eighths of the body's box.
struct Cut {
    Kind kind;
    std::vector<Grid> places;  ///< a point of a plane, a centre, or the corners of a blade's edge
    Grid direction;            ///< normal of a plane; way of a blade, in quarters of the box
    int size;                  ///< steps of a blade; radius of a sphere in quarters of the box
};

/// x_i += s_i x_i + b x_j x_k, in eighths.
struct Deformation {
    Grid stretch;
    Grid bend;
    bool is_none() const { return stretch == Grid{} && bend == Grid{}; }
};

struct Program {
    GeneratedBody body;
    Deformation deformation;
    int snap;  ///< in hundredths
    std::vector<Cut> cuts;
};

std::ostream& operator<<(std::ostream& out, const Grid& g) {
    return out << '(' << g[0] << ' ' << g[1] << ' ' << g[2] << ')';
}

std::ostream& operator<<(std::ostream& out, const Cut& cut) {
    switch (cut.kind) {
        case Kind::plane:
            return out << "plane through " << cut.places[0] << ", normal " << cut.direction;
        case Kind::sphere:
            return out << "sphere about " << cut.places[0] << ", radius " << cut.size;
        case Kind::blade:
            break;
    }
    out << "blade with its edge along";
    for (const Grid& place : cut.places) out << ' ' << place;
    return out << ", in " << cut.size << " steps by " << cut.direction;
}

std::ostream& operator<<(std::ostream& out, const Program& program) {
    out << program.body << "\n  ";
    if (program.deformation.is_none())
        out << "at rest";
    else
        out << "stretched by " << program.deformation.stretch << ", bent by "
            << program.deformation.bend;
    out << ", snap 0.0" << program.snap;
    for (std::size_t i = 0; i < program.cuts.size(); ++i)
        out << "\n  " << i + 1 << ". " << program.cuts[i];
    return out;
}

Vec3 vector(const Grid& g) { return {double(g[0]), double(g[1]), double(g[2])}; }

rc::Gen<Grid> grid(int low, int high) {
    const auto number = rc::gen::inRange(low, high + 1);
    return rc::gen::apply(
        [](int x, int y, int z) {
            return Grid{x, y, z};
        },
        number, number, number);
}

rc::Gen<Program> programs() {
    using rc::gen::inRange;
    const auto cuts = rc::gen::apply(
        [](int kind, Grid place, std::vector<Grid> further, Grid direction, int size) {
            if (direction == Grid{}) direction = {1, 0, 0};
            // A blade's edge has two corners or more, none twice in a row.
            if (further.empty()) further.push_back({place[0] + 8, place[1], place[2]});
            further.insert(further.begin(), place);
            further.erase(std::unique(further.begin(), further.end()), further.end());
            return Cut{static_cast<Kind>(kind), std::move(further), direction, size};
        },
        inRange(0, 3), grid(-1, 9), test::up_to(3, grid(-4, 12)), grid(-2, 2), inRange(1, 4));
    return rc::gen::apply(
        [](GeneratedBody body, Grid stretch, Grid bend, int snap, std::vector<Cut> all) {
            return Program{std::move(body), {stretch, bend}, snap, std::move(all)};
        },
        test::generated_bodies(test::tetrahedral_families(), 48), grid(0, 2), grid(0, 1),
        inRange(0, 10), test::up_to(4, cuts));
}

/// A body in motion that is cut while its tissue is still.
class Patient {
  public:
    explicit Patient(const Program& program)
        : table_(all_materials(program.body.family->data.num_cells())),
          mesh_(Mesh::build(with_all_materials(program.body.mesh())).mesh),
          model_(mesh_, table_),
          first_mesh_(mesh_),
          snap_(program.snap / 100.0),
          is_at_rest_(program.deformation.is_none()) {
        deform(program.deformation);
        cutter_.emplace(mesh_, model_.mesh_positions());
        for (const Vec3& x : model_.positions()) box_.extend(x);
        longest_edge_ = longest_edge(mesh_, model_.positions());
        first_forces_.assign(model_.elastic_forces().begin(), model_.elastic_forces().end());
        first_masses_.assign(model_.masses().begin(), model_.masses().end());
    }

    void carry_out(const Cut& cut) {
        std::optional<CutId> blade;
        const Stroke stroke = stroke_of(cut);
        for (const StrokePart& part : stroke) cut_and_check(part, blade);
        if (cut.kind == Kind::blade) finish_and_check(cut, *blade);
        if (cut.kind != Kind::plane) return;
        expect_parted(mesh_, model_.mesh_positions(), plane_of(cut),
                      how_far_off() * longest_edge_ + 1e-6 * box_.diagonal().norm());
        const std::size_t num_cuts = done_.size();
        cut_and_check(stroke.front(), blade);
        EXPECT_EQ(done_.size(), num_cuts) << "the same plane cuts a second time";
    }

    void expect_undone_to_the_first_bits() {
        for (; !done_.empty(); done_.pop_back()) {
            const physics::BodyEdit back = inverse(done_.back());
            replay(mesh_, back.material);
            model_.apply(mesh_, back);
        }
        EXPECT_EQ(test::MeshSnapshot(mesh_), first_mesh_);
        model_.compute_forces(0.0);
        EXPECT_TRUE(std::ranges::equal(model_.elastic_forces(), first_forces_));
        EXPECT_TRUE(std::ranges::equal(model_.masses(), first_masses_));
    }

  private:
    Vec3 at(const Grid& g) const { return box_.min() + vector(g).cwiseProduct(box_.sizes()) / 8.0; }

    PlaneOfCut plane_of(const Cut& cut) const { return {at(cut.places[0]), vector(cut.direction)}; }

    Stroke stroke_of(const Cut& cut) const {
        Stroke stroke;
        if (cut.kind == Kind::plane) {
            const auto [point, normal] = plane_of(cut);
            stroke.emplace_back(std::make_unique<Plane>(point, normal));
        } else if (cut.kind == Kind::sphere) {
            const double radius = cut.size / 4.0 * box_.sizes().maxCoeff();
            stroke.push_back(
                std::make_unique<TriangleSurface>(icosphere(at(cut.places[0]), radius, 1)));
        } else {
            stroke = sweep(edge_of(cut, 0.0), edge_of(cut, 1.0), cut.size);
        }
        return stroke;
    }

    Vec3 way_of(const Cut& cut) const {
        return vector(cut.direction).cwiseProduct(box_.sizes()) / 4.0;
    }
    /// Of a blade after this share of its way.
    Polyline edge_of(const Cut& cut, double share) const {
        Polyline edge;
        for (const Grid& place : cut.places) edge.push_back(at(place) + share * way_of(cut));
        return edge;
    }

    void deform(const Deformation& deformation) {
        test::Random random(5);
        std::vector<Vec3> x, v;
        for (const Vec3& X : mesh_.rest_positions()) {
            const Vec3 bent(X.y() * X.z(), X.z() * X.x(), X.x() * X.y());
            x.push_back(X + vector(deformation.stretch).cwiseProduct(X) / 8.0 +
                        vector(deformation.bend).cwiseProduct(bent) / 8.0);
            v.push_back(random.vector(1.0));
        }
        model_.set_state(x, v, 0.0);
        model_.compute_forces(0.0);
    }

    void cut_and_check(const StrokePart& part, std::optional<CutId>& blade) {
        edit_and_check([&] {
            if (part.from.empty()) return cutter_->split(mesh_, *part.surface, snap_);
            if (!blade) blade = cutter_->begin_cut(snap_);
            return cutter_->split(*blade, mesh_, part.from, part.to);
        });
    }

    void finish_and_check(const Cut& cut, CutId blade) {
        const BladeEnd end(edge_of(cut, 1.0), {cut.places.size(), way_of(cut)});
        edit_and_check([&] { return cutter_->end_cut(blade, mesh_, model_.fragments(), end); });
        EXPECT_FALSE(cutter_->is_in_tissue(blade));
        cutter_->remove_cut(blade);
    }

    /// edit() returns a Split.
    template <class Edit>
    void edit_and_check(Edit edit) {
        const Balance before(model_);
        cutter_->follow_motion(mesh_, model_.mesh_positions());
        const ChangeSet changes = edit().changes;
        physics::BodyEdit done = model_.apply(mesh_, changes);
        cutter_->apply(mesh_, changes);
        if (changes.is_empty()) return;
        ASSERT_EQ(topology::validate(mesh_), std::vector<std::string>{});
        ASSERT_EQ(fragments::validate(model_.fragments(), mesh_), std::vector<std::string>{});
        expect_kept(before, model_, done);
        done_.push_back(std::move(done));
        expect_equal_to_a_fresh_one(model_, table_);
    }

    /// A node may be off the surface by this share of an edge: at rest; where the body is strained,
    /// what is near at rest may be farther.
    double how_far_off() const {
        if (is_at_rest_ || snap_ == 0.0) return snap_;
        return 3.0 * snap_;
    }

    physics::MaterialTable table_;
    Mesh mesh_;
    Model model_;
    test::MeshSnapshot first_mesh_;
    std::vector<Vec3> first_forces_;
    std::vector<double> first_masses_;
    double snap_;
    bool is_at_rest_;
    Box box_;              // at first
    double longest_edge_;  // at first, m
    std::optional<Cutter> cutter_;
    std::vector<physics::BodyEdit> done_;
};

TEST(CutProperties, HoldForCutsThroughPointsOfAGrid) {
    test::expect_for_all(test::num_cases(2500), programs(), [](const Program& program) {
        Patient patient(program);
        for (const Cut& cut : program.cuts) patient.carry_out(cut);
        patient.expect_undone_to_the_first_bits();
    });
}

}  // namespace
}  // namespace incise::cutting
