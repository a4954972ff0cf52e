// What an edited body's selections have become, found without the sets that follow edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tests/physics/test_bodies.h"

namespace incise::physics {

/// What constraints hold and what loads load, in ascending order.
struct Selections {
    std::vector<VertexId> held, moved;
    std::vector<FaceId> loaded_faces;
    std::vector<CellId> loaded_elements;
};

/// Nodes at the lower end in x, and next to it; the whole surface; two thirds of the elements.
inline Selections selections(const topology::Mesh& mesh) {
    double low = std::numeric_limits<double>::infinity();
    for (const Vec3& x : mesh.rest_positions()) low = std::min(low, x.x());
    const auto near = [&](double from, double to) {
        return nodes_where(mesh,
                           [&](const Vec3& x) { return x.x() >= low + from && x.x() < low + to; });
    };
    Selections s{near(0.0, 0.01), near(0.01, 0.3), topology::boundary_faces(mesh), {}};
    for (const CellId e : living_elements(mesh))
        if (e.index() % 3 != 1) s.loaded_elements.push_back(e);
    return s;
}

/// Follows selections through edits: nodes by the first nodes between which they lie, elements by
/// their first ancestor, faces by where they lie at rest.
class Descent {
  public:
    Descent(const topology::Mesh& mesh, Selections first) : first_(std::move(first)) {
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) roots_.push_back({VertexId(n)});
        for (std::size_t e = 0; e < mesh.element_capacity(); ++e) ancestors_.push_back(CellId(e));
        for (const FaceId f : first_.loaded_faces) {
            const auto at = [&](int p) { return mesh.rest_position(mesh.face_corner(f, p)); };
            planes_.emplace(f.cell,
                            Plane{at(0), (at(1) - at(0)).cross(at(2) - at(0)).normalized()});
        }
    }

    void follow(const topology::ChangeSet& changes) {
        for (const auto& record : changes.nodes_added) {
            roots_.emplace_back();
            for (int s = 0; s < record.num_sources; ++s) {
                const auto& of = roots_[record.sources[static_cast<std::size_t>(s)].node.index()];
                roots_.back().insert(of.begin(), of.end());
            }
        }
        for (const auto& record : changes.elements_added)
            ancestors_.push_back(ancestors_[record.parent.index()]);
        ASSERT_EQ(roots_.size(), changes.node_capacity_after);
        ASSERT_EQ(ancestors_.size(), changes.element_capacity_after);
    }

    Selections now(const topology::Mesh& mesh) const {
        Selections s;
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
            const auto is_among = [&](const std::vector<VertexId>& first) {
                return std::includes(first.begin(), first.end(), roots_[n].begin(),
                                     roots_[n].end());
            };
            if (is_among(first_.held)) s.held.emplace_back(n);
            if (is_among(first_.moved)) s.moved.emplace_back(n);
        }
        for (std::size_t i = 0; i < mesh.element_capacity(); ++i) {
            const CellId e(i);
            if (std::binary_search(first_.loaded_elements.begin(), first_.loaded_elements.end(),
                                   ancestors_[i]))
                s.loaded_elements.push_back(e);
            for (int f = 0; f < mesh.num_faces(e) && mesh.is_alive(e); ++f)
                if (lies_in_loaded_plane(mesh, {e, f})) s.loaded_faces.push_back({e, f});
        }
        return s;
    }

  private:
    struct Plane {
        Vec3 point, normal;

        double distance(const Vec3& x) const { return std::abs(normal.dot(x - point)); }
    };

    // A part of the ancestor in the plane of one of its faces lies in that face.
    bool lies_in_loaded_plane(const topology::Mesh& mesh, FaceId f) const {
        const auto [begin, end] = planes_.equal_range(ancestors_[f.cell.index()]);
        return std::any_of(begin, end, [&](const auto& plane) {
            bool all = true;
            for (int p = 0; p < mesh.face_size(f); ++p)
                all &= plane.second.distance(mesh.rest_position(mesh.face_corner(f, p))) < 1e-12;
            return all;
        });
    }

    Selections first_;
    std::vector<std::set<VertexId>> roots_;
    std::vector<CellId> ancestors_;
    std::multimap<CellId, Plane> planes_;  // of loaded faces
};

}  // namespace incise::physics
