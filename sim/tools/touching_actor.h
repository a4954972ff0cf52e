// What tools that touch tissue by one kind of contact have in common.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "incise/sim/tools/tool_actor.h"

namespace incise::sim {

/// A tool of one kind with a contact, which it has from its first touch until it lets go.
/// @tparam Contact  a contact::ToolContact that is made of a Shape and the mean length of an
///                  element at rest, m
template <class Shape, class Contact>
class TouchingActor : public ActorOf<Shape> {
  public:
    using ActorOf<Shape>::ActorOf;

    contact::ToolContact* contact() override { return contact_ ? &*contact_ : nullptr; }
    void let_go() override { contact_.reset(); }

  protected:
    /// Returns the contact, which begins if there is none.
    /// @pre  the world has contact
    Contact& contact_with(const Tissue& tissue) {
        if (!contact_) contact_.emplace(this->shape(), tissue.contact->size());
        return *contact_;
    }
    void save_own(ArchiveWriter& ar) const override {
        ar(contact_.has_value());
        if (contact_) contact_->save(ar);
    }
    /// Restores what save_own() wrote. The contact may need more than the archive.
    /// Throws InputError for what is unsound, or if the world has no contact.
    template <class... Arguments>
    void restore_contact(ArchiveReader& ar, const Tissue& tissue, const Arguments&... arguments) {
        if (!ar.read<bool>()) return;
        if (!tissue.contact) this->refuse("touches tissue, and there is no contact");
        contact_with(tissue).restore(ar, arguments...);
    }

    std::optional<Contact> contact_;
};

}  // namespace incise::sim
