// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/fragment_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "incise/topology/fragment_update.h"
#include "incise/topology/geometry.h"

namespace incise::topology {

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

}  // namespace

FragmentMesh::FragmentMesh(const Mesh& material, double light_share, std::span<const NodeId> held)
    : FragmentMesh(light_share, FollowedEpoch(material)) {
    is_held_.assign(material.node_capacity(), 0);
    hold(held);
    const Carriers& source = material.source_carriers();
    const std::vector<NodeId> corners_of_source = add_nodes(material);
    std::vector<ElementId> carrier_of_row(source.corners.size());
    for (std::size_t i = 0; i < material.element_capacity(); ++i) {
        const ElementId e(i);
        ElementId carrier = e;
        auto corners = material.corners(e);
        if (i < source.of_cell.size() && source.of_cell[i] != Carriers::whole) {
            const auto row = static_cast<std::size_t>(source.of_cell[i]);
            if (!carrier_of_row[row].is_valid()) carrier_of_row[row] = e;
            carrier = carrier_of_row[row];
            if (carrier == e) corners = std::span(corners_of_source).subspan(4 * row, 4);
            if (material.is_alive(e)) cells_of_carrier_[carrier].push_back(e);
        }
        kinds_.push_back(material.kind(e));
        regions_.push_back(material.region(e));
        for (const NodeId n : corners) origins_of_carrier_.push_back(origins_[n.index()]);
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        origin_begin_.push_back(origins_of_carrier_.size());
        carriers_.push_back(e);
        is_alive_.push_back(material.is_alive(e) && carrier == e ? 1 : 0);
        shares_.push_back(1.0);
        carrier_of_cell_.push_back(carrier);
        fragment_of_cell_.push_back(carrier);
    }
    corner_begin_ = origin_begin_;
    is_node_alive_.assign(rest_positions_.size(), 0);
    for (std::size_t i = 0; i < is_alive_.size(); ++i)
        if (is_alive_[i] != 0)
            for (const NodeId n : corners(ElementId(i))) is_node_alive_[n.index()] = 1;
    std::vector<ElementId> divided;
    for (const ElementId carrier : carrier_of_row)
        if (carrier.is_valid()) divided.push_back(carrier);
    for (const ElementId carrier : divided) drop_if_trivial(cells_of_carrier_, carrier);
    cells_of_fragment_ = cells_of_carrier_;
    complete();
    if (!divided.empty()) FragmentUpdate::divide(*this, material, std::move(divided));
}

/// Adds the nodes of the material, and one for each position at which only carriers of the source
/// have a corner. Returns the node of each corner of these carriers, in the order of their rows.
std::vector<NodeId> FragmentMesh::add_nodes(const Mesh& material) {
    rest_positions_.assign(material.rest_positions().begin(), material.rest_positions().end());
    const std::size_t num_nodes = rest_positions_.size();
    std::vector<Vec3> positions = rest_positions_;
    for (const std::array<Vec3, 4>& corners : material.source_carriers().corners)
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
    first_part_.assign(kinds_.size(), -1);
    part_of_cell_.assign(carrier_of_cell_.size(), -1);
    std::vector<std::size_t> end(num_origins_ + 1, 0);  // of the list of each node
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        x.clear();
        for (const NodeId n : origins_of(ElementId(i))) {
            x.push_back(rest_position(n));
            if (!was_never_alive(ElementId(i))) ++end[n.index() + 1];
        }
        volumes_.push_back(signed_volume(kinds_[i], x));
    }
    for (std::size_t i = 0; i < num_origins_; ++i) end[i + 1] += end[i];
    carrier_begin_ = end;
    carriers_at_.resize(end.back());
    for (std::size_t i = 0; i < kinds_.size(); ++i)
        if (!was_never_alive(ElementId(i)))
            for (const NodeId n : origins_of(ElementId(i)))
                carriers_at_[end[n.index()]++] = ElementId(i);
}

FragmentChanges FragmentMesh::apply(const Mesh& material, const ChangeSet& changes) {
    if (changes.is_empty()) return {};
    epoch_.advance(material, changes, "fragment mesh");
    hold_new_nodes(changes);
    return FragmentUpdate(*this, material, changes).run();
}

void FragmentMesh::hold(std::span<const NodeId> nodes) {
    std::ranges::fill(is_held_, 0);
    for (const NodeId n : nodes) is_held_[n.index()] = 1;
}

void FragmentMesh::hold_new_nodes(const ChangeSet& changes) {
    is_held_.resize(changes.node_capacity_after, 0);
    for (const NodeRecord& record : changes.nodes_added) {
        if (record.id.index() < changes.node_capacity_before) continue;  // an undo brings it back
        const auto sources =
            std::span(record.sources).first(static_cast<std::size_t>(record.num_sources));
        is_held_[record.id.index()] = std::ranges::all_of(
            sources, [&](const NodeSource& source) { return is_held(source.node); });
    }
}

void FragmentMesh::undo(const Mesh& material, const FragmentChanges& changes) {
    const ChangeSet& edit = changes.mesh;
    if (edit.epoch_before == edit.epoch_after) return;
    ChangeSet back;
    back.epoch_before = edit.epoch_after;
    back.epoch_after = edit.epoch_before;
    epoch_.advance(material, back, "fragment mesh");

    for (const CarriedCell& cell : changes.cells) {
        if (cell.from.is_valid() && cell.to.is_valid()) continue;
        auto& cells = cells_of_carrier_.try_emplace(cell.carrier, 1, cell.carrier).first->second;
        if (cell.from.is_valid())
            cells.insert(std::ranges::upper_bound(cells, cell.cell), cell.cell);
        else
            std::erase(cells, cell.cell);
        drop_if_trivial(cells_of_carrier_, cell.carrier);
    }
    std::vector<ElementId> carriers;
    for (const auto* records : {&edit.elements_added, &edit.elements_removed})
        for (const ElementRecord& record : *records) carriers.push_back(carrier(record.id));
    for (const Rewiring& rewiring : edit.rewired)
        corners_[corner_begin_[rewiring.element.index()] +
                 static_cast<std::size_t>(rewiring.corner)] = rewiring.from;
    for (const ElementRecord& record : edit.elements_removed) is_alive_[record.id.index()] = 1;
    for (const ElementRecord& record : edit.elements_added) is_alive_[record.id.index()] = 0;
    for (const ShareChange& share : changes.shares) shares_[share.fragment.index()] = share.from;
    for (const NodeRecord& record : edit.nodes_removed) is_node_alive_[record.id.index()] = 1;
    for (const CarriedCell& cell : changes.cells) {
        move_cell(cell.cell, cell.to, cell.from);
        set_carried_around(cell.cell, cell.was_around);
    }
    for (const ElementId e : carriers) {
        std::vector<ElementId> living;
        for (const ElementId known : fragments_of(e))
            if (is_alive(known)) living.push_back(known);
        for (const ElementRecord& record : edit.elements_removed)
            if (carrier(record.id) == e && std::ranges::find(living, record.id) == living.end())
                living.push_back(record.id);
        std::ranges::sort(living);
        set_fragments(e, std::move(living));
    }
    for (const ElementRecord& record : edit.elements_added) cells_of_fragment_.erase(record.id);
    num_elements_ += edit.elements_removed.size();
    num_elements_ -= edit.elements_added.size();
    num_nodes_ += edit.nodes_removed.size();
    num_nodes_ -= edit.nodes_added.size();
    truncate(edit.node_capacity_before, edit.element_capacity_before, material.element_capacity());
    is_held_.resize(material.node_capacity());
}

void FragmentMesh::truncate(std::size_t num_nodes, std::size_t num_elements,
                            std::size_t num_cells) {
    carriers_.resize(num_elements);
    is_alive_.resize(num_elements);
    shares_.resize(num_elements);
    corner_begin_.resize(num_elements + 1);
    corners_.resize(corner_begin_.back());
    origins_.resize(num_nodes);
    rest_positions_.resize(num_nodes);
    is_node_alive_.resize(num_nodes);
    carrier_of_cell_.resize(num_cells);
    fragment_of_cell_.resize(num_cells);
    part_of_cell_.resize(num_cells, -1);
}

void FragmentMesh::drop_if_trivial(std::unordered_map<ElementId, std::vector<ElementId>>& lists,
                                   ElementId key) {
    const auto it = lists.find(key);
    if (it != lists.end() && it->second.size() == 1 && it->second.front() == key) lists.erase(it);
}

void FragmentMesh::move_cell(ElementId cell, ElementId from, ElementId to) {
    const auto list_of = [&](ElementId e) -> std::vector<ElementId>& {
        return cells_of_fragment_.try_emplace(e, 1, e).first->second;
    };
    if (from.is_valid()) std::erase(list_of(from), cell);
    if (to.is_valid()) {
        auto& cells = list_of(to);
        cells.insert(std::ranges::upper_bound(cells, cell), cell);
    }
    fragment_of_cell_[cell.index()] = to;
    if (from.is_valid()) drop_if_trivial(cells_of_fragment_, from);
    if (to.is_valid()) drop_if_trivial(cells_of_fragment_, to);
}

void FragmentMesh::set_fragments(ElementId carrier, std::vector<ElementId> fragments) {
    fragments_of_carrier_[carrier] = std::move(fragments);
    drop_if_trivial(fragments_of_carrier_, carrier);
}

int FragmentMesh::corner_of(ElementId e, NodeId n) const {
    const auto nodes = corners(e);
    const auto it = std::find(nodes.begin(), nodes.end(), n);
    return it == nodes.end() ? -1 : static_cast<int>(it - nodes.begin());
}

std::span<const ElementId> FragmentMesh::fragments_of(const ElementId& carrier) const {
    const auto it = fragments_of_carrier_.find(carrier);
    if (it != fragments_of_carrier_.end()) return it->second;
    return {&carrier, is_alive(carrier) ? 1u : 0u};
}

std::span<const ElementId> FragmentMesh::cells_of_carrier(const ElementId& carrier) const {
    const auto it = cells_of_carrier_.find(carrier);
    return it != cells_of_carrier_.end() ? std::span<const ElementId>(it->second)
                                         : std::span<const ElementId>(&carrier, 1);
}

std::span<const ElementId> FragmentMesh::cells_of(const ElementId& e) const {
    const auto it = cells_of_fragment_.find(e);
    return it != cells_of_fragment_.end() ? std::span<const ElementId>(it->second)
                                          : std::span<const ElementId>(&e, 1);
}

std::span<const NodeId> FragmentMesh::origins_of(ElementId carrier) const {
    return {origins_of_carrier_.data() + origin_begin_[carrier.index()],
            origin_begin_[carrier.index() + 1] - origin_begin_[carrier.index()]};
}

std::span<const ElementId> FragmentMesh::carriers_at(NodeId origin) const {
    return {carriers_at_.data() + carrier_begin_[origin.index()],
            carrier_begin_[origin.index() + 1] - carrier_begin_[origin.index()]};
}

void FragmentMesh::star(NodeId n, std::vector<ElementId>& elements) const {
    elements.clear();
    for (const ElementId carrier : carriers_at(origins_[n.index()]))
        for (const ElementId e : fragments_of(carrier))
            if (corner_of(e, n) >= 0) elements.push_back(e);
    std::sort(elements.begin(), elements.end());
}

bool FragmentMesh::has_element_at(NodeId n) const {
    return std::ranges::any_of(carriers_at(origins_[n.index()]), [&](ElementId carrier) {
        return std::ranges::any_of(fragments_of(carrier),
                                   [&](ElementId e) { return corner_of(e, n) >= 0; });
    });
}

ElementId FragmentMesh::incident_element(NodeId n) const {
    std::vector<ElementId> elements;
    star(n, elements);
    return elements.empty() ? ElementId() : elements.front();
}

Embedding FragmentMesh::embedding(const Mesh& material, NodeId n) const {
    std::vector<ElementId> cells;
    material.star(n, cells);
    ElementId at_home, lowest;
    for (const ElementId cell : cells) {
        const ElementId e = fragment_of_cell(cell);
        if (!lowest.is_valid() || e < lowest) lowest = e;
        if (is_at_home(cell) && (!at_home.is_valid() || e < at_home)) at_home = e;
    }
    return embedding_in(at_home.is_valid() ? at_home : lowest, material.rest_position(n));
}

Embedding FragmentMesh::embedding_in(ElementId e, const Vec3& x) const {
    Embedding result{e, {}, weights_in_carrier(carrier(e), x), 0};
    const auto nodes = corners(e);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (rest_position(nodes[k]) != x) continue;
        result.nodes[0] = nodes[k];
        result.weights = {1.0};
        result.count = 1;
        return result;
    }
    std::copy(nodes.begin(), nodes.end(), result.nodes.begin());
    result.count = static_cast<int>(nodes.size());
    return result;
}

std::array<double, max_corners> FragmentMesh::weights_in_carrier(ElementId carrier,
                                                                 const Vec3& x) const {
    std::array<double, max_corners> weights{};
    const auto nodes = origins_of(carrier);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        if (rest_position(nodes[k]) == x) {
            weights[k] = 1.0;
            return weights;
        }
    // Only tetrahedra are divided.
    assert(nodes.size() == 4);
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

}  // namespace incise::topology
