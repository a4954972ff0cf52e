// All elements of a body, in blocks of one kind and material each.
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
#include "incise/physics/elements/element_block.h"
#include "incise/physics/elements/precision.h"
#include "incise/physics/elements/state.h"
#include "incise/physics/elements/workers.h"
#include "incise/physics/laws/material.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The materials of a body and which region has which.
struct MaterialTable {
    std::vector<Material> materials;
    std::map<int, std::size_t> of_region;  ///< region -> index of its material
    /// By element id, the direction of the fibres at rest, of unit length; zero where the material
    /// has none, empty if no material has any.
    std::vector<Vec3> fibres = {};
    /// Of the forces that explicit steps take (Model::compute_forces). Energies, stresses, viscous
    /// parts, tangents and the forces of implicit steps and statics are in doubles throughout.
    Precision precision = Precision::double_precision;
};

/// The material of a region has no forces for one of its elements.
struct UnsuitableMaterial : InputError {
    UnsuitableMaterial(int of_region, const std::string& text)
        : InputError(text), region(of_region) {}
    int region;
};

/// Elements whose ids share all but their lowest bits and that have the same material form a
/// block. The division is a function of the ids alone: a body that has been edited is divided,
/// and so summed, exactly as one built afresh from the same mesh.
class ElementStore {
  public:
    /// Throws UnsuitableMaterial for a region without material, for a kind of element for which the
    /// material has no force law and for an element without the fibres that its material has;
    /// InputError for mass springs in single precision, which they have no forces in.
    ElementStore(const topology::Mesh& mesh, const MaterialTable& table);

    /// What elements keep by their ids follows an edit: parts of a divided element inherit its
    /// fibres. Before the elements themselves do.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
        if (fibres_) fibres_->apply(mesh, changes);
    }

    void insert(const topology::Mesh& mesh, ElementId e);
    /// Recomputes an element whose corners are others now.
    void replace(const topology::Mesh& mesh, ElementId e);
    /// @param region of the element, which the mesh may have forgotten by now
    void erase(ElementId e, int region);

    /// Brings the blocks that have changed, and whose nodes they share, up to date: at the end of
    /// an edit, before anything is asked of the elements but their shares and rest volumes.
    void number_nodes(std::size_t num_nodes);

    const ElementBlock& block_of(const topology::Mesh& mesh, ElementId e) const {
        return *blocks_[block_index(e, mesh.region(e))];
    }

    /// kg/m3
    double density(int region) const {
        return table_.materials[table_.of_region.at(region)].density;
    }

    /// What the store was built from, without the fibres.
    const MaterialTable& materials() const { return table_; }
    /// As MaterialTable has them, also of the elements that edits added.
    std::span<const Vec3> fibres() const {
        return fibres_ ? fibres_->values() : std::span<const Vec3>();
    }

    /// The most numbers that an element of any of the materials remembers; 0 if none is viscous.
    std::size_t history_size() const;

    /// Brings the history of all elements from the positions `before` to `positions`, dt later;
    /// see ElementBlock. Returns the energy that viscosity took, J: the same bits for any number
    /// of workers.
    double advance(std::span<const Vec3> before, std::span<const Vec3> positions, double dt,
                   Workers& workers, ViscousHistory& history);

    /// Computes what each block comes to, if that is not known, for totals(), and right after it
    /// the block's forces, for compute_forces: so what both read comes from memory once.
    void compute_totals_and_forces(const State& state, const Workers& workers);
    /// Computes the forces of each block, with those of viscosity as far as the history goes, for
    /// gather_forces. Those that compute_totals_and_forces computed stand, if neither an edit
    /// changed the block nor the state is another.
    void compute_forces(const State& state, const Workers& workers);
    /// Sets `forces` (N, by node id) to those last computed, for one range of nodes: a node's force
    /// is the sum of those of the blocks, in ascending order. For different ranges at the same
    /// time.
    void gather_forces(NodeRange range, std::span<Vec3> forces) const;

    /// Adds the forces at the end of a step, N, by node id; see ElementBlock.
    void add_forces(const EndOfStep& end, std::span<Vec3> forces) const {
        for_each_block([&](const ElementBlock& block) { block.add_forces(end, forces); });
    }

    /// What all elements come to. Blocks keep theirs until an edit changes them or the state is
    /// another, so that another call beside an edit costs what that touched.
    /// @thread not by several at the same time
    BlockState totals(const State& state, const Workers& workers) const;

    /// add(compute(block)) for each block in ascending order: computed at the same time, and so
    /// added up in the same order whatever the number of workers. Takes no memory.
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

    /// In ascending order, as they are now: edits work on copies of those that are shared. Whoever
    /// has them lets go of them on the thread that edits, which counts who shares a block.
    std::vector<std::shared_ptr<const ElementBlock>> share_blocks() const;

  private:
    /// The nodes that a block has in one range, by local number.
    struct Piece {
        std::size_t block, begin, end;
    };

    /// Of a block, until an edit changes it or the state is another.
    struct Known {
        std::optional<BlockState> totals;
        bool has_forces = false;  ///< which nobody has asked for yet
    };

    void note_change(std::size_t block);
    /// Forgets what was known of another state.
    void take_note_of(const State& state) const;
    void compute_forces_of(std::size_t block, const State& state);
    /// Has the processor fetch what gather_forces reads of a piece.
    void fetch(const Piece& piece) const;
    /// Those of the elements of the first block from the given number on, if there is one.
    std::span<const std::byte> bytes_from(std::size_t block) const;
    /// The block, or a copy that takes its place if somebody shares it.
    ElementBlock& editable(std::size_t block);

    std::size_t block_index(ElementId e, int region) const;
    void require_law(const topology::Mesh& mesh, ElementId e) const;
    Vec3 fibre_of(ElementId e) const;

    MaterialTable table_;  // without the fibres
    std::optional<topology::ElementField<Vec3>> fibres_;
    std::vector<std::shared_ptr<ElementBlock>> blocks_;  // by chunk of ids, then material
    std::vector<std::size_t> changed_blocks_;            // since the nodes were numbered
    std::vector<std::vector<Piece>> ranges_;       // of node ids; in ascending order of blocks
    std::vector<std::vector<LocalVector>> parts_;  // the forces of each block
    std::vector<std::uint16_t> local_numbers_;     // scratch, by node id
    std::vector<double> energies_taken_;           // scratch, by block
    mutable std::vector<Known> known_;             // by block
    mutable std::uint64_t known_version_ = 0;      // of the state that they are of
};

}  // namespace incise::physics
