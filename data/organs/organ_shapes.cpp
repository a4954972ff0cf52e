// SPDX-License-Identifier: LGPL-3.0-or-later
#include "data/organs/organ_shapes.h"

#include "data/organs/implicit_shapes.h"

namespace incise::organs {

namespace {

double liver_body(const Vec3& p) {
    const double right_lobe = ellipsoid(p, {-0.038, 0.005, 0.002}, {0.062, 0.066, 0.076});
    const double right_base = ellipsoid(p, {-0.055, -0.012, -0.026}, {0.045, 0.050, 0.054});
    const double left_lobe = ellipsoid(p, {0.030, -0.016, 0.020}, {0.074, 0.050, 0.038});
    const double right = smooth_union(right_lobe, right_base, 0.030);
    const double lobes = smooth_union(right, left_lobe, 0.050);

    // Kidney and bowel press a hollow into the liver from below and behind, the stomach one into
    // its left lobe. What they leave in front is the sharp lower edge.
    const Vec3 porta(0.0, 0.0, -0.008);
    constexpr double hollow_radius = 0.19;
    const Vec3 hollow_centre = porta + hollow_radius * Vec3(0.24, 0.72, -0.65).normalized();
    const double hollow = ball(p, hollow_centre, hollow_radius);
    const double stomach = ball(p, {0.080, 0.010, -0.086}, 0.100);
    const double below = smooth_union(hollow, stomach, 0.02);
    const double wedge = smooth_difference(lobes, below, 0.009);

    const auto on_hollow = [&](const Vec3& q) -> Vec3 {
        return hollow_centre + hollow_radius * (q - hollow_centre).normalized();
    };
    const double gallbladder =
        capsule(p, on_hollow({-0.012, 0.0, -0.020}), on_hollow({-0.025, -0.050, -0.080}), 0.010);
    const double vena_cava = capsule(p, {-0.002, 0.066, -0.1}, {-0.002, 0.060, 0.1}, 0.012);
    const double ligament = capsule(p, {0.020, -0.080, -0.045}, {0.012, 0.0, -0.012}, 0.007);
    double body = smooth_difference(wedge, gallbladder, 0.008);
    body = smooth_difference(body, ligament, 0.010);
    return smooth_difference(body, vena_cava, 0.012);
}

double liver_tumour(const Vec3& p) {
    return ellipsoid(p, {-0.055, -0.005, 0.020}, {0.0135, 0.0125, 0.012});
}

/// The poles of a kidney lean towards the spine.
Vec3 straightened(const Vec3& p) { return {p.x() - 4.0 * p.z() * p.z(), p.y(), p.z()}; }

double kidney_body(const Vec3& p) {
    const double bean = ellipsoid(straightened(p), Vec3::Zero(), {0.030, 0.021, 0.055});
    const double hilum = ellipsoid(p, {0.033, 0.0, 0.0}, {0.021, 0.011, 0.014});
    return smooth_difference(bean, hilum, 0.015);
}

double kidney_medulla(const Vec3& p) {
    const double core = ellipsoid(straightened(p), {0.002, 0.0, 0.0}, {0.019, 0.0115, 0.040});
    constexpr double least_cortex = 0.006;
    return smooth_intersection(core, kidney_body(p) + least_cortex, 0.006);
}

}  // namespace

Organ liver() {
    return {.name = "liver",
            .body = liver_body,
            .inner = liver_tumour,
            .bounding_radius = 0.15,
            .surface_size = 0.0050,
            .core_size = 0.0097,
            .size_growth = 0.25};
}

Organ kidney() {
    return {.name = "kidney",
            .body = kidney_body,
            .inner = kidney_medulla,
            .bounding_radius = 0.075,
            .surface_size = 0.0031,
            .core_size = 0.0045,
            .size_growth = 0.2};
}

std::vector<Organ> all_organs() { return {liver(), kidney()}; }

}  // namespace incise::organs
