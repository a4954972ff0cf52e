// A kind of tool, as scenarios, programs and pages write it: its keys, and what they mean.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/tools/tool.h"
#include "incise/scenario/document.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/table_reader.h"
#include "incise/scenario/tool_build.h"

namespace incise::scenario {

/// A key of a [[tool]] section that belongs to some kinds of tools.
struct ToolKey {
    std::string_view name;
    std::string_view hint = {};  ///< for messages, if the kind needs the key: what to write
    bool tells_where = false;    ///< without a sound value it is not known what the tool meets
    bool is_time = false;        ///< it says when: not for a tool that is led by hand
};

/// The extent of a tool: the tool is within `radius` of the convex hull of `points`, m, in the
/// frame of the tool.
struct Extent {
    std::vector<Vec3> points;
    double radius = 0.0;
};

/// A kind of tool. Each is a class of its own, in the file of this folder that has its name.
///
/// A tool that a pose leads has the key `path`, another one the key `time`: see has_path().
class ToolKind {
  public:
    /// What a kind says about the keys `path` and `time`, for messages.
    struct Motion {
        std::string_view time_hint = {};     ///< without a path: what to write for `time`
        std::string_view why_no_path = {};   ///< without a path: why it has none
        std::string_view why_two_keys = {};  ///< why a path needs two keys; empty if one will do
    };
    ToolKind(const cutting::ToolTraits& traits, std::span<const ToolKey> keys, Motion motion)
        : traits_(traits), keys_(keys), motion_(motion) {}
    virtual ~ToolKind() = default;
    ToolKind(const ToolKind&) = delete;
    ToolKind& operator=(const ToolKind&) = delete;

    std::string_view name() const { return traits_.kind; }
    const cutting::ToolTraits& traits() const { return traits_; }
    std::span<const ToolKey> keys() const { return keys_; }
    const Motion& motion() const { return motion_; }
    bool has_path() const { return traits_.has_pose && !traits_.is_at_once; }

    /// True if a tool without a known kind is read as this one too, so that all that is wrong with
    /// it is told at once. Kinds whose keys have another meaning elsewhere are left out.
    virtual bool reads_unknown_kinds() const { return false; }
    /// Reports what is missing, beyond the keys with a hint. Returns false if there is such.
    virtual bool has_all(const TableReader& /*tool*/) const { return true; }
    /// Reads the keys of the kind. What is wrong is reported, and left as it is by default.
    /// @param folder  of the scenario, to which the names of files are relative
    virtual void read(const TableReader& tool, const std::filesystem::path& folder,
                      ToolSpec& spec) const = 0;
    /// Reports what is wrong with the times of a tool.
    /// @param end_time  of the run, s; not above 0 if not known
    virtual void check_times(const TableReader& /*tool*/, const ToolSpec& /*spec*/,
                             [[maybe_unused]] double end_time) const {}
    /// Returns what to do about a key of another kind; empty: leave it out.
    virtual std::string advice_on(std::string_view /*key*/) const { return ""; }

    /// Gives a tool the surface of its file. Throws InputError if it cannot be its shape.
    /// @param surface   as in the file
    /// @param scale     factor of all coordinates
    /// @param warnings  receives warnings, without the name of the file
    virtual void take_surface([[maybe_unused]] const topology::SurfaceData& surface,
                              [[maybe_unused]] double scale, cutting::ToolShape& /*shape*/,
                              [[maybe_unused]] std::vector<std::string>& warnings) const {}

    /// Throws InputError if the tool does not fit the body at rest.
    virtual void require_fit(const ScriptedTool& /*tool*/, const topology::Mesh& /*mesh*/) const {}
    /// Returns a warning if the tool begins in a way that is hardly meant.
    virtual std::optional<std::string> warning_of_begin(const ScriptedTool& /*tool*/,
                                                        const topology::Mesh& /*mesh*/) const {
        return std::nullopt;
    }
    /// Returns the sharp edge of a tool with a path at moments one after the other, until
    /// `end_time`, s, in the frame of the world, m. Between two of them it divides what it sweeps.
    virtual std::vector<std::vector<Vec3>> edges(const ScriptedTool& /*tool*/,
                                                 double /*end_time*/) const {
        return {};
    }
    /// Returns the extent of a tool with a path. Without one it may be everywhere.
    virtual std::optional<Extent> extent(const cutting::ToolShape& /*shape*/) const {
        return std::nullopt;
    }
    /// Returns the keys of a tool that say how it looks; none if nobody draws it.
    virtual Table describe(const cutting::ToolShape& /*shape*/) const { return {}; }

  private:
    const cutting::ToolTraits& traits_;
    std::span<const ToolKey> keys_;
    Motion motion_;
};

/// Returns the kind of the tools with a shape of this type. Defined in the file of the kind.
template <class Shape>
const ToolKind& kind_for();
/// Returns all kinds of tools, in the order of cutting::ToolShape.
std::span<const ToolKind* const> tool_kinds();
/// Returns the kind of a tool.
const ToolKind& kind_of(const cutting::ToolShape& shape);
/// Returns how a tool looks, with the keys of a [[tool]] section. A shape from a file comes as
/// {mesh = {points, triangles}}, and a half space as {plane = {point, normal}}. Returns nothing for
/// tools that nobody draws: cuts at once, and sutures.
std::optional<Value> definition_of(const cutting::ToolShape& shape);
/// Returns the kinds with a key, for messages, such as "a grasper or a suture".
std::string owners_of(std::string_view key);

/// Reads the keys `shape` and `friction` of an obstacle.
void read_obstacle(const TableReader& obstacle, const std::filesystem::path& folder,
                   ToolSpec& spec);

}  // namespace incise::scenario
