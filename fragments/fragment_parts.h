// The parts of carriers near an edit, and the fragments that carry light ones. Internal to
// topology. SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "incise/base/disjoint_set.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// Finds the parts of carriers as they are asked for. A part consists of the cells of one carrier
/// that hang together inside it. Uses scratch of the fragment mesh while it lives.
class FragmentParts {
  public:
    struct Neighbor {
        std::size_t part;
        double area;  // of the shared faces, at rest, m2
    };
    struct CarrierPart {
        CarrierId carrier;
        std::pmr::vector<CellId> cells;        // in ascending order
        std::pmr::vector<Neighbor> neighbors;  // see neighbors()
        std::pmr::vector<CellId> beyond;       // see for_each_known_neighbor()
        double volume = 0.0;                   // at rest, m3
        std::size_t master = 0;   // the part whose fragment carries it; see join_light()
        ElementId fragment;       // that carries it
        std::int32_t local = -1;  // scratch of users
        bool is_light = false;
        bool is_constrained = false;    // is light, and has material at a node that is held
        bool is_element = false;        // see FragmentMesh::is_own()
        bool has_neighbors = false;     // found
        bool has_beyond = false;        // found
        bool is_in_cluster = false;     // see light_cluster()
        bool is_kept_together = false;  // see keep_bridges()
        bool is_waiting = false;        // see join_in_rounds()
        bool is_open = false;           // of a carrier that join_light() returned; set by users
        CellId head() const { return cells.front(); }

        explicit CarrierPart(std::pmr::memory_resource& memory)
            : cells(&memory), neighbors(&memory), beyond(&memory) {}
    };
    /// The parts from `begin` to before `end`.
    struct Range {
        std::size_t begin, end;
    };

    /// @pre  the fragment mesh has the lists of cells after the edit
    FragmentParts(FragmentMesh& fragments, const topology::Mesh& material);
    ~FragmentParts();
    FragmentParts(const FragmentParts&) = delete;
    FragmentParts& operator=(const FragmentParts&) = delete;

    CarrierPart& operator[](std::size_t part) { return *parts_[part]; }
    /// Returns the parts of a carrier. References to parts stay valid.
    Range of(CarrierId carrier);
    /// Returns the part of a living cell.
    std::size_t of_cell(CellId cell);
    /// Returns the volume of a part over that of its carrier. The shares of all parts of a carrier
    /// that no edit has taken anything from add up to 1.
    double share_of(std::size_t part);
    /// Returns the parts of other carriers that share faces with a light part, in the order of
    /// their heads.
    std::span<const Neighbor> neighbors(std::size_t index);
    /// Calls visit(part) for the parts of other carriers that share faces with a part, in no
    /// particular order and for some of them several times. Leaves out those of carriers whose
    /// parts have not been asked for yet.
    template <class Visit>
    void for_each_known_neighbor(std::size_t index, Visit visit) {
        for (const CellId cell : cells_beyond(*parts_[index]))
            if (const std::int32_t part = fragments_.scratch_.part_of_cell[cell.index()]; part >= 0)
                visit(static_cast<std::size_t>(part));
    }

    /// Sets the masters of all parts of touched carriers, and of the light parts whose masters the
    /// edit may change. Returns the carriers of these parts, in ascending order.
    /// @param parted  in ascending order, those of which an edit removed, parted or joined
    /// something
    std::vector<CarrierId> join_light(std::span<const CarrierId> touched,
                                      std::span<const CarrierId> parted);
    /// True if all of a carrier is one part that is an element, and was so before the edit.
    bool is_undivided(CarrierId carrier, std::span<const CarrierId> parted);

  private:
    void find(CarrierId carrier);
    bool is_constrained(std::span<const CellId> cells) const;
    std::span<const CellId> cells_beyond(CarrierPart& part);
    void add(CarrierId carrier, std::span<const CellId> cells, double volume);
    std::vector<std::size_t> light_cluster(std::span<const CarrierId> touched,
                                           std::span<const CarrierId> parted);
    bool are_in_one_region(std::size_t a, std::size_t b) const {
        return fragments_.region_of_carrier(parts_[a]->carrier) ==
               fragments_.region_of_carrier(parts_[b]->carrier);
    }
    bool is_larger(std::size_t a, std::size_t b) const;
    void join_in_rounds(std::vector<std::size_t>& lights);
    void join_larger_lights(const std::vector<std::size_t>& lights);
    void keep_bridges(const std::vector<std::size_t>& lights);
    void keep_together(const std::vector<std::size_t>& lights);
    DisjointSet connected_elements(const std::vector<std::size_t>& near);
    bool is_element(std::size_t part) const {
        const CarrierPart& of = *parts_[part];
        return of.is_in_cluster ? of.master == part : of.is_element || !of.is_light;
    }

    FragmentMesh& fragments_;
    const topology::Mesh& material_;
    std::vector<CarrierId> carriers_found_;       // whose parts are known
    std::pmr::monotonic_buffer_resource memory_;  // of the parts
    std::vector<CarrierPart*> parts_;             // those of a carrier follow each other
    std::vector<CellId> cells_, members_;         // scratch of find()
};

}  // namespace incise::fragments
