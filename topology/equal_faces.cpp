// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/equal_faces.h"

#include <functional>
#include <map>

namespace incise::topology {

std::vector<FaceKey> sorted_faces(const MeshData& data, const SourceFaces& faces,
                                  std::span<const std::uint8_t> usable) {
    const auto for_each_face = [&](auto visit) {
        for (std::size_t c = 0; c < data.num_cells(); ++c) {
            if (!usable.empty() && !usable[c]) continue;
            for (int f = 0; f < faces.num_faces(c); ++f) visit(SourceFace{c, f});
        }
    };
    // A counting sort by the highest point leaves short buckets, which are fast to sort. The faces
    // are gone through twice, since a list of them in their first order takes much memory.
    std::vector<std::size_t> begin(data.points.size() + 1, 0);
    for_each_face([&](SourceFace face) {
        std::int64_t highest = 0;
        for (int p = 0; p < faces.size(face); ++p)
            highest = std::max(highest, faces.point(face, p));
        ++begin[static_cast<std::size_t>(highest) + 1];
    });
    for (std::size_t p = 0; p < data.points.size(); ++p) begin[p + 1] += begin[p];
    std::vector<FaceKey> sorted(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    std::map<std::vector<std::int64_t>, std::int64_t> numbers;  // of the other points, from -2 down
    for_each_face([&](SourceFace face) {
        FaceKey key;
        key.face = face;
        if (const int size = faces.size(face); size <= max_face_corners) {
            for (int p = 0; p < size; ++p)
                key.points[static_cast<std::size_t>(p)] = faces.point(face, p);
            std::ranges::sort(key.points, std::greater{});
        } else {
            std::vector<std::int64_t> points = faces.points(face);
            std::ranges::sort(points, std::greater{});
            std::copy_n(points.begin(), 3, key.points.begin());
            points.erase(points.begin(), points.begin() + 3);
            key.points[3] =
                numbers.try_emplace(std::move(points), -2 - std::ssize(numbers)).first->second;
        }
        sorted[next[static_cast<std::size_t>(key.points[0])]++] = key;
    });
    for (std::size_t p = 0; p < data.points.size(); ++p)
        std::ranges::sort(std::span(sorted).subspan(begin[p], begin[p + 1] - begin[p]));
    return sorted;
}

}  // namespace incise::topology
