// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/carrier_check.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/topology/geometry.h"

namespace incise::topology {

namespace {

/// Returns the text of the parts, behind it the remedy.
std::string fault(auto&&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    text << "; write the file again, or leave out its cell array 'carrier' to take each cell as an "
            "element of its own";
    return text.str();
}

/// The check of carriers.
class CarrierCheck {
  public:
    CarrierCheck(const MeshData& data, std::span<const SharedFace> shared_faces)
        : data_(data), carriers_(data.carriers), shared_faces_(shared_faces) {}

    /// Returns the first fault.
    std::string run() {
        if (carriers_.of_cell.size() != data_.num_cells())
            return fault("there are carriers for ", carriers_.of_cell.size(), " cells of ",
                         data_.num_cells());
        std::string found = fault_of_corners();
        for (std::size_t c = 0; c < data_.num_cells() && found.empty(); ++c)
            if (carriers_.of_cell[c] != Carriers::whole) found = fault_of_cell(c);
        for (std::size_t i = 0; i < shared_faces_.size() && found.empty(); ++i)
            found = fault_of_face(shared_faces_[i].a.cell, shared_faces_[i].b.cell);
        return found;
    }

  private:
    std::string fault_of_corners() {
        for (std::size_t row = 0; row < carriers_.corners.size(); ++row) {
            const auto& x = carriers_.corners[row];
            volumes_.push_back(signed_volume(CellKind::tetrahedron, x));
            if (!(volumes_.back() > 0.0 && std::isfinite(volumes_.back())))
                return fault("carrier ", row, " has the volume ", volumes_.back(),
                             ", which must be positive");
        }
        filled_.assign(carriers_.corners.size(), 0.0);
        region_of_.assign(carriers_.corners.size(), {false, 0});
        return "";
    }

    std::string fault_of_cell(std::size_t c) {
        const std::int64_t given = carriers_.of_cell[c];
        if (given < 0 || given >= std::ssize(carriers_.corners))
            return fault(data_.cell_name(c), " has the carrier ", given,
                         ", which is out of range (", carriers_.corners.size(), " carriers; ",
                         Carriers::whole, " means a whole cell)");
        if (data_.kinds[c] != CellKind::tetrahedron)
            return fault(data_.cell_name(c), " has the carrier ", given,
                         ", and only tetrahedra can be parts of one");
        const auto row = static_cast<std::size_t>(given);
        auto& [has_region, region] = region_of_[row];
        if (has_region && region != data_.regions[c])
            return fault(data_.cell_name(c), " of region ", data_.regions[c], " has the carrier ",
                         row, ", which has cells of region ", region);
        region_of_[row] = {true, data_.regions[c]};
        if (const double outside = distance_outside(c, row); !(outside <= tolerance))
            return fault(data_.cell_name(c), " is not inside its carrier ", row,
                         ", but outside by ", outside, " of its size");
        filled_[row] += signed_volume(CellKind::tetrahedron, corners_of(c));
        if (!(filled_[row] <= (1.0 + tolerance) * volumes_[row]))
            return fault("the cells of carrier ", row, " up to ", data_.cell_name(c),
                         " have more volume than the carrier: ", filled_[row], " of ",
                         volumes_[row]);
        return "";
    }

    /// Returns how far a cell is outside a tetrahedron, over the altitudes of the tetrahedron.
    double distance_outside(std::size_t c, std::size_t row) const {
        const auto& x = carriers_.corners[row];
        double most = 0.0;
        for (const Vec3& corner : corners_of(c))
            for (std::size_t k = 0; k < 4; ++k) {
                std::array<Vec3, 4> moved = x;
                moved[k] = corner;
                const double weight = signed_volume(CellKind::tetrahedron, moved) / volumes_[row];
                if (!(-weight <= most)) most = -weight;
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

    std::vector<Vec3> corners_of(std::size_t c) const {
        std::vector<Vec3> x;
        for (const std::int64_t p : data_.cell(c))
            x.push_back(data_.points[static_cast<std::size_t>(p)]);
        return x;
    }
    std::vector<Vec3> corners_of_carrier(std::size_t c) const {
        if (carriers_.of_cell[c] == Carriers::whole) return corners_of(c);
        const auto& x = carriers_.corners[static_cast<std::size_t>(carriers_.of_cell[c])];
        return {x.begin(), x.end()};
    }

    /// Far above the rounding of points on faces of carriers, and far below what a viewer shows.
    static constexpr double tolerance = 1e-6;

    const MeshData& data_;
    const Carriers& carriers_;
    std::span<const SharedFace> shared_faces_;
    // By row.
    std::vector<double> volumes_, filled_;
    std::vector<std::pair<bool, int>> region_of_;
};

}  // namespace

std::string fault_of_carriers(const MeshData& data, std::span<const SharedFace> shared_faces) {
    if (data.carriers.is_empty())
        return data.carriers.corners.empty() ? "" : fault("the cells do not name their carriers");
    return CarrierCheck(data, shared_faces).run();
}

}  // namespace incise::topology
