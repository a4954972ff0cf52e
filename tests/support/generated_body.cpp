// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/generated_body.h"

#include <algorithm>
#include <ostream>

namespace incise::test {

topology::MeshData GeneratedBody::mesh() const {
    const topology::MeshData& all = family->data;
    topology::MeshData some;
    some.points = all.points;
    for (std::size_t i = 0; i < std::min(num_cells, all.num_cells()); ++i) {
        // The first cell stays: there is no body without any.
        if (i > 0 && std::find(gaps.begin(), gaps.end(), i) != gaps.end()) continue;
        const std::size_t c = (first_cell + i) % all.num_cells();
        some.add_cell(all.kinds[c], all.cell(c), all.regions[c]);
    }
    return some;
}

std::ostream& operator<<(std::ostream& out, const GeneratedBody& body) {
    out << body.num_cells << " cells of '" << body.family->name << "', from cell "
        << body.first_cell << " on";
    for (std::size_t i = 0; i < body.gaps.size(); ++i)
        out << (i == 0 ? ", but not number " : ", ") << body.gaps[i];
    return out;
}

rc::Gen<GeneratedBody> generated_bodies(const std::vector<const MeshFamily*>& families,
                                        std::size_t most_cells) {
    using rc::gen::inRange;
    return rc::gen::apply(
        [families](std::size_t family, std::size_t first, std::size_t count,
                   std::vector<std::size_t> gaps) {
            return GeneratedBody{families[family], first, count, std::move(gaps)};
        },
        inRange<std::size_t>(0, families.size()), inRange<std::size_t>(0, 200),
        inRange<std::size_t>(1, most_cells + 1), up_to(6, inRange<std::size_t>(1, most_cells)));
}

}  // namespace incise::test
