// What a world says about contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::contact {

/// Settings of the contact between tissue and tissue.
struct ContactSettings {
    bool enabled = true;
    double friction = 0.0;  ///< Coulomb's coefficient, 0 or more
    bool self = true;       ///< any surface against any other; false: only faces of cuts

    bool operator==(const ContactSettings&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.enabled, self.friction, self.self); }
};

}  // namespace incise::contact
