// Scissors: two blades that close on the tissue between them, and cut it where they meet.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/sim/tools/edge_cut.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"

namespace incise::sim {

namespace {

using cutting::Scissors;

std::string fault_of(const Scissors& scissors) {
    if (!(scissors.length > 0.0 && std::isfinite(scissors.length)))
        return "their length is " + format_number(scissors.length) + " m: it must be above 0";
    if (!(scissors.angle >= Scissors::least_angle && scissors.angle < Scissors::largest_angle))
        return "their angle is " + format_number(scissors.angle) + ": it must be from " +
               format_number(Scissors::least_angle) + " and below " +
               format_number(Scissors::largest_angle);
    if (!(scissors.closing_time > 0.0 && std::isfinite(scissors.closing_time)))
        return "their closing time is " + format_number(scissors.closing_time) +
               " s: it must be above 0";
    return fault_of_snap(scissors.snap);
}

class ScissorsActor final : public ActorOf<Scissors> {
  public:
    explicit ScissorsActor(const ToolDef& def) : ActorOf(def) { require_none(fault_of(shape())); }

    std::size_t close(const Tissue&) override {
        require_there();
        is_closing_ = true;
        return 0;
    }
    void open() override {
        require_there();
        is_closing_ = false;
    }
    bool is_closed() const override { return is_closing_; }

    void begin_step(double dt) override {
        const double turn = dt / shape().closing_time;
        constexpr double rounding = 1e-9;  // of sums of steps: no step is left over for it
        is_cutting_ = is_closing_ && closed_ < 1.0;
        target_closed_ = closed_ + (is_closing_ ? turn : -turn);
        if (target_closed_ > 1.0 - rounding) target_closed_ = 1.0;
        if (target_closed_ < rounding) target_closed_ = 0.0;
    }
    void let_go() override {
        is_closing_ = is_cutting_ = false;
        closed_ = target_closed_ = 0.0;
    }
    bool is_in_tissue(const cutting::Cutter& cutter) const override {
        return edge_.is_in_tissue(cutter);
    }

  private:
    void require_there() const {
        if (!is_present())
            throw InputError("scissors '" + def().name + "' are not there: give them a pose first");
    }
    /// Sets where the blades meet: a line across what they enclose when they are open.
    void place_edge(const Pose& at, double closed, std::vector<Vec3>& edge) const {
        const auto points = cutting::meeting_line(shape(), closed);
        edge.resize(points.size());
        std::ranges::transform(points, edge.begin(), [&](const Vec3& x) { return at.to_world(x); });
    }
    void cut(const Tissue& tissue, const CarryOut& carry_out) override {
        if (!is_cutting_ && !is_in_tissue(tissue.cutter)) return;
        // Blades that open leave the end of the cut where it is, wherever they go.
        const Pose& there = is_cutting_ ? target() : pose();
        const double closed = is_cutting_ ? target_closed_ : closed_;
        carry_out([&] {
            place_edge(pose(), closed_, edge_.before);
            place_edge(there, closed, edge_.after);
            return edge_.split(tissue);
        });
        if (is_cutting_ && closed < 1.0) return;
        carry_out([&] { return edge_.end(tissue); });
        is_cutting_ = false;  // a step of statics asks again
    }
    void arrive() override { closed_ = target_closed_; }
    void leave(const Tissue& tissue, const CarryOut& carry_out) override {
        if (is_in_tissue(tissue.cutter)) carry_out([&] { return edge_.end(tissue); });
        let_go();
    }
    void begin(const Tissue& tissue) override { edge_.begin(tissue.cutter, shape().snap); }
    void save_own(ArchiveWriter& ar) const override {
        ar(is_closing_, closed_);
        edge_.save(ar);
    }
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        ar(is_closing_, closed_);
        if (!(closed_ >= 0.0 && closed_ <= 1.0) || !edge_.restore(ar, tissue.cutter, true, 2))
            refuse("has a cut of another one");
        target_closed_ = closed_;
    }

    bool is_closing_ = false;                    // what was asked for
    bool is_cutting_ = false;                    // in this step
    double closed_ = 0.0, target_closed_ = 0.0;  // now and after this step: from 0, open, to 1
    EdgeCut edge_;
};

}  // namespace

template <>
struct ActorFor<Scissors> {
    using type = ScissorsActor;
};
template std::unique_ptr<ToolActor> make_actor_of<Scissors>(const ToolDef&);

}  // namespace incise::sim
