// Splitting by a blade: the same cut however many steps it takes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "blade_path.h"
#include "incise/base/archive.h"
#include "incise/topology/mesh_metrics.h"
#include "split_body.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"

namespace incise::cutting {
namespace {

using test::Random;

/// What a cut has come to, told by counts.
struct Outcome {
    std::size_t num_elements, num_nodes, num_opened, num_cut_faces;
    int num_pieces;
    bool operator==(const Outcome&) const = default;
    friend void PrintTo(const Outcome& o, std::ostream* out) {
        *out << o.num_elements << " elements, " << o.num_nodes << " nodes, " << o.num_opened
             << " faces opened, " << o.num_cut_faces << " now, " << o.num_pieces << " pieces";
    }
};
Outcome outcome(const SplitBody& body, const std::vector<Split>& parts) {
    return {body.mesh.num_elements(), body.mesh.num_nodes(), sum(parts).faces_opened,
            cut_faces(body.mesh).size(), topology::components(body.mesh).count};
}

TEST(SplitByBlade, RightThroughIsAlikeInManySteps) {
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(4); ++seed) {
            std::vector<double> volumes;
            Outcome expected{};
            for (const int num_steps : {1, 2, 7, 60}) {
                SCOPED_TRACE(testing::Message()
                             << family->name << ", seed " << seed << ", " << num_steps << " steps");
                Random random(seed);
                SplitBody body(family->data);
                const BladePath path(body.box(), random);
                const auto parts = body.cut(sweep(path.from, path.to, num_steps));
                if (num_steps == 1) {
                    expected = outcome(body, parts);
                    volumes = piece_volumes(body.mesh);
                    continue;
                }
                EXPECT_EQ(outcome(body, parts), expected);
                const auto now = piece_volumes(body.mesh);
                ASSERT_EQ(now.size(), volumes.size());
                for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(now[i], volumes[i], 1e-9);
            }
        }
}

/// The faces of a body by where their corners are at rest, whatever the ids: of both sides of a
/// cut, each counts.
struct Faces {
    using Triangle = std::array<std::array<long, 3>, 3>;
    std::multiset<Triangle> all, outer;

    explicit Faces(const SplitBody& body) {
        const topology::Mesh& mesh = body.mesh;
        const double hair = 1e-8 * body.box().diagonal().norm();
        for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
            for (int f = 0; f < 4; ++f) {
                const FaceId face{CellId(i), f};
                Triangle triangle;
                for (std::size_t p = 0; p < 3; ++p)
                    for (std::size_t c = 0; c < 3; ++c)
                        triangle[p][c] = std::lround(
                            mesh.rest_position(mesh.face_corner(
                                face, static_cast<int>(p)))[static_cast<Eigen::Index>(c)] /
                            hair);
                std::sort(triangle.begin(), triangle.end());
                all.insert(triangle);
                if (!mesh.neighbor(face).is_valid()) outer.insert(triangle);
            }
    }
};

/// Expects that a body is the same, face for face, whether it is cut in one step or in many.
/// @param cut  (body, number of steps)
template <class Cut>
void expect_same_in_many_steps(const topology::MeshData& data, Cut cut) {
    std::optional<Faces> expected;
    int num_pieces = 0;
    for (const int num_steps : {1, 2, 7, 60}) {
        SCOPED_TRACE(testing::Message() << num_steps << " steps");
        SplitBody body(data);
        cut(body, num_steps);
        const Faces faces(body);
        const int count = topology::components(body.mesh).count;
        if (num_steps == 1) {
            expected = faces;
            num_pieces = count;
            continue;
        }
        EXPECT_EQ(faces.all, expected->all);
        EXPECT_EQ(faces.outer, expected->outer);
        EXPECT_EQ(count, num_pieces);
    }
}

// Where it stops on its way, elements at the front are cut in part. Into which parts depends on the
// order of their edges, and on which nodes count as on the cut by then: both are decided as the
// blade comes to them, in whatever steps.
TEST(SplitByBlade, PartlyThroughIsAlikeInManySteps) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, 0.1, default_snap})
            for (const double share : {0.4, 0.5, 1.0})
                for (std::uint64_t seed = 0; seed < test::num_cases(6); ++seed) {
                    SCOPED_TRACE(testing::Message() << family->name << ", snap " << snap
                                                    << ", seed " << seed << ", share " << share);
                    expect_same_in_many_steps(family->data, [&](SplitBody& body, int num_steps) {
                        Random random(seed);
                        const BladePath path(body.box(), random, share);
                        body.cut(sweep(path.from, path.to, num_steps), SplitOptions{snap});
                    });
                }
}

/// A waved edge, which sweeps a corrugated sheet right through the body.
struct WavedBlade {
    Polyline from, to;

    WavedBlade(const Box& box, Random& random) {
        const double size = box.diagonal().norm();
        const Vec3 point = box.center() + random.vector(0.05 * size);
        const Vec3 normal = random.vector(1.0).normalized();
        const Vec3 u = 1.5 * size * normal.unitOrthogonal(), v = normal.cross(u);
        const double height = random.uniform(0.02, 0.08) * size;
        const double waves = random.uniform(4.0, 16.0), phase = random.uniform(0.0, 6.0);
        for (int i = 0; i <= 24; ++i) {
            const double s = i / 12.0 - 1.0;
            const Vec3 x = point + s * u + height * std::sin(waves * s + phase) * normal +
                           random.uniform(-0.05, 0.05) * v;
            from.push_back(x - v);
            to.push_back(x + v);
        }
    }
};

// It goes through edges more than once: each time when the blade is there, and through no edge that
// was made after it had been there.
TEST(SplitByBlade, WithWavedEdgesIsAlikeInManySteps) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, default_snap})
            for (std::uint64_t seed = 0; seed < test::num_cases(12); ++seed) {
                SCOPED_TRACE(testing::Message()
                             << family->name << ", snap " << snap << ", seed " << seed);
                expect_same_in_many_steps(family->data, [&](SplitBody& body, int num_steps) {
                    Random random(seed);
                    const WavedBlade blade(body.box(), random);
                    body.cut(sweep(blade.from, blade.to, num_steps), SplitOptions{snap});
                });
            }
}

// Small pieces between two cuts hang on the rest by the face to which the blade comes last, whether
// others have opened in earlier steps or in the same; and whether they do is not decided before the
// blade is past them.
TEST(SplitByBlade, ThroughCutBodiesIsAlikeInManySteps) {
    for (const auto* family : test::tetrahedral_families())
        for (const double snap : {0.0, 0.1, default_snap})
            for (std::uint64_t seed = 0; seed < test::num_cases(8); ++seed) {
                SCOPED_TRACE(testing::Message()
                             << family->name << ", snap " << snap << ", seed " << seed);
                expect_same_in_many_steps(family->data, [&](SplitBody& body, int num_steps) {
                    Random random(seed);
                    const BladePath earlier(body.box(), random), path(body.box(), random);
                    body.cut(sweep(earlier.from, earlier.to, 1), SplitOptions{snap});
                    body.cut(sweep(path.from, path.to, num_steps), SplitOptions{snap});
                });
            }
}

// Also what small pieces wait for is in a checkpoint.
TEST(SplitByBlade, ResumesFromItsArchiveToTheSameCut) {
    for (const auto* family : test::tetrahedral_families())
        for (std::uint64_t seed = 0; seed < test::num_cases(20); ++seed) {
            SCOPED_TRACE(testing::Message() << family->name << ", seed " << seed);
            const auto cut = [&](bool is_archived) {
                Random random(seed);
                SplitBody body(family->data);
                const BladePath path(body.box(), random);
                std::optional<CutId> blade;
                for (const auto& part : sweep(path.from, path.to, 40)) {
                    body.cut(part, blade, SplitOptions{default_snap});
                    if (!is_archived) continue;
                    ArchiveWriter ar;
                    ar(body.cutter());
                    Cutter read(body.mesh, body.positions);
                    ArchiveReader reader(ar.bytes());
                    reader(read);
                    body.replace(std::move(read));
                    EXPECT_TRUE(body.cutter().is_on(body.mesh));
                }
                return Faces(body);
            };
            const Faces whole = cut(false), archived = cut(true);
            EXPECT_EQ(archived.all, whole.all);
            EXPECT_EQ(archived.outer, whole.outer);
        }
}

}  // namespace
}  // namespace incise::cutting
