// Small bodies cut out of the families, for generated programs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <vector>

#include "support/mesh_families.h"
#include "support/properties.h"

namespace incise::test {

/// Some neighbouring cells of a family's body, with gaps. They meet as it happens: in faces, in
/// edges or in points.
struct GeneratedBody {
    const MeshFamily* family;
    std::size_t first_cell, num_cells;
    std::vector<std::size_t> gaps;  ///< numbers among the cells

    topology::MeshData mesh() const;
};
std::ostream& operator<<(std::ostream& out, const GeneratedBody& body);

/// Of up to so many cells; shrinks to the first cell of the first family.
rc::Gen<GeneratedBody> generated_bodies(const std::vector<const MeshFamily*>& families,
                                        std::size_t most_cells);

}  // namespace incise::test
