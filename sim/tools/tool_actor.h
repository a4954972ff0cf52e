// A tool in a world: what it does in a step, and what a hand does with it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "incise/base/archive.h"
#include "incise/contact/contact.h"
#include "incise/contact/tool_contact.h"
#include "incise/cutting/cutter.h"
#include "incise/cutting/tools/tool.h"
#include "incise/physics/body/model.h"
#include "incise/sim/world.h"
#include "incise/topology/mesh.h"
#include "incise/topology/pose.h"

namespace incise::sim {

/// The body on which tools act.
struct Tissue {
    topology::Mesh& mesh;
    const physics::Model& model;
    cutting::Cutter& cutter;
    contact::Contact* contact;  ///< null for a world without contact
};

/// Carries out an edit of the mesh. The world then follows it.
using CarryOut = std::function<void(const std::function<cutting::Split()>&)>;

/// A tool of a world. Each kind of tool is a class of its own, in the file of this folder that has
/// its name; make_actor() finds it. Docs: docs/architecture.md, How to add a tool.
///
/// A step first asks each tool that is there what it touches, then moves the body, and then lets
/// each tool act(). All orders of a hand throw InputError, and change nothing, for a tool that
/// cannot do it.
class ToolActor {
  public:
    explicit ToolActor(ToolDef def) : def_(std::move(def)) {}
    virtual ~ToolActor() = default;
    ToolActor(const ToolActor&) = delete;
    ToolActor& operator=(const ToolActor&) = delete;

    const ToolDef& def() const { return def_; }
    bool is_present() const { return is_present_; }
    /// True if the tool felt a force and was withdrawn at the end of the last step.
    bool has_just_left() const { return has_just_left_; }
    const Pose& pose() const { return pose_; }
    /// Throws InputError unless the tool can act on the tissue.
    /// @param materials  of the tissue, as they are or are to be
    virtual void require_fit(const Tissue& tissue, const physics::MaterialTable& materials) const;

    // What a hand does: see the methods of World with these names.
    void place(const Tissue& tissue, const Pose& pose);
    virtual std::size_t close(const Tissue& tissue);
    virtual void open();
    virtual bool is_closed() const { return false; }
    virtual std::size_t num_held() const { return 0; }
    virtual std::size_t tie(const Tissue& tissue);
    virtual double length() const;
    virtual void untie();
    virtual bool is_tied() const;

    /// Throws InputError unless the tool can do this in a step.
    virtual void require_possible(const ToolInput& input) const;
    /// Returns in how many parts a step must be divided in which the tool goes to a pose.
    /// @param element_size  mean length of an element at rest, m
    /// @pre  the tool is there
    virtual double num_substeps([[maybe_unused]] const Pose& to,
                                [[maybe_unused]] double element_size) const {
        return 1.0;
    }
    /// Takes what the tool is to do in the step that now begins.
    /// @pre  require_possible()
    virtual void take(const ToolInput& input);
    /// Prepares what the tool does in a step of `dt`, s, also if it has no input.
    virtual void begin_step(double /*dt*/) {}
    /// Goes on in a part of a step, from one share of it to another. Returns what the tool does to
    /// the tissue that it touches; null if it touches nothing.
    /// @param moved  how far the tissue may have moved in the step so far, m
    /// @pre  the tool is there, it feels a force, and the world has contact
    virtual contact::ToolContact* touch(const Tissue& tissue, double from, double to, double moved);
    /// Cuts what the tool has met on its way to its target, and is there then.
    void act(const Tissue& tissue, const CarryOut& carry_out);

    /// Returns the contact of the tool; null if it has touched nothing since it came.
    virtual contact::ToolContact* contact() { return nullptr; }
    /// Lets go of the tissue: ends the contact, and opens jaws.
    virtual void let_go() {}
    /// Ends the step in which the tool left.
    void forget_leaving() {
        let_go();
        has_just_left_ = false;
    }
    /// True if the tool divides elements and its cut ends in one.
    virtual bool is_in_tissue(const cutting::Cutter& /*cutter*/) const { return false; }

    /// Writes what the tool is and does. load_actor() reads it.
    void save(ArchiveWriter& ar) const;

  protected:
    /// Throws InputError that names the tool, if there is a fault.
    void require_none(const std::string& fault) const;
    [[noreturn]] void refuse(const std::string& why) const;

    /// Prepares a tool that is new in its world.
    virtual void begin(const Tissue& /*tissue*/) {}
    /// Cuts what the tool has met between its pose and its target.
    virtual void cut(const Tissue& /*tissue*/, const CarryOut& /*carry_out*/) {}
    /// Sets what follows from the arrival at the target.
    virtual void arrive() {}
    /// Leaves the tissue. The tool is at its target.
    virtual void leave(const Tissue& /*tissue*/, const CarryOut& /*carry_out*/) {}
    /// Writes and reads the values of the kind.
    virtual void save_own(ArchiveWriter& /*ar*/) const {}
    virtual void restore_own(ArchiveReader& /*ar*/, const Tissue& /*tissue*/) {}

    const Pose& target() const { return target_; }
    const std::optional<Pose>& pose_before_end() const { return pose_before_end_; }
    void set_present(bool is_present) {
        is_present_ = is_present;
        is_leaving_ = false;
    }

  private:
    friend std::unique_ptr<ToolActor> make_actor(const ToolDef& def, const Tissue& tissue);
    friend std::unique_ptr<ToolActor> load_actor(ArchiveReader& ar, const Tissue& tissue);
    void require_sound(const Pose& pose) const;
    /// Throws InputError unless the tool can be at the pose.
    void require_pose(const Pose& pose) const;
    static void list(auto& ar, auto& self) { ar(self.is_present_, self.pose_); }

    ToolDef def_;
    bool is_present_ = false, has_just_left_ = false;
    Pose pose_ = {};  // at present
    // In a step; between two steps the target is the pose.
    Pose target_ = {};  // at the end
    bool is_leaving_ = false;
    std::optional<Pose> pose_before_end_ = {};
};

/// A tool of one kind.
template <class Shape>
class ActorOf : public ToolActor {
  public:
    using ToolActor::ToolActor;

  protected:
    const Shape& shape() const { return std::get<Shape>(def().shape); }
};

/// Makes an actor from its definition, which has a shape of this type. Defined in the file of its
/// kind. Throws InputError if the shape is invalid.
template <class Shape>
std::unique_ptr<ToolActor> make_actor_of(const ToolDef& def);
/// Makes the actor of a new tool. Throws InputError if its definition is invalid, or if it cannot
/// act on the tissue.
std::unique_ptr<ToolActor> make_actor(const ToolDef& def, const Tissue& tissue);
/// Restores what ToolActor::save() wrote. Throws InputError for what is unsound.
/// @pre  the parts of the tissue are restored
std::unique_ptr<ToolActor> load_actor(ArchiveReader& ar, const Tissue& tissue);

}  // namespace incise::sim
