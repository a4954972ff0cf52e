// Meshes keep the shape of the body in any unit and place, or tell what they change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "incise/topology/boundary_surface.h"
#include "made_mesh.h"

namespace incise {
namespace {

using test::box_surface;
using test::joined;
using testing::HasSubstr;

topology::SurfaceData placed(topology::SurfaceData surface, double scale, const Vec3& by) {
    for (Vec3& x : surface.points) x = scale * x + by;
    return surface;
}

class MeshShape : public test::MakesTetrahedra {
  protected:
    const topology::SurfaceData box_ = box_surface(Box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
};

TEST_F(MeshShape, IsTheSameInAnyUnitAndPlace) {
    struct Case {
        double scale;
        Vec3 by;
    };
    for (const auto& [scale, by] :
         {Case{1.0, {0, 0, 0}}, Case{1.0, {1e7, 1e7, 1e7}}, Case{1.0, {-1e8, 0, 3}},
          Case{1e38, {0, 0, 0}}, Case{1e-30, {0, 0, 0}}, Case{1e30, {1e37, 0, -1e36}},
          Case{1e-30, {0, 1e-24, 0}}}) {
        SCOPED_TRACE(testing::Message() << scale << " at " << by.transpose());
        write_surface("box.stl", placed(box_, scale, by));
        const auto size = [scale](double length) {
            std::ostringstream text;
            text << " --size " << length * scale;
            return text.str();
        };
        const auto sharp = make("box.stl out.vtu --features 30" + size(0.3));
        EXPECT_THAT(sharp.err, testing::Not(HasSubstr("warning")));
        EXPECT_NEAR(sharp.metrics.volume / std::pow(scale, 3), 1.0, 1e-3);
        EXPECT_NEAR(sharp.metrics.surface_area / std::pow(scale, 2), 6.0, 1e-3);
        EXPECT_GT(sharp.metrics.min_altitude, 0.05 * scale);
        EXPECT_NEAR(make("box.stl out.vtu" + size(0.2)).metrics.volume / std::pow(scale, 3), 1.0,
                    0.05);
    }
}

TEST_F(MeshShape, EndsWhereNumbersEnd) {
    write_surface("box.stl", box_);
    for (const auto* scale : {"1e60", "1e-60", "1e300", "1e-300"})
        EXPECT_THAT(refusal(std::string("box.stl out.vtu --size ") + scale + " --scale " + scale),
                    HasSubstr("it must be from 1e-50 to 1e50"));
    write_surface("far.stl", placed(box_, 1.0, {1e13, 0, 0}));
    EXPECT_THAT(refusal("far.stl out.vtu --size 0.3"), HasSubstr("too far from the origin"));
}

TEST_F(MeshShape, FillsASurfaceWithFlatTriangles) {
    // A point in the middle of an edge belongs to one of its two triangles only.
    auto surface = box_;
    surface.points.push_back(0.5 * (surface.points[0] + surface.points[1]));
    ASSERT_EQ(surface.triangles[1], (std::array<std::int64_t, 3>{0, 3, 1}));
    surface.triangles[1] = {0, 3, 8};
    surface.triangles.push_back({8, 3, 1});
    surface.triangles.push_back({0, 8, 1});
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (const bool is_turned : {false, true}) {
        SCOPED_TRACE(is_turned);
        if (is_turned)
            for (Vec3& x : surface.points) x = (turn * x).cast<float>().cast<double>();
        write_surface("flat.stl", surface);
        const auto made = make("flat.stl out.vtu --size 0.3 --features 30");
        EXPECT_THAT(made.err, testing::Not(HasSubstr("warning")));
        EXPECT_NEAR(made.metrics.volume, 1.0, 1e-3);
    }
}

TEST_F(MeshShape, TellsOfEachGapThatItCloses) {
    const Box left(Vec3(0, 0, 0), Vec3(0.4, 0.4, 0.4)), right(Vec3(0.42, 0, 0), Vec3(1, 0.4, 0.4));
    const auto both = joined(box_surface(left), box_surface(right));
    std::size_t num_kept = 0, num_closed = 0;
    for (const bool is_far : {false, true})
        for (const auto* size : {"0.2", "0.15", "0.05"}) {
            SCOPED_TRACE(testing::Message() << size << (is_far ? " far" : ""));
            write_surface("two.stl", placed(both, 1.0, Vec3::Constant(is_far ? 1e4 : 0.0)));
            const auto outcome = run(std::string("mesh two.stl out.vtu --size ") + size);
            ASSERT_EQ(outcome.status, 0) << outcome.err;
            const auto data = io::read_mesh(folder_ / "out.vtu").mesh;
            const auto mesh = topology::Mesh::build(data).mesh;
            const bool is_kept = topology::components(mesh).count == 2;
            (is_kept ? num_kept : num_closed) += 1;
            if (!is_kept) {
                EXPECT_THAT(outcome.err, HasSubstr("0.02 wide at ("));
            }
        }
    EXPECT_GT(num_kept, 0u);
    EXPECT_GT(num_closed, 0u);
}

TEST_F(MeshShape, RefusesToLoseAQuarterOfTheVolume) {
    write_surface("ball.stl", test::icosphere({1, 2, 3}, 1.0, 3));
    const auto message = refusal("ball.stl out.vtu --size 2");
    EXPECT_THAT(message, HasSubstr("the mesh would have a volume of "));
    EXPECT_THAT(message, HasSubstr("most 25 % are allowed"));
    EXPECT_THAT(message, HasSubstr("give a smaller --size"));
}

TEST_F(MeshShape, HasNoFlatElementOnAnOrgan) {
    const auto liver = io::read_mesh(std::string(INCISE_DATA_DIR) + "/liver.vtu").mesh;
    const auto mesh = topology::Mesh::build(liver).mesh;
    topology::SurfaceData surface;
    surface.points = liver.points;
    const topology::BoundarySurface boundary(mesh);
    for (const auto& [a, b, c] : boundary.triangles())
        surface.triangles.push_back({a.value, b.value, c.value});
    write_surface("liver.stl", surface);
    for (const auto* options : {"0.015", "0.012", "0.010"}) {
        SCOPED_TRACE(options);
        const auto made = make(std::string("liver.stl out.vtu --size ") + options);
        EXPECT_THAT(made.err, testing::Not(HasSubstr("warning")));
        // What a mesh generator by advancing fronts reaches at these sizes.
        EXPECT_GT(made.metrics.min_altitude, 0.16 * made.metrics.mean_edge_length);
        EXPECT_GE(made.least_angle(), 13.9);
    }
}

}  // namespace
}  // namespace incise
