// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/run_warnings.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "incise/base/number_format.h"
#include "incise/physics/body/winding.h"
#include "incise/scenario/tool_build.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::runner {

RunWarnings::RunWarnings(const sim::World& world, const scenario::DynamicsSpec& dynamics)
    : has_stable_step_(dynamics.is_explicit()),
      warned_step_(world.ledger().initial().stable_step),
      size_(topology::mean_element_length(world.mesh())) {}

void RunWarnings::add_step(const sim::World& world, std::vector<std::string>& warnings) {
    for (const sim::Edit& edit : world.report().edits) add_short_step(world, edit.record, warnings);
    add_stiffening(world, warnings);
    const double depth = world.report().contact.max_penetration;
    if (depth > overlap_.depth) overlap_ = {depth, world.time()};
}

void RunWarnings::add_short_step(const sim::World& world, const sim::EditRecord& edit,
                                 std::vector<std::string>& warnings) {
    constexpr double much_shorter = 0.1;
    const double now = edit.after.stable_step;
    if (!has_stable_step_ || !(now < much_shorter * warned_step_)) return;
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << edit.tool << "', at t = " << edit.time << " s: its cut has left stiff "
         << "elements with so little mass that the stable step fell from " << warned_step_ << " to "
         << now << " s: the run takes " << warned_step_ / now << " times as long from here on";
    if (const auto tool = world.find_tool(edit.tool))
        text << "; " << scenario::for_longer_steps(world.tool(*tool).shape);
    warnings.push_back(text.str());
    warned_step_ = now;
}

namespace {

/// Returns the element with the shortest stable step in the present strain.
ElementId limiting_element(const physics::Model& model) {
    ElementId limiting;
    double shortest = std::numeric_limits<double>::infinity();
    const physics::Structure& structure = model.structure();
    for (const ElementId e : model.fragments().elements()) {
        const double stiffening =
            structure.elements().block_of(model.fragments(), e).stiffening(e, model.positions());
        const double step = structure.element_stable_step(e) / std::sqrt(stiffening);
        if (limiting.is_valid() && !(step < shortest)) continue;
        limiting = e;
        shortest = step;
    }
    return limiting;
}

}  // namespace

void RunWarnings::add_stiffening(const sim::World& world, std::vector<std::string>& warnings) {
    constexpr double much_shorter = 0.01;
    const double at_rest = world.rest_stable_step(), now = world.stable_step();
    if (!has_stable_step_ || has_told_stiffening_ || !(now < much_shorter * at_rest)) return;
    has_told_stiffening_ = true;
    const physics::Model& model = world.model();
    const ElementId e = limiting_element(model);
    if (!e.is_valid()) return;
    std::ostringstream text;
    text.precision(3);
    text << "at t = " << world.time() << " s, strain has made tissue so stiff that the stable step "
         << "fell from " << at_rest << " s at rest to " << now << " s: the run takes "
         << at_rest / now << " times as long while this lasts; most strained is element "
         << world.mesh().label(model.fragments().cells_of(e).front()) << ", of region "
         << model.fragments().region(e) << ", with a volume ratio J of "
         << model.element_result(e).volume_ratio
         << "; let tools, obstacles and constraints press it less far, use a finer mesh there, or "
            "a law that stiffens less, such as \"stable-neo-hookean\"";
    warnings.push_back(text.str());
}

void RunWarnings::add_end(const sim::World& world, std::vector<std::string>& warnings) {
    add_loss(world, "at the end, t = ", warnings);
    if (has_large_overlap()) add_overlap(warnings);
}

void RunWarnings::add_meanwhile(const sim::World& world, std::vector<std::string>& warnings) {
    constexpr std::uint64_t between_looks = 256;  // steps
    if (!has_told_overlap_ && has_large_overlap()) {
        has_told_overlap_ = true;
        add_overlap(warnings);
    }
    if (has_told_loss_ || world.num_steps() < next_look_) return;
    next_look_ = world.num_steps() + between_looks;
    has_told_loss_ = add_loss(world, "at t = ", warnings);
}

// Contact keeps overlaps to some thousandths of an element.
bool RunWarnings::has_large_overlap() const {
    constexpr double large = 0.2;
    return overlap_.depth > large * size_;
}

void RunWarnings::add_overlap(std::vector<std::string>& warnings) {
    std::ostringstream text;
    text.precision(2);
    text << "surfaces overlapped by up to " << overlap_.depth << " m, " << overlap_.depth / size_
         << " of an element, at t = " << format_number(overlap_.time)
         << " s: by a cut through tissue that is strained, by bodies or tools that begin in each "
            "other, or by parts that are thin and pressed hard; see max_penetration in history.csv";
    warnings.push_back(text.str());
}

/// Returns true if there was something to warn of.
bool RunWarnings::add_loss(const sim::World& world, const std::string& when,
                           std::vector<std::string>& warnings) {
    // Tissue keeps its volume. An element below this volume ratio is crushed, even if its law has
    // finite energy there.
    constexpr double least_volume_ratio = 0.01;
    const physics::Model& model = world.model();
    std::size_t num_crushed = 0;
    if (model.energetics().min_volume_ratio() < least_volume_ratio)
        for (const ElementId e : model.fragments().elements())
            num_crushed += model.least_volume_ratio(e) < least_volume_ratio;
    std::ostringstream text;
    text << when << world.time() << " s, ";
    if (num_crushed > 0) {
        text << num_crushed << (num_crushed == 1 ? " element is" : " elements are")
             << " flat or inverted (J below " << least_volume_ratio
             << "): the body has been pressed through itself, which tissue cannot; see min_J in "
                "history.csv for when, and use smaller motions or loads, a finer mesh, or law = "
                "\"stable-neo-hookean\"";
    } else if (const auto winding = physics::find_winding(world.mesh(), world.positions());
               winding.num_edges > 0) {
        text << "the body is wound up: round " << winding.num_edges
             << (winding.num_edges == 1 ? " edge" : " edges")
             << " elements go twice and lie in each other, one of them element "
             << world.mesh().label(winding.element)
             << ", though none is inverted; no law can undo that: see the frames for when it "
                "happened, and use smaller motions or loads, a smaller dynamics.safety, or a lower "
                "Poisson's ratio";
    } else {
        return false;
    }
    warnings.push_back(text.str());
    return true;
}

}  // namespace incise::runner
