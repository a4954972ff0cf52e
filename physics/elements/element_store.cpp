// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/element_store.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "incise/base/error.h"
#include "incise/physics/elements/centre_viscous_kernel.h"
#include "incise/physics/elements/kernel_block.h"
#include "incise/physics/elements/virtual_centre_kernel.h"

namespace incise::physics {

using fragments::FragmentMesh;
using topology::CellKind;

namespace {

template <CellKind kind>
std::shared_ptr<ElementBlock> make_centre_block(const HyperElasticLinks& links, double density) {
    const VirtualCentreKernel<kind> elastic{links.law, links.inversion_threshold};
    if (links.prony.empty())
        return std::make_shared<KernelBlock<VirtualCentreKernel<kind>>>(elastic, density);
    return std::make_shared<KernelBlock<CentreViscousKernel<kind>>>(
        CentreViscousKernel<kind>(elastic, links.prony), density);
}

/// Makes a block without elements.
/// @param is_divided  a box of hybrid springs with less or more material than the box, or with
///                    faces that meet triangles
std::shared_ptr<ElementBlock> make_block(const Material& material, Precision precision,
                                         CellKind kind, bool is_divided) {
    if (const auto* springs = std::get_if<MassSprings>(&material.method))
        return std::make_shared<KernelBlock<MassSpringKernel>>(MassSpringKernel{springs->young},
                                                               material.density);
    if (const auto* hybrid = std::get_if<HybridSprings>(&material.method)) {
        if (is_divided)
            return make_centre_block<CellKind::hexahedron>(links_of_divided_box(*hybrid),
                                                           material.density);
        return std::make_shared<KernelBlock<HybmssKernel>>(HybmssKernel{*hybrid, precision},
                                                           material.density);
    }
    const auto& links = std::get<HyperElasticLinks>(material.method);
    if (kind == CellKind::hexahedron)
        return make_centre_block<CellKind::hexahedron>(links, material.density);
    if (kind == CellKind::wedge) return make_centre_block<CellKind::wedge>(links, material.density);
    if (kind == CellKind::pyramid)
        return make_centre_block<CellKind::pyramid>(links, material.density);
    const HemlKernel elastic{links.law, links.inversion_threshold, precision};
    if (links.prony.empty())
        return std::make_shared<KernelBlock<HemlKernel>>(elastic, material.density);
    if (links.prony_rule == PronyRule::nodal)
        return std::make_shared<KernelBlock<NodalViscousKernel>>(
            NodalViscousKernel(elastic, links.prony), material.density);
    return std::make_shared<KernelBlock<ViscousKernel>>(ViscousKernel(elastic, links.prony),
                                                        material.density);
}

/// See VirtualCentreKernel::why_no_cell.
std::optional<std::string> why_no_centre_cell(const FragmentMesh& fragments, ElementId e) {
    return fragments::with_division(
        fragments.kind(e), [&]<CellKind kind>(fragments::CentreDivision<kind>) {
            typename VirtualCentreKernel<kind>::Corners corners;
            for (std::size_t k = 0; k < corners.size(); ++k)
                corners[k] = fragments.rest_position(fragments.corners(e)[k]);
            return VirtualCentreKernel<kind>::why_no_cell(corners, fragments.diagonals(e));
        });
}

/// Calls visit(range, begin, end) for each range of node ids that has some of `nodes`. These are
/// nodes[begin] to before nodes[end], and `nodes` is in ascending order.
template <class Visit>
void for_each_range(std::span<const std::uint32_t> nodes, Visit visit) {
    for (std::size_t begin = 0; begin < nodes.size();) {
        const std::size_t range = nodes[begin] / nodes_per_range;
        const auto end = std::lower_bound(nodes.begin() + static_cast<std::ptrdiff_t>(begin),
                                          nodes.end(), (range + 1) * nodes_per_range);
        const auto next = static_cast<std::size_t>(end - nodes.begin());
        visit(range, begin, next);
        begin = next;
    }
}

}  // namespace

std::size_t history_size(const Material& material, CellKind kind) {
    const auto* links = std::get_if<HyperElasticLinks>(&material.method);
    if (!links || links->prony.empty()) return 0;
    const std::size_t num_terms = links->prony.size();
    switch (kind) {
        case CellKind::hexahedron:
            return CentreViscousKernel<CellKind::hexahedron>::history_size(num_terms);
        case CellKind::wedge:
            return CentreViscousKernel<CellKind::wedge>::history_size(num_terms);
        case CellKind::pyramid:
            return CentreViscousKernel<CellKind::pyramid>::history_size(num_terms);
        case CellKind::tetrahedron:
        case CellKind::polyhedron:
            break;
    }
    return links->prony_rule == PronyRule::nodal ? NodalViscousKernel::history_size(num_terms)
                                                 : ViscousKernel::history_size(num_terms);
}

ElementStore::ElementStore(const FragmentMesh& fragments, const topology::Mesh& mesh,
                           const MaterialTable& table)
    : table_(table) {
    if (table.precision == Precision::single_precision)
        for (const Material& material : table.materials)
            if (std::holds_alternative<MassSprings>(material.method))
                throw InputError(
                    "mass springs have no forces in single precision; use double precision, or "
                    "another method");
    if (!table_.fibres.empty()) {
        table_.fibres.resize(fragments.element_capacity(), Vec3::Zero());
        fibres_.emplace(fragments, std::exchange(table_.fibres, {}));
    }
    for (std::size_t e = 0; e < fragments.element_capacity(); ++e)  // also if an edit removed it
        has_kind_[static_cast<std::size_t>(fragments.kind(ElementId(e)))] = true;
    // Blocks are completed one after the other, so that few have lists of changes at a time.
    std::size_t range = 0;
    for (const ElementId e : fragments.elements()) {
        if (e.index() / ElementBlock::max_elements != range)
            number_nodes(fragments.rest_positions());
        range = e.index() / ElementBlock::max_elements;
        require_law(fragments, mesh, e);
        insert(fragments, e);
    }
    number_nodes(fragments.rest_positions());
}

void ElementStore::require_law(const FragmentMesh& fragments, const topology::Mesh& mesh,
                               ElementId e) const {
    const int region = fragments.region(e);
    const CellId cell = fragments.cells_of(e).front();
    const std::string name = "element " + std::to_string(mesh.label(cell));
    const auto refuse = [&](MaterialMisfit why, const std::string& text) {
        throw UnsuitableMaterial(cell, region, why, name + text);
    };
    const std::string of_region = ", of region " + std::to_string(region) + ", ";
    if (!table_.of_region.contains(region))
        refuse(MaterialMisfit::other,
               " has region " + std::to_string(region) +
                   ", for which there is no material; add one, or one without regions");
    const Material& material = table_.materials[table_.of_region.at(region)];
    const auto* hybrid = std::get_if<HybridSprings>(&material.method);
    const CellKind kind = fragments.kind(e);
    const std::string is_a = of_region + "is a " + traits(kind).name;
    if (hybrid && kind != CellKind::hexahedron)
        refuse(MaterialMisfit::needs_hexahedra, is_a + "; the method hybmss needs hexahedra");
    if (std::holds_alternative<MassSprings>(material.method) && kind != CellKind::tetrahedron)
        refuse(MaterialMisfit::needs_tetrahedra,
               is_a + "; the method mass-spring needs tetrahedra");
    const auto* links = std::get_if<HyperElasticLinks>(&material.method);
    if (links && kind != CellKind::tetrahedron) {
        if (!links->prony.empty() && links->prony_rule == PronyRule::nodal)
            refuse(MaterialMisfit::needs_tetrahedra,
                   is_a + "; the nodal rule of a Prony series needs tetrahedra");
        if (const auto reason = why_no_centre_cell(fragments, e))
            refuse(MaterialMisfit::other, of_region + *reason);
    }
    constexpr double rounding = 1e-12;
    if (material.has_fibres() && !(std::abs(input_of(fragments, e).fibre.norm() - 1.0) <= rounding))
        refuse(MaterialMisfit::other,
               of_region + "has no direction of fibres of unit length, which its material needs");
    if (!hybrid) return;
    std::array<Vec3, 8> corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
        corners[k] = fragments.rest_position(fragments.corners(e)[k]);
    if (const auto reason = why_no_cell(*hybrid, corners))
        refuse(MaterialMisfit::needs_cubes, " " + *reason);
}

std::size_t ElementStore::index_of_form(ElementId e, int region, std::size_t form) const {
    const std::size_t of_material =
        e.index() / ElementBlock::max_elements * table_.materials.size() +
        table_.of_region.at(region);
    return of_material * num_forms + form;
}

std::size_t ElementStore::block_index(ElementId e, int region, CellKind kind) const {
    if (has_springs_in_boxes(region)) {
        const std::size_t of_divided = index_of_form(e, region, form_of_divided_box);
        if (of_divided < blocks_.size() && blocks_[of_divided] && blocks_[of_divided]->has(e))
            return of_divided;
    }
    return index_of_form(e, region, static_cast<std::size_t>(kind));
}

bool ElementStore::has_springs_in_boxes(int region) const {
    return std::holds_alternative<HybridSprings>(
        table_.materials[table_.of_region.at(region)].method);
}

std::size_t ElementStore::next_form(const FragmentMesh& fragments, ElementId e) const {
    const bool is_divided = !fragments.part_shares(e).empty() || fragments.volume_share(e) != 1.0 ||
                            !fragments.diagonals(e).is_none();
    return is_divided && has_springs_in_boxes(fragments.region(e))
               ? form_of_divided_box
               : static_cast<std::size_t>(fragments.kind(e));
}

ElementInput ElementStore::input_of(const FragmentMesh& fragments, ElementId e) const {
    return {fragments.corners(e),
            fragments.rest_positions(),
            fibres_ ? (*fibres_)[e] : Vec3(Vec3::Zero()),
            fragments.volume_share(e),
            fragments.part_shares(e),
            fragments.diagonals(e)};
}

void ElementStore::insert(const FragmentMesh& fragments, ElementId e) {
    const std::size_t form = next_form(fragments, e);
    const std::size_t index = index_of_form(e, fragments.region(e), form);
    if (index >= blocks_.size()) blocks_.resize(index + 1);
    if (!blocks_[index])
        blocks_[index] =
            make_block(table_.materials[table_.of_region.at(fragments.region(e))], table_.precision,
                       fragments.kind(e), form == form_of_divided_box);
    editable(index).insert(e, input_of(fragments, e));
    note_change(index);
}

void ElementStore::replace(const FragmentMesh& fragments, ElementId e) {
    const int region = fragments.region(e);
    const CellKind kind = fragments.kind(e);
    const std::size_t index = block_index(e, region, kind);
    if (index != index_of_form(e, region, next_form(fragments, e))) {
        erase(e, region, kind);
        insert(fragments, e);
        return;
    }
    editable(index).replace(e, input_of(fragments, e));
    note_change(index);
}

ElementBlock& ElementStore::editable(std::size_t block) {
    if (blocks_[block].use_count() > 1) blocks_[block] = blocks_[block]->clone();
    return *blocks_[block];
}

void ElementStore::note_change(std::size_t block) {
    if (block < known_.size()) known_[block] = {};
    if (changed_blocks_.empty() || changed_blocks_.back() != block)
        changed_blocks_.push_back(block);
}

void ElementStore::number_nodes(std::span<const Vec3> rest_positions) {
    const std::size_t num_nodes = rest_positions.size();
    std::sort(changed_blocks_.begin(), changed_blocks_.end());
    const auto last = std::unique(changed_blocks_.begin(), changed_blocks_.end());
    changed_blocks_.erase(last, changed_blocks_.end());

    local_numbers_.resize(std::max(local_numbers_.size(), num_nodes), ElementBlock::unnumbered);
    ranges_.resize(std::max(ranges_.size(), num_node_ranges(num_nodes)));
    parts_.resize(blocks_.size());
    const auto offset_of = [](std::vector<Piece>& range, std::size_t block) {
        return std::lower_bound(range.begin(), range.end(), block,
                                [](const Piece& p, std::size_t b) { return p.block < b; });
    };
    for (const std::size_t b : changed_blocks_) {
        ElementBlock& block = editable(b);
        for_each_range(block.nodes(), [&](std::size_t r, std::size_t, std::size_t) {
            ranges_[r].erase(offset_of(ranges_[r], b));
        });
        block.number_nodes(local_numbers_, rest_positions);
        for_each_range(block.nodes(), [&](std::size_t r, std::size_t begin, std::size_t end) {
            ranges_[r].insert(offset_of(ranges_[r], b), {b, begin, end});
        });
        parts_[b].resize(block.nodes().size() + 1);
    }
    ranges_.resize(num_node_ranges(num_nodes));
    changed_blocks_.clear();
}

std::span<const std::byte> ElementStore::bytes_from(std::size_t block) const {
    while (block < blocks_.size() && !blocks_[block]) ++block;
    if (block == blocks_.size()) return {};
    return blocks_[block]->bytes_of_elements();
}

void ElementStore::take_note_of(const State& state) const {
    if (known_version_ != state.version()) known_.clear();
    known_version_ = state.version();
    known_.resize(blocks_.size());
}

void ElementStore::compute_forces(const State& state, const Workers& workers) {
    assert(ranges_.size() == num_node_ranges(state.positions().size()));
    take_note_of(state);
    workers.for_each(blocks_.size(), [&](std::size_t b) {
        if (blocks_[b] && !known_[b].has_forces) compute_forces_of(b, state);
        known_[b].has_forces = false;
    });
}

void ElementStore::compute_totals_and_forces(const State& state, const Workers& workers) {
    take_note_of(state);
    workers.for_each(blocks_.size(), [&](std::size_t b) {
        if (!blocks_[b] || known_[b].totals) return;
        known_[b].totals = blocks_[b]->state(state.positions());
        compute_forces_of(b, state);
        known_[b].has_forces = true;
    });
}

void ElementStore::compute_forces_of(std::size_t block, const State& state) {
    assert(changed_blocks_.empty());
    blocks_[block]->compute_forces(blocks_[block]->local_positions(state.positions()),
                                   state.history(), parts_[block], bytes_from(block + 1));
}

void ElementStore::fetch(const Piece& piece) const {
    constexpr std::size_t vectors_in_line = 64 / sizeof(LocalVector);
    __builtin_prefetch(blocks_[piece.block]->nodes().data() + piece.begin);
    const LocalVector* const part = parts_[piece.block].data();
    for (std::size_t i = piece.begin; i < piece.end; i += vectors_in_line)
        __builtin_prefetch(part + i);
}

void ElementStore::gather_forces(NodeRange range, std::span<Vec3> forces) const {
    for (std::size_t n = range.begin; n < range.end; ++n) forces[n].setZero();
    // Pieces read memory at distant places. If the body is larger than the caches, each read would
    // have to wait for the memory, so that it is prefetched.
    constexpr std::size_t ahead = 2;
    const std::vector<Piece>& pieces = ranges_[range.number];
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        if (p + ahead < pieces.size()) fetch(pieces[p + ahead]);
        const Piece& piece = pieces[p];
        const std::uint32_t* const nodes = blocks_[piece.block]->nodes().data();
        const LocalVector* const part = parts_[piece.block].data();
        for (std::size_t i = piece.begin, end = piece.end; i < end; ++i)
            forces[nodes[i]] += part[i].vector();
    }
}

bool ElementStore::compute_excess_stiffness(const State& state, const Workers& workers) const {
    assert(changed_blocks_.empty());
    take_note_of(state);
    excess_.resize(blocks_.size());
    workers.for_each(blocks_.size(), [&](std::size_t b) {
        if (!blocks_[b] || known_[b].has_stiffness) return;
        excess_[b].resize(blocks_[b]->nodes().size());
        if (!blocks_[b]->set_excess_stiffness(blocks_[b]->local_positions(state.positions()),
                                              excess_[b]))
            excess_[b].clear();
        known_[b].has_stiffness = true;
    });
    return std::ranges::any_of(excess_, [](const auto& excess) { return !excess.empty(); });
}

void ElementStore::gather_excess_stiffness(NodeRange range, std::span<double> excess) const {
    for (const Piece& piece : ranges_[range.number]) {
        const std::vector<double>& part = excess_[piece.block];
        if (part.empty()) continue;
        const std::uint32_t* const nodes = blocks_[piece.block]->nodes().data();
        for (std::size_t i = piece.begin; i < piece.end; ++i)
            excess[nodes[i] - range.begin] += part[i];
    }
}

BlockState ElementStore::totals(const State& state, const Workers& workers) const {
    take_note_of(state);
    workers.for_each(blocks_.size(), [&](std::size_t b) {
        if (blocks_[b] && !known_[b].totals)
            known_[b].totals = blocks_[b]->state(state.positions());
    });
    BlockState all;
    for (const Known& block : known_)
        if (block.totals) all += *block.totals;
    return all;
}

std::vector<std::shared_ptr<const ElementBlock>> ElementStore::share_blocks() const {
    std::vector<std::shared_ptr<const ElementBlock>> shared;
    std::copy_if(blocks_.begin(), blocks_.end(), std::back_inserter(shared),
                 [](const auto& block) { return block != nullptr; });
    return shared;
}

std::size_t ElementStore::history_size() const {
    std::size_t most = 0;
    for (const Material& material : table_.materials)
        for (std::size_t k = 0; k < has_kind_.size(); ++k)
            if (has_kind_[k])
                most = std::max(most, physics::history_size(material, static_cast<CellKind>(k)));
    return most;
}

double ElementStore::advance(std::span<const Vec3> before, std::span<const Vec3> positions,
                             double dt, Workers& workers, ViscousHistory& history) {
    assert(changed_blocks_.empty());
    energies_taken_.assign(blocks_.size(), 0.0);
    workers.for_each(blocks_.size(), [&](std::size_t b) {
        if (!blocks_[b] || !blocks_[b]->has_history()) return;
        thread_local std::vector<LocalVector> places_before;
        energies_taken_[b] =
            blocks_[b]->advance(blocks_[b]->local_positions(before, places_before),
                                blocks_[b]->local_positions(positions), dt, history);
    });
    return std::accumulate(energies_taken_.begin(), energies_taken_.end(), 0.0);
}

void ElementStore::erase(ElementId e, int region, CellKind kind) {
    const std::size_t index = block_index(e, region, kind);
    editable(index).erase(e);
    note_change(index);
}

}  // namespace incise::physics
