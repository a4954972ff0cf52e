// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/image/label_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "incise/base/error.h"
#include "incise/io/files/memory.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

using Index3 = std::array<std::int64_t, 3>;
using topology::CellKind;
using topology::MeshData;

constexpr double max_cells = 1e8;  // as for the box meshes of scenarios

/// A lattice of boxes that becomes a mesh. Its boxes are those of [begin, end) along each axis.
struct Lattice {
    Index3 begin{}, end{};
    Vec3 corner;            ///< of box (0, 0, 0)
    Eigen::Matrix3d steps;  ///< edges of a box, one a column
    /// Returns the label of box (i, j, k).
    std::function<int(std::int64_t, std::int64_t, std::int64_t)> label;

    std::int64_t num(std::size_t axis) const { return end[axis] - begin[axis]; }
    Vec3 point(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return corner +
               steps * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    }
};

/// Finds the smallest box of voxels [begin, end) outside of which all labels are 0.
void crop(const LabelImage& image, Index3& begin, Index3& end) {
    const auto [nx, ny, nz] = image.dimensions;
    begin = image.dimensions;
    end = {0, 0, 0};
    for (std::int64_t k = 0; k < nz; ++k)
        for (std::int64_t j = 0; j < ny; ++j) {
            const auto* row = image.labels.data() + nx * (j + ny * k);
            const auto* first = std::find_if(row, row + nx, [](int l) { return l != 0; });
            if (first == row + nx) continue;
            auto last = nx - 1;
            while (row[last] == 0) --last;
            const Index3 low = {first - row, j, k}, high = {last, j, k};
            for (std::size_t a = 0; a < 3; ++a) {
                begin[a] = std::min(begin[a], low[a]);
                end[a] = std::max(end[a], high[a] + 1);
            }
        }
    if (end[0] == 0) throw InputError("no voxel with a label: all are 0");
}

Lattice voxels(const LabelImage& image) {
    Lattice lattice;
    crop(image, lattice.begin, lattice.end);
    lattice.steps = image.directions * image.spacing.asDiagonal();
    lattice.corner = image.origin - lattice.steps * Vec3::Constant(0.5);
    lattice.label = [&image](std::int64_t i, std::int64_t j, std::int64_t k) {
        return image.label(i, j, k);
    };
    return lattice;
}

/// Returns orthogonal unit vectors with the handedness of `directions`. The first vector is that of
/// `directions`; the second lies in the plane of its first two.
Eigen::Matrix3d orthogonal(const Eigen::Matrix3d& directions) {
    Eigen::Matrix3d frame = directions;
    frame.col(1) -= frame.col(0) * frame.col(0).dot(frame.col(1));
    frame.col(1).normalize();
    const Vec3 third = frame.col(0).cross(frame.col(1));
    frame.col(2) = third.dot(directions.col(2)) < 0.0 ? Vec3(-third) : third;
    return frame;
}

/// Returns the voxel at a position along an axis, or -1 if there is none. The position is in voxels
/// from the beginning of the image. A position between two voxels belongs to the upper one,
/// independent of rounding.
std::int64_t voxel_at(const LabelImage& image, std::size_t axis, double place) {
    constexpr double tie = 1e-9;
    const auto voxel = static_cast<std::int64_t>(std::floor(place + tie));
    return voxel < image.dimensions[axis] ? std::max<std::int64_t>(voxel, -1) : -1;
}

/// The labels at the centres of cubes whose edges are parallel to the axes of the image. The voxel
/// along each axis then depends on one index only.
class AlongAxes {
  public:
    /// `to_voxels` is the edge of a cube along each axis, in voxels.
    AlongAxes(const LabelImage& image, const Lattice& lattice, const Vec3& to_voxels)
        : image_(&image), begin_(lattice.begin) {
        for (std::size_t a = 0; a < 3; ++a)
            for (auto i = lattice.begin[a]; i < lattice.end[a]; ++i) {
                const double place =
                    to_voxels[static_cast<Eigen::Index>(a)] * (static_cast<double>(i) + 0.5);
                voxels_[a].push_back(static_cast<std::int32_t>(voxel_at(image, a, place)));
            }
    }

    int operator()(std::int64_t i, std::int64_t j, std::int64_t k) const {
        const auto x = voxel(0, i), y = voxel(1, j), z = voxel(2, k);
        return x < 0 || y < 0 || z < 0 ? 0 : image_->label(x, y, z);
    }

  private:
    std::int64_t voxel(std::size_t axis, std::int64_t cube) const {
        return voxels_[axis][static_cast<std::size_t>(cube - begin_[axis])];
    }

    const LabelImage* image_;
    Index3 begin_;
    std::array<std::vector<std::int32_t>, 3> voxels_;
};

/// Returns the lattice of cubes of edge `size`.
Lattice cubes(const LabelImage& image, double size) {
    // Directions in single precision are orthogonal only to rounding.
    constexpr double skew = 1e-5;
    const Eigen::Matrix3d gram = image.directions.transpose() * image.directions;
    const bool is_orthogonal = (gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < skew;
    const bool is_identity = image.directions == Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d frame = is_identity ? image.directions : orthogonal(image.directions);

    // From coordinates in voxels to those in cubes, and back. The outer corner of the first voxel
    // is the origin of both.
    Eigen::Matrix3d to_cubes = Eigen::Matrix3d::Identity();
    if (!is_orthogonal) to_cubes = frame.transpose() * image.directions;
    to_cubes = to_cubes * image.spacing.asDiagonal();
    to_cubes /= size;
    const Eigen::Matrix3d to_voxels = to_cubes.inverse();

    Index3 begin, end;
    crop(image, begin, end);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (int c = 0; c < 8; ++c) {
        Vec3 at;
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            at[a] = static_cast<double>((c >> a) & 1 ? end[i] : begin[i]);
        }
        at = to_cubes * at;
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    }
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    const Vec3 extent = high - low + Vec3::Constant(2.0);
    const auto too_many = [&](const std::string& number) {
        return InputError("cubes of edge " + shown(size) + " would be " + number +
                          " in the box round the labels; give a larger size");
    };
    if (!(extent.prod() < most && to_voxels.allFinite())) throw too_many("more than 2147483647");

    Lattice lattice;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto i = static_cast<Eigen::Index>(a);
        lattice.begin[a] = static_cast<std::int64_t>(std::floor(low[i]));
        lattice.end[a] = static_cast<std::int64_t>(std::ceil(high[i]));
    }
    lattice.steps = frame * size;
    lattice.corner =
        image.origin - image.directions * image.spacing.asDiagonal() * Vec3::Constant(0.5);
    if (is_orthogonal)
        lattice.label = AlongAxes(image, lattice, to_voxels.diagonal());
    else
        lattice.label = [&image, to_voxels](std::int64_t i, std::int64_t j, std::int64_t k) {
            const Vec3 at =
                to_voxels * Vec3(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5,
                                 static_cast<double>(k) + 0.5);
            const auto x = voxel_at(image, 0, at.x()), y = voxel_at(image, 1, at.y()),
                       z = voxel_at(image, 2, at.z());
            return x < 0 || y < 0 || z < 0 ? 0 : image.label(x, y, z);
        };
    return lattice;
}

std::size_t count_cells(const Lattice& lattice) {
    std::size_t count = 0;
    for (auto k = lattice.begin[2]; k < lattice.end[2]; ++k)
        for (auto j = lattice.begin[1]; j < lattice.end[1]; ++j)
            for (auto i = lattice.begin[0]; i < lattice.end[0]; ++i)
                count += lattice.label(i, j, k) != 0;
    return count;
}

/// Throws InputError if the coordinates are so large that rounding deforms the cells.
void require_precision(const Lattice& lattice) {
    constexpr double finest = 1e-10;  // edge over coordinate, for a relative error of about 1e-6
    double largest = 0.0;
    for (const auto i : {lattice.begin[0], lattice.end[0]})
        for (const auto j : {lattice.begin[1], lattice.end[1]})
            for (const auto k : {lattice.begin[2], lattice.end[2]})
                largest = std::max(largest, lattice.point(i, j, k).cwiseAbs().maxCoeff());
    const double edge = lattice.steps.colwise().norm().minCoeff();
    const double volume = std::abs(lattice.steps.determinant());
    if (!(edge > finest * largest && std::isfinite(largest) && volume > 0.0 &&
          std::isfinite(volume)))
        throw InputError("cells of edge " + shown(edge) + " at coordinates up to " +
                         shown(largest) +
                         " are beyond the precision of numbers; correct the spacing and the "
                         "origin of the image");
}

/// A builder of the mesh, layer by layer. The points of a plane are numbered when the labels of the
/// layers on both sides are known. The cells below the plane then have all corners.
class Builder {
  public:
    explicit Builder(const Lattice& lattice)
        : lattice_(lattice),
          width_(static_cast<std::size_t>(lattice.num(0))),
          depth_(static_cast<std::size_t>(lattice.num(1))),
          is_left_handed_(lattice.steps.determinant() < 0.0) {}

    MeshData build(std::size_t num_cells) {
        mesh_.kinds.reserve(num_cells);
        mesh_.regions.reserve(num_cells);
        mesh_.offsets.reserve(num_cells + 1);
        mesh_.corners.reserve(8 * num_cells);
        std::vector<int> below(width_ * depth_), above(width_ * depth_);
        std::vector<std::int64_t> lower, upper;
        for (auto k = lattice_.begin[2]; k <= lattice_.end[2]; ++k) {
            fill(above, k);
            upper.assign((width_ + 1) * (depth_ + 1), unused);
            mark(below, upper);
            mark(above, upper);
            number(upper, k);
            add_cells(below, lower, upper);
            std::swap(below, above);
            std::swap(lower, upper);
        }
        return std::move(mesh_);
    }

  private:
    static constexpr std::int64_t unused = -1, used = -2;

    std::size_t box(std::size_t i, std::size_t j) const { return i + width_ * j; }
    std::size_t node(std::size_t i, std::size_t j) const { return i + (width_ + 1) * j; }

    void fill(std::vector<int>& layer, std::int64_t k) const {
        std::ranges::fill(layer, 0);
        if (k == lattice_.end[2]) return;
        for (std::size_t j = 0; j < depth_; ++j)
            for (std::size_t i = 0; i < width_; ++i)
                layer[box(i, j)] =
                    lattice_.label(lattice_.begin[0] + static_cast<std::int64_t>(i),
                                   lattice_.begin[1] + static_cast<std::int64_t>(j), k);
    }

    void mark(const std::vector<int>& layer, std::vector<std::int64_t>& plane) const {
        for (std::size_t j = 0; j < depth_; ++j)
            for (std::size_t i = 0; i < width_; ++i)
                if (layer[box(i, j)] != 0)
                    plane[node(i, j)] = plane[node(i + 1, j)] = plane[node(i, j + 1)] =
                        plane[node(i + 1, j + 1)] = used;
    }

    void number(std::vector<std::int64_t>& plane, std::int64_t k) {
        for (std::size_t j = 0; j <= depth_; ++j)
            for (std::size_t i = 0; i <= width_; ++i) {
                auto& point = plane[node(i, j)];
                if (point != used) continue;
                point = static_cast<std::int64_t>(mesh_.points.size());
                mesh_.points.push_back(
                    lattice_.point(lattice_.begin[0] + static_cast<std::int64_t>(i),
                                   lattice_.begin[1] + static_cast<std::int64_t>(j), k));
            }
    }

    void add_cells(const std::vector<int>& layer, const std::vector<std::int64_t>& lower,
                   const std::vector<std::int64_t>& upper) {
        // In a left-handed frame, exchanging the layers makes the volume positive.
        const auto& first = is_left_handed_ ? upper : lower;
        const auto& second = is_left_handed_ ? lower : upper;
        for (std::size_t j = 0; j < depth_; ++j)
            for (std::size_t i = 0; i < width_; ++i) {
                if (layer[box(i, j)] == 0) continue;
                const std::size_t around[] = {node(i, j), node(i + 1, j), node(i + 1, j + 1),
                                              node(i, j + 1)};
                std::array<std::int64_t, 8> corners;
                for (std::size_t c = 0; c < 4; ++c) {
                    corners[c] = first[around[c]];
                    corners[c + 4] = second[around[c]];
                }
                mesh_.add_cell(CellKind::hexahedron, corners, layer[box(i, j)]);
            }
    }

    const Lattice& lattice_;
    std::size_t width_, depth_;
    bool is_left_handed_;
    MeshData mesh_;
};

}  // namespace

MeshData hex_mesh(const LabelImage& image, std::optional<double> size) {
    if (size && !(*size > 0.0 && std::isfinite(*size)))
        throw InputError("a size of " + shown(*size) + " is not allowed; it must be above 0");
    const auto lattice = size ? cubes(image, *size) : voxels(image);
    require_precision(lattice);
    const auto num_cells = count_cells(lattice);
    if (num_cells == 0)
        throw InputError("no cube of edge " + shown(*size) +
                         " has its centre in a voxel with a label; give a smaller size");
    const std::string remedy = size ? "give a larger size" : "give a size larger than the voxels";
    const std::string what = "a mesh of " + std::to_string(num_cells) + " cells";
    if (static_cast<double>(num_cells) > max_cells)
        throw InputError(what + " is too large, 1e8 are the most; " + remedy);
    // A mesh takes about 100 bytes a cell if cells share their points. The text of a mesh is in
    // memory when it is written. With that of the longest format, 420 bytes a cell were measured.
    constexpr double bytes_of_cell = 420;
    constexpr double bytes_of_place = 2 * (8 + 4);  // two layers of point numbers and labels
    require_memory(bytes_of_cell * static_cast<double>(num_cells) +
                       bytes_of_place * static_cast<double>(lattice.num(0) + 1) *
                           static_cast<double>(lattice.num(1) + 1),
                   what, remedy);
    return Builder(lattice).build(num_cells);
}

}  // namespace incise::io
