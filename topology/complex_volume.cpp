// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/complex_volume.h"

#include <algorithm>
#include <array>
#include <utility>

namespace incise::topology {

namespace {

using ConstHandle = LinearCellComplex::Dart_const_handle;

/// The face and position of a dart in its cell. The dart starts at the corner that cell_kind.h
/// lists there.
struct DartPlace {
    int face = -1, position = -1;
};
template <class Value>
using ByPlace = std::array<std::array<Value, max_face_corners>, max_faces>;

/// Returns for each dart of a kind of cell the dart along the same edge on the other face there.
constexpr ByPlace<DartPlace> opposite_darts(const CellTraits& t) {
    ByPlace<DartPlace> places{};
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        for (std::size_t p = 0; p < face.size(); ++p) {
            const int from = face[p], to = face[(p + 1) % face.size()];
            for (int g = 0; g < t.num_faces; ++g) {
                const auto other = t.face(g);
                for (std::size_t q = 0; q < other.size(); ++q)
                    if (other[q] == to && other[(q + 1) % other.size()] == from)
                        places[static_cast<std::size_t>(f)][p] = {g, static_cast<int>(q)};
            }
        }
    }
    return places;
}

constexpr std::array<ByPlace<DartPlace>, num_cell_kinds> opposite_places = {
    opposite_darts(cell_traits[0]), opposite_darts(cell_traits[1]), opposite_darts(cell_traits[2]),
    opposite_darts(cell_traits[3])};

auto& at(auto& by_place, int face, int position) {
    return by_place[static_cast<std::size_t>(face)][static_cast<std::size_t>(position)];
}

/// Walks over a volume and a kind of cell side by side.
class VolumeMatch {
  public:
    VolumeMatch(const LinearCellComplex& complex, const ComplexCell& info, CellKind kind)
        : complex_(complex), diagonals_(info.diagonals), kind_(kind), traits_(traits(kind)) {}

    /// Returns a dart at each corner, with `first` as the first dart of the first face. Empty if
    /// the volume is of another kind.
    std::vector<ConstHandle> corners(ConstHandle first) const {
        ByPlace<ConstHandle> darts{};
        at(darts, 0, 0) = first;
        std::vector<std::pair<DartPlace, ConstHandle>> open{{{0, 0}, first}};
        bool fits = true;
        const auto reach = [&](int f, int p, ConstHandle d) {
            ConstHandle& known = at(darts, f, p);
            if (known == nullptr) open.push_back({{f, p}, d});
            if (known == nullptr) known = d;
            fits = fits && known == d;
        };
        while (fits && !open.empty()) {
            const auto [place, d] = open.back();
            open.pop_back();
            const int size = static_cast<int>(traits_.face(place.face).size());
            if (complex_.is_free<1>(d) || complex_.is_free<2>(d)) return {};
            const ConstHandle next = next_of_whole(place, d);
            if (next == nullptr) return {};
            reach(place.face, (place.position + 1) % size, next);
            const DartPlace other =
                at(opposite_places[static_cast<std::size_t>(kind_)], place.face, place.position);
            reach(other.face, other.position, complex_.beta<2>(d));
        }
        if (!fits) return {};
        return one_a_corner(darts);
    }

  private:
    /// Returns the dart that follows in a face before it was divided; null if there is none.
    ConstHandle next_of_whole(DartPlace at, ConstHandle d) const {
        const ConstHandle next = complex_.beta<1>(d);
        const int first = diagonals_.first_end(at.face);
        if (first < 0 || (at.position + 1 - first) % 2 != 0) return next;
        const ConstHandle other_half = complex_.beta<2>(next);
        return complex_.is_free<2>(next) || complex_.is_free<1>(other_half)
                   ? ConstHandle(nullptr)
                   : complex_.beta<1>(other_half);
    }

    /// Returns a dart at each corner; empty if those at one start from several vertices.
    std::vector<ConstHandle> one_a_corner(const ByPlace<ConstHandle>& darts) const {
        std::vector<ConstHandle> corners(static_cast<std::size_t>(traits_.num_corners), nullptr);
        for (int f = 0; f < traits_.num_faces; ++f) {
            const auto face = traits_.face(f);
            for (int p = 0; p < static_cast<int>(face.size()); ++p) {
                ConstHandle& known =
                    corners[static_cast<std::size_t>(face[static_cast<std::size_t>(p)])];
                const ConstHandle d = at(darts, f, p);
                if (known != nullptr && complex_.attribute<0>(known) != complex_.attribute<0>(d))
                    return {};
                known = d;
            }
        }
        return corners;
    }

    const LinearCellComplex& complex_;
    const Diagonals diagonals_;
    const CellKind kind_;
    const CellTraits& traits_;
};

}  // namespace

std::optional<VolumeOfKind> volume_of_kind(const LinearCellComplex& complex,
                                           std::span<const ConstHandle> darts,
                                           const ComplexCell& info) {
    const auto id = [&](ConstHandle d) {
        return complex.info_of_attribute<0>(complex.attribute<0>(d)).id;
    };
    const auto is_first = [&](ConstHandle d) {
        return id(d).is_valid() && !complex.is_free<1>(d) &&
               std::array{id(d), id(complex.beta<1>(d))} == info.first_edge;
    };
    std::vector<ConstHandle> firsts(darts.begin(), darts.end());
    std::stable_partition(firsts.begin(), firsts.end(), is_first);
    for (int k = 0; k < num_cell_kinds; ++k) {
        const auto kind = static_cast<CellKind>(k);
        const int num_darts = traits(kind).num_face_corners() + 2 * info.diagonals.count();
        if (!info.diagonals.fits(kind) || std::ssize(darts) != num_darts) continue;
        const VolumeMatch match(complex, info, kind);
        for (const ConstHandle first : firsts)
            if (auto corners = match.corners(first); !corners.empty())
                return VolumeOfKind{kind, std::move(corners)};
    }
    return std::nullopt;
}

}  // namespace incise::topology
