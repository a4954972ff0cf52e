// Where a surface passes through an edge of the mesh, and how far from its ends.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "cutting/cut_surface.h"
#include "topology/mesh.h"

namespace incise::cutting {

/// An edge of the mesh that may be crossed.
struct CrossableEdge {
    MovingPoint a, b;  ///< before and after the step, m
    Vec3 at_rest;      ///< from a to b, m
};

/// Where the surface passes through an edge, and how far away its ends are from it there, in units
/// of the edge's length at rest.
struct Passage {
    double place, from_a, from_b;
    double time;          ///< 0 before the step, 1 after it
    Vec3 point, normal;   ///< after the step; the normal of unit length, or zero if not known
    Vec3 normal_at_rest;  ///< the same in the frame of rest
};
using Passages = std::vector<Passage>;  // in ascending order of places

/// In ascending order of places. Two that are nearer to each other than `apart`, a share of the
/// edge, are not told apart and cancel out.
std::vector<Crossing> crossings_of(const CutSurface& surface, const CrossableEdge& edge,
                                   double apart);

/// @param normal_at_rest  of the surface at the crossing, in the frame of rest and of any length;
///                        zero if not known: the surface then counts as perpendicular to the edge
Passage passage_at(const Crossing& crossing, const CutSurface& surface, const CrossableEdge& edge,
                   const Vec3& normal_at_rest);

/// An end of an edge that the surface passes through, and where, seen from there.
struct EdgeEnd {
    topology::NodeId node, other;
    topology::ElementId element;  ///< one of those that have the edge
    double place, from;           ///< as in Passage
};

/// How near a node has to be to count as on the surface.
struct NearLimits {
    double share;     ///< of an edge at the node that the surface passes through
    double farthest;  ///< m, at rest
};

/// Whether the end is so near that it counts as on the surface. It is that for all of its edges at
/// once, from the first of them on that the surface comes to: so those of them count that the
/// surface passes through if it goes on straight, and it does not matter into how many steps the
/// way of a blade is taken. Of an edge that lies all but in the surface both ends might be near;
/// that edge speaks for the nearer one only, or whole layers of elements would lie on the surface.
/// @param normal_at_rest  of the surface, of unit length, or zero if not known: only the edge
///                        counts then
/// Cost: a look at the elements round the node, if the edge alone is not long enough.
bool is_near(const topology::Mesh& mesh, const EdgeEnd& end, const Vec3& normal_at_rest,
             const NearLimits& limits);

}  // namespace incise::cutting
