// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "incise/fragments/cell_weights.h"
#include "incise/fragments/fragment_update.h"
#include "incise/fragments/part_shares.h"
#include "incise/fragments/part_volumes.h"
#include "incise/topology/geometry.h"

namespace incise::fragments {

using topology::Carriers;
using topology::CellKind;
using topology::ChangeSet;
using topology::FollowedEpoch;
using topology::max_corners;
using topology::Mesh;
using topology::signed_volume;
using topology::VertexRecord;

namespace {

/// Returns for each node the lowest one with the same rest position.
std::vector<NodeId> lowest_at_same_position(std::span<const Vec3> rest_positions) {
    std::vector<NodeId> nodes;
    for (std::size_t n = 0; n < rest_positions.size(); ++n) nodes.emplace_back(n);
    const auto position = [&](NodeId n) -> const Vec3& { return rest_positions[n.index()]; };
    std::ranges::sort(nodes, [&](NodeId a, NodeId b) {
        const Vec3 &x = position(a), &y = position(b);
        for (int c = 0; c < 3; ++c)
            if (x[c] != y[c]) return x[c] < y[c];
        return a < b;
    });
    std::vector<NodeId> lowest(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const bool is_first = i == 0 || position(nodes[i - 1]) != position(nodes[i]);
        lowest[nodes[i].index()] = is_first ? nodes[i] : lowest[nodes[i - 1].index()];
    }
    return lowest;
}

/// Returns the volume of a cell with plane triangles where diagonals divide its faces, m3.
double volume_of_cell(CellKind kind, std::span<const Vec3> x, topology::Diagonals diagonals) {
    if (diagonals.is_none()) return signed_volume(kind, x);
    const PartNumbers volumes = part_volumes(kind, x, diagonals);
    return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

}  // namespace

FragmentMesh::FragmentMesh(const Mesh& material, double light_share, std::span<const VertexId> held)
    : FragmentMesh(light_share, FollowedEpoch(material)) {
    is_constrained_.assign(material.node_capacity(), 0);
    constrain(held);
    const Carriers& source = material.source_carriers();
    const std::vector<NodeId> corners_of_source = add_nodes(material);
    std::vector<std::size_t> first_corner{0};  // by row
    for (const auto& corners : source.corners)
        first_corner.push_back(first_corner.back() + corners.size());
    std::vector<CarrierId> carrier_of_row(source.corners.size());
    topology::reserve_with_room(material.element_capacity(), kinds_, regions_, is_alive_,
                                corner_begin_, carrier_of_cell_, fragment_of_cell_);
    topology::reserve_with_room(material.connectivity().corners.size(), corners_);
    for (std::size_t i = 0; i < material.element_capacity(); ++i) {
        const CellId cell(i);
        CarrierId carrier(i);
        std::vector<NodeId> corners;
        // Of a polyhedron, the carrier is the cell before its faces were divided.
        const auto whole = material.is_polyhedron(cell) ? material.whole_cell(cell) : std::nullopt;
        CellKind kind = whole ? whole->kind : material.kind(cell);
        for (const VertexId v : whole ? whole->corners() : material.corners(cell))
            corners.push_back(with_number_of<NodeId>(v));
        if (whole) {
            diagonals_.resize(material.element_capacity());
            diagonals_[i] = whole->diagonals;
        }
        if (i < source.of_cell.size() && source.of_cell[i] != Carriers::whole) {
            const auto row = static_cast<std::size_t>(source.of_cell[i]);
            if (!carrier_of_row[row].is_valid()) carrier_of_row[row] = carrier;
            carrier = carrier_of_row[row];
            // A polyhedron that is not the first part has an id of a carrier, and none of its own.
            if (carrier == CarrierId(i) || material.is_polyhedron(cell)) {
                const auto of_source = std::span(corners_of_source)
                                           .subspan(first_corner[row], source.corners[row].size());
                corners.assign(of_source.begin(), of_source.end());
                kind = source.corners[row].kind();
                if (!source.corners[row].diagonals.is_none()) {
                    diagonals_.resize(material.element_capacity());
                    diagonals_[i] = source.corners[row].diagonals;
                }
            }
            if (material.is_alive(cell)) cells_of_carrier_[carrier].push_back(cell);
        }
        kinds_.push_back(kind);
        regions_.push_back(material.region(cell));
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        corner_begin_.push_back(static_cast<std::uint32_t>(corners_.size()));
        is_alive_.push_back(material.is_alive(cell) && carrier == CarrierId(i) ? 1 : 0);
        carrier_of_cell_.push_back(carrier);
        fragment_of_cell_.push_back(with_number_of<ElementId>(carrier));
    }
    is_node_alive_.assign(rest_positions_.size(), 0);
    for (std::size_t i = 0; i < is_alive_.size(); ++i)
        if (is_alive_[i] != 0)
            for (const NodeId n : corners(ElementId(i))) is_node_alive_[n.index()] = 1;
    std::vector<CarrierId> divided;
    for (const CarrierId carrier : carrier_of_row)
        if (carrier.is_valid()) divided.push_back(carrier);
    for (const CarrierId carrier : divided) drop_if_trivial(cells_of_carrier_, carrier);
    for (const auto& [carrier, cells] : cells_of_carrier_)
        cells_of_fragment_.emplace(with_number_of<ElementId>(carrier), cells);
    complete();
    if (!divided.empty()) FragmentUpdate::divide(*this, material, std::move(divided));
}

/// Adds the nodes of the material, and one for each position at which only carriers of the source
/// have a corner. Returns the node of each corner of these carriers, in the order of their rows.
std::vector<NodeId> FragmentMesh::add_nodes(const Mesh& material) {
    rest_positions_.assign(material.rest_positions().begin(), material.rest_positions().end());
    const std::size_t num_nodes = rest_positions_.size();
    std::vector<Vec3> positions = rest_positions_;
    for (const topology::CarrierCorners& corners : material.source_carriers().corners)
        positions.insert(positions.end(), corners.begin(), corners.end());
    std::vector<NodeId> nodes = lowest_at_same_position(positions);
    origins_.assign(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(num_nodes));
    for (std::size_t i = num_nodes; i < nodes.size(); ++i) {
        const bool is_new = nodes[i] == NodeId(i);
        nodes[i] = is_new ? NodeId(rest_positions_.size()) : nodes[nodes[i].index()];
        if (!is_new) continue;
        rest_positions_.push_back(positions[i]);
        origins_.push_back(nodes[i]);
    }
    num_origins_ = origins_.size();
    nodes.erase(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(num_nodes));
    return nodes;
}

void FragmentMesh::complete() {
    num_nodes_ = static_cast<std::size_t>(std::ranges::count(is_node_alive_, 1));
    num_elements_ = static_cast<std::size_t>(std::ranges::count(is_alive_, 1));
    std::vector<std::uint32_t> end(num_origins_ + 1, 0);  // of the list of each node
    volumes_.reserve(kinds_.size());
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        const CarrierId carrier(i);
        const CornerNodes origins = origins_of(carrier);
        std::array<Vec3, max_corners> x;
        for (std::size_t k = 0; k < origins.size(); ++k) x[k] = rest_position(origins[k]);
        volumes_.push_back(volume_of_cell(kind_of(carrier), std::span(x).first(origins.size()),
                                          diagonals_of(carrier)));
        if (!was_never_alive(carrier))
            for (const NodeId n : origins) ++end[n.index() + 1];
    }
    for (std::size_t i = 0; i < num_origins_; ++i) end[i + 1] += end[i];
    carrier_begin_ = end;
    carriers_at_.resize(end.back());
    for (std::size_t i = 0; i < kinds_.size(); ++i)
        if (!was_never_alive(CarrierId(i)))
            for (const NodeId n : origins_of(CarrierId(i)))
                carriers_at_[end[n.index()]++] = CarrierId(i);
}

FragmentChanges FragmentMesh::apply(const Mesh& material, const ChangeSet& changes) {
    if (changes.is_empty()) return {};
    epoch_.advance(material, changes, "fragment mesh");
    constrain_new_nodes(changes);
    return FragmentUpdate(*this, material, changes).run();
}

void FragmentMesh::constrain(std::span<const VertexId> vertices) {
    std::ranges::fill(is_constrained_, 0);
    for (const VertexId v : vertices) is_constrained_[v.index()] = 1;
}

void FragmentMesh::constrain_new_nodes(const ChangeSet& changes) {
    is_constrained_.resize(changes.node_capacity_after, 0);
    for (const VertexRecord& record : changes.nodes_added) {
        if (record.id.index() < changes.node_capacity_before) continue;  // an undo brings it back
        const auto sources =
            std::span(record.sources).first(static_cast<std::size_t>(record.num_sources));
        is_constrained_[record.id.index()] = std::ranges::all_of(
            sources,
            [&](const VertexRecord::Source& source) { return is_constrained(source.node); });
    }
}

void FragmentMesh::go_back(const Mesh& material, const FragmentChanges& back) {
    const FragmentMeshChanges& edit = back.mesh;
    if (edit.epoch_before == edit.epoch_after) return;
    epoch_.advance(material, edit, "fragment mesh");

    for (const CarriedCell& cell : back.cells) {
        if (cell.from.is_valid() && cell.to.is_valid()) continue;
        std::vector<CellId>& cells = entry_of(cells_of_carrier_, cell.carrier);
        if (cell.to.is_valid())
            cells.insert(std::ranges::upper_bound(cells, cell.cell), cell.cell);
        else
            std::erase(cells, cell.cell);
        drop_if_trivial(cells_of_carrier_, cell.carrier);
    }
    std::vector<CarrierId> carriers;
    for (const auto* records : {&edit.elements_added, &edit.elements_removed})
        for (const auto& record : *records) carriers.push_back(carrier(record.id));
    for (const auto& rewiring : edit.rewired)
        corners_[corner_begin_[rewiring.element.index()] +
                 static_cast<std::size_t>(rewiring.corner)] = rewiring.to;
    for (const auto& record : edit.elements_added) is_alive_[record.id.index()] = 1;
    for (const auto& record : edit.elements_removed) is_alive_[record.id.index()] = 0;
    for (const ShareChange& share : back.shares) set_share(share.fragment, share.to);
    for (const auto& record : edit.nodes_added) is_node_alive_[record.id.index()] = 1;
    for (const CarriedCell& cell : back.cells) {
        move_cell(cell.cell, cell.from, cell.to);
        set_carried_around(cell.cell, cell.is_around);
    }
    for (const CarrierId of : carriers) {
        std::vector<ElementId> living;
        for (const ElementId known : fragments_of(of))
            if (is_alive(known)) living.push_back(known);
        for (const auto& record : edit.elements_added)
            if (carrier(record.id) == of && std::ranges::find(living, record.id) == living.end())
                living.push_back(record.id);
        std::ranges::sort(living);
        set_fragments(of, std::move(living));
    }
    for (const auto& record : edit.elements_removed) cells_of_fragment_.erase(record.id);
    num_elements_ += edit.elements_added.size();
    num_elements_ -= edit.elements_removed.size();
    num_nodes_ += edit.nodes_added.size();
    num_nodes_ -= edit.nodes_removed.size();
    std::vector<ElementId> changed;
    for (const CarriedCell& cell : back.cells) changed.insert(changed.end(), {cell.from, cell.to});
    for (const ShareChange& share : back.shares) changed.push_back(share.fragment);
    std::vector<CarrierId> touched;
    for (const ElementId e : changed) {
        if (!e.is_valid()) continue;
        touched.push_back(carrier(e));
        if (!is_alive(e)) part_shares_.erase(e);
    }
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const CarrierId carrier : touched) update_part_shares(material, carrier);
    truncate(edit.node_capacity_after, edit.element_capacity_after, material.element_capacity());
    is_constrained_.resize(material.node_capacity());
}

void FragmentMesh::truncate(std::size_t num_nodes, std::size_t num_elements,
                            std::size_t num_cells) {
    for (std::size_t e = num_elements; e < element_capacity(); ++e) shares_.erase(ElementId(e));
    carriers_of_added_.resize(num_elements - kinds_.size());
    is_alive_.resize(num_elements);
    corner_begin_.resize(num_elements + 1);
    corners_.resize(corner_begin_.back());
    origins_.resize(num_nodes);
    rest_positions_.resize(num_nodes);
    is_node_alive_.resize(num_nodes);
    carrier_of_cell_.resize(num_cells);
    fragment_of_cell_.resize(num_cells);
}

void FragmentMesh::move_cell(CellId cell, ElementId from, ElementId to) {
    if (from.is_valid()) std::erase(entry_of(cells_of_fragment_, from), cell);
    if (to.is_valid()) {
        std::vector<CellId>& cells = entry_of(cells_of_fragment_, to);
        cells.insert(std::ranges::upper_bound(cells, cell), cell);
    }
    fragment_of_cell_[cell.index()] = to;
    if (from.is_valid()) drop_if_trivial(cells_of_fragment_, from);
    if (to.is_valid()) drop_if_trivial(cells_of_fragment_, to);
}

FragmentMesh::PartSharesUpdate FragmentMesh::update_part_shares(const Mesh& material,
                                                                CarrierId carrier) {
    PartSharesUpdate update;
    const CellKind kind = kinds_[carrier.index()];
    if (kind == CellKind::tetrahedron) return update;
    const topology::Diagonals diagonals = diagonals_of(carrier);
    std::array<Vec3, max_corners> x;
    const auto origins = origins_of(carrier);
    for (std::size_t k = 0; k < origins.size(); ++k) x[k] = rest_position(origins[k]);
    const auto at_rest = std::span(x).first(origins.size());

    std::vector<ElementId> owners;  // of the parts; the last one has none: it is carried elsewhere
    std::vector<std::vector<CellId>> parts;
    for (const ElementId e : fragments_of(carrier)) {
        if (!e.is_valid()) continue;
        owners.push_back(e);
        parts.emplace_back();
        for (const CellId cell : cells_of(e))
            if (is_own(cell)) parts.back().push_back(cell);
    }
    owners.emplace_back();
    parts.emplace_back();
    for (const CellId cell : cells_of_carrier(carrier))
        if (material.is_alive(cell) && !is_own(cell)) parts.back().push_back(cell);

    const double whole = volume_of(carrier);
    constexpr double rounding = 1e-10;  // as FragmentParts::share_of
    double filled = 0.0;
    std::vector<double> volumes;  // by part, m3
    std::vector<std::vector<double>> fractions, divided;
    for (const auto& cells : parts) {
        fractions.push_back(filled_fractions(kind, at_rest, material, cells, diagonals));
        double sum = 0.0;
        for (const CellId cell : cells) sum += topology::rest_volume(material, cell);
        filled += sum;
        // A part that is turned inside out has volume, and nothing in any tetrahedron.
        if (fractions.back().empty() && sum > 0.0 && sum < (1.0 - rounding) * whole)
            fractions.back().assign(num_parts(kind), sum / whole);
        volumes.push_back(sum);
    }
    const PartNumbers part_sizes = part_volumes(kind, at_rest, diagonals);
    const auto volume_of = [&](std::span<const double> of_part) {
        return std::inner_product(of_part.begin(), of_part.end(), part_sizes.begin(), 0.0);
    };
    // What is carried elsewhere has its volume there, and the others share the rest.
    std::vector<double> rest(num_parts(kind), 1.0);
    const std::vector<double>& elsewhere = fractions.back();
    const double volume_elsewhere = elsewhere.empty() ? 0.0 : volume_of(elsewhere);
    for (std::size_t t = 0; t < rest.size(); ++t)
        rest[t] = std::max(
            0.0, 1.0 - volumes.back() * (volume_elsewhere > 0.0 ? elsewhere[t] / volume_elsewhere
                                                                : 1.0 / whole));
    fractions.pop_back();
    for (const auto& of_part : fractions)
        if (!of_part.empty()) divided.push_back(of_part);
    const bool fit = !divided.empty() && std::abs(filled - whole) <= rounding * whole;
    if (fit) {
        fit_together(divided, rest);
        auto next = divided.begin();
        for (auto& of_part : fractions)
            if (!of_part.empty()) of_part = std::move(*next++);
    }
    for (std::size_t p = 0; p + 1 < owners.size(); ++p) {
        const ElementId e = owners[p];
        double others = 0.0;
        for (const CellId cell : cells_of(e))
            if (carrier_of_cell(cell) != carrier || !is_own(cell))
                others += topology::rest_volume(material, cell);
        if (!fractions[p].empty()) {
            // Parts that reach into each other have not what their volumes say: together, they
            // have the whole of each tetrahedron.
            const double own = volume_of(fractions[p]);
            const bool differs = fit && std::abs(own - volumes[p]) > rounding * whole;
            update.has_overlaps |= differs;
            set_share(e, ((differs ? own : volumes[p]) + others) / whole);
        }
        // What it carries of others is in all tetrahedra alike: if an edit then divides the
        // fragment, that stays where it is.
        if (others > rounding * whole)
            for (double& fraction : fractions[p]) fraction += others / whole;
        if (std::ranges::equal(part_shares(e), fractions[p])) continue;
        update.changed.push_back(e);
        if (fractions[p].empty())
            part_shares_.erase(e);
        else
            part_shares_[e] = std::move(fractions[p]);
    }
    return update;
}

void FragmentMesh::set_fragments(CarrierId carrier, std::vector<ElementId> fragments) {
    fragments_of_carrier_[carrier] = std::move(fragments);
    drop_if_trivial(fragments_of_carrier_, carrier);
}

VertexId FragmentMesh::vertex_of_origin(const Mesh& material, NodeId n) const {
    const auto v = with_number_of<VertexId>(origin(n));
    const bool is_there = v.index() < material.node_capacity() &&
                          material.rest_position(v) == rest_position(origin(n));
    return is_there ? v : VertexId();
}

int FragmentMesh::corner_of(ElementId e, NodeId n) const {
    const auto nodes = corners(e);
    const auto it = std::find(nodes.begin(), nodes.end(), n);
    return it == nodes.end() ? -1 : static_cast<int>(it - nodes.begin());
}

CornerNodes FragmentMesh::origins_of(CarrierId carrier) const {
    CornerNodes origins;
    for (const NodeId n : corners(with_number_of<ElementId>(carrier)))
        origins.push_back(origins_[n.index()]);
    return origins;
}

std::span<const CarrierId> FragmentMesh::carriers_at(NodeId origin) const {
    return {carriers_at_.data() + carrier_begin_[origin.index()],
            carrier_begin_[origin.index() + 1] - carrier_begin_[origin.index()]};
}

void FragmentMesh::star(NodeId n, std::vector<ElementId>& elements) const {
    elements.clear();
    for (const CarrierId carrier : carriers_at(origins_[n.index()]))
        for (const ElementId e : fragments_of(carrier))
            if (corner_of(e, n) >= 0) elements.push_back(e);
    std::sort(elements.begin(), elements.end());
}

bool FragmentMesh::has_element_at(NodeId n) const {
    return std::ranges::any_of(carriers_at(origins_[n.index()]), [&](CarrierId carrier) {
        return std::ranges::any_of(fragments_of(carrier),
                                   [&](ElementId e) { return corner_of(e, n) >= 0; });
    });
}

ElementId FragmentMesh::incident_element(NodeId n) const {
    std::vector<ElementId> elements;
    star(n, elements);
    return elements.empty() ? ElementId() : elements.front();
}

EmbeddedPoint FragmentMesh::embedded(const Mesh& material, VertexId v) const {
    std::vector<CellId> cells;
    material.star(v, cells);
    ElementId at_home, lowest;
    for (const CellId cell : cells) {
        const ElementId e = fragment_of_cell(cell);
        if (!lowest.is_valid() || e < lowest) lowest = e;
        if (is_at_home(cell) && (!at_home.is_valid() || e < at_home)) at_home = e;
    }
    return embedded(at_home.is_valid() ? at_home : lowest, material.rest_position(v));
}

EmbeddedPoint FragmentMesh::embedded(ElementId e, const Vec3& x) const {
    const auto weights = weights_in_carrier(carrier(e), x);
    EmbeddedPoint result{e, {}, {}, 0};
    const auto nodes = corners(e);
    for (const NodeId n : nodes) {
        if (rest_position(n) != x) continue;
        result.nodes[0] = n;
        result.weights = {1.0};
        result.count = 1;
        return result;
    }
    // On a face or an edge of a cell with many corners, most weights are zero.
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (weights[k] == 0.0 && kind(e) != CellKind::tetrahedron) continue;
        const auto next = static_cast<std::size_t>(result.count++);
        result.nodes[next] = nodes[k];
        result.weights[next] = weights[k];
    }
    return result;
}

std::array<double, max_corners> FragmentMesh::weights_in_carrier(CarrierId carrier,
                                                                 const Vec3& x) const {
    std::array<double, max_corners> weights{};
    const auto nodes = origins_of(carrier);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        if (rest_position(nodes[k]) == x) {
            weights[k] = 1.0;
            return weights;
        }
    if (const CellKind kind = kinds_[carrier.index()]; kind != CellKind::tetrahedron) {
        std::array<Vec3, max_corners> corners;
        for (std::size_t k = 0; k < nodes.size(); ++k) corners[k] = rest_position(nodes[k]);
        return weights_in_cell(kind, std::span(corners).first(nodes.size()), x,
                               diagonals_of(carrier));
    }
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) =
            rest_position(nodes[static_cast<std::size_t>(k) + 1]) - rest_position(nodes[0]);
    const Vec3 local = edges.partialPivLu().solve(x - rest_position(nodes[0]));
    weights = {1.0 - local.sum(), local[0], local[1], local[2]};
    // A point on a face of the carrier depends on the corners of this face only.
    constexpr double rounding = 1e-13;
    std::size_t largest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (std::abs(weights[k]) < rounding) weights[k] = 0.0;
        if (weights[k] > weights[largest]) largest = k;
    }
    double others = 0.0;
    for (std::size_t k = 0; k < 4; ++k) others += k == largest ? 0.0 : weights[k];
    weights[largest] = 1.0 - others;
    return weights;
}

}  // namespace incise::fragments
