// Conversion of a world to bytes and back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/checksum.h"
#include "incise/base/number_format.h"
#include "incise/sim/undo_point.h"
#include "incise/sim/world_checks.h"
#include "incise/sim/world_parts.h"
#include "incise/topology/mesh_archive.h"
#include "incise/topology/mesh_edit.h"

namespace incise::sim {

namespace {

double read_time(ArchiveReader& ar) {
    const auto time = ar.read<double>();
    if (!(time >= 0.0 && std::isfinite(time)))
        throw InputError("its time is " + format_number(time) + " s");
    return time;
}

}  // namespace

World::Parts::Parts(const Parts& former, ArchiveReader& ar)
    : number(next_number()),
      mesh(topology::load_mesh(ar)),
      time(read_time(ar)),
      model(mesh, former.model.structure().elements().materials(), ar, time),
      contact(former.contact ? make_contact(former.contact->settings(), former.solver) : nullptr),
      integrator(make_integrator(former.solver, contact.get())),
      solver(former.solver),
      ledger(model) {
    restore_rest(ar);
    model.set_num_threads(former.model.workers().num_threads());
}

void World::Parts::restore_rest(ArchiveReader& ar) {
    integrator->restore(ar, model);
    ledger.restore(ar);
    if (ar.read<bool>()) ar(cutter.emplace(mesh, model.mesh_positions()));
    ar(tool_ids, constraints, grasps, loads, num_steps, stable_step, bound_interval, has_moved,
       has_failed);
    if (cutter && !cutter->is_on(mesh))
        throw InputError("what its tools remember is of another body");
    constraints.complete(model.boundary().constraints().size());
    loads.complete(model.boundary().loads().all().size());
    if (ar.read<bool>() != (contact != nullptr))
        throw InputError(
            "the world that was saved has contact, and this one has not, or the other "
            "way round");
    if (contact) contact->restore(ar, model, built_surface());
    report_contact();
    for (auto count = ar.read<std::uint64_t>(); count > 0; --count)
        tools.push_back(load_actor(ar, tissue()));
    tool_ids.complete(tools.size());
    for (std::size_t i = 0; i < tools.size(); ++i)
        if (tool_ids.all()[i].index != i) throw InputError("its tools have ids of others");
    if (!ar.is_at_end()) throw InputError("there are data beyond the end of the world");
    if (!(stable_step > 0.0)) throw InputError("its stable step is not above 0");
    require_sound_grasps();
}

void World::Parts::require_sound_grasps() const {
    bool fits = grasps.size() == model.boundary().constraints().size();
    for (std::size_t i = 0; i < grasps.size() && fits; ++i)
        fits = !grasps[i] || (grasps[i]->pose.is_sound() &&
                              !model.boundary().constraints().all()[i].grip.is_empty());
    if (!fits) throw InputError("its grasps are those of another world");
}

void World::Parts::save(ArchiveWriter& ar) const {
    topology::save(mesh, ar);
    ar(time);
    model.save(ar);
    save_rest(ar);
}

void World::Parts::save_motion(ArchiveWriter& ar) const {
    ar(time);
    model.save_motion(ar);
    save_rest(ar);
}

void World::Parts::save_rest(ArchiveWriter& ar) const {
    integrator->save(ar);
    ledger.save(ar);
    ar(cutter, tool_ids, constraints, grasps, loads, num_steps, stable_step, bound_interval,
       has_moved, has_failed);
    ar(contact != nullptr);
    if (contact) contact->save(ar);
    ar(static_cast<std::uint64_t>(tools.size()));
    for (const auto& tool : tools) tool->save(ar);
}

void World::Parts::go_back(std::span<const physics::BodyEdit* const> edits,
                           const std::shared_ptr<FormerMaterials>& with, ArchiveReader& ar) {
    for (std::size_t i = edits.size(); i-- > 0;) {
        const physics::BodyEdit back = inverse(*edits[i]);
        topology::replay(mesh, back.material);
        model.apply(mesh, back);
        if (surface) surface->apply(mesh, back.material);
    }
    time = read_time(ar);
    if (with != materials) {
        // The same moment may be gone back to again, and a later one from here.
        materials->table = materials_with_fibres();
        physics::MaterialTable table = std::move(*with->table);
        with->table.reset();
        if (!table.fibres.empty())
            table.fibres.resize(model.fragments().element_capacity(), Vec3::Zero());
        model.set_materials(std::move(table), time);
        materials = with;
    }
    model.restore_motion(ar, time);
    // The rest is made anew and then read, as in a world that is restored.
    number = next_number();
    tool_ids = {"tool", number};
    constraints = {"constraint", number};
    loads = {"load", number};
    tools.clear();
    grasps.clear();
    cutter.reset();
    if (contact) contact = make_contact(contact->settings(), solver);
    integrator = make_integrator(solver, contact.get());
    loads_have_changed = false;
    report = {};
    restore_rest(ar);
    // There may be other force terms now.
    stable_step = std::min(stable_step, model.structure().rest_stable_step());
}

namespace {

constexpr std::uint32_t state_mark = 0x57434e49;  // "INCW"

void add_values(ArchiveWriter& ar, const physics::HyperElasticLinks& links) {
    ar(static_cast<std::uint64_t>(links.law.index()), physics::rest_mu(links.law),
       physics::rest_lambda(links.law), links.inversion_threshold, links.prony_rule);
    for (const physics::PronyTerm& term : links.prony) ar(term.alpha, term.tau);
}

void add_values(ArchiveWriter& ar, const physics::MassSprings& springs) { ar(springs.young); }

void add_values(ArchiveWriter& ar, const physics::HybridSprings& springs) {
    ar(springs.shear_modulus, springs.volume_modulus, springs.stiffness_ratio);
}

/// Returns a checksum of the plain values of the materials. Two laws of one kind with the same
/// moduli at rest have the same checksum.
std::uint64_t fingerprint_of(const physics::Model& model) {
    const physics::MaterialTable& table = model.structure().elements().materials();
    ArchiveWriter ar;
    for (const physics::Material& material : table.materials) {
        ar(material.density, static_cast<std::uint64_t>(material.method.index()));
        std::visit([&](const auto& method) { add_values(ar, method); }, material.method);
    }
    for (const auto& [region, material] : table.of_region)
        ar(region, static_cast<std::uint64_t>(material));
    ar(table.precision);
    return incise::checksum(ar.bytes());
}

}  // namespace

std::string World::save() const {
    ArchiveWriter ar;
    ar(state_mark, state_format, parts_->solver, fingerprint_of(parts_->model));
    parts_->save(ar);
    return ar.take();
}

void World::restore(std::string_view bytes) {
    ArchiveReader ar(bytes);
    const auto mark = ar.read<std::uint32_t>();
    const auto format = ar.read<std::uint32_t>();
    if (mark != state_mark) throw InputError("this is no saved world");
    if (format != state_format)
        throw InputError("the world was saved in format " + std::to_string(format) +
                         ", and this version reads " + std::to_string(state_format));
    if (ar.read<Solver>() != parts_->solver)
        throw InputError("the world that was saved has another solver");
    if (ar.read<std::uint64_t>() != fingerprint_of(parts_->model))
        throw InputError("the world that was saved has other materials");
    auto restored = std::make_unique<Parts>(*parts_, ar);
    restored->model.take_force_terms(parts_->model, restored->time);
    // The saved world may have had other force terms.
    restored->stable_step =
        std::min(restored->stable_step, restored->model.structure().rest_stable_step());
    parts_ = std::move(restored);
}

UndoPoint World::undo_point() const {
    if (parts_->has_failed)
        throw InputError(
            "the world has failed, and this is no moment to go back to: go back to one from before "
            "the step that failed, by undo() or restore()");
    ArchiveWriter ar;
    parts_->save_motion(ar);
    return {parts_->log_end, parts_->mesh.epoch(), parts_->materials, ar.take()};
}

void World::undo(const UndoPoint& point) {
    const auto edits = point.edits_->edits_until(*parts_->log_end);
    if (!edits)
        throw InputError(
            "the world cannot go back to this moment: it is of another world, or the world has "
            "taken back an edit before it, or was restored since");
    const std::uint64_t last = edits->empty() ? point.epoch_ : edits->back()->material.epoch_after;
    if (last != parts_->mesh.epoch() || last != parts_->model.fragments().epoch())
        throw InputError(
            "the world cannot go back: it has failed within an edit; restore a state that was "
            "saved before");
    ArchiveReader ar(*point.motion_);
    parts_->go_back(*edits, point.materials_, ar);
    point.edits_->cut_off();
    parts_->log_end = point.edits_;
}

}  // namespace incise::sim
