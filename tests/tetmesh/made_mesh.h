// Meshes that incise mesh has made, as its user meets them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "app/in_folder.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/validate.h"
#include "support/surfaces.h"

namespace incise::test {

/// A mesh, and measures of it.
struct MadeMesh {
    topology::MeshData data;
    topology::MeshMetrics metrics;
    std::map<int, double> volumes;  ///< by region
    int num_components = 0;
    std::string out, err;

    double least_angle() const { return metrics.min_dihedral_angle * 180.0 / std::numbers::pi; }
    double volume(int region) const {
        const auto found = volumes.find(region);
        return found == volumes.end() ? 0.0 : found->second;
    }
};

class MakesTetrahedra : public InFolder {
  protected:
    void write_surface(const std::string& name, const topology::SurfaceData& surface) {
        write(name, stl_text(surface));
    }

    /// Makes out.vtu. It must be valid, without warnings of its check, and all of its tetrahedra
    /// must have dihedral angles of ten degrees or more.
    MadeMesh make(const std::string& arguments) {
        SCOPED_TRACE(arguments);
        const auto outcome = run("mesh " + arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        MadeMesh made;
        made.out = outcome.out;
        made.err = outcome.err;
        if (outcome.status != 0) return made;
        made.data = io::read_mesh(folder_ / "out.vtu").mesh;
        const topology::BuiltMesh built = topology::Mesh::build(made.data);
        EXPECT_THAT(built.warnings, testing::IsEmpty());
        EXPECT_THAT(topology::validate(built.mesh), testing::IsEmpty());
        made.num_components = topology::components(built.mesh).count;
        made.metrics = topology::measure(made.data);
        for (std::size_t c = 0; c < made.data.num_cells(); ++c) {
            std::array<Vec3, 4> x;
            for (std::size_t k = 0; k < 4; ++k)
                x[k] = made.data.points[static_cast<std::size_t>(made.data.cell(c)[k])];
            made.volumes[made.data.regions[c]] += topology::signed_volume(made.data.kinds[c], x);
        }
        EXPECT_GE(made.least_angle(), 10.0);
        return made;
    }

    /// The message of status 2, after which nothing is written.
    std::string refusal(const std::string& arguments) {
        const auto outcome = run("mesh " + arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtu")) << arguments;
        return outcome.err;
    }
};

}  // namespace incise::test
