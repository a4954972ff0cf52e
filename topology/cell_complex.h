// Cells of any shape in CGAL's linear cell complex, and the operations that divide and join them.
// Internal: only files that cut include this header.
// Source: Damiand, Lienhardt 2014, chapters 4 and 6 (combinatorial maps, Euler operators).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <CGAL/Cell_attribute.h>
#include <CGAL/Cell_attribute_with_point.h>
#include <CGAL/Linear_cell_complex_for_combinatorial_map.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// Cells that are balls: their faces are polygons with one boundary, and each edge of a cell has
/// exactly two of its faces. A hexahedron, wedge, pyramid or tetrahedron is one, and so is each
/// part of it.
///
/// A dart is an edge of a face of a cell, with a direction: from the corner at which it starts to
/// the next one of the face, anticlockwise as seen from outside the cell. next() goes on in the
/// face, opposite() goes to the other face of the cell at the edge, across() to the same edge in
/// the cell on the other side of the face.
///
/// Each operation changes the map near its arguments only, and has an inverse. Ids are given by the
/// caller. CGAL's own operations of the same meaning are the reference in the tests; these here
/// know more of their arguments and cost a fraction.
class CellComplex {
  public:
    struct Items {
        template <class Map>
        struct Dart_wrapper {
            using Vertex_attribute = CGAL::Cell_attribute_with_point<Map, VertexId>;
            using Volume_attribute = CGAL::Cell_attribute<Map, CellId>;
            using Attributes = std::tuple<Vertex_attribute, void, void, Volume_attribute>;
        };
    };
    using Map = CGAL::Linear_cell_complex_for_combinatorial_map<
        3, 3, CGAL::Linear_cell_complex_traits<3, CGAL::Simple_cartesian<double>>, Items>;
    using Dart = Map::Dart_handle;

    CellComplex() = default;
    CellComplex(const CellComplex&) = delete;  // handles belong to one map
    CellComplex& operator=(const CellComplex&) = delete;

    Dart next(Dart d) const { return map().beta<1>(d); }
    Dart previous(Dart d) const { return map().beta<0>(d); }
    Dart opposite(Dart d) const { return map().beta<2>(d); }
    /// Returns the dart on the other side of the face, which runs the other way. Null on the
    /// boundary.
    Dart across(Dart d) const { return map().is_free<3>(d) ? nullptr : map().beta<3>(d); }
    /// Returns the vertex at which the dart starts.
    VertexId vertex(Dart d) const { return map_.info<0>(d); }
    CellId cell(Dart d) const { return map_.info<3>(d); }
    Vec3 position(Dart d) const {
        const auto& x = map_.point(d);
        return {x.x(), x.y(), x.z()};
    }

    /// Returns a dart of a cell. @pre the cell is there
    Dart dart_of(CellId e) const { return darts_[e.index()]; }
    bool has(CellId e) const { return e.index() < darts_.size() && darts_[e.index()] != nullptr; }
    /// Returns one dart for each face of a cell, in the order in which a walk from dart_of() finds
    /// them.
    void faces(CellId e, std::vector<Dart>& faces) const;
    /// Returns the darts of the face of a dart, from it on.
    void face(Dart d, std::vector<Dart>& darts) const;
    /// Returns the volume of a cell at rest, m3: of the fans of its faces.
    double volume(CellId e) const;
    /// Returns the vector area of the face of a dart, m2. It points out of the cell.
    Vec3 area(Dart d) const;

    /// Adds a cell that is joined to no other. Vertices with the ids of others are theirs.
    /// @param e        its id
    /// @param kind     its kind
    /// @param corners  in the order of cell_kind.h
    /// @param x        their rest positions, m, in the same order
    void add(CellId e, CellKind kind, std::span<const VertexId> corners, std::span<const Vec3> x);
    /// Removes a cell, and opens its faces. Appends a dart of each face that is on the boundary
    /// now.
    void remove(CellId e, std::vector<Dart>& opened);
    /// Joins two faces of two cells. The vertices on both sides are the same.
    /// @param a, b  the dart of one face and that of the other along the same edge
    void join(Dart a, Dart b);
    /// Opens the face of a dart. Its vertices stay the same on both sides: see separate().
    /// Returns the dart on the other side. Takes join() back.
    Dart open(Dart d);

    /// Divides an edge, in all cells at it, by a new vertex. Returns the dart from the new vertex
    /// to the end of the edge, in the face of `d`.
    Dart divide_edge(Dart d, VertexId v, const Vec3& x);
    /// Takes divide_edge() back: `d` is what it returned. @pre the vertex has no other edge
    void join_edge(Dart d);
    /// Divides a face, on both sides, by an edge between two of its corners. Returns the new dart
    /// from the first one to the second one, in the part that begins with `to`.
    /// @param from, to  two darts of the face, which are not neighbours
    Dart divide_face(Dart from, Dart to);
    /// Takes divide_face() back: `d` is what it returned.
    void join_faces(Dart d);
    /// Divides a cell by a face. Returns a dart of the new face, in the new cell.
    /// @param loop  darts of the cell, each of which starts where the one before it ends, and the
    ///              first one where the last one ends. No vertex is met twice.
    /// @param e     the id of the part on the other side of the loop, to the right of its darts
    Dart divide_cell(std::span<const Dart> loop, CellId e);
    /// Takes divide_cell() back: `d` is what it returned. The cell on the other side remains.
    void join_cells(Dart d);

    /// Appends the darts that start at the vertex of a dart and are connected with it through faces
    /// at the vertex, and returns the lowest cell that has one.
    CellId star(Dart d, std::vector<Dart>& darts) const;
    /// Makes `v`, at `x`, the vertex of all darts that star() gives: a copy where faces were
    /// opened, or the former one again. Call it for each part of a star that came apart, also for
    /// the one that keeps its vertex.
    void set_vertex(Dart d, VertexId v, const Vec3& x);

    std::size_t num_cells() const { return map_.attributes<3>().size(); }
    std::size_t num_vertices() const { return map_.attributes<0>().size(); }
    /// Returns what is wrong with the map; empty if nothing is. For each cell it checks links, that
    /// it is a ball (vertices - edges + faces = 2), that its volume is not below `least_volume`,
    /// m3, and that vertices are the same all round. Cost: O(n).
    std::vector<std::string> faults(double least_volume = 0.0) const;

    /// CGAL's map, for its own operations and files.
    const Map& map_of_cgal() const { return map_; }

  private:
    using Vertex = Map::Attribute_handle<0>::type;
    using Volume = Map::Attribute_handle<3>::type;

    // Most functions of CGAL that return a plain handle are not const, though they change nothing.
    Map& map() const { return const_cast<Map&>(map_); }
    Dart create(Vertex v, Volume e);
    void erase(Dart d);
    Vertex vertex_for(VertexId v, const Vec3& x);
    template <class Visit>
    void for_each_dart_of_cell(Dart start, Visit visit) const;
    Volume add_volume(CellId e);
    void set_dart_of(CellId e, Dart d);

    Map map_;
    std::vector<Dart> darts_;       // by cell id; null if it is not there
    std::vector<Vertex> vertices_;  // by vertex id; null if it is not there
};

}  // namespace incise::topology
