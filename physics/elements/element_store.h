// All elements of a body, in blocks. Each block has one material.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/base/sum.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/elements/element_block.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/elements/state.h"
#include "incise/physics/elements/workers.h"
#include "incise/physics/laws/material.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"

namespace incise::physics {

/// The materials of a body and of its regions.
struct MaterialTable {
    std::vector<Material> materials;
    std::map<int, std::size_t> of_region;  ///< by region, the index of its material
    /// By element id, the direction of the fibres at rest, of unit length. It is zero where the
    /// material has no fibres. Empty if no material has fibres.
    std::vector<Vec3> fibres = {};
    /// Precision of the elastic forces in explicit steps (Model::compute_forces). Energies,
    /// stresses, viscous parts, tangents, and the forces of implicit steps and statics are always
    /// in doubles.
    Precision precision = Precision::double_precision;
};

/// Returns how many values an element of the material and kind stores in ViscousHistory: the stress
/// of its law, then as much for each term of its Prony series. 0 without viscosity.
std::size_t history_size(const Material& material, topology::CellKind kind);

/// Why a material does not suit an element.
enum class MaterialMisfit {
    needs_tetrahedra,  ///< its method is for tetrahedra, and the element is none
    needs_hexahedra,   ///< its method is for hexahedra, and the element is none
    needs_cubes,       ///< its method is for cubes or nearly cubic boxes
    other,
};

/// Thrown if a region has no material, or if its material does not suit one of its elements.
struct UnsuitableMaterial : InputError {
    UnsuitableMaterial(CellId which, int of_region, MaterialMisfit why, const std::string& text)
        : InputError(text), cell(which), region(of_region), cause(why) {}
    CellId cell;
    int region;
    MaterialMisfit cause;
};

/// The elements of a body in blocks: its fragments.
///
/// A block has the elements of one material and one kind whose ids agree in all but their lowest
/// bits, that is in a range of ElementBlock::max_elements ids. The division depends only on ids and
/// materials, and on which boxes of hybrid springs are divided. An edited body is therefore divided
/// and summed exactly as a new body with the same mesh.
///
/// A box of HybMSS that a cut has divided, or that carries a light part of another one, is computed
/// by HEML on the tetrahedra about its centre: see links_of_divided_box(). If the cut is taken
/// back, it is HybMSS again. A box of which a face meets two triangles is so from the start.
class ElementStore {
  public:
    /// Builds the blocks of a mesh. Throws UnsuitableMaterial for a region without material and for
    /// an element that its material does not suit. The kind or the shape of the element may be
    /// wrong, or it may lack the fibres that the material needs.
    /// Throws InputError for mass springs in single precision.
    /// @param fragments  the elements
    /// @param mesh       the mesh that they are fragments of, for labels in messages
    /// @param table      the materials; its fibres are by id of fragments
    ElementStore(const fragments::FragmentMesh& fragments, const topology::Mesh& mesh,
                 const MaterialTable& table);

    /// Follows an edit with the values by element id: parts of a divided element inherit its
    /// fibres. It must be called before insert(), replace() and erase() for this edit.
    void apply(const fragments::FragmentMesh& fragments,
               const fragments::FragmentMeshChanges& changes) {
        if (fibres_) fibres_->apply(fragments, changes);
    }

    void insert(const fragments::FragmentMesh& fragments, ElementId e);
    /// Precomputes an element again whose corners or whose shares have changed.
    void replace(const fragments::FragmentMesh& fragments, ElementId e);
    /// Erases an element. Its region and its kind are arguments.
    void erase(ElementId e, int region, topology::CellKind kind);

    /// Numbers the nodes of the changed blocks, at the end of an edit. Before this call, only
    /// contributions and rest volumes of elements may be read.
    /// @param rest_positions  of the nodes of the fragments, m, by id
    void number_nodes(std::span<const Vec3> rest_positions);

    /// Returns the block of an element.
    const ElementBlock& block_of(const fragments::FragmentMesh& fragments, ElementId e) const {
        return *blocks_[block_index(e, fragments.region(e), fragments.kind(e))];
    }

    /// Returns the density of the material of a region, kg/m3.
    double density(int region) const {
        return table_.materials[table_.of_region.at(region)].density;
    }

    /// Returns the table of the constructor, without the fibres.
    const MaterialTable& materials() const { return table_; }
    /// Returns the fibres as in MaterialTable, including those of the elements that edits added.
    std::span<const Vec3> fibres() const {
        return fibres_ ? fibres_->values() : std::span<const Vec3>();
    }

    /// Returns the size of ViscousHistory: the largest number of values that an element of any of
    /// the materials, and of a kind that the body has or had, stores; 0 if none is viscous.
    std::size_t history_size() const;

    /// Advances the history of all elements from the positions `before` to `positions` (m, by node
    /// id), `dt` (s) later. Returns the energy that viscosity dissipated, J. It is the same bit for
    /// bit with any number of threads.
    double advance(std::span<const Vec3> before, std::span<const Vec3> positions, double dt,
                   Workers& workers, ViscousHistory& history);

    /// Computes the totals and the forces of each block whose totals are not known, for totals()
    /// and compute_forces(). What both need is thus read from memory only once.
    void compute_totals_and_forces(const State& state, const Workers& workers);
    /// Computes the elastic and viscous forces of each block, for gather_forces(). Forces of
    /// compute_totals_and_forces() are used if the state has the same version and no edit has
    /// changed the block since.
    void compute_forces(const State& state, const Workers& workers);
    /// Sets `forces` (N, by node id) to the forces of compute_forces(), for one range of nodes. The
    /// force on a node is the sum over the blocks in ascending order.
    /// @thread Several threads may call it at the same time, for different ranges.
    void gather_forces(NodeRange range, std::span<Vec3> forces) const;

    /// Adds the forces at the end of a step, N, by node id; see ElementBlock::add_forces.
    void add_forces(const EndOfStep& end, std::span<Vec3> forces) const {
        for_each_block([&](const ElementBlock& block) { block.add_forces(end, forces); });
    }

    /// Computes for each block what the bounds on the stiffness of its nodes are above those at
    /// rest. Values of the same state are kept where no edit has changed the block. Returns false
    /// if no element is stiffer than at rest.
    /// @thread One thread at a time.
    bool compute_excess_stiffness(const State& state, const Workers& workers) const;
    /// Adds the values of compute_excess_stiffness() to `excess`, N/m, for one range of nodes. Its
    /// first entry belongs to the first node of the range. The sums are in ascending order of
    /// blocks.
    /// @thread Several threads may call it at the same time.
    void gather_excess_stiffness(NodeRange range, std::span<double> excess) const;

    /// Returns the totals of all elements. The totals of a block are stored until an edit changes
    /// the block or the state changes. After an edit, only touched blocks are computed again.
    /// @thread One thread at a time.
    BlockState totals(const State& state, const Workers& workers) const;

    /// Calls add(compute(block)) for each block. The threads compute at the same time. The results
    /// are added in ascending order of blocks, with any number of threads. Allocates no memory.
    template <class Compute, class Add>
    void add_up_blocks(const Workers& workers, Compute compute, Add add) const {
        constexpr std::size_t at_once = 256;
        std::array<decltype(compute(*blocks_[0])), at_once> values;
        for (std::size_t first = 0; first < blocks_.size(); first += at_once) {
            const std::size_t count = std::min(at_once, blocks_.size() - first);
            workers.for_each(count, [&](std::size_t i) {
                if (const auto& block = blocks_[first + i]) values[i] = compute(*block);
            });
            for (std::size_t i = 0; i < count; ++i)
                if (blocks_[first + i]) add(values[i]);
        }
    }

    /// Calls visit(block) for each block in ascending order.
    template <class Visit>
    void for_each_block(Visit visit) const {
        for (const auto& block : blocks_)
            if (block) visit(*block);
    }

    /// Returns the present blocks in ascending order. Later edits do not change them, since an edit
    /// replaces a shared block by a copy.
    /// @thread The pointers must be destroyed on the thread that edits, as its test whether a block
    /// is shared reads the use count.
    std::vector<std::shared_ptr<const ElementBlock>> share_blocks() const;

  private:
    /// The nodes of a block in one range of node ids, as a range of local numbers.
    struct Piece {
        std::size_t block, begin, end;
    };

    /// Results of a block, valid until an edit changes the block or the state changes.
    struct Known {
        std::optional<BlockState> totals;
        bool has_forces = false;  ///< the forces were computed, and compute_forces() not called yet
        bool has_stiffness = false;  ///< excess_ of the block is that of the state
    };

    void note_change(std::size_t block);
    /// Discards the results that belong to another version of the state.
    void take_note_of(const State& state) const;
    void compute_forces_of(std::size_t block, const State& state);
    /// Prefetches the memory that gather_forces() reads for a piece.
    void fetch(const Piece& piece) const;
    /// Returns bytes_of_elements() of the first block from number `block` on; empty if none.
    std::span<const std::byte> bytes_from(std::size_t block) const;
    /// Returns the block. If it is shared, a copy replaces it first.
    ElementBlock& editable(std::size_t block);

    /// The forms of elements: the kinds of cells, and boxes of HybMSS with less or more material
    /// than the box has, or with faces that meet triangles.
    static constexpr std::size_t form_of_divided_box = topology::num_cell_kinds,
                                 num_forms = topology::num_cell_kinds + 1;
    std::size_t index_of_form(ElementId e, int region, std::size_t form) const;
    /// Returns the block that an element is in.
    std::size_t block_index(ElementId e, int region, topology::CellKind kind) const;
    bool has_springs_in_boxes(int region) const;
    /// Returns the form that an element has by its present shares, in which it is not yet if an
    /// edit has just changed these.
    std::size_t next_form(const fragments::FragmentMesh& fragments, ElementId e) const;
    void require_law(const fragments::FragmentMesh& fragments, const topology::Mesh& mesh,
                     ElementId e) const;
    ElementInput input_of(const fragments::FragmentMesh& fragments, ElementId e) const;

    MaterialTable table_;  // without the fibres
    std::array<bool, topology::num_cell_kinds> has_kind_{};
    std::optional<topology::ElementField<ElementId, Vec3>> fibres_;
    std::vector<std::shared_ptr<ElementBlock>>
        blocks_;                               // by range of ids, then by material, then by form
    std::vector<std::size_t> changed_blocks_;  // since the nodes were numbered
    std::vector<std::vector<Piece>> ranges_;   // by range of nodes; in ascending order of blocks
    std::vector<std::vector<LocalVector>> parts_;      // the forces of each block
    std::vector<std::uint16_t> local_numbers_;         // scratch, by node id
    std::vector<double> energies_taken_;               // scratch, by block, J
    mutable std::vector<Known> known_;                 // by block
    mutable std::vector<std::vector<double>> excess_;  // stiffness, by block and local number; or
                                                       // empty, if all elements are as at rest
    mutable std::uint64_t known_version_ = 0;          // of the state to which known_ belongs
};

}  // namespace incise::physics
