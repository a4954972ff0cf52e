// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_update.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <iterator>

#include "incise/base/disjoint_set.h"
#include "incise/topology/geometry.h"

namespace incise::fragments {

using topology::CellRecord;
using topology::ChangeSet;
using topology::FacePair;
using topology::Mesh;

namespace {

template <class T>
void make_sorted_set(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <class T>
void insert_sorted(std::vector<T>& values, const T& value) {
    values.insert(std::upper_bound(values.begin(), values.end(), value), value);
}

}  // namespace

FragmentChanges FragmentUpdate::run() {
    begin();
    follow_cells();
    find_fragments();
    return differences();
}

void FragmentUpdate::divide(FragmentMesh& fragments, const Mesh& material,
                            std::vector<CarrierId> carriers) {
    const ChangeSet no_edit;
    FragmentUpdate update(fragments, material, no_edit);
    update.begin();
    make_sorted_set(carriers);
    update.parted_carriers_ = carriers;
    update.touched_carriers_ = std::move(carriers);
    update.find_fragments();
}

void FragmentUpdate::begin() {
    node_capacity_before_ = fragments_.node_capacity();
    element_capacity_before_ = fragments_.element_capacity();
}

void FragmentUpdate::find_fragments() {
    open_carriers_ = parts_.join_light(touched_carriers_, parted_carriers_);
    assign_fragments();
    assign_nodes();
}

/// Takes the cells that came and went, and notes the carriers that the edit touches.
void FragmentUpdate::follow_cells() {
    auto& carrier_of = fragments_.carrier_of_cell_;
    auto& fragment_of = fragments_.fragment_of_cell_;
    const std::size_t capacity = std::max(carrier_of.size(), changes_.element_capacity_after);
    carrier_of.resize(capacity);
    fragment_of.resize(capacity);
    fragments_.scratch_.part_of_cell.resize(capacity, -1);
    const auto list_of = [&](CarrierId carrier) -> std::vector<CellId>& {
        return fragments_.entry_of(fragments_.cells_of_carrier_, carrier);
    };
    const auto part = [&](CellId cell) { parted_carriers_.push_back(carrier_of[cell.index()]); };
    for (const CellRecord& record : changes_.elements_removed) {
        std::erase(list_of(carrier_of[record.id.index()]), record.id);
        part(record.id);
    }
    for (const CellRecord& record : changes_.elements_added) {  // parents before their parts
        const CellId cell = record.id;
        if (cell.index() >= changes_.element_capacity_before) {
            carrier_of[cell.index()] = carrier_of[record.parent.index()];
            fragment_of[cell.index()] = fragment_of[record.parent.index()];
            if (fragments_.is_carried_around(record.parent))
                fragments_.set_carried_around(cell, true);
        }
        insert_sorted(list_of(carrier_of[cell.index()]), cell);
        touched_carriers_.push_back(carrier_of[cell.index()]);
        if (!record.parent.is_valid()) part(cell);  // an undo brings it back
    }
    for (const auto* pairs : {&changes_.faces_opened, &changes_.faces_closed})
        for (const FacePair& pair : *pairs) {
            part(pair.a.cell);
            part(pair.b.cell);
        }
    // A cell that keeps its volume can have what it has of each part of its carrier summed anew.
    for (const topology::ShapeChange& change : changes_.shape_changes)
        if (const CarrierId carrier = carrier_of[change.cell.index()]; carrier.is_valid())
            touched_carriers_.push_back(carrier);
    make_sorted_set(parted_carriers_);
    touched_carriers_.insert(touched_carriers_.end(), parted_carriers_.begin(),
                             parted_carriers_.end());
    make_sorted_set(touched_carriers_);
    for (const CarrierId carrier : touched_carriers_)
        FragmentMesh::drop_if_trivial(fragments_.cells_of_carrier_, carrier);
}

/// Adds a fragment for a cell that is an element now.
ElementId FragmentUpdate::add_fragment(CellId cell) {
    const CarrierId carrier = fragments_.carrier_of_cell(cell);
    const ElementId e(fragments_.element_capacity());
    fragments_.carriers_of_added_.push_back(carrier);
    fragments_.is_alive_.push_back(1);
    fragments_.set_share(e, 0.0);  // until update_shares()
    const auto origins = fragments_.origins_of(carrier);
    fragments_.corners_.insert(fragments_.corners_.end(), origins.size(), NodeId());
    fragments_.corner_begin_.push_back(static_cast<std::uint32_t>(fragments_.corners_.size()));
    fragments_.cells_of_fragment_[e] = {};
    ++fragments_.num_elements_;
    parents_.push_back(fragments_.fragment_of_cell(cell));
    is_from_own_part_.push_back(fragments_.is_own(cell));
    return e;
}

void FragmentUpdate::assign_fragments() {
    for (const CarrierId carrier : open_carriers_) assign_fragments_of(carrier);
    carry_cells();
    update_shares();
}

/// Gives each part of a carrier that is an element a fragment: one that has carried cells of it
/// before, or a new one.
void FragmentUpdate::assign_fragments_of(CarrierId carrier) {
    const auto listed = fragments_.fragments_of(carrier);
    const std::vector<ElementId> before(listed.begin(), listed.end());
    for (const ElementId e : before) note_corners(e);
    std::vector<ElementId> now;
    for (auto [i, end] = parts_.of(carrier); i < end; ++i) {
        CarrierPart& part = parts_[i];
        part.is_open = true;
        part.is_element = part.master == i;
        if (!part.is_element) continue;
        ElementId own;
        for (const CellId cell : part.cells) {
            const ElementId e = fragments_.fragment_of_cell(cell);
            if (fragments_.is_own(cell) && fragments_.is_alive(e) &&
                std::ranges::find(now, e) == now.end() && (!own.is_valid() || e < own))
                own = e;
        }
        part.fragment = own.is_valid() ? own : add_fragment(part.head());
        insert_sorted(now, part.fragment);
    }
    for (const ElementId e : before) {
        if (std::ranges::binary_search(now, e)) continue;
        fragments_.is_alive_[e.index()] = 0;
        --fragments_.num_elements_;
        died_.push_back(e);
    }
    fragments_.set_fragments(carrier, std::move(now));
}

/// Writes which fragment carries each cell.
void FragmentUpdate::carry_cells() {
    const auto list_of = [&](ElementId e) -> std::vector<CellId>& {
        shares_before_.try_emplace(e, fragments_.volume_share(e));
        return fragments_.entry_of(fragments_.cells_of_fragment_, e);
    };
    const auto leave = [&](CellId cell) {
        const ElementId from = fragments_.fragment_of_cell(cell);
        fragment_before_.push_back({cell, from, from, fragments_.is_carried_around(cell)});
        std::erase(list_of(from), cell);
    };
    for (const CellRecord& record : changes_.elements_removed) {
        leave(record.id);
        fragments_.fragment_of_cell_[record.id.index()] = {};
        fragments_.set_carried_around(record.id, false);
    }
    for (const CellRecord& record : changes_.elements_added)
        fragment_before_.push_back({record.id, ElementId(), fragments_.fragment_of_cell(record.id),
                                    fragments_.is_carried_around(record.id)});
    for (const CarrierId carrier : open_carriers_)
        for (auto [i, end] = parts_.of(carrier); i < end; ++i) {
            const ElementId to = parts_[parts_[i].master].fragment;
            const bool is_around = !parts_[i].is_element && fragments_.carrier(to) == carrier;
            shares_before_.try_emplace(to, fragments_.volume_share(to));  // a cell may have shrunk
            for (const CellId cell : parts_[i].cells) {
                const ElementId from = fragments_.fragment_of_cell(cell);
                if (is_added(cell))
                    insert_sorted(list_of(to), cell);
                else if (from != to) {
                    leave(cell);
                    insert_sorted(list_of(to), cell);
                } else if (is_around != fragments_.is_carried_around(cell)) {
                    fragment_before_.push_back({cell, from, from, !is_around});
                }
                fragments_.fragment_of_cell_[cell.index()] = to;
                fragments_.set_carried_around(cell, is_around);
            }
        }
}

void FragmentUpdate::update_shares() {
    std::vector<CarrierId> carriers;
    for (const auto& [e, before] : shares_before_) {
        if (!fragments_.is_alive(e)) continue;
        fragments_.set_share(e, share_of(e));
        fragments_.drop_if_trivial(fragments_.cells_of_fragment_, e);
        carriers.push_back(fragments_.carrier(e));
    }
    make_sorted_set(carriers);
    for (const CarrierId carrier : carriers)
        for (const ElementId e : fragments_.fragments_of(carrier))
            if (e.is_valid()) shares_before_.try_emplace(e, fragments_.volume_share(e));
    for (const CarrierId carrier : carriers) {
        const auto update = fragments_.update_part_shares(material_, carrier);
        part_shares_changed_.insert(part_shares_changed_.end(), update.changed.begin(),
                                    update.changed.end());
        has_overlaps_ |= update.has_overlaps;
    }
    make_sorted_set(part_shares_changed_);
    for (const ElementId e : died_) fragments_.part_shares_.erase(e);
}

double FragmentUpdate::share_of(ElementId fragment) {
    const CarrierId carrier = fragments_.carrier(fragment);
    double own = 0.0, others = 0.0;
    std::vector<std::size_t> parts;
    for (const CellId cell : fragments_.cells_of(fragment)) {
        const std::size_t part = parts_.of_cell(cell);
        if (std::ranges::find(parts, part) != parts.end()) continue;
        parts.push_back(part);
        (parts_[part].carrier == carrier ? own : others) +=
            parts_.share_of(part) * fragments_.volume_of(parts_[part].carrier);
    }
    const double whole = fragments_.volume_of(carrier);
    return own == whole ? 1.0 + others / whole : (own + others) / whole;
}

void FragmentUpdate::note_corners(ElementId fragment) {
    const auto corners = fragments_.corners(fragment);
    corners_before_.try_emplace(fragment, corners.begin(), corners.end());
}

bool FragmentUpdate::is_added(CellId cell) const {
    return std::ranges::binary_search(changes_.elements_added, cell, {}, &CellRecord::id);
}

/// Returns the node that a fragment, or the fragment that it is a part of, had at a corner before
/// the edit.
NodeId FragmentUpdate::node_before(ElementId fragment, NodeId origin) const {
    if (const ElementId parent = parent_of(fragment); parent.is_valid()) {
        const std::size_t added = fragment.index() - element_capacity_before_;
        return is_from_own_part_[added] ? node_before(parent, origin) : NodeId();
    }
    return node_at(corners_before(fragment), origin);
}

/// Returns the node of an element at a corner before the edit. Fragments of carriers that are not
/// open are as they were.
NodeId FragmentUpdate::node_before(const CarrierPart& part, NodeId origin) const {
    return part.is_open ? node_before(part.fragment, origin)
                        : node_at(fragments_.corners(part.fragment), origin);
}

/// Returns the one of some corners that is a node before any cut, or a copy of it.
NodeId FragmentUpdate::node_at(std::span<const NodeId> corners, NodeId origin) const {
    for (const NodeId n : corners)
        if (fragments_.origins_[n.index()] == origin) return n;
    return {};
}

/// Returns the corners that a fragment had before the edit.
std::span<const NodeId> FragmentUpdate::corners_before(ElementId fragment) const {
    const auto it = corners_before_.find(fragment);
    return it != corners_before_.end() ? std::span<const NodeId>(it->second)
                                       : fragments_.corners(fragment);
}

/// Appends the groups of parts that are connected at a node before any cut.
void FragmentUpdate::find_groups(NodeId origin, std::vector<Group>& groups) {
    std::vector<std::size_t> parts;
    for (const CarrierId carrier : fragments_.carriers_at(origin))
        for (auto [part, end] = parts_.of(carrier); part < end; ++part) {
            parts_[part].local = static_cast<std::int32_t>(parts.size());
            parts.push_back(part);
        }
    DisjointSet connected(parts.size());
    for (const std::size_t part : parts)
        parts_.for_each_known_neighbor(part, [&](std::size_t neighbor) {
            const std::int32_t local = parts_[neighbor].local;
            if (local > parts_[part].local) connected.join(parts_[part].local, local);
        });
    if (is_settled(origin, parts, connected)) {
        for (const std::size_t part : parts) parts_[part].local = -1;
        return;
    }
    std::vector<Group> found(parts.size());
    for (const std::size_t part : parts) {
        Group& group = found[static_cast<std::size_t>(connected.find(parts_[part].local))];
        if (!parts_[part].is_element) continue;
        const ElementId e = parts_[part].fragment;
        group.origin = origin;
        insert_sorted(group.fragments, e);
        const NodeId before = node_before(parts_[part], origin);
        if (before.is_valid() && group.before.is_valid()) merge(before, group.before);
        if (before.is_valid()) group.before = before;
    }
    for (const std::size_t part : parts) parts_[part].local = -1;
    for (Group& group : found)
        if (!group.fragments.empty()) groups.push_back(std::move(group));
}

/// True if all parts at a node before any cut are connected, and have the same node already.
bool FragmentUpdate::is_settled(NodeId origin, std::span<const std::size_t> parts,
                                DisjointSet& connected) {
    NodeId common;
    for (const std::size_t part : parts) {
        if (connected.find(parts_[part].local) != connected.find(0)) return false;
        if (!parts_[part].is_element) continue;
        const NodeId before = node_before(parts_[part], origin);
        if (!before.is_valid() || (common.is_valid() && before != common)) return false;
        if (parent_of(parts_[part].fragment).is_valid()) return false;
        common = before;
    }
    return true;
}

NodeId FragmentUpdate::add_node(const Group& group) {
    const NodeId n(fragments_.node_capacity());
    NodeRecord record{n, fragments_.rest_position(group.origin), {}, 1};
    if (group.before.is_valid()) {
        record.sources[0] = {group.before, 1.0};
    } else {
        // A light part becomes an element: it goes on from where it was carried.
        const EmbeddedPoint from =
            fragments_.embedded(parent_of(group.fragments.front()), record.rest_position);
        record.num_sources = 0;
        from.for_each([&](NodeId source, double weight) {
            const auto next = static_cast<std::size_t>(record.num_sources++);
            assert(next < record.sources.size());
            record.sources[next] = {source, weight};
        });
    }
    nodes_added_.push_back(record);
    fragments_.origins_.push_back(group.origin);
    fragments_.rest_positions_.push_back(record.rest_position);
    fragments_.is_node_alive_.push_back(1);
    ++fragments_.num_nodes_;
    return n;
}

void FragmentUpdate::set_node(ElementId fragment, NodeId origin, NodeId node) {
    const auto origins = fragments_.origins_of(fragments_.carrier(fragment));
    const auto k = static_cast<std::size_t>(std::ranges::find(origins, origin) - origins.begin());
    assert(k < origins.size() && fragments_.origins_[node.index()] == origin);
    NodeId& corner = fragments_.corners_[fragments_.corner_begin_[fragment.index()] + k];
    if (corner == node) return;
    if (!parent_of(fragment).is_valid()) note_corners(fragment);
    corner = node;
}

NodeId FragmentUpdate::survivor_of(NodeId n) const {
    for (auto it = merged_.find(n); it != merged_.end(); it = merged_.find(n)) n = it->second;
    return n;
}

void FragmentUpdate::merge(NodeId a, NodeId b) {
    a = survivor_of(a);
    b = survivor_of(b);
    if (a != b) merged_[std::max(a, b)] = std::min(a, b);
}

// Nodes of parts that were joined again become one. A node stays with the group that has its lowest
// fragment. The others get copies.
void FragmentUpdate::assign_nodes() {
    std::vector<NodeId> origins, touched;
    for (const CarrierId carrier : open_carriers_)
        if (!parts_.is_undivided(carrier, parted_carriers_))
            for (const NodeId origin : fragments_.origins_of(carrier)) origins.push_back(origin);
    make_sorted_set(origins);
    std::vector<Group> groups;
    for (const NodeId origin : origins) find_groups(origin, groups);
    for (const auto& [e, corners] : corners_before_)
        for (const NodeId n : corners)
            if (n.is_valid()) touched.push_back(n);
    merge_nodes_of_fragments();
    for (Group& group : groups)
        if (group.before.is_valid()) group.before = survivor_of(group.before);

    const auto key = [](const Group& group) {
        return std::pair(group.before.is_valid() ? 0 : 1,
                         std::pair(group.before, group.fragments.front()));
    };
    std::ranges::sort(groups, {}, key);
    NodeId last;
    for (const Group& group : groups) {
        const bool keeps = group.before.is_valid() && group.before != last;
        const NodeId node = keeps ? group.before : add_node(group);
        last = group.before;
        for (const ElementId e : group.fragments) set_node(e, group.origin, node);
    }
    remove_unused_nodes(std::move(touched));
}

/// Merges the nodes of fragments of one carrier that the edit joined, even if it parted them
/// elsewhere.
void FragmentUpdate::merge_nodes_of_fragments() {
    std::unordered_map<ElementId, ElementId> first_of;  // of an added fragment, what it comes from
    for (const auto& [cell, before, inherited, was_around] : fragment_before_) {
        const ElementId now = fragments_.fragment_of_cell(cell);
        if (!before.is_valid() || !now.is_valid() || before == now || was_around ||
            fragments_.carrier(before) != fragments_.carrier_of_cell(cell) ||
            !fragments_.is_own(cell))
            continue;
        const bool is_added = parent_of(now).is_valid();
        const ElementId other = is_added ? first_of.try_emplace(now, before).first->second : now;
        const auto from = corners_before(before), to = corners_before(other);
        for (std::size_t k = 0; k < to.size(); ++k) merge(from[k], to[k]);
    }
}

void FragmentUpdate::remove_unused_nodes(std::vector<NodeId> touched) {
    for (const auto& [node, lower] : merged_) touched.push_back(node);
    make_sorted_set(touched);
    for (const NodeId n : touched) {
        if (!fragments_.is_alive(n) || fragments_.has_element_at(n)) continue;
        NodeRecord record{n, fragments_.rest_position(n), {}, 0};
        if (const NodeId survivor = survivor_of(n); survivor != n) {
            record.sources[0] = {survivor, 1.0};
            record.num_sources = 1;
        }
        nodes_removed_.push_back(record);
        fragments_.is_node_alive_[n.index()] = 0;
        --fragments_.num_nodes_;
    }
}

FragmentChanges FragmentUpdate::differences() {
    FragmentChanges result;
    result.has_overlaps = has_overlaps_;
    auto& edit = result.mesh;
    edit.epoch_before = changes_.epoch_before;
    edit.epoch_after = changes_.epoch_after;
    edit.node_capacity_before = node_capacity_before_;
    edit.node_capacity_after = fragments_.node_capacity();
    edit.element_capacity_before = element_capacity_before_;
    edit.element_capacity_after = fragments_.element_capacity();
    edit.nodes_added = std::move(nodes_added_);
    edit.nodes_removed = std::move(nodes_removed_);
    for (std::size_t i = element_capacity_before_; i < fragments_.element_capacity(); ++i) {
        const ElementId e(i);
        const auto corners = fragments_.corners(e);
        edit.elements_added.push_back({e,
                                       fragments_.kind(e),
                                       fragments_.region(e),
                                       parent_of(e),
                                       {corners.begin(), corners.end()}});
    }
    std::sort(died_.begin(), died_.end());
    for (const ElementId e : died_)
        edit.elements_removed.push_back(
            {e, fragments_.kind(e), fragments_.region(e), {}, corners_before_.at(e)});
    for (const auto& [e, before] : corners_before_) {
        if (!fragments_.is_alive(e)) continue;
        const auto now = fragments_.corners(e);
        for (std::size_t k = 0; k < now.size(); ++k)
            if (before[k] != now[k])
                edit.rewired.push_back({e, static_cast<int>(k), before[k], now[k]});
    }
    std::ranges::sort(edit.rewired, {},
                      [](const auto& r) { return std::pair(r.element, r.corner); });
    for (const auto& [e, before] : shares_before_)
        if (fragments_.is_alive(e) && !parent_of(e).is_valid() &&
            (fragments_.volume_share(e) != before ||
             std::ranges::binary_search(part_shares_changed_, e)))
            result.shares.push_back({e, before, fragments_.volume_share(e)});
    std::ranges::sort(result.shares, {}, &ShareChange::fragment);
    std::ranges::sort(fragment_before_, {}, &CellBefore::cell);
    for (const auto& [cell, before, inherited, was_around] : fragment_before_) {
        const ElementId now =
            material_.is_alive(cell) ? fragments_.fragment_of_cell(cell) : ElementId();
        const bool is_around = fragments_.is_carried_around(cell);
        if (now == before && is_around == was_around) continue;
        const CarrierId carrier = fragments_.carrier_of_cell(cell);
        const bool is_other = inherited != now;
        const auto is_away = [&](ElementId e, bool is_around_there) {
            return e.is_valid() && is_other &&
                   (is_around_there || fragments_.carrier(e) != carrier);
        };
        result.cells.push_back({cell, carrier, before, now, is_away(inherited, was_around),
                                is_away(now, is_around), before.is_valid() && was_around,
                                is_around});
    }
    return result;
}

}  // namespace incise::fragments
