// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_archive.h"

#include <algorithm>
#include <string>

#include "incise/fragments/validate.h"
#include "incise/topology/geometry.h"

namespace incise::fragments {

using topology::CellKind;
using topology::FollowedEpoch;
using topology::Mesh;
using topology::num_cell_kinds;
using topology::traits;

/// The list of members that an archive of fragments contains, and the computation of the others.
class FragmentArchive {
  public:
    static void list(auto& ar, auto& f) {
        ar(f.light_share_, f.num_origins_, f.kinds_, f.diagonals_, f.regions_, f.carriers_of_added_,
           f.is_alive_, f.shares_, f.corners_, f.origins_, f.rest_positions_, f.is_node_alive_,
           f.carrier_of_cell_, f.fragment_of_cell_, f.carried_around_, f.is_constrained_);
    }

    static FragmentMesh load(const Mesh& material, ArchiveReader& ar) {
        FragmentMesh fragments(0.0, FollowedEpoch(material));
        list(ar, fragments);
        FragmentArchive archive(fragments, material);
        archive.require_lists();
        archive.restore_rows();
        archive.restore_lists_of_cells();
        for (std::size_t c = 0; c < fragments.kinds_.size(); ++c)
            if (const CarrierId carrier(c); !fragments.was_never_alive(carrier))
                fragments.update_part_shares(material, carrier);
        if (const auto faults = validate(fragments, material); !faults.empty())
            require(false, faults.front().c_str());
        return fragments;
    }

  private:
    FragmentArchive(FragmentMesh& fragments, const Mesh& material)
        : fragments_(fragments), material_(material) {}

    static void require(bool holds, const char* text) {
        if (!holds) throw InputError(std::string("its fragments are not sound: ") + text);
    }

    void require_lists() const {
        const FragmentMesh& f = fragments_;
        const std::size_t num_carriers = f.kinds_.size(), num_fragments = f.is_alive_.size(),
                          num_nodes = f.origins_.size();
        require(f.num_origins_ <= num_nodes && f.regions_.size() == num_carriers &&
                    (f.diagonals_.empty() || f.diagonals_.size() == num_carriers) &&
                    num_fragments == num_carriers + f.carriers_of_added_.size() &&
                    f.rest_positions_.size() == num_nodes && f.is_node_alive_.size() == num_nodes &&
                    f.is_constrained_.size() == material_.node_capacity() &&
                    f.carrier_of_cell_.size() == material_.element_capacity() &&
                    f.fragment_of_cell_.size() == material_.element_capacity(),
                "lists of different lengths");
        const auto is_carrier = [&](CarrierId e) {
            return e.is_valid() && e.index() < num_carriers;
        };
        const auto is_fragment = [&](ElementId e) {
            return !e.is_valid() || e.index() < num_fragments;
        };
        const auto is_cell = [&](CellId e) {
            return e.is_valid() && e.index() < material_.element_capacity();
        };
        const auto is_node = [&](NodeId n) { return n.is_valid() && n.index() < num_nodes; };
        const auto is_origin = [&](NodeId n) { return n.is_valid() && n.index() < f.num_origins_; };
        require(
            std::ranges::all_of(
                f.kinds_,
                [](CellKind kind) { return static_cast<std::size_t>(kind) < num_cell_kinds; }) &&
                have_diagonals() && std::ranges::all_of(f.carriers_of_added_, is_carrier) &&
                std::ranges::all_of(f.carrier_of_cell_, is_carrier) &&
                std::ranges::all_of(f.fragment_of_cell_, is_fragment) &&
                std::ranges::all_of(f.carried_around_, is_cell) &&
                std::ranges::all_of(
                    f.shares_,
                    [&](const auto& of) { return of.first.is_valid() && is_fragment(of.first); }) &&
                std::ranges::all_of(f.corners_, is_node) &&
                std::ranges::all_of(f.origins_, is_origin) &&
                std::ranges::all_of(f.rest_positions_, [](const Vec3& x) { return x.allFinite(); }),
            "an element or a node that they name is not there");
    }

    /// True if all diagonals are those of quadrilaterals.
    bool have_diagonals() const {
        for (std::size_t c = 0; c < fragments_.diagonals_.size(); ++c)
            if (!fragments_.diagonals_[c].fits(fragments_.kinds_[c])) return false;
        return true;
    }

    void restore_rows() {
        FragmentMesh& f = fragments_;
        for (std::size_t e = 0; e < f.element_capacity(); ++e) {
            const int num_corners = traits(f.kind(ElementId(e))).num_corners;
            f.corner_begin_.push_back(f.corner_begin_.back() +
                                      static_cast<std::uint32_t>(num_corners));
        }
        require(f.corners_.size() == f.corner_begin_.back(), "lists of corners");
        f.complete();
    }

    void restore_lists_of_cells() {
        FragmentMesh& f = fragments_;
        std::vector<std::vector<CellId>> of_carrier(f.kinds_.size()),
            of_fragment(f.element_capacity());
        std::vector<std::vector<ElementId>> fragments_of(f.kinds_.size());
        for (const CellId cell : material_.elements()) {
            require(f.fragment_of_cell(cell).is_valid(), "a cell without a fragment");
            of_carrier[f.carrier_of_cell(cell).index()].push_back(cell);
            of_fragment[f.fragment_of_cell(cell).index()].push_back(cell);
        }
        for (const ElementId e : f.elements()) fragments_of[f.carrier(e).index()].push_back(e);
        const auto keep = [&](auto& lists, const auto& all) {
            for (std::size_t i = 0; i < all.size(); ++i) {
                using Key = typename std::remove_cvref_t<decltype(lists)>::key_type;
                using Id = typename std::remove_cvref_t<decltype(all[i])>::value_type;
                const bool is_default = all[i] == std::vector{Id(i)} ||
                                        (i < f.kinds_.size() && f.was_never_alive(CarrierId(i)));
                if (!is_default) lists[Key(i)] = all[i];
            }
        };
        keep(f.cells_of_carrier_, of_carrier);
        keep(f.fragments_of_carrier_, fragments_of);
        keep(f.cells_of_fragment_, of_fragment);
    }

    FragmentMesh& fragments_;
    const Mesh& material_;
};

void save(const FragmentMesh& fragments, ArchiveWriter& ar) {
    FragmentArchive::list(ar, fragments);
}

FragmentMesh load_fragments(const Mesh& material, ArchiveReader& ar) {
    return FragmentArchive::load(material, ar);
}

}  // namespace incise::fragments
