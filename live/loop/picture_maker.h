// Makes pictures of a session for pages. docs/live.md describes their bytes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "incise/live/display_mesh.h"
#include "incise/live/server/server.h"
#include "incise/live/session.h"

namespace incise::live {

/// A quantity that colours the body.
struct ShownField {
    std::string_view name, unit;
};

/// Makes pictures of one session. Between two pictures it keeps what has not changed.
class PictureMaker {
  public:
    /// The fields that can be shown; the first is none.
    static const std::vector<ShownField>& fields();

    explicit PictureMaker(const Session& session) : mesh_(session.world().mesh()) {}

    /// Chooses a field by name. Returns false if there is none of this name.
    bool show(std::string_view field);
    std::string_view field() const { return fields()[field_].name; }
    const DisplayMesh& mesh() const { return mesh_; }
    /// Says that the session went back: the surface may be another although its version is not.
    void forget_surface() { has_surface_ = false; }

    /// Makes a picture, without its state. Cost: O(#vertices), and O(#triangles) after edits.
    std::shared_ptr<Picture> make(Session& session);

    /// Takes over the surface after edits. Cost: O(#triangles) then, otherwise nothing.
    const DisplayMesh& follow(Session& session);

  private:
    void add_values(const Session& session, std::string& bytes);

    DisplayMesh mesh_;
    bool has_surface_ = false;
    std::uint64_t version_ = 0;
    std::shared_ptr<const std::string> topology_;
    std::vector<float> rest_, moving_;  // scratch
    std::size_t field_ = 0;
    std::vector<float> values_;   // of the field, by vertex
    std::size_t next_value_ = 0;  // the vertex whose value is computed next
};

}  // namespace incise::live
