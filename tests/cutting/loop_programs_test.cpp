// Random programs of exact cuts through bodies of all kinds of cells, in motion: what each cut has
// to keep, that the body is the one built afresh, and that all is taken back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cut_balance.h"
#include "cut_programs.h"
#include "incise/cutting/exact/loop_splitter.h"
#include "incise/fragments/validate.h"
#include "incise/physics/body/model.h"
#include "incise/topology/mesh.h"
#include "incise/topology/validate.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/mesh_snapshot.h"
#include "support/num_cases.h"
#include "tests/physics/test_bodies.h"

namespace incise::cutting {
namespace {

using physics::Model;
using test::Bricks;
using test::Random;
using topology::Mesh;
using topology::MeshData;

/// A body in motion that is cut.
class Patient {
  public:
    /// @param table  the materials, which the cells have in turn
    Patient(const MeshData& data, physics::MaterialTable table, std::uint64_t seed)
        : random_(seed),
          table_(std::move(table)),
          mesh_(Mesh::build(physics::with_regions(data, table_.materials.size())).mesh),
          model_(mesh_, table_),
          rest_volume_(volume()) {
        Box box;
        for (const Vec3& X : mesh_.rest_positions()) box.extend(X);
        size_ = box.diagonal().norm();
        if (random_.below(2) == 0) deform(model_, 0.3, size_, random_);
    }

    void run() {
        const test::MeshSnapshot uncut(mesh_);
        const std::vector<double> masses(model_.masses().begin(), model_.masses().end());
        const std::size_t num_cuts = 1 + random_.below(3);
        for (std::size_t i = 0; i < num_cuts && !testing::Test::HasFailure(); ++i) {
            std::vector<Vec3> positions;
            for (const VertexId n : mesh_.nodes())
                positions.push_back(model_.mesh_positions()[n.index()]);
            const RandomCut cut = random_cut(positions, random_);
            SCOPED_TRACE("cut " + std::to_string(i) + ": " + cut.description);
            carry_out(cut);
        }
        if (testing::Test::HasFailure()) return;
        for (std::size_t i = edits_.size(); i-- > 0;) {
            const physics::BodyEdit back = inverse(edits_[i]);
            topology::replay(mesh_, back.material);
            model_.apply(mesh_, back);
        }
        EXPECT_TRUE(test::MeshSnapshot(mesh_) == uncut);
        EXPECT_TRUE(std::ranges::equal(model_.masses(), masses));
        EXPECT_EQ(fragments::validate(model_.fragments(), mesh_), std::vector<std::string>{});
    }

    std::size_t num_divided() const { return num_divided_; }

  private:
    /// What validate() finds. A curved cut through coarse, uneven cells can leave flat ones that
    /// are turned inside out.
    std::vector<std::string> faults() const {
        std::vector<std::string> found = topology::validate(mesh_);
        std::erase_if(found, [](const std::string& fault) {
            return fault.find("has a negative volume") != std::string::npos;
        });
        return found;
    }

    static double sum(std::span<const double> values) {
        return std::accumulate(values.begin(), values.end(), 0.0);
    }

    double volume() const {
        double sum = 0.0;
        for (const CellId e : mesh_.elements()) sum += topology::rest_volume(mesh_, e);
        return sum;
    }

    void carry_out(const RandomCut& cut) {
        LoopFront front;
        for (const StrokePart& part : cut.stroke) {
            const auto now = model_.mesh_positions();
            const std::vector<Vec3> positions_before(now.begin(), now.end());
            deform(model_, 0.02, size_, random_);
            const Balance before(model_);
            const Split done =
                split_cells(mesh_, {mesh_, positions_before, model_.mesh_positions()},
                            *part.surface, front, {}, {});
            if (done.changes.is_empty()) continue;
            num_divided_ += done.changes.elements_added.size();
            edits_.push_back(model_.apply(mesh_, done.changes));
            ASSERT_EQ(faults(), std::vector<std::string>{});
            EXPECT_NEAR(volume(), rest_volume_, 1e-12 * rest_volume_);
            ASSERT_EQ(fragments::validate(model_.fragments(), mesh_), std::vector<std::string>{});
            EXPECT_NEAR(sum(model_.structure().mesh_masses()), sum(model_.masses()),
                        1e-12 * sum(model_.masses()));
            expect_kept(before, model_, edits_.back(), false);
            expect_equal_to_a_fresh_one(model_, table_);
        }
    }

    Random random_;
    physics::MaterialTable table_;
    Mesh mesh_;
    Model model_;
    double rest_volume_, size_;
    std::vector<physics::BodyEdit> edits_;
    std::size_t num_divided_ = 0;
};

struct Programs {
    const char* body;
    MeshData (*make)();
    int count;
    bool has_springs = false;  ///< HybMSS, else HEML
};
void PrintTo(const Programs& p, std::ostream* out) { *out << p.count << " on " << p.body; }

template <Bricks bricks, int jitter>
MeshData cube() {
    return test::brick_cube(bricks, 3, 0.01 * jitter, 11);
}
template <int family>
MeshData of_family() {
    constexpr std::array names = {"hexahedra", "voxels", "mixed"};
    for (const auto& found : test::mesh_families())
        if (found.name == names[static_cast<std::size_t>(family)]) return found.data;
    return {};
}

const Programs all_programs[] = {{"cube of hexahedra", cube<Bricks::hexahedra, 0>, 40},
                                 {"cube of hybrid springs", cube<Bricks::hexahedra, 0>, 30, true},
                                 {"cube of wedges", cube<Bricks::wedges, 0>, 30},
                                 {"cube of pyramids", cube<Bricks::pyramids, 0>, 20},
                                 {"mixed cube", cube<Bricks::mixed, 0>, 30},
                                 {"jittered cube of hexahedra", cube<Bricks::hexahedra, 15>, 40},
                                 {"jittered mixed cube", cube<Bricks::mixed, 15>, 30},
                                 {"joined cube", cube<Bricks::joined, 0>, 30},
                                 {"jittered joined cube", cube<Bricks::joined, 8>, 30},
                                 {"hexahedra", of_family<0>, 15},
                                 {"voxels", of_family<1>, 15},
                                 {"mixed", of_family<2>, 60}};

class LoopPrograms : public testing::TestWithParam<Programs> {};

TEST_P(LoopPrograms, KeepMeshesValidAndBodiesInBalance) {
    const MeshData data = GetParam().make();
    std::size_t num_divided = 0;
    for (int seed = 0; seed < test::num_cases(GetParam().count); ++seed) {
        Patient patient(data,
                        GetParam().has_springs ? physics::table_of_hybrid_springs()
                                               : all_materials(data.num_cells()),
                        static_cast<std::uint64_t>(seed));
        SCOPED_TRACE("seed " + std::to_string(seed));
        patient.run();
        num_divided += patient.num_divided();
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(num_divided, 0u);
}

INSTANTIATE_TEST_SUITE_P(OnBodies, LoopPrograms, testing::ValuesIn(all_programs),
                         [](const auto& programs) {
                             std::string name = programs.param.body;
                             std::ranges::replace(name, ' ', '_');
                             return name;
                         });

}  // namespace
}  // namespace incise::cutting
