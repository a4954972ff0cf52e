// Thousands of random programs of cuts, with a moving body that follows each of them: what must
// hold after every cut, whatever it was.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cut_programs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

#include "cut_balance.h"
#include "incise/fragments/validate.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/validate.h"

namespace incise::cutting {
namespace {

using physics::Model;
using test::Random;
using topology::ChangeSet;
using topology::Mesh;
using topology::MeshData;

/// A body in motion through which a program of cuts goes.
class Patient {
  public:
    Patient(const MeshData& data, std::uint64_t seed)
        : random_(seed),
          table_(all_materials(data.num_cells())),
          mesh_(Mesh::build(with_all_materials(data)).mesh),
          model_(mesh_, table_),
          rest_volume_(rest_volume(mesh_)),
          least_step_(std::numeric_limits<double>::infinity()) {
        for (const ElementId e : model_.fragments().elements())
            least_step_ = std::min(least_step_, model_.structure().element_stable_step(e));
        constexpr std::array<double, 3> snaps = {0.0, default_snap, 0.1};
        const double snap = snaps[random_.below(3)];
        options_ = SplitOptions{snap};
        Box box;
        for (const Vec3& X : mesh_.rest_positions()) box.extend(X);
        size_ = box.diagonal().norm();
        if (random_.below(2) == 0) deform(model_, 0.5, size_, random_);
        is_at_rest_ = false;
        if (std::equal(mesh_.rest_positions().begin(), mesh_.rest_positions().end(),
                       model_.positions().begin()))
            is_at_rest_ = true;
        cutter_.emplace(mesh_, model_.mesh_positions());
    }

    std::string describe() const {
        return "snap " + std::to_string(options_.snap) + (is_at_rest_ ? ", at rest" : ", deformed");
    }

    /// @param is_convex  the body at rest
    void run(bool is_convex) {
        const std::size_t num_cuts = 1 + random_.below(3);
        for (std::size_t i = 0; i < num_cuts && !testing::Test::HasFailure(); ++i) {
            const RandomCut cut = random_cut(living_positions(), random_);
            SCOPED_TRACE("cut " + std::to_string(i) + ": " + cut.description);
            carry_out(cut);
            if (cut.kind == CutKind::plane)
                expect_parted(mesh_, model_.mesh_positions(), {cut.point, cut.normal},
                              how_far_off() * longest_edge(mesh_, model_.mesh_positions()) +
                                  1e-6 * size_ +
                                  (has_joins_ && !is_at_rest_
                                       ? 0.05 * longest_edge(mesh_, mesh_.rest_positions())
                                       : 0.0));
            if (i == 0 && is_convex && is_at_rest_ && cut.kind == CutKind::plane)
                expect_halves(cut);
            // Light fragments move with others, so that in a deformed body their faces are a little
            // off the surface that made them.
            if (cut.kind != CutKind::blade && (is_at_rest_ || !has_joins_)) repeat(cut);
        }
    }

  private:
    std::vector<Vec3> living_positions() const {
        std::vector<Vec3> positions;
        for (const VertexId n : mesh_.nodes())
            positions.push_back(model_.mesh_positions()[n.index()]);
        return positions;
    }

    void carry_out(const RandomCut& cut) {
        std::optional<CutId> blade;
        for (const StrokePart& part : cut.stroke) {
            if (!is_at_rest_) deform(model_, 0.02, size_, random_);
            cut_and_follow(part, blade);
        }
        if (!cut.end) return;
        follow([&] { return cutter_->end_cut(*blade, mesh_, model_.fragments(), *cut.end); });
        EXPECT_FALSE(cutter_->is_in_tissue(*blade));
        cutter_->remove_cut(*blade);
    }

    Split cut_and_follow(const StrokePart& part, std::optional<CutId>& blade) {
        return follow([&] {
            if (part.from.empty()) return cutter_->split(mesh_, *part.surface, options_.snap);
            if (!blade) blade = cutter_->begin_cut(options_.snap);
            return cutter_->split(*blade, mesh_, part.from, part.to);
        });
    }

    /// Carries out an edit, which returns what it did.
    template <class Edit>
    Split follow(Edit edit) {
        const Balance before(model_);
        cutter_->follow_motion(mesh_, model_.mesh_positions());
        const Split done = edit();
        const physics::BodyEdit done_to_body = model_.apply(mesh_, done.changes);
        cutter_->apply(mesh_, done.changes);
        if (!done.changes.is_empty()) check(before, done_to_body);
        has_joins_ |= done_to_body.physics.has_joins();
        return done;
    }

    void check(const Balance& before, const physics::BodyEdit& done) {
        ASSERT_EQ(topology::validate(mesh_), std::vector<std::string>{});
        EXPECT_NEAR(rest_volume(mesh_), rest_volume_, 1e-12 * rest_volume_);
        ASSERT_EQ(fragments::validate(model_.fragments(), mesh_), std::vector<std::string>{});
        EXPECT_GE(model_.structure().rest_stable_step(), least_step_ * (1.0 - 1e-12));
        expect_kept(before, model_, done);
        expect_equal_to_a_fresh_one(model_, table_);
    }

    /// A node may be off the surface by this share of an edge: at rest; where the body is strained,
    /// what is near at rest may be farther.
    double how_far_off() const {
        if (is_at_rest_) return options_.snap;
        return 3.0 * options_.snap;
    }

    /// A convex body at rest is in two; each is as large as the plane leaves it, but for what is
    /// snapped.
    void expect_halves(const RandomCut& cut) const {
        const double off = how_far_off() * longest_edge(mesh_, mesh_.rest_positions());
        const auto volume = [&](double height, int side) {
            return volume_above(mesh_, mesh_.rest_positions(),
                                cut.point + height * cut.normal.normalized(), side * cut.normal);
        };
        // Next to nothing on one side may be nothing.
        const double room = 1e-6 * rest_volume_;
        if (volume(off, 1) < room || volume(-off, -1) < room) return;
        const auto volumes = piece_volumes(mesh_);
        ASSERT_EQ(volumes.size(), 2u);
        EXPECT_GE(volumes[0], std::max(volume(off, 1), volume(-off, -1)) - 1e-6 * room);
        EXPECT_LE(volumes[0], std::max(volume(-off, 1), volume(off, -1)) + 1e-6 * room);
    }

    /// The same cut at the same place has nothing more to do.
    void repeat(const RandomCut& cut) {
        std::optional<CutId> none;
        const Split again = cut_and_follow(cut.stroke.front(), none);
        EXPECT_TRUE(again.changes.is_empty());
    }

    Random random_;
    physics::MaterialTable table_;
    Mesh mesh_;
    Model model_;
    double rest_volume_, size_;
    double least_step_;  // that an element of the uncut body has alone, s
    SplitOptions options_;
    std::optional<Cutter> cutter_;
    bool is_at_rest_ = true;
    bool has_joins_ = false;  // so far
};

struct Programs {
    std::string_view body;
    std::uint64_t count;
    bool is_convex;
};
void PrintTo(const Programs& p, std::ostream* out) { *out << p.count << " on " << p.body; }

constexpr Programs all_programs[] = {{"one tetrahedron", 500, true}, {"two by a face", 400, false},
                                     {"two by an edge", 300, false}, {"cube", 250, true},
                                     {"ring", 250, false},           {"ball", 250, true},
                                     {"organ", 60, false},           {"liver.vtu", 6, false},
                                     {"kidney.vtu", 6, false}};
static_assert(std::accumulate(std::begin(all_programs), std::end(all_programs), std::uint64_t{0},
                              [](std::uint64_t sum, const Programs& p) { return sum + p.count; }) >=
              2'000);

MeshData body(std::string_view name) {
    for (const auto* family : test::tetrahedral_families())
        if (family->name == name) return family->data;
    return io::read_mesh(std::string(INCISE_DATA_DIR) + "/" + std::string(name)).mesh;
}

class CutPrograms : public testing::TestWithParam<Programs> {};

TEST_P(CutPrograms, KeepMeshesValidAndBodiesInBalance) {
    const MeshData data = body(GetParam().body);
    for (std::uint64_t seed = 0; seed < GetParam().count; ++seed) {
        Patient patient(data, seed);
        SCOPED_TRACE(std::string(GetParam().body) + ", seed " + std::to_string(seed) + ", " +
                     patient.describe());
        patient.run(GetParam().is_convex);
        if (HasFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(OnBodies, CutPrograms, testing::ValuesIn(all_programs),
                         [](const auto& programs) {
                             std::string name(programs.param.body);
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char c) { return c == ' ' || c == '.'; }, '_');
                             return name;
                         });

TEST(CutPrograms, AreRunOnEveryFamilyOfTetrahedra) {
    EXPECT_EQ(test::tetrahedral_families().size() + 2, std::size(all_programs))
        << "add the new one above";
}

}  // namespace
}  // namespace incise::cutting
