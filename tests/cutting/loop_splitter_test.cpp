// Exact cuts through cells of any shape: against the exact arrangement of planes, in one step and
// in many, from any side, with edits that are taken back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/loop_splitter.h"

#include <gtest/gtest.h>

#include "loop_body.h"

namespace incise::cutting {
namespace {

TEST(LoopSplitter, PartsABodyAlongAPlane) {
    for_bodies(4, 4, [](Body& body, Random& random) {
        const auto planes = random_planes(random, 1);
        LoopFront front;
        body.cut(Plane(planes[0].point, planes[0].normal), front);
        EXPECT_FALSE(front.is_empty());
        expect_parts(body, planes, 2e-3);
        body.expect_replay();
    });
}

TEST(LoopSplitter, PartsABodyAlongThePathOfABlade) {
    for (const int num_steps : {1, 7, 100})
        for_bodies(3, 3, [&](Body& body, Random& random) {
            const auto planes = random_planes(random, 1);
            body.sweep(planes[0], num_steps);
            expect_parts(body, planes, 3e-3);
            body.expect_replay();
        });
}

TEST(LoopSplitter, PartsABodyAlongThreePlanes) {
    for (const int num_steps : {1, 25})
        for_bodies(4, 4, [&](Body& body, Random& random) {
            const auto planes = random_planes(random, 3);
            for (const Divider& plane : planes) {
                body.sweep(plane, num_steps);
            }
            expect_parts(body, planes, 5e-3);
            body.expect_replay();
        });
}

}  // namespace
}  // namespace incise::cutting
