// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_parts.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "incise/base/disjoint_set.h"

namespace incise::fragments {

using topology::rest_volume;

FragmentParts::FragmentParts(FragmentMesh& fragments, const topology::Mesh& material)
    : fragments_(fragments), material_(material) {
    fragments_.scratch_.first_part.resize(fragments_.kinds_.size(), -1);
    fragments_.scratch_.part_of_cell.resize(fragments_.carrier_of_cell_.size(), -1);
}

FragmentParts::~FragmentParts() {
    for (const CarrierId carrier : carriers_found_)
        fragments_.scratch_.first_part[carrier.index()] = -1;
    for (const CarrierPart* part : parts_)
        for (const CellId cell : part->cells) fragments_.scratch_.part_of_cell[cell.index()] = -1;
}

FragmentParts::Range FragmentParts::of(CarrierId carrier) {
    std::int32_t& first = fragments_.scratch_.first_part[carrier.index()];
    if (first < 0) {
        first = static_cast<std::int32_t>(parts_.size());
        carriers_found_.push_back(carrier);
        find(carrier);
    }
    const auto begin = static_cast<std::size_t>(first);
    std::size_t end = begin;
    while (end < parts_.size() && parts_[end]->carrier == carrier) ++end;
    return {begin, end};
}

std::size_t FragmentParts::of_cell(CellId cell) {
    std::int32_t& part = fragments_.scratch_.part_of_cell[cell.index()];
    if (part < 0) of(fragments_.carrier_of_cell(cell));
    return static_cast<std::size_t>(part);
}

double FragmentParts::share_of(std::size_t part) {
    const CarrierId carrier = parts_[part]->carrier;
    const double whole = fragments_.volume_of(carrier);
    double all = 0.0;
    std::size_t count = 0;
    for (auto [i, end] = of(carrier); i < end; ++i, ++count) all += parts_[i]->volume;
    // If the parts fill the carrier to rounding, their shares add up to exactly 1. A removed part
    // that is smaller than that does not count.
    constexpr double rounding = 1e-10;
    if (std::abs(all - whole) > rounding * whole) return parts_[part]->volume / whole;
    return count == 1 ? 1.0 : parts_[part]->volume / all;
}

bool FragmentParts::is_constrained(std::span<const CellId> cells) const {
    for (const CellId cell : cells)
        for (const VertexId n : material_.corners(cell))
            if (fragments_.is_constrained(n)) return true;
    return false;
}

void FragmentParts::add(CarrierId carrier, std::span<const CellId> cells, double volume) {
    const std::size_t index = parts_.size();
    for (const CellId cell : cells)
        fragments_.scratch_.part_of_cell[cell.index()] = static_cast<std::int32_t>(index);
    // Nothing frees a part: its lists are in the same memory.
    CarrierPart& part =
        *new (memory_.allocate(sizeof(CarrierPart), alignof(CarrierPart))) CarrierPart(memory_);
    part.carrier = carrier;
    // A cut can leave flat cells whose volume is negative to rounding.
    constexpr double least_share = 1e-12;
    const double whole = fragments_.volume_of(carrier);
    part.volume = volume > 0.0 ? volume : least_share * whole;
    part.master = index;
    part.is_light = volume < fragments_.light_share_ * whole;
    part.is_constrained = part.is_light && is_constrained(cells);
    // A part that no edit has touched is carried as before.
    part.fragment = fragments_.fragment_of_cell(cells.front());
    part.is_element = fragments_.is_own(cells.front());
    part.cells.assign(cells.begin(), cells.end());
    parts_.push_back(&part);
}

void FragmentParts::find(CarrierId carrier) {
    if (!fragments_.cells_of_carrier_.contains(carrier)) {  // whole, or what is left of it
        if (const auto cell = with_number_of<CellId>(carrier); material_.is_alive(cell))
            add(carrier, {&cell, 1}, rest_volume(material_, cell));
        return;
    }
    std::vector<CellId>& cells = cells_;
    cells.clear();
    for (const CellId cell : fragments_.cells_of_carrier(carrier))
        if (material_.is_alive(cell)) cells.push_back(cell);
    DisjointSet groups(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        for (int f = 0; f < material_.num_faces(cells[i]); ++f) {
            const CellId other = material_.neighbor({cells[i], f}).cell;
            if (!other.is_valid() || other > cells[i] ||
                fragments_.carrier_of_cell(other) != carrier)
                continue;
            const auto it = std::lower_bound(cells.begin(), cells.end(), other);
            groups.join(static_cast<std::int32_t>(i),
                        static_cast<std::int32_t>(it - cells.begin()));
        }
    std::vector<CellId>& members = members_;
    for (std::size_t first = 0; first < cells.size(); ++first) {
        if (groups.find(static_cast<std::int32_t>(first)) != static_cast<std::int32_t>(first))
            continue;
        members.clear();
        double volume = 0.0;
        for (std::size_t i = first; i < cells.size(); ++i) {
            if (groups.find(static_cast<std::int32_t>(i)) != static_cast<std::int32_t>(first))
                continue;
            members.push_back(cells[i]);
            volume += rest_volume(material_, cells[i]);
        }
        add(carrier, members, volume);
    }
}

std::span<const FragmentParts::Neighbor> FragmentParts::neighbors(std::size_t index) {
    CarrierPart& part = *parts_[index];
    assert(part.is_light);
    if (part.has_neighbors) return part.neighbors;
    part.has_neighbors = true;
    for (const CellId cell : part.cells)
        for (int f = 0; f < material_.num_faces(cell); ++f) {
            const CellId other = material_.neighbor({cell, f}).cell;
            if (!other.is_valid() || fragments_.carrier_of_cell(other) == part.carrier) continue;
            const std::size_t neighbor = of_cell(other);
            const double area = rest_area(material_, {cell, f});
            const auto known = std::ranges::find(part.neighbors, neighbor, &Neighbor::part);
            if (known == part.neighbors.end())
                part.neighbors.push_back({neighbor, area});
            else
                known->area += area;
        }
    std::ranges::sort(part.neighbors, {},
                      [&](const Neighbor& n) { return parts_[n.part]->head(); });
    return part.neighbors;
}

/// Returns the cells of other carriers that share faces with a part, one for each face.
std::span<const CellId> FragmentParts::cells_beyond(CarrierPart& part) {
    if (part.has_beyond) return part.beyond;
    part.has_beyond = true;
    for (const CellId cell : part.cells)
        for (int f = 0; f < material_.num_faces(cell); ++f) {
            const CellId other = material_.neighbor({cell, f}).cell;
            if (other.is_valid() && fragments_.carrier_of_cell(other) != part.carrier)
                part.beyond.push_back(other);
        }
    return part.beyond;
}

bool FragmentParts::is_undivided(CarrierId carrier, std::span<const CarrierId> parted) {
    if (std::ranges::binary_search(parted, carrier)) return false;
    const auto [first, end] = of(carrier);
    return end - first == 1 && parts_[first]->is_element && !parts_[first]->is_light;
}

/// Returns the light parts whose masters the edit may change, in the order of their heads: those of
/// touched carriers and beside them, and all that are connected with these through light parts or
/// carriers.
std::vector<std::size_t> FragmentParts::light_cluster(std::span<const CarrierId> touched,
                                                      std::span<const CarrierId> parted) {
    std::vector<std::size_t> cluster;
    const auto add = [&](std::size_t part) {
        if (!parts_[part]->is_light || parts_[part]->is_in_cluster) return;
        parts_[part]->is_in_cluster = true;
        cluster.push_back(part);
    };
    const auto add_beside = [&](std::size_t part) {
        for (const CellId cell : cells_beyond(*parts_[part])) add(of_cell(cell));
    };
    for (const CarrierId carrier : touched) {
        if (is_undivided(carrier, parted)) continue;
        for (auto [part, end] = of(carrier); part < end; ++part) {
            add(part);
            add_beside(part);
        }
    }
    // NOLINTNEXTLINE(modernize-loop-convert): the list grows in the loop
    for (std::size_t next = 0; next < cluster.size(); ++next) {
        add_beside(cluster[next]);
        // All parts of a carrier are assigned together.
        for (auto [part, end] = of(parts_[cluster[next]]->carrier); part < end; ++part) add(part);
    }
    std::ranges::sort(cluster, {}, [&](std::size_t part) { return parts_[part]->head(); });
    return cluster;
}

// Light parts join, across faces and within their region, the part behind the largest area. First
// those do that have a neighbour which is an element; then those beside these, and so on. Those
// that reach none join their largest light neighbour if it is larger. The largest of all becomes an
// element although it is light. So does a part without which the material would come apart, and one
// that is held.
std::vector<CarrierId> FragmentParts::join_light(std::span<const CarrierId> touched,
                                                 std::span<const CarrierId> parted) {
    std::vector<std::size_t> lights = light_cluster(touched, parted);
    std::vector<CarrierId> open(touched.begin(), touched.end());
    for (const std::size_t part : lights) open.push_back(parts_[part]->carrier);
    std::sort(open.begin(), open.end());
    open.erase(std::unique(open.begin(), open.end()), open.end());
    const std::vector<std::size_t> cluster = lights;
    std::erase_if(lights, [&](std::size_t part) { return parts_[part]->is_constrained; });
    join_in_rounds(lights);
    join_larger_lights(lights);
    keep_bridges(cluster);
    return open;
}

void FragmentParts::join_in_rounds(std::vector<std::size_t>& lights) {
    for (const std::size_t part : lights) parts_[part]->is_waiting = true;
    while (!lights.empty()) {
        std::vector<std::pair<std::size_t, std::size_t>> joined;  // part, master
        for (const std::size_t part : lights) {
            const Neighbor* best = nullptr;
            for (const Neighbor& neighbor : neighbors(part))
                if (!parts_[neighbor.part]->is_waiting && are_in_one_region(neighbor.part, part) &&
                    (!best || neighbor.area > best->area))
                    best = &neighbor;
            if (best) joined.emplace_back(part, parts_[best->part]->master);
        }
        if (joined.empty()) break;
        for (const auto& [part, master] : joined) {
            parts_[part]->master = master;
            parts_[part]->is_waiting = false;
        }
        std::erase_if(lights, [&](std::size_t part) { return !parts_[part]->is_waiting; });
    }
}

bool FragmentParts::is_larger(std::size_t a, std::size_t b) const {
    if (parts_[a]->volume != parts_[b]->volume) return parts_[a]->volume > parts_[b]->volume;
    return parts_[a]->head() < parts_[b]->head();
}

void FragmentParts::join_larger_lights(const std::vector<std::size_t>& lights) {
    for (const std::size_t part : lights) {
        std::size_t largest = part;
        for (const Neighbor& neighbor : neighbors(part))
            if (are_in_one_region(neighbor.part, part) && is_larger(neighbor.part, largest))
                largest = neighbor.part;
        parts_[part]->master = largest;
    }
    // Along masters the volume rises, so that each chain ends at a part that is its own master.
    for (const std::size_t part : lights)
        while (parts_[part]->master != parts_[parts_[part]->master]->master)
            parts_[part]->master = parts_[parts_[part]->master]->master;
}

// A bridge of light parts may be carried in halves by elements on either side that have no common
// node. Then parts of it become elements, until the material hangs together as the mesh does. Each
// set of light parts that hang together is decided alone, whatever else the edit touches.
void FragmentParts::keep_bridges(const std::vector<std::size_t>& lights) {
    for (const std::size_t first : lights) {
        if (parts_[first]->is_kept_together) continue;
        std::vector<std::size_t> near{first};
        const auto add = [&](std::size_t part) {
            if (parts_[part]->is_kept_together || !parts_[part]->is_in_cluster) return;
            parts_[part]->is_kept_together = true;
            near.push_back(part);
        };
        parts_[first]->is_kept_together = true;
        // NOLINTNEXTLINE(modernize-loop-convert): the list grows in the loop
        for (std::size_t next = 0; next < near.size(); ++next) {
            for (const Neighbor& neighbor : neighbors(near[next])) add(neighbor.part);
            for (auto [part, end] = of(parts_[near[next]]->carrier); part < end; ++part) add(part);
        }
        keep_together(near);
    }
}

/// Makes light parts elements where the elements that carry two neighbours are not connected.
void FragmentParts::keep_together(const std::vector<std::size_t>& lights) {
    std::vector<std::size_t> near = lights;
    for (const std::size_t part : lights)
        for (const Neighbor& neighbor : neighbors(part)) near.push_back(neighbor.part);
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (std::size_t i = 0; i < near.size(); ++i)
        parts_[near[i]]->local = static_cast<std::int32_t>(i);
    for (;;) {
        DisjointSet connected = connected_elements(near);
        std::vector<std::size_t> bridges;
        for (const std::size_t part : lights)
            for (const Neighbor& neighbor : neighbors(part)) {
                const auto a = parts_[parts_[part]->master]->local,
                           b = parts_[parts_[neighbor.part]->master]->local;
                if (connected.find(a) == connected.find(b)) continue;
                const bool is_first = is_element(neighbor.part) ||
                                      (!is_element(part) && is_larger(part, neighbor.part));
                const std::size_t bridge = is_first ? part : neighbor.part;
                // Neighbours without a common node are in files that somebody has changed only.
                if (!is_element(bridge)) bridges.push_back(bridge);
            }
        if (bridges.empty()) break;
        for (const std::size_t part : bridges) parts_[part]->master = part;
    }
    for (const std::size_t part : near) parts_[part]->local = -1;
}

/// Joins the elements among some parts that have common nodes: at a node before any cut, they are
/// in one group of parts that share faces. `near` has the part of each number `local`.
DisjointSet FragmentParts::connected_elements(const std::vector<std::size_t>& near) {
    std::vector<std::pair<NodeId, std::int32_t>> places;
    for (const std::size_t part : near)
        for (const NodeId origin : fragments_.origins_of(parts_[part]->carrier))
            places.emplace_back(origin, parts_[part]->local);
    std::ranges::sort(places);
    DisjointSet connected(near.size());
    std::vector<std::int32_t> place_of(near.size(), -1);  // by local number, at the present node
    for (auto begin = places.begin(); begin != places.end();) {
        auto end = begin;
        for (; end != places.end() && end->first == begin->first; ++end)
            place_of[static_cast<std::size_t>(end->second)] =
                static_cast<std::int32_t>(end - begin);
        DisjointSet groups(static_cast<std::size_t>(end - begin));
        for (auto it = begin; it != end; ++it)
            for_each_known_neighbor(
                near[static_cast<std::size_t>(it->second)], [&](std::size_t next) {
                    const std::int32_t local = parts_[next]->local;
                    if (local < 0 || local > it->second) return;  // the other one joins them
                    const std::int32_t place = place_of[static_cast<std::size_t>(local)];
                    if (place >= 0) groups.join(static_cast<std::int32_t>(it - begin), place);
                });
        std::vector<std::int32_t> first(static_cast<std::size_t>(end - begin), -1);
        for (auto it = begin; it != end; ++it) {
            place_of[static_cast<std::size_t>(it->second)] = -1;
            if (!is_element(near[static_cast<std::size_t>(it->second)])) continue;
            std::int32_t& element =
                first[static_cast<std::size_t>(groups.find(static_cast<std::int32_t>(it - begin)))];
            if (element < 0) element = it->second;
            connected.join(element, it->second);
        }
        begin = end;
    }
    return connected;
}

}  // namespace incise::fragments
