// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/equal_faces.h"

#include <functional>
#include <map>

namespace incise::topology {

std::vector<FaceKey> sorted_faces(const MeshData& data, const SourceFaces& faces,
                                  std::span<const std::uint8_t> usable) {
    std::vector<FaceKey> keys;
    keys.reserve(4 * data.num_cells());
    std::map<std::vector<std::int64_t>, std::int64_t> numbers;  // of the other points, from -2 down
    for (std::size_t c = 0; c < data.num_cells(); ++c) {
        if (!usable.empty() && !usable[c]) continue;
        for (int f = 0; f < faces.num_faces(c); ++f) {
            FaceKey key;
            key.face = {c, f};
            if (const int size = faces.size({c, f}); size <= max_face_corners) {
                for (int p = 0; p < size; ++p)
                    key.points[static_cast<std::size_t>(p)] = faces.point({c, f}, p);
                std::ranges::sort(key.points, std::greater{});
            } else {
                std::vector<std::int64_t> points = faces.points({c, f});
                std::ranges::sort(points, std::greater{});
                std::copy_n(points.begin(), 3, key.points.begin());
                points.erase(points.begin(), points.begin() + 3);
                key.points[3] =
                    numbers.try_emplace(std::move(points), -2 - std::ssize(numbers)).first->second;
            }
            keys.push_back(key);
        }
    }
    // A counting sort by the highest point leaves short buckets, which are fast to sort.
    std::vector<std::size_t> begin(data.points.size() + 1, 0);
    for (const FaceKey& key : keys) ++begin[static_cast<std::size_t>(key.points[0]) + 1];
    for (std::size_t p = 0; p < data.points.size(); ++p) begin[p + 1] += begin[p];
    std::vector<FaceKey> sorted(keys.size());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const FaceKey& key : keys) sorted[next[static_cast<std::size_t>(key.points[0])]++] = key;
    for (std::size_t p = 0; p < data.points.size(); ++p)
        std::ranges::sort(std::span(sorted).subspan(begin[p], begin[p + 1] - begin[p]));
    return sorted;
}

}  // namespace incise::topology
