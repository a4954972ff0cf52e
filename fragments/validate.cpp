// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/validate.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "incise/base/disjoint_set.h"
#include "incise/fragments/part_volumes.h"
#include "incise/topology/geometry.h"

namespace incise::fragments {

using topology::Mesh;
using topology::rest_volume;

namespace {

/// The check of fragments.
class FragmentCheck {
  public:
    FragmentCheck(const FragmentMesh& fragments, const Mesh& mesh)
        : fragments_(fragments), mesh_(mesh) {}

    std::vector<std::string> run() {
        for (const CellId cell : mesh_.elements()) check_cell(cell);
        if (!found_.empty()) return found_;
        std::size_t num_elements = 0;
        double volume = 0.0, whole = 0.0;
        std::vector<bool> is_used(fragments_.node_capacity(), false);
        for (const ElementId e : fragments_.elements()) {
            ++num_elements;
            volume += fragments_.volume(e);
            check_fragment(e);
            for (const NodeId n : fragments_.corners(e)) is_used[n.index()] = true;
        }
        for (const CellId cell : mesh_.elements()) {
            whole += rest_volume(mesh_, cell);
            for (int f = 0; f < mesh_.num_faces(cell); ++f) check_face({cell, f});
        }
        constexpr double rounding = 1e-10;
        if (!(std::abs(volume - whole) <= rounding * whole))
            report("the shares add up to ", volume, " m3, and the mesh has ", whole);
        if (num_elements != fragments_.num_elements())
            report("there are ", num_elements, " fragments, counted as ",
                   fragments_.num_elements());
        std::size_t num_nodes = 0;
        for (const NodeId n : fragments_.nodes()) {
            ++num_nodes;
            if (!is_used[n.index()]) report("node ", n.value, " of the fragments has no fragment");
        }
        if (num_nodes != fragments_.num_nodes())
            report("there are ", num_nodes, " nodes, counted as ", fragments_.num_nodes());
        check_connections();
        return found_;
    }

  private:
    void report(auto&&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        found_.push_back(text.str());
    }

    void check_connections() {
        DisjointSet connected(fragments_.node_capacity());
        for (const ElementId e : fragments_.elements())
            for (const NodeId n : fragments_.corners(e))
                connected.join(fragments_.corners(e)[0].value, n.value);
        const auto root = [&](CellId cell) {
            return connected.find(fragments_.corners(fragments_.fragment_of_cell(cell))[0].value);
        };
        for (const CellId cell : mesh_.elements())
            for (int f = 0; f < mesh_.num_faces(cell); ++f) {
                const CellId other = mesh_.neighbor({cell, f}).cell;
                if (other.is_valid() && cell < other && root(cell) != root(other))
                    report("elements ", cell.value, " and ", other.value,
                           " hang together, but their fragments do not");
            }
    }

    void check_cell(CellId cell) {
        const ElementId e = fragments_.fragment_of_cell(cell);
        if (!e.is_valid() || e.index() >= fragments_.element_capacity() || !fragments_.is_alive(e))
            report("element ", cell.value, " is in no living fragment");
        else if (std::ranges::count(fragments_.cells_of(e), cell) != 1)
            report("fragment ", e.value, " does not know its element ", cell.value);
        else if (fragments_.region(e) != mesh_.region(cell))
            report("element ", cell.value, " is in a fragment of another region");
        else if (fragments_.is_carried_around(cell) && !fragments_.is_at_home(cell))
            report("element ", cell.value, " is in a fragment of another carrier");
    }

    void check_part_shares(ElementId e) {
        const auto shares = fragments_.part_shares(e);
        if (shares.empty()) return;
        std::vector<Vec3> x;
        for (const NodeId n : fragments_.corners(e)) x.push_back(fragments_.rest_position(n));
        const PartNumbers volumes = part_volumes(fragments_.kind(e), x, fragments_.diagonals(e));
        double volume = 0.0;
        bool are_positive = true;
        for (std::size_t t = 0; t < shares.size(); ++t) {
            volume += shares[t] * volumes[t];
            are_positive = are_positive && shares[t] >= 0.0;
        }
        constexpr double tolerance = 1e-9;  // of the carrier: rounding, and FragmentParts::share_of
        const double expected = fragments_.volume(e);
        if (!are_positive ||
            !(std::abs(volume - expected) <= tolerance * fragments_.carrier_volume(e)))
            report("the tetrahedra of fragment ", e.value, " have ", volume, " m3, and it has ",
                   expected);
    }

    void check_fragment(ElementId e) {
        check_part_shares(e);
        if (!(fragments_.volume_share(e) > 0.0 && std::isfinite(fragments_.volume_share(e))))
            report("fragment ", e.value, " has the share ", fragments_.volume_share(e));
        if (fragments_.cells_of(e).empty()) report("fragment ", e.value, " has no element");
        for (const CellId cell : fragments_.cells_of(e))
            if (!mesh_.is_alive(cell) || fragments_.fragment_of_cell(cell) != e)
                report("fragment ", e.value, " has element ", cell.value, ", which is not its own");
        const auto corners = fragments_.corners(e);
        const auto origins = fragments_.origins_of(fragments_.carrier(e));
        for (std::size_t k = 0; k < corners.size(); ++k)
            if (!fragments_.is_alive(corners[k]) || fragments_.origin(corners[k]) != origins[k])
                report("corner ", k, " of fragment ", e.value, " is not one of its carrier");
    }

    void check_face(FaceId face) {
        const CellId other = mesh_.neighbor(face).cell;
        if (!other.is_valid() || face.cell > other) return;
        const ElementId a = fragments_.fragment_of_cell(face.cell),
                        b = fragments_.fragment_of_cell(other);
        if (fragments_.carrier_of_cell(face.cell) == fragments_.carrier_of_cell(other)) {
            if (a != b ||
                fragments_.is_carried_around(face.cell) != fragments_.is_carried_around(other))
                report("elements ", face.cell.value, " and ", other.value,
                       " hang together in different fragments");
            return;
        }
        if (!fragments_.is_own(face.cell) || !fragments_.is_own(other)) return;
        std::size_t num_shared = 0, num_common = 0;
        for (const NodeId m : fragments_.corners(a))
            for (const NodeId n : fragments_.corners(b)) {
                num_shared += m == n ? 1 : 0;
                num_common += fragments_.origin(m) == fragments_.origin(n) ? 1 : 0;
            }
        constexpr std::size_t least = 3;  // of a face of the carriers, whatever part the face is
        if (num_shared < least || num_shared != num_common)
            report("fragments ", a.value, " and ", b.value,
                   " do not share the nodes of their face");
    }

    const FragmentMesh& fragments_;
    const Mesh& mesh_;
    std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> validate(const FragmentMesh& fragments, const Mesh& mesh) {
    return FragmentCheck(fragments, mesh).run();
}

}  // namespace incise::fragments
