// A mesh as CGAL's linear cell complex, and back. A program that includes this header links
// CGAL::CGAL.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <CGAL/Cell_attribute.h>
#include <CGAL/Cell_attribute_with_point.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Linear_cell_complex_for_combinatorial_map.h>

#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/diagonals.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// What a vertex of a linear cell complex carries, beside its rest position, m.
struct ComplexVertex {
    VertexId id;  ///< in the mesh that it was made from; invalid for a vertex of your own
    bool operator==(const ComplexVertex&) const = default;
};

/// What a face of a linear cell complex carries. Faces without it are on no cut.
struct ComplexFace {
    bool is_on_cut = true;  ///< see Mesh::is_on_cut()
    bool operator==(const ComplexFace&) const = default;
};

/// What a volume of a linear cell complex carries.
struct ComplexCell {
    CellId id;  ///< in the mesh that it was made from; invalid for a cell of your own
    int region = 0;
    /// The ends of the first dart of the first face, in the order of cell_kind.h: it gives all
    /// corners their places. If the volume has no such dart, any fitting order is taken. Invalid
    /// for a polyhedron.
    std::array<VertexId, 2> first_edge = {};
    /// The cell that this one is a part of; none for a cell that is whole. Cells with the same
    /// corners here are parts of one carrier. See Carriers. A volume with a carrier becomes a
    /// polyhedron, whatever its shape, but for a tetrahedron of a tetrahedron with a first edge.
    std::optional<CarrierCorners> carrier = {};
    /// Of a hexahedron, wedge or pyramid, the quadrilaterals that are two triangles here.
    Diagonals diagonals = {};
    bool operator==(const ComplexCell&) const = default;
};

/// The attributes of a linear cell complex. Edges have none; of the faces only those on cuts have.
struct LinearCellComplexItems {
    template <class Map>
    struct Dart_wrapper {
        using Vertex_attribute = CGAL::Cell_attribute_with_point<Map, ComplexVertex>;
        using Face_attribute = CGAL::Cell_attribute<Map, ComplexFace>;
        using Volume_attribute = CGAL::Cell_attribute<Map, ComplexCell>;
        using Attributes = std::tuple<Vertex_attribute, void, Face_attribute, Volume_attribute>;
    };
};

/// CGAL's linear cell complex of a mesh. Its kernel is one whose points CGAL writes to files
/// exactly: CGAL::save_combinatorial_map() and CGAL::load_combinatorial_map() write and read the
/// attributes, too.
using LinearCellComplex = CGAL::Linear_cell_complex_for_combinatorial_map<
    3, 3, CGAL::Linear_cell_complex_traits<3, CGAL::Exact_predicates_inexact_constructions_kernel>,
    LinearCellComplexItems>;

/// Returns the living cells and vertices as a linear cell complex: a volume for each cell, sewn
/// where cells are joined. Attributes are created in ascending order of ids.
/// Cost: O(n), about a microsecond and a kilobyte a cell.
/// @param mesh      the mesh
/// @param carriers  of its living cells, as fragments::carriers_of() gives them; empty for a body
///                  that was never cut
LinearCellComplex to_linear_cell_complex(const Mesh& mesh, const Carriers& carriers = {});

/// Builds a mesh from a linear cell complex. Cells are joined where volumes are sewn, and nowhere
/// else. Ids are given in ascending order of the ids of the complex; vertices without an id come
/// last, in the order of their attributes, and cells in that of their first darts. Volumes without
/// attribute have region 0. Volumes with a carrier become polyhedra, as cuts leave them, with faces
/// in the order of their first darts. Others must be tetrahedra, hexahedra, wedges or pyramids.
/// The mesh of to_linear_cell_complex() is the same mesh, but for ids of dead nodes and cells,
/// labels and epoch.
/// Throws InputError, which names the volume and a remedy: for a polyhedron without a carrier,
/// which has no forces; for a volume that is not closed, is no ball, is turned inside out, or
/// cannot be a part of its carrier; for a dart without vertex attribute; and as Mesh::build() does.
/// Cost: O(n log n).
BuiltMesh from_linear_cell_complex(const LinearCellComplex& complex);

/// Let CGAL write the attributes to files and read them.
void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexVertex& vertex);
void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexFace& face);
void write_cmap_attribute_node(boost::property_tree::ptree& node, const ComplexCell& cell);
void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexVertex& vertex);
void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexFace& face);
void read_cmap_attribute_node(const boost::property_tree::ptree::value_type& node,
                              ComplexCell& cell);

}  // namespace incise::topology
