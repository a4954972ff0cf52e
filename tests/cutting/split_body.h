// Bodies that are split, the surfaces along which they are, and plain geometry to judge by.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "incise/cutting/cutter.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/surface_data.h"
#include "support/first_surface.h"
#include "support/surfaces.h"

namespace incise::cutting {

using test::box_surface;
using test::icosphere;

using Polyline = std::vector<Vec3>;
/// A surface, or what a blade sweeps in a step.
struct StrokePart {
    template <class Surface>
    StrokePart(std::unique_ptr<Surface> whole) : surface(std::move(whole)) {}
    StrokePart(const Polyline& before, const Polyline& after);

    std::unique_ptr<CutSurface> surface;
    Polyline from, to;  ///< of a blade's edge; else empty
};
/// What one cut consists of.
using Stroke = std::vector<StrokePart>;
Stroke sweep(const Polyline& from, const Polyline& to, int num_steps);

/// A mesh whose nodes are moved about, and split. Every cut is followed by the checks of a mesh.
class SplitBody {
  public:
    explicit SplitBody(const topology::MeshData& data);

    /// A blade goes on with its cut, which it begins if there is none. The nodes go to `moved` (m,
    /// by node id) meanwhile.
    Split cut(const StrokePart& part, std::optional<CutId>& blade, const SplitOptions& options,
              const std::vector<Vec3>& moved);
    Split cut(const StrokePart& part, std::optional<CutId>& blade, const SplitOptions& options) {
        return cut(part, blade, options, std::vector<Vec3>(positions));
    }
    /// A surface at once, through tissue that is still.
    Split cut(const CutSurface& surface, const SplitOptions& options = {0.0});

    /// What the parts of a stroke did, one after the other. Its blade is taken away at last.
    std::vector<Split> cut(const Stroke& stroke, const SplitOptions& options = {0.0});

    /// Ends the cut of a blade in tissue that is still.
    Split finish(const BladeEnd& end, std::optional<CutId>& blade);

    /// Of the body as it is. It begins to know it at the first call.
    Cutter& cutter();
    void replace(Cutter cutter) { cutter_ = std::move(cutter); }

    Box box() const;  ///< of the present positions

    topology::Mesh mesh;
    fragments::FragmentMesh fragments;
    std::vector<Vec3> positions;  ///< by node id, m
    test::FirstSurface first_surface;

  private:
    Split follow(Split done);

    std::optional<Cutter> cutter_;
};

SplitReport sum(const std::vector<Split>& parts);

/// Positions after an edit: new nodes are where its record says.
std::vector<Vec3> followed(std::vector<Vec3> positions, const topology::ChangeSet& changes);

/// Of a cell, m3.
double element_volume(const topology::Mesh& mesh, CellId e, std::span<const Vec3> positions);
/// At rest, the largest first, m3.
std::vector<double> piece_volumes(const topology::Mesh& mesh);
double rest_volume(const topology::Mesh& mesh);
/// Volume of a body on the side of the plane to which the normal points; each cell is clipped for
/// itself.
double volume_above(const topology::Mesh& mesh, std::span<const Vec3> positions, const Vec3& point,
                    const Vec3& normal);

double longest_edge(const topology::Mesh& mesh, std::span<const Vec3> positions);

/// Both sides of each face that cuts have opened: faces of the boundary at the same place at rest.
/// Only those sides that have not been divided differently since.
std::vector<topology::FacePair> cut_faces(const topology::Mesh& mesh);
/// Nodes at cut faces, without those that only pairs of one and the same node meet at: sides of
/// the cut that are still joined there.
struct NodesOfCut {
    std::vector<VertexId> parted;  ///< both of each pair
    std::vector<VertexId> front;   ///< the same on both sides
};
NodesOfCut nodes_of_cut(const topology::Mesh& mesh);

struct PlaneOfCut {
    Vec3 point, normal;
};
/// Expects that no piece is on both sides of a plane, but for so much (m), and slivers.
void expect_parted(const topology::Mesh& mesh, std::span<const Vec3> positions,
                   const PlaneOfCut& plane, double off);

/// A rectangle about `centre` from -u - v to u + v in n x n squares, raised by height(s, t), s and
/// t from -1 to 1.
topology::SurfaceData sheet(const Vec3& centre, const Vec3& u, const Vec3& v, int n,
                            const std::function<Vec3(double, double)>& height);
/// Of a closed surface, m3.
double enclosed_volume(const topology::SurfaceData& surface);

}  // namespace incise::cutting
