// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/carrier_check.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/topology/corner_check.h"
#include "incise/topology/geometry.h"
#include "incise/topology/source_faces.h"

namespace incise::topology {

namespace {

/// Returns the text of the parts, behind it the remedy.
std::string with_remedy(const MeshData& data, auto&&... parts) {
    std::ostringstream text;
    (text << ... << parts) << "; " << data.words.mend_carriers;
    return text.str();
}

/// The check of carriers.
class CarrierCheck {
  public:
    CarrierCheck(const MeshData& data, std::span<const SharedFace> shared_faces)
        : data_(data), faces_(data), carriers_(data.carriers), shared_faces_(shared_faces) {}

    /// Returns the first fault.
    std::string run() {
        if (carriers_.of_cell.size() != data_.num_cells())
            return fault("there are carriers for ", carriers_.of_cell.size(), " cells of ",
                         data_.num_cells());
        std::string found = fault_of_corners();
        for (std::size_t c = 0; c < data_.num_cells() && found.empty(); ++c)
            if (carriers_.of_cell[c] != Carriers::whole) found = fault_of_cell(c);
        for (std::size_t row = 0; row < filled_.size() && found.empty(); ++row)
            if (!(filled_[row] <= (1.0 + tolerance) * shapes_[row].volume))
                found = fault("the cells of carrier ", row,
                              " have more volume than the carrier: ", filled_[row], " of ",
                              shapes_[row].volume, first_part_of(row));
        for (std::size_t i = 0; i < shared_faces_.size() && found.empty(); ++i)
            found = fault_of_face(shared_faces_[i].a.cell, shared_faces_[i].b.cell);
        return found;
    }

  private:
    /// What a cell of a carrier is measured by.
    struct Shape {
        double volume = 0.0;  // m3
        double size = 0.0;    // the largest distance of two corners, m
        // By face, its direction, and how far the corners of the carrier are along it, m. In a
        // carrier with faces that are not plane, corners can be beyond the mean plane of a face.
        struct Extent {
            Vec3 outwards;
            double lowest, highest;
        };
        std::vector<Extent> extents;
    };

    std::string fault(auto&&... parts) const { return with_remedy(data_, parts...); }

    /// Returns words that name the first cell of a carrier; empty if it has none.
    std::string first_part_of(std::size_t row) const {
        const auto& rows = carriers_.of_cell;
        const auto it = std::ranges::find(rows, static_cast<std::int64_t>(row));
        if (it == rows.end()) return "";
        return "; its first part is " +
               data_.cell_name(static_cast<std::size_t>(it - rows.begin()));
    }

    std::string fault_of_corners() {
        for (std::size_t row = 0; row < carriers_.corners.size(); ++row) {
            shapes_.push_back(shape_of(carriers_.corners[row]));
            const double volume = shapes_.back().volume;
            if (!(volume > 0.0 && std::isfinite(volume)))
                return fault("carrier ", row, " has the volume ", volume,
                             ", which must be positive", first_part_of(row));
            const CarrierCorners& x = carriers_.corners[row];
            if (x.kind() == CellKind::tetrahedron) continue;
            if (const auto inverted = first_inverted_corner(x.kind(), x))
                return fault("carrier ", row, " (", traits(x.kind()).name,
                             ") is turned inside out at its corner ", *inverted,
                             first_part_of(row));
        }
        filled_.assign(carriers_.corners.size(), 0.0);
        region_of_.assign(carriers_.corners.size(), {false, 0});
        return "";
    }

    static Shape shape_of(const CarrierCorners& x) {
        Shape shape;
        shape.volume = signed_volume(x.kind(), x);
        for (const Vec3& a : x)
            for (const Vec3& b : x) shape.size = std::max(shape.size, (a - b).norm());
        const CellTraits& t = traits(x.kind());
        for (int f = 0; f < t.num_faces; ++f) {
            const auto face = t.face(f);
            // Between its halves and the same about the mean of its corners is half a tetrahedron.
            if (const int first = x.diagonals.first_end(f); first >= 0) {
                const auto at = [&](int p) {
                    return x[static_cast<std::size_t>(
                        face[static_cast<std::size_t>((first + p) % 4)])];
                };
                shape.volume -= 0.5 * tetrahedron_volume(at(0), at(1), at(2), at(3));
            }
            Shape::Extent& extent = shape.extents.emplace_back();
            extent.outwards = area_vector(static_cast<int>(face.size()), [&](int p) {
                return x[static_cast<std::size_t>(face[static_cast<std::size_t>(p)])];
            });
            extent.outwards.normalize();
            extent.lowest = extent.highest = extent.outwards.dot(x[0]);
            for (const Vec3& corner : x) {
                extent.lowest = std::min(extent.lowest, extent.outwards.dot(corner));
                extent.highest = std::max(extent.highest, extent.outwards.dot(corner));
            }
        }
        return shape;
    }

    std::string fault_of_cell(std::size_t c) {
        const std::int64_t given = carriers_.of_cell[c];
        if (given < 0 || given >= std::ssize(carriers_.corners))
            return fault(data_.cell_name(c), " has the carrier ", given,
                         ", which is out of range (", carriers_.corners.size(), " carriers; ",
                         Carriers::whole, " means a whole cell)");
        const auto row = static_cast<std::size_t>(given);
        const CellKind kind = carriers_.corners[row].kind();
        if (data_.kinds[c] != CellKind::polyhedron &&
            !(data_.kinds[c] == CellKind::tetrahedron && kind == CellKind::tetrahedron))
            return fault(data_.cell_name(c), " has the carrier ", row, ", a ", traits(kind).name,
                         ": only polyhedra can be parts of one, and tetrahedra of a tetrahedron");
        auto& [has_region, region] = region_of_[row];
        if (has_region && region != data_.regions[c])
            return fault(data_.cell_name(c), " of region ", data_.regions[c], " has the carrier ",
                         row, ", which has cells of region ", region);
        region_of_[row] = {true, data_.regions[c]};
        if (const double outside = distance_outside(c, row); !(outside <= tolerance))
            return fault(data_.cell_name(c), " is not inside its carrier ", row,
                         ", but outside by ", outside, " of its size");
        const double volume = faces_.volume(c);
        filled_[row] += volume;
        if (data_.kinds[c] != CellKind::polyhedron) return "";
        return fault_of_polyhedron(c, row, volume);
    }

    /// Returns why a polyhedron cannot be what a cut leaves of its carrier.
    std::string fault_of_polyhedron(std::size_t c, std::size_t row, double volume) const {
        const Shape& carrier = shapes_[row];
        if (!(volume >= -least_volume_of_part * carrier.volume))
            return fault(data_.cell_name(c), " has the volume ", volume,
                         ", which must be positive: its faces run the wrong way round");
        for (int f = 0; f < faces_.num_faces(c); ++f)
            if (const double bend = bend_of({c, f}); !(bend <= most_bend * carrier.size))
                return fault(data_.cell_name(c), " has a face ", f,
                             " that is not plane: its corners are off its mean plane by ", bend,
                             ", and its carrier ", row, " has the size ", carrier.size);
        return "";
    }

    /// Returns how far the corners of a face are from its mean plane, m. A face without area has no
    /// plane.
    double bend_of(SourceFace f) const {
        const int size = faces_.size(f);
        const auto at = [&](int p) -> const Vec3& { return faces_.position(f, p); };
        const Vec3 area = area_vector(size, at);
        if (size == 3 || !(area.norm() > 0.0)) return 0.0;
        const Vec3 normal = area.normalized();
        double mean = 0.0, most = 0.0;
        for (int p = 0; p < size; ++p) mean += normal.dot(at(p) - at(0)) / size;
        for (int p = 0; p < size; ++p)
            most = std::max(most, std::abs(normal.dot(at(p) - at(0)) - mean));
        return most;
    }

    /// Returns how far a cell is outside its carrier, over the altitude of the carrier: beyond the
    /// corner that is farthest out, in the direction of a face. What is in a carrier is a mean of
    /// its corners, so that it is never outside.
    double distance_outside(std::size_t c, std::size_t row) const {
        double most = 0.0;
        for (const std::int64_t p : data_.cell(c))
            for (const auto& [outwards, lowest, highest] : shapes_[row].extents) {
                const double along = outwards.dot(data_.points[static_cast<std::size_t>(p)]);
                const double outside = (along - highest) / (highest - lowest);
                if (!(outside <= most)) most = outside;
            }
        return most;
    }

    std::string fault_of_face(std::size_t a, std::size_t b) const {
        const std::int64_t row_a = carriers_.of_cell[a], row_b = carriers_.of_cell[b];
        if (row_a == row_b) return "";  // also if both are whole
        const std::vector<Vec3> of_a = corners_of_carrier(a), of_b = corners_of_carrier(b);
        const auto num_common = std::ranges::count_if(
            of_a, [&](const Vec3& x) { return std::ranges::find(of_b, x) != of_b.end(); });
        constexpr std::ptrdiff_t corners_of_triangle = 3;
        if (num_common >= corners_of_triangle) return "";
        return fault(data_.cell_name(a), " and ", data_.cell_name(b),
                     " share a face, but of their carriers only ", num_common,
                     " corners are at the same position: points or carriers were moved or rounded");
    }

    std::vector<Vec3> corners_of_carrier(std::size_t c) const {
        std::vector<Vec3> x;
        if (carriers_.of_cell[c] == Carriers::whole)
            for (const std::int64_t p : data_.cell(c))
                x.push_back(data_.points[static_cast<std::size_t>(p)]);
        else
            for (const Vec3& corner :
                 carriers_.corners[static_cast<std::size_t>(carriers_.of_cell[c])])
                x.push_back(corner);
        return x;
    }

    /// Far above the rounding of points on faces of carriers, and far below what a viewer shows.
    static constexpr double tolerance = 1e-6;
    /// Faces on cuts are triangles. Others are parts of the faces of carriers, and as bent as
    /// these: up to 0.06 of the carrier in the same bodies, whose nodes are off by 0.15 of an edge.
    static constexpr double most_bend = 0.25;

    const MeshData& data_;
    const SourceFaces faces_;
    const Carriers& carriers_;
    std::span<const SharedFace> shared_faces_;
    // By row.
    std::vector<Shape> shapes_;
    std::vector<double> filled_;
    std::vector<std::pair<bool, int>> region_of_;
};

}  // namespace

std::string fault_of_carriers(const MeshData& data, std::span<const SharedFace> shared_faces) {
    if (data.carriers.is_empty())
        return data.carriers.corners.empty()
                   ? ""
                   : with_remedy(data, "the cells do not name their carriers");
    return CarrierCheck(data, shared_faces).run();
}

}  // namespace incise::topology
