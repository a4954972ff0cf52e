// Homogeneous bodies against the tables of data/references/uniaxial.json.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "incise/topology/box_mesh.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/textbook_energies.h"

namespace incise::physics {
namespace {

constexpr double side = 0.1;        // m
constexpr double tolerance = 1e-9;  // relative; the tables are good to 1e-13

class UniaxialCube {
  public:
    explicit UniaxialCube(const Law& law)
        : mesh_(topology::Mesh::build(topology::box_mesh(topology::CellKind::tetrahedron,
                                                         Vec3::Zero(), Vec3::Constant(side),
                                                         {3, 3, 3}))
                    .mesh),
          model_(mesh_, table_of_one_law(law)) {}

    void stretch(double axial, double lateral) {
        BodyState state = rest_state(mesh_);
        for (Vec3& x : state.positions) x = x.cwiseProduct(Vec3(lateral, lateral, axial));
        set_state(model_, state);
    }

    /// Sum of the elastic forces on the face where component c of the rest position is `side`.
    Vec3 face_force(int c) const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t n = 0; n < mesh_.node_capacity(); ++n)
            if (is_at(mesh_.rest_positions()[n][c], side)) sum += model_.elastic_forces()[n];
        return sum;
    }

    /// Largest force on a node, of its components along which it may move freely.
    double largest_free_force() const {
        double largest = 0.0;
        for (std::size_t n = 0; n < mesh_.node_capacity(); ++n) {
            Vec3 f = model_.elastic_forces()[n];
            const double z = mesh_.rest_positions()[n].z();
            if (is_at(z, 0.0) || is_at(z, side)) f.z() = 0.0;
            largest = std::max(largest, f.norm());
        }
        return largest;
    }

    /// The lateral stretch at which the sides are free of force, by bisection.
    double free_lateral_stretch(double axial) {
        double low = 0.3, high = 2.0;  // at the low end the sides push out, at the high end in
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            stretch(axial, middle);
            (face_force(0).x() > 0.0 ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    const Model& model() const { return model_; }

  private:
    static bool is_at(double x, double plane) { return std::abs(x - plane) < 1e-9 * side; }

    topology::Mesh mesh_;
    Model model_;
};

template <class Visit>
void for_each_reference(Visit visit) {
    std::size_t num_tables = 0;
    for (const auto& reference : test::uniaxial_references()) {
        const auto law = law_of(reference.law);
        if (!law) continue;
        SCOPED_TRACE(reference.law.name);
        ++num_tables;
        UniaxialCube cube(*law);
        for (const auto& row : reference.rows) {
            SCOPED_TRACE(row.stretch);
            visit(reference, row, cube);
        }
    }
    EXPECT_EQ(num_tables, test::uniaxial_references().size()) << "a table without a law";
}

TEST(UniaxialReference, ForcesAtTheLateralStretchOfTheTable) {
    for_each_reference([](const auto& reference, const auto& row, UniaxialCube& cube) {
        cube.stretch(row.stretch, row.lateral_stretch);
        const double scale = reference.young * side * side;
        EXPECT_LE(cube.largest_free_force(), tolerance * scale);
        // The body pulls its ends together with the force that holds them apart.
        EXPECT_NEAR(-cube.face_force(2).z(), row.first_piola_kirchhoff * side * side,
                    tolerance * std::abs(row.first_piola_kirchhoff) * side * side + 1e-13 * scale);
    });
}

TEST(UniaxialReference, LateralStretchIsFoundFromTheForces) {
    for_each_reference([](const auto&, const auto& row, UniaxialCube& cube) {
        EXPECT_NEAR(cube.free_lateral_stretch(row.stretch), row.lateral_stretch,
                    tolerance * row.lateral_stretch);
    });
}

TEST(UniaxialReference, StressAndVolumeOfTheElements) {
    for_each_reference([](const auto& reference, const auto& row, UniaxialCube& cube) {
        cube.stretch(row.stretch, row.lateral_stretch);
        const double axial = row.first_piola_kirchhoff * row.stretch / row.volume_ratio;
        const Mat3 expected = Vec3(0.0, 0.0, axial).asDiagonal();
        for (const auto e : living_elements(cube.model().fragments())) {
            const ElementResult result = cube.model().element_result(e);
            EXPECT_NEAR(result.volume_ratio, row.volume_ratio, tolerance * row.volume_ratio);
            EXPECT_LE((result.cauchy_stress - expected).norm(), tolerance * reference.young);
        }
        EXPECT_NEAR(cube.model().energetics().min_volume_ratio(), row.volume_ratio,
                    tolerance * row.volume_ratio);
    });
}

/// Principal first Piola-Kirchhoff stresses at these stretches, by differences of the energy.
template <class L>
Vec3 principal_stress(const L& law, const Vec3& stretches) {
    Vec3 P;
    const double h = 1e-3;  // five points: truncation and round-off below 1e-11 of the modulus
    for (int i = 0; i < 3; ++i) {
        const auto w = [&](double d) {
            return energy_density(law, (stretches + d * Vec3::Unit(i)).asDiagonal());
        };
        P[i] = (8.0 * (w(h) - w(-h)) - (w(2.0 * h) - w(-2.0 * h))) / (12.0 * h);
    }
    return P;
}

// Tables or not: a bar of each law against its textbook energy, with the lateral stretch found by
// bisection of the lateral stress.
TEST(UniaxialBars, HaveTheStressOfTheTextbookEnergy) {
    for (const NamedLaw& named : test_laws()) {
        if (has_fibres(named.law)) continue;  // Fibres.GiveBarsTheStressOfTheLaw
        SCOPED_TRACE(named.name);
        std::visit(
            [&](const auto& law) {
                const double modulus = law.rest_lambda() + 2.0 * law.rest_mu();
                UniaxialCube cube(named.law);
                for (const double axial : {0.8, 0.95, 1.05, 1.25}) {
                    SCOPED_TRACE(axial);
                    double low = 0.7, high = 1.4;
                    for (int i = 0; i < 60; ++i) {
                        const double middle = 0.5 * (low + high);
                        const double side_stress =
                            principal_stress(law, Vec3(middle, middle, axial)).x();
                        (side_stress < 0.0 ? low : high) = middle;
                    }
                    const double P = principal_stress(law, Vec3(low, low, axial)).z();
                    EXPECT_GT(std::abs(P), 0.01 * law.rest_mu());
                    cube.stretch(axial, low);
                    const double area = side * side;
                    EXPECT_LE(cube.largest_free_force(), 1e-8 * modulus * area);
                    EXPECT_NEAR(-cube.face_force(2).z(), P * area, 1e-8 * modulus * area);
                }
            },
            named.law);
    }
}

// With a stretch e along the axis and t across, the side is free where
// mu (1 - 1/(e^2 + 2 t^2 + 1)) + lambda (e t^2 - alpha) e = 0: a quadratic equation for t^2.
TEST(UniaxialStretch, OfStableNeoHookeanIsItsClosedForm) {
    for (const auto& [rest_lambda, rest_mu] :
         {std::pair(5769.0, 3846.0), std::pair(0.0, 5000.0), std::pair(1.6e5, 3356.0)}) {
        const double mu = 4.0 / 3.0 * rest_mu, lambda = rest_lambda + 5.0 / 6.0 * rest_mu;
        const double alpha = 1.0 + 0.75 * mu / lambda;
        UniaxialCube cube(StableNeoHookean::of_rest_moduli(rest_lambda, rest_mu));
        for (const double e : {0.3, 0.6, 0.9, 1.0, 1.2, 1.6, 3.0}) {
            SCOPED_TRACE(e);
            const double square = e * e + 1.0;
            const double a = 2.0 * lambda * e * e,
                         b = 2.0 * mu + lambda * e * (e * square - 2.0 * alpha),
                         c = mu * e * e - lambda * e * alpha * square;
            const double lateral = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);  // squared
            const double stress = mu * (1.0 - 1.0 / (square + 2.0 * lateral)) * e +
                                  lambda * (e * lateral - alpha) * lateral;
            const double scale = (rest_lambda + 2.0 * rest_mu) * side * side;
            EXPECT_NEAR(cube.free_lateral_stretch(e), std::sqrt(lateral), tolerance);
            cube.stretch(e, std::sqrt(lateral));
            EXPECT_LE(cube.largest_free_force(), 1e-12 * scale);
            EXPECT_NEAR(-cube.face_force(2).z(), stress * side * side, 1e-12 * scale);
            EXPECT_NEAR(cube.model().energetics().min_volume_ratio(), e * lateral, 1e-12);
        }
    }
}

// The work of the end force from rest is the elastic energy: Simpson's rule over the table's own
// stretches, whose force is not known between them, is good to the fourth power of their distance.
TEST(UniaxialReference, EnergyIsTheWorkOfTheEndForce) {
    for (const auto& reference : test::uniaxial_references()) {
        const auto law = law_of(reference.law);
        if (!law) continue;
        SCOPED_TRACE(reference.law.name);
        UniaxialCube cube(*law);
        const auto energy = [&](const test::UniaxialRow& row) {
            cube.stretch(row.stretch, row.lateral_stretch);
            return cube.model().energetics().totals().elastic_energy / (side * side * side);
        };
        const auto& rows = reference.rows;
        for (std::size_t i = 0; i + 2 < rows.size(); i += 2) {
            const double h = rows[i + 1].stretch - rows[i].stretch;
            const double work =
                h / 3.0 *
                (rows[i].first_piola_kirchhoff + 4.0 * rows[i + 1].first_piola_kirchhoff +
                 rows[i + 2].first_piola_kirchhoff);
            EXPECT_NEAR(energy(rows[i + 2]) - energy(rows[i]), work, 1e-5 * reference.young);
        }
    }
}

}  // namespace
}  // namespace incise::physics
