// The bodies over which invariants are tested, and random programs of edits on them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"

namespace incise::test {

struct MeshFamily {
    std::string name;
    topology::MeshData data;
};

/// One tetrahedron; two by a face; two by an edge; a jittered Kuhn cube; a ring; a ball; an
/// organ-like body; a block of boxes; cubes that fill a hollow ball; wedge, pyramid, hexahedron and
/// tetrahedra glued together; bricks in which quadrilaterals meet triangles.
const std::vector<MeshFamily>& mesh_families();

/// The same cells, each with points of its own: points are numbered in the order of the corners.
topology::MeshData soup_of(const topology::MeshData& data);

/// Those of one kind of cell only; under sanitizers, of a few hundred cells only.
std::vector<const MeshFamily*> families_of(topology::CellKind kind);
std::vector<const MeshFamily*> tetrahedral_families();

/// Kuhn cube of n^3 bricks, side 1, inner points moved by up to `jitter` of an edge.
topology::MeshData jittered_cube(int n, double jitter, std::uint64_t seed);

/// What the bricks of a cube consist of: hexahedra, two wedges or six pyramids each, or all of
/// these, with whole columns of wedges. Those that are joined are at random hexahedra, wedges,
/// tetrahedra, or pyramids and tetrahedra: quadrilaterals meet two triangles, with any diagonal.
enum class Bricks { hexahedra, wedges, pyramids, mixed, joined };
/// The unit cube in n^3 bricks, inner points moved by up to `jitter` of an edge.
topology::MeshData brick_cube(Bricks bricks, int n, double jitter, std::uint64_t seed);

/// Random numbers that are the same on every machine: the standard leaves distributions open.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// In [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    std::size_t below(std::size_t n) {
        return static_cast<std::size_t>(uniform() * static_cast<double>(n));
    }
    Vec3 vector(double size) {
        const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
        return {x, y, z};
    }
    /// A point with coordinates 0 to size - 1, among which anything touches anything.
    Vec3 grid_point(std::size_t size) {
        const auto coordinate = [&] { return static_cast<double>(below(size)); };
        const double x = coordinate(), y = coordinate(), z = coordinate();
        return {x, y, z};
    }

  private:
    std::mt19937_64 engine_;
};

/// Faces between two elements; of its two sides the lower one.
std::vector<FaceId> inner_faces(const topology::Mesh& mesh);
/// Pairs of boundary faces at the same rest positions: what an opened face left.
std::vector<topology::FacePair> open_pairs(const topology::Mesh& mesh);

/// One random transaction: removals, openings, closings, edges divided or a mixture of them, near
/// each other or scattered, small or large. Empty when the mesh has nothing left to edit.
topology::ChangeSet random_edit(topology::Mesh& mesh, Random& random);

}  // namespace incise::test
