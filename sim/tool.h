// A tool of the scenario in motion: where it is when, and what it cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cutting/cut_front.h"
#include "cutting/pose.h"
#include "cutting/splitter.h"
#include "sim/scenario.h"
#include "topology/change_set.h"
#include "topology/mesh.h"

namespace incise::sim {

/// How blades cut if they are not told: they split, unless the mesh has other elements than
/// tetrahedra. Cost: O(#elements).
CutMode usual_mode(const topology::Mesh& mesh);

/// Blades get a mode that suits the mesh, unless they have one.
/// Throws InputError for what is to split a mesh without tetrahedra.
ToolSpec with_mode(ToolSpec spec, const topology::Mesh& mesh);

/// Follows its path: position linear between keys, orientation along the shortest turn.
class Tool {
  public:
    /// Throws InputError if the file of its surface cannot be read. Warnings name that file.
    Tool(const ToolSpec& spec, std::vector<std::string>& warnings);

    /// Before the first cut: what the body then is. The mode of a blade must be given.
    void prepare(const cutting::UncutBody& uncut) { options_.uncut = uncut; }

    const std::string& name() const { return spec_.name; }
    cutting::Pose pose(double time) const;
    /// Whether it acts in the step (from, to], s: it is there from its first to its last key, a
    /// tool with one key in the step that contains it. The first step contains its start too.
    bool is_present(double from, double to) const;

    /// False only if nothing of it is ever in the box. Cost: that of its path, or of its surface.
    bool may_meet(const cutting::Box& box) const;

    /// Throws InputError if it is to divide elements and meets one on its path that it cannot
    /// divide, where the body rests: a run would stop there. Its path after `end_time`, s, is not
    /// looked at. Cost: O(#elements) for each key.
    void require_divisible(const topology::Mesh& mesh, double end_time) const;
    /// A warning of elements that it cannot divide and comes near to at rest, if it is to divide
    /// and there are any: tissue that moves may come into its way.
    /// @pre  require_divisible() throws nothing
    /// Cost: as there.
    std::optional<std::string> warning_of_near_misses(const topology::Mesh& mesh,
                                                      double end_time) const;
    /// What to do about such an element.
    std::string instead_of_dividing() const;
    /// Whether it divides elements: a cut, or a blade in the mode "split".
    bool divides() const;
    /// What to do where its edits leave a stable step that is too short.
    std::string for_longer_steps() const;

    /// Cuts what it meets while it and the tissue of the mesh move in [from, to]. Returns what it
    /// did, which is nothing if it is not there.
    /// @param resting  the other tools that are on their way through the body
    cutting::Split cut(topology::Mesh& mesh, const cutting::TissueMotion& tissue,
                       cutting::Scars& scars, std::span<cutting::RestingBlade> resting, double from,
                       double to);

    /// Whether its way ends in the step (from, to], s, and it has cut elements in part.
    bool is_to_finish(double from, double to) const;
    /// Then: ends its cut where it is (cutting::finish). The tissue is at rest.
    cutting::Split finish(topology::Mesh& mesh, const cutting::TissueMotion& tissue,
                          cutting::Scars& scars, std::span<cutting::RestingBlade> resting);

    /// Of a blade that has cut elements in part: what it is while another tool cuts in [from, to],
    /// before or after its own turn in that step. Refers to its front.
    std::optional<cutting::RestingBlade> resting(double from, double to, bool has_moved);

    /// Its front keeps up with the nodes that another tool copied.
    void follow(const topology::ChangeSet& changes) { front_.follow(changes); }

    /// Whether the mesh has all nodes that it remembers.
    bool is_on(const topology::Mesh& mesh) const { return front_.is_on(mesh); }

    /// What it remembers of its cut so far.
    static void archive(auto& ar, auto& self) { ar(self.front_); }

  private:
    void for_each_surface(double end_time,
                          const std::function<void(const cutting::CutSurface&)>& look) const;
    cutting::Split cut_with(const Carver& carver, topology::Mesh& mesh,
                            const cutting::TissueMotion& tissue, cutting::Scars& scars,
                            std::span<cutting::RestingBlade> resting, double from, double to);
    cutting::Split cut_with(const Blade& blade, topology::Mesh& mesh,
                            const cutting::TissueMotion& tissue, cutting::Scars& scars,
                            std::span<cutting::RestingBlade> resting, double from, double to);
    cutting::Split cut_with(const Cut& cut, topology::Mesh& mesh,
                            const cutting::TissueMotion& tissue, cutting::Scars& scars,
                            std::span<cutting::RestingBlade> resting, double from, double to);
    std::vector<Vec3> edge_at(const Blade& blade, double time) const;
    cutting::Box box_at(const Blade& blade, double time) const;
    cutting::Box swept_box(std::span<const Vec3> points) const;

    ToolSpec spec_;
    cutting::SplitOptions options_;
    cutting::CutFront front_;                             // of a blade that splits
    std::shared_ptr<const cutting::CutSurface> surface_;  // of a cut
};

}  // namespace incise::sim
