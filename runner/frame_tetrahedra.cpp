// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/frame_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "incise/topology/source_faces.h"

namespace incise::runner {

namespace {

using topology::CellKind;
using topology::MeshData;

class Divider {
  public:
    explicit Divider(MeshData mesh) : old_(std::move(mesh)), faces_(old_) {
        new_.points = old_.points;
        new_.points_may_coincide = old_.points_may_coincide;
        for (std::size_t c = 0; c < old_.num_cells(); ++c)
            old_.kinds[c] == CellKind::polyhedron ? divide(c) : keep(c);
    }

    /// The points of which each new point is the mean, behind the old points.
    const std::vector<std::vector<std::int64_t>>& sources() const { return sources_; }
    /// By new cell, the old one.
    const std::vector<std::size_t>& origins() const { return origins_; }
    MeshData take() { return std::move(new_); }

  private:
    void keep(std::size_t c) {
        add(old_.kinds[c], old_.cell(c), c);
        for (int f = 0; f < faces_.num_faces(c); ++f)
            if (old_.is_on_cut(c, f)) new_.set_on_cut(new_.num_cells() - 1, f);
    }

    void divide(std::size_t c) {
        const std::int64_t centre = add_point({old_.cell(c).begin(), old_.cell(c).end()});
        for (int f = 0; f < faces_.num_faces(c); ++f) {
            const auto face = faces_.points({c, f});
            const bool is_on_cut = old_.is_on_cut(c, f);
            if (face.size() == 3) {
                add_tetrahedron(face[0], face[1], face[2], centre, c, is_on_cut);
                continue;
            }
            const std::int64_t middle = middle_of(face);
            for (std::size_t p = face.size() - 1, q = 0; q < face.size(); p = q++)
                add_tetrahedron(middle, face[p], face[q], centre, c, is_on_cut);
        }
    }

    /// Adds the tetrahedron from a triangle, anticlockwise as seen from outside, to a point inside.
    void add_tetrahedron(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t inside,
                         std::size_t origin, bool is_on_cut) {
        constexpr int face = 3;  // of the corners 0, 2 and 1
        add(CellKind::tetrahedron, std::array{a, c, b, inside}, origin);
        if (is_on_cut) new_.set_on_cut(new_.num_cells() - 1, face);
    }

    void add(CellKind kind, std::span<const std::int64_t> corners, std::size_t origin) {
        new_.add_cell(kind, corners, old_.regions[origin]);
        origins_.push_back(origin);
    }

    std::int64_t add_point(std::vector<std::int64_t> of) {
        Vec3 mean = Vec3::Zero();
        for (const std::int64_t p : of) mean += old_.points[static_cast<std::size_t>(p)];
        new_.points.push_back(mean / static_cast<double>(of.size()));
        sources_.push_back(std::move(of));
        return std::ssize(new_.points) - 1;
    }

    /// Returns the point in the middle of a face, the same for both cells at it.
    std::int64_t middle_of(const std::vector<std::int64_t>& face) {
        std::vector<std::int64_t> key = face;
        std::ranges::sort(key);
        const auto [it, is_new] = middles_.try_emplace(key, 0);
        if (is_new) it->second = add_point(std::move(key));
        return it->second;
    }

    MeshData old_;
    topology::SourceFaces faces_;
    MeshData new_;
    std::vector<std::vector<std::int64_t>> sources_;
    std::vector<std::size_t> origins_;
    std::map<std::vector<std::int64_t>, std::int64_t> middles_;
};

/// Appends the values of the new points.
void append_points(io::Field& field, const std::vector<std::vector<std::int64_t>>& sources) {
    constexpr std::array<std::string_view, 3> sums = {"mass", "force", "contact_force"};
    const bool is_sum = std::ranges::find(sums, field.name) != sums.end();
    const auto width = static_cast<std::size_t>(field.components);
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            values.reserve(values.size() + width * sources.size());
            for (const auto& of : sources)
                for (std::size_t k = 0; k < width; ++k) {
                    double mean = 0.0;
                    for (const std::int64_t p : of)
                        mean +=
                            static_cast<double>(values[width * static_cast<std::size_t>(p) + k]);
                    mean /= static_cast<double>(of.size());
                    values.push_back(std::is_integral_v<T> ? T{-1}
                                     : is_sum              ? T{0}
                                                           : static_cast<T>(mean));
                }
        },
        field.values);
}

void copy_cells(io::Field& field, const std::vector<std::size_t>& origins) {
    const auto width = static_cast<std::size_t>(field.components);
    std::visit(
        [&]<class T>(std::vector<T>& values) {
            std::vector<T> copied;
            copied.reserve(width * origins.size());
            for (const std::size_t c : origins) {
                const auto from = values.begin() + static_cast<std::ptrdiff_t>(width * c);
                copied.insert(copied.end(), from, from + field.components);
            }
            values = std::move(copied);
        },
        field.values);
}

}  // namespace

io::Frame with_tetrahedra(io::Frame frame) {
    if (frame.mesh.faces.empty()) return frame;
    const bool has_cut_faces = !frame.mesh.cut_faces.empty();
    Divider divider(std::move(frame.mesh));
    for (io::Field& field : frame.point_fields) append_points(field, divider.sources());
    for (io::Field& field : frame.cell_fields) copy_cells(field, divider.origins());
    frame.mesh = divider.take();
    if (has_cut_faces) frame.mesh.cut_faces.resize(frame.mesh.num_cells());
    return frame;
}

}  // namespace incise::runner
