// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/label_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "incise/base/error.h"
#include "tetmesh/first_points.h"

namespace incise::tetmesh {

namespace {

using Index3 = std::array<std::int64_t, 3>;

/// The labels of an image, at any point.
class LabelField {
  public:
    explicit LabelField(io::LabelImage image)
        : image_(std::move(image)),
          steps_(image_.directions * image_.spacing.asDiagonal()),
          to_voxels_(steps_.inverse()) {}

    const io::LabelImage& image() const { return image_; }

    Vec3 centre(const Index3& v) const {
        return image_.origin + steps_ * Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]),
                                             static_cast<double>(v[2]));
    }
    double voxel_volume() const { return std::abs(steps_.determinant()); }

    /// Returns the label of a voxel; outside of the image it is 0.
    int label(const Index3& v) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (v[a] < 0 || v[a] >= image_.dimensions[a]) return 0;
        return image_.label(v[0], v[1], v[2]);
    }

    int operator()(const Vec3& x) const {
        const Vec3 place = to_voxels_ * (x - image_.origin);
        Index3 low;
        Vec3 share;
        for (std::size_t a = 0; a < 3; ++a) {
            const auto axis = static_cast<Eigen::Index>(a);
            const double floor = std::floor(place[axis]);
            // As a number in double precision, as it may be too large for an index.
            if (!(floor >= -1.0 && floor < static_cast<double>(image_.dimensions[a]))) return 0;
            low[a] = static_cast<std::int64_t>(floor);
            share[axis] = place[axis] - floor;
        }
        std::array<int, 8> labels;
        for (std::size_t c = 0; c < 8; ++c) labels[c] = label(corner(low, c));
        if (std::ranges::all_of(labels, [&](int l) { return l == labels[0]; })) return labels[0];
        return heaviest(labels, share);
    }

    /// Returns the first point outside of the label of `in` on the line to `out`.
    Vec3 boundary_between(Vec3 in, Vec3 out) const {
        const int label = (*this)(in);
        constexpr int num_halvings = 30;  // to the last digits of a voxel
        for (int i = 0; i < num_halvings; ++i) {
            const Vec3 middle = 0.5 * (in + out);
            ((*this)(middle) == label ? in : out) = middle;
        }
        return out;
    }

  private:
    static Index3 corner(const Index3& low, std::size_t c) {
        return {low[0] + static_cast<std::int64_t>(c & 1),
                low[1] + static_cast<std::int64_t>(c >> 1 & 1),
                low[2] + static_cast<std::int64_t>(c >> 2 & 1)};
    }

    /// Returns the label of the largest weight; of equal ones, the lowest label.
    static int heaviest(const std::array<int, 8>& labels, const Vec3& share) {
        std::array<double, 8> weights;
        for (std::size_t c = 0; c < 8; ++c)
            weights[c] = (c & 1 ? share.x() : 1.0 - share.x()) *
                         (c & 2 ? share.y() : 1.0 - share.y()) *
                         (c & 4 ? share.z() : 1.0 - share.z());
        int best = 0;
        double best_weight = -1.0;
        for (std::size_t c = 0; c < 8; ++c) {
            double weight = 0.0;
            for (std::size_t d = 0; d < 8; ++d)
                if (labels[d] == labels[c]) weight += weights[d];
            if (weight < best_weight || (weight == best_weight && labels[c] >= best)) continue;
            best = labels[c];
            best_weight = weight;
        }
        return best;
    }

    io::LabelImage image_;
    Eigen::Matrix3d steps_, to_voxels_;
};

/// Visits a point between each two neighbouring voxels of different labels.
void visit_faces(const LabelField& field, const SurfaceVisitor& visit) {
    const auto [nx, ny, nz] = field.image().dimensions;
    // From one voxel outside of the image, as that is background.
    for (std::int64_t k = -1; k < nz; ++k)
        for (std::int64_t j = -1; j < ny; ++j)
            for (std::int64_t i = -1; i < nx; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const Index3 v = {i, j, k};
                    Index3 next = v;
                    ++next[axis];
                    if (field.label(v) == field.label(next)) continue;
                    const Vec3 in = field.centre(v), out = field.centre(next);
                    visit(field.boundary_between(in, out), (out - in).normalized());
                }
}

/// The voxels of an image that have a label, in parts.
class VoxelParts {
  public:
    explicit VoxelParts(const LabelField& field)
        : field_(field), is_known_(field.image().labels.size(), false) {}

    /// Adds points of the surface, and the volume, of the part that begins with a voxel.
    void add_part(std::size_t first, BodyShape& body) {
        const auto& image = field_.image();
        const int label = image.labels[first];
        std::vector<std::size_t> voxels = {first};
        is_known_[first] = true;
        ExtremePoints extremes;
        for (std::size_t next = 0; next < voxels.size(); ++next) {
            const Index3 v = place_of(voxels[next]);
            bool is_on_surface = false;
            for (int side = 0; side < 6; ++side) {
                const Index3 other = neighbor(v, side);
                if (field_.label(other) != label) {
                    is_on_surface = true;
                    body.area += std::pow(field_.voxel_volume(), 2.0 / 3.0);
                    continue;
                }
                const std::size_t number = number_of(other);
                if (is_known_[number]) continue;
                is_known_[number] = true;
                voxels.push_back(number);
            }
            body.box.extend(field_.centre(v));
            if (is_on_surface) extremes.add(field_.centre(v), voxels[next]);
        }
        body.volumes[label] += static_cast<double>(voxels.size()) * field_.voxel_volume();
        PartPoints points{label, {}};
        for (const std::size_t number : extremes.numbers()) add_surface_points(number, points);
        body.first_points.push_back(std::move(points));
    }

    bool is_known(std::size_t voxel) const { return is_known_[voxel]; }

  private:
    Index3 place_of(std::size_t number) const {
        const auto n = static_cast<std::int64_t>(number);
        const auto [nx, ny, nz] = field_.image().dimensions;
        return {n % nx, n / nx % ny, n / (nx * ny)};
    }
    std::size_t number_of(const Index3& v) const {
        const auto [nx, ny, nz] = field_.image().dimensions;
        return static_cast<std::size_t>(v[0] + nx * (v[1] + ny * v[2]));
    }
    static Index3 neighbor(Index3 v, int side) {
        v[static_cast<std::size_t>(side / 2)] += side % 2 == 0 ? 1 : -1;
        return v;
    }

    /// Adds the points at which lines from the centre of a voxel to its neighbours leave its label.
    void add_surface_points(std::size_t number, PartPoints& points) const {
        const Index3 v = place_of(number);
        for (int side = 0; side < 6; ++side) {
            if (field_.label(neighbor(v, side)) == points.region) continue;
            points.points.push_back(
                field_.boundary_between(field_.centre(v), field_.centre(neighbor(v, side))));
        }
    }

    const LabelField& field_;
    std::vector<bool> is_known_;
};

}  // namespace

BodyShape shape_of(io::LabelImage image) {
    const auto field = std::make_shared<const LabelField>(std::move(image));
    const auto& labels = field->image().labels;
    BodyShape body;
    VoxelParts parts(*field);
    for (std::size_t v = 0; v < labels.size(); ++v)
        if (labels[v] != 0 && !parts.is_known(v)) parts.add_part(v, body);
    if (body.volumes.empty())
        throw InputError("no voxel with a label: all are 0; give an image that has labels");
    // From the centres of voxels to their corners.
    const Vec3 half = 0.5 * (field->image().directions.cwiseAbs() * field->image().spacing);
    body.box = Box(body.box.min() - half, body.box.max() + half);
    constexpr double share_of_voxel = 0.25;  // what interpolation leaves of the steps
    body.roughness = share_of_voxel * field->image().spacing.maxCoeff();
    body.region_at = [field](const Vec3& x) { return (*field)(x); };
    body.visit_surface = [field](double, const SurfaceVisitor& visit) {
        visit_faces(*field, visit);
    };
    return body;
}

}  // namespace incise::tetmesh
