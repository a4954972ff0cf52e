// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/tetrahedral_division.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "incise/topology/equal_faces.h"
#include "incise/topology/face_triangles.h"
#include "incise/topology/geometry.h"
#include "incise/topology/joined_quads.h"
#include "incise/topology/source_faces.h"
#include "incise/topology/star_filling.h"

namespace incise::topology {

namespace {

using Triangle = std::array<std::int64_t, 3>;

constexpr std::int64_t no_point = -1;

/// How a face is divided: about a point in its middle, or into triangles between its corners.
struct FaceDivision {
    std::int64_t middle = no_point;
    std::vector<Triangle> triangles;  // if there is no middle
};

class Divider {
  public:
    explicit Divider(const MeshData& data) : data_(data), faces_(data) {
        result_.mesh.points = data.points;
        result_.mesh.points_may_coincide = data.points_may_coincide;
        find_neighbors();
        for (std::size_t c = 0; c < data.num_cells(); ++c)
            data.kinds[c] == CellKind::tetrahedron ? keep(c) : divide(c);
        if (!data.cut_faces.empty()) result_.mesh.cut_faces.resize(result_.mesh.num_cells());
    }
    TetrahedralDivision take() { return std::move(result_); }

  private:
    std::size_t number(SourceFace f) const {
        return first_[f.cell] + static_cast<std::size_t>(f.face);
    }

    /// Finds which faces are joined, as a reader of the data joins them.
    void find_neighbors() {
        first_.reserve(data_.num_cells() + 1);
        first_.push_back(0);
        for (std::size_t c = 0; c < data_.num_cells(); ++c)
            first_.push_back(first_.back() + static_cast<std::size_t>(faces_.num_faces(c)));
        divisions_.resize(first_.back());
        partner_.resize(first_.back());
        std::vector<SourceFace> lone;
        std::vector<FaceKey> keys = sorted_faces(data_, faces_, {});
        for_each_equal_faces(data_, keys, [&](const EqualFaces& same) {
            if (same.is_lone()) lone.push_back(same.inner[0].face);
            if (same.num_meeting() != 2) return;
            const auto [a, b] = same.joined();
            partner_[number(b)] = a;
        });
        diagonals_ = diagonals_of_cells(data_, find_joined_quads(data_, faces_, lone));
    }

    void keep(std::size_t c) {
        const auto corners = data_.cell(c);
        add(std::array{corners[0], corners[1], corners[2], corners[3]}, c);
        for (int f = 0; f < faces_.num_faces(c); ++f)
            if (data_.is_on_cut(c, f)) result_.mesh.set_on_cut(result_.mesh.num_cells() - 1, f);
    }

    void divide(std::size_t c) {
        triangles_.clear();
        cut_triangles_.clear();
        for (int f = 0; f < faces_.num_faces(c); ++f) {
            const std::size_t begin = triangles_.size();
            append_triangles({c, f});
            if (!data_.is_on_cut(c, f)) continue;
            for (std::size_t t = begin; t < triangles_.size(); ++t)
                cut_triangles_.push_back(sorted(triangles_[t]));
        }
        const auto corners = data_.cell(c);
        std::vector<PointWeight> weights = equal_weights({corners.begin(), corners.end()});
        if (auto filling = fill_surface(triangles_, result_.mesh.points, mean_of(weights))) {
            triangles_ = std::move(filling->triangles);
            move_mean(weights, filling->centre);
            for (const auto& tetrahedron : filling->tetrahedra) add_part(tetrahedron, c);
        } else {
            result_.inverted.push_back(c);
        }
        const std::int64_t inside = add_point(std::move(weights));
        for (const auto& [p, q, r] : triangles_) add_part({p, r, q, inside}, c);
    }

    /// Adds a part of a cell that is divided.
    void add_part(const std::array<std::int64_t, 4>& corners, std::size_t c) {
        add(corners, c);
        if (cut_triangles_.empty()) return;
        const CellTraits& tetrahedron = traits(CellKind::tetrahedron);
        for (int f = 0; f < tetrahedron.num_faces; ++f) {
            const auto face = tetrahedron.face(f);
            const auto at = [&](std::size_t p) {
                return corners[static_cast<std::size_t>(face[p])];
            };
            if (std::ranges::find(cut_triangles_, sorted({at(0), at(1), at(2)})) !=
                cut_triangles_.end())
                result_.mesh.set_on_cut(result_.mesh.num_cells() - 1, f);
        }
    }

    static Triangle sorted(Triangle t) {
        std::ranges::sort(t);
        return t;
    }

    /// Appends the triangles of a face, anticlockwise as seen from outside.
    void append_triangles(SourceFace f) {
        const auto points = faces_.points(f);
        if (points.size() == 3) {
            triangles_.push_back({points[0], points[1], points[2]});
            return;
        }
        const std::optional<SourceFace> other = partner_[number(f)];  // its cell came before
        FaceDivision& division = divisions_[number(f)];
        if (other) {
            division = divisions_[number(*other)];
            for (auto& [a, b, c] : division.triangles) std::swap(b, c);
        } else {
            division = division_of(f, points);
        }
        if (division.middle == no_point) {
            triangles_.insert(triangles_.end(), division.triangles.begin(),
                              division.triangles.end());
            return;
        }
        for (std::size_t p = points.size() - 1, q = 0; q < points.size(); p = q++)
            triangles_.push_back({division.middle, points[p], points[q]});
    }

    FaceDivision division_of(SourceFace f, const std::vector<std::int64_t>& points) {
        FaceDivision division;
        // A polyhedron may have more faces than diagonals have bits for, and has none.
        if (!diagonals_.empty() && !diagonals_[f.cell].is_none() &&
            diagonals_[f.cell].divides(f.face)) {
            const auto at = [&](int p) {
                return points[static_cast<std::size_t>((diagonals_[f.cell].first_end(f.face) + p) %
                                                       4)];
            };
            division.triangles = {{at(0), at(1), at(2)}, {at(2), at(3), at(0)}};
        } else if (is_star_about_mean(points)) {
            division.middle = add_point(equal_weights(points));
        } else {
            division.triangles = triangles_between(points);
        }
        return division;
    }

    /// Returns the triangles of a face between its corners.
    std::vector<Triangle> triangles_between(const std::vector<std::int64_t>& points) const {
        std::vector<VertexId> corners;
        std::vector<Vec3> x;
        for (const std::int64_t p : points) {
            corners.emplace_back(static_cast<std::size_t>(p));
            x.push_back(position(p));
        }
        Ears ears(std::move(corners), std::move(x));
        // A third corner on the new edge would leave flat triangles.
        const auto is_clear = [&](VertexId a, VertexId, VertexId c) {
            constexpr double rounding = 1e-9;
            const Vec3 &from = position(a.value), edge = position(c.value) - from;
            for (std::size_t p = 0; p < ears.size(); ++p) {
                const Vec3 v = position(ears.corner(p).value) - from;
                const double t = v.dot(edge) / edge.squaredNorm();
                if (t > rounding && t < 1.0 - rounding &&
                    (v - t * edge).norm() <= rounding * edge.norm())
                    return false;
            }
            return true;
        };
        const auto any = [](VertexId, VertexId, VertexId) { return true; };
        const auto point = [&](std::size_t p) -> std::int64_t { return ears.corner(p).value; };
        std::vector<Triangle> triangles;
        while (ears.size() > 3) {
            auto best = ears.best(is_clear);
            if (!best || !(ears.quality_of(*best) > 0.0)) best = ears.best(any);
            triangles.push_back({point(*best + ears.size() - 1), point(*best), point(*best + 1)});
            ears.cut(*best);
        }
        triangles.push_back({point(0), point(1), point(2)});
        return triangles;
    }

    /// True if the triangles about the mean of the corners face the way of the face.
    bool is_star_about_mean(const std::vector<std::int64_t>& points) const {
        constexpr double rounding = 1e-10;  // of the area
        const int size = static_cast<int>(points.size());
        const auto at = [&](int p) -> const Vec3& {
            return position(points[static_cast<std::size_t>(p)]);
        };
        const Vec3 area = area_vector(size, at);
        Vec3 middle = Vec3::Zero();
        for (int p = 0; p < size; ++p) middle += at(p) / size;
        for (int p = 0; p < size; ++p)
            if ((at(p) - middle).cross(at((p + 1) % size) - middle).dot(area) <=
                rounding * area.squaredNorm())
                return false;
        return true;
    }

    /// Changes equal weights as little as it takes to give a point, also for linear fields.
    void move_mean(std::vector<PointWeight>& weights, const Vec3& to) const {
        const Vec3 mean = mean_of(weights);
        if (to == mean) return;
        Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
        for (const auto& [p, weight] : weights)
            moments += (position(p) - mean) * (position(p) - mean).transpose();
        const Vec3 slope = moments.ldlt().solve(to - mean);
        for (auto& [p, weight] : weights) weight += slope.dot(position(p) - mean);
    }

    static std::vector<PointWeight> equal_weights(const std::vector<std::int64_t>& points) {
        std::vector<PointWeight> weights;
        weights.reserve(points.size());
        for (const std::int64_t p : points)
            weights.push_back({p, 1.0 / static_cast<double>(points.size())});
        return weights;
    }
    const Vec3& position(std::int64_t p) const { return data_.points[static_cast<std::size_t>(p)]; }
    Vec3 mean_of(const std::vector<PointWeight>& weights) const {
        Vec3 mean = Vec3::Zero();
        for (const auto& [p, weight] : weights) mean += weight * position(p);
        return mean;
    }
    std::int64_t add_point(std::vector<PointWeight> weights) {
        result_.mesh.points.push_back(mean_of(weights));
        result_.added.push_back(std::move(weights));
        return std::ssize(result_.mesh.points) - 1;
    }
    void add(const std::array<std::int64_t, 4>& corners, std::size_t origin) {
        result_.mesh.add_cell(CellKind::tetrahedron, corners, data_.regions[origin]);
        result_.cells.push_back(origin);
    }

    const MeshData& data_;
    SourceFaces faces_;
    std::vector<std::size_t> first_;  // by cell, the number of its first face
    // By number of a face, the one of an earlier cell that it is joined to.
    std::vector<std::optional<SourceFace>> partner_;
    std::vector<FaceDivision> divisions_;  // by number of a face
    std::vector<Diagonals> diagonals_;     // by cell; empty if there are none
    TetrahedralDivision result_;
    // Of the cell that is divided: its triangles, and the points of those on cuts.
    std::vector<Triangle> triangles_, cut_triangles_;
};

}  // namespace

bool has_only_tetrahedra(const MeshData& data) {
    return std::ranges::all_of(data.kinds,
                               [](CellKind kind) { return kind == CellKind::tetrahedron; });
}

TetrahedralDivision divide_into_tetrahedra(const MeshData& data) { return Divider(data).take(); }

}  // namespace incise::topology
