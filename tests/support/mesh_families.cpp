// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/mesh_families.h"

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "incise/base/error.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "support/num_cases.h"

namespace incise::test {

using namespace topology;

namespace {

MeshData tetrahedra(std::vector<Vec3> points,
                    const std::vector<std::array<std::int64_t, 4>>& tets) {
    MeshData data;
    data.points = std::move(points);
    for (const auto& tet : tets) data.add_cell(CellKind::tetrahedron, tet);
    return data;
}

MeshData ball(int n) {
    // A cube whose concentric shells are drawn onto spheres.
    MeshData data = jittered_cube(n, 0.0, 0);
    for (Vec3& x : data.points) {
        const Vec3 y = 2.0 * (x - Vec3::Constant(0.5));
        const double size = y.cwiseAbs().maxCoeff();
        x = size == 0.0 ? Vec3::Zero().eval() : (size / y.norm() * y).eval();
    }
    return data;
}

MeshData ring(int around) {
    // A bar whose ends are joined: the last layer of points is the first one.
    MeshData bar = box_mesh(CellKind::tetrahedron, Vec3::Zero(), {1, 1, 1}, {2, 2, around});
    const std::int64_t layer = 9;
    const auto num_points = static_cast<std::int64_t>(bar.points.size()) - layer;
    for (std::int64_t& corner : bar.corners) corner %= num_points;
    bar.points.resize(static_cast<std::size_t>(num_points));
    for (Vec3& x : bar.points) {
        const double angle = 2.0 * std::numbers::pi * x.z();
        const double radius = 1.0 + 0.6 * x.x();
        x = Vec3(radius * std::cos(angle), radius * std::sin(angle), -0.6 * x.y());
    }
    return bar;
}

MeshData organ() {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/organ_ellipsoid.json");
    const auto json = nlohmann::json::parse(file);
    MeshData data;
    for (const auto& x : json["nodes"]) data.points.emplace_back(x[0], x[1], x[2]);
    for (const auto& t : json["tets"])
        data.add_cell(CellKind::tetrahedron, t.get<std::vector<std::int64_t>>());
    return data;
}

// A hexahedron with a pyramid on one side, a wedge on another, and tetrahedra on the free
// triangles of both.
MeshData mixed() {
    MeshData data;
    data.points = {{0, 0, 0},     {1, 0, 0},      {1, 1, 0},      {0, 1, 0}, {0, 0, 1},
                   {1, 0, 1},     {1, 1, 1},      {0, 1, 1},      {2, 0, 0}, {2, 0, 1},
                   {0.5, 0.5, 2}, {1.5, -1, 0.5}, {1.6, 1.2, 1.4}};
    const auto add = [&](CellKind kind, std::vector<std::int64_t> corners) {
        data.add_cell(kind, corners, static_cast<int>(kind));
    };
    add(CellKind::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    add(CellKind::pyramid, {4, 5, 6, 7, 10});
    // The wedge's quadrilateral 1, 2, 6, 5 is the hexahedron's far face in x.
    add(CellKind::wedge, {1, 2, 8, 5, 6, 9});
    add(CellKind::tetrahedron, {6, 5, 9, 12});
    add(CellKind::tetrahedron, {6, 5, 12, 10});
    return data;
}

std::vector<CellId> living_elements(const Mesh& mesh) {
    std::vector<CellId> alive;
    for (const CellId e : mesh.elements()) alive.push_back(e);
    return alive;
}

std::pair<VertexId, VertexId> longest_edge(const Mesh& mesh, CellId e) {
    std::pair<VertexId, VertexId> longest;
    double length = 0.01;  // of tiny elements rounding would make flat ones
    for (const auto& [a, b] : traits(mesh.kind(e)).edges) {
        if (a == b) continue;  // beyond the last
        const VertexId from = mesh.corners(e)[static_cast<std::size_t>(a)];
        const VertexId to = mesh.corners(e)[static_cast<std::size_t>(b)];
        const double l = (mesh.rest_position(from) - mesh.rest_position(to)).norm();
        if (l > length) {
            length = l;
            longest = {from, to};
        }
    }
    return longest;
}

bool is_among_tetrahedra(const Mesh& mesh, VertexId n) {
    std::vector<CellId> star;
    mesh.star(n, star);
    return std::all_of(star.begin(), star.end(),
                       [&](CellId e) { return mesh.kind(e) == CellKind::tetrahedron; });
}

}  // namespace

namespace {

using Row = std::vector<std::int64_t>;

/// Divides bricks at random. Two triangles on one side of a face between bricks, and two on the
/// other, share the same diagonal.
class JoinedBricks {
  public:
    JoinedBricks(MeshData& data, std::uint64_t seed) : data_(data), random_(seed + 1) {}

    /// @param p  the corners, as those of a hexahedron
    void add(const Row& p) {
        const std::size_t kind = random_.below(5);
        if (kind == 0) return data_.add_cell(CellKind::hexahedron, p);
        if (kind == 1 && add_wedges(p, random_.below(3))) return;
        if (kind == 2 && add_kuhn(p)) return;
        add_cone(p, kind == 3 ? 1.0 : 0.5);
    }

  private:
    using Ends = std::pair<std::int64_t, std::int64_t>;

    static Row face_of(const Row& p, int f) {
        Row face;
        for (const int c : traits(CellKind::hexahedron).face(f))
            face.push_back(p[static_cast<std::size_t>(c)]);
        return face;
    }
    static Row key(Row face) {
        std::sort(face.begin(), face.end());
        return face;
    }

    /// Sets the diagonals of faces, unless one of them has another one already.
    bool set_diagonals(const std::vector<std::pair<Row, Ends>>& all) {
        for (const auto& [face, ends] : all)
            if (const auto it = diagonals_.find(key(face));
                it != diagonals_.end() && it->second != Ends(std::minmax(ends.first, ends.second)))
                return false;
        for (const auto& [face, ends] : all)
            diagonals_[key(face)] = Ends(std::minmax(ends.first, ends.second));
        return true;
    }
    /// Returns the position in a face of one end of its diagonal, which is random if it is new.
    std::size_t first_end(const Row& face) {
        const std::size_t any = random_.below(2);
        const auto it =
            diagonals_.try_emplace(key(face), Ends(std::minmax(face[any], face[any + 2]))).first;
        return face[0] == it->second.first || face[0] == it->second.second ? 0 : 1;
    }

    /// Adds two wedges whose triangles are on the faces across an axis.
    bool add_wedges(const Row& p, std::size_t axis) {
        constexpr std::array<std::array<std::size_t, 8>, 3> turned = {
            {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 4, 5, 1, 3, 7, 6, 2}, {0, 3, 7, 4, 1, 2, 6, 5}}};
        Row q;
        for (const std::size_t k : turned[axis]) q.push_back(p[k]);
        if (!set_diagonals({{{q[0], q[1], q[2], q[3]}, {q[0], q[2]}},
                            {{q[4], q[5], q[6], q[7]}, {q[4], q[6]}}}))
            return false;
        data_.add_cell(CellKind::wedge, Row{q[0], q[2], q[1], q[4], q[6], q[5]});
        data_.add_cell(CellKind::wedge, Row{q[0], q[3], q[2], q[4], q[7], q[6]});
        return true;
    }

    /// Adds six tetrahedra about the diagonal from corner 0 to corner 6.
    bool add_kuhn(const Row& p) {
        std::vector<std::pair<Row, Ends>> all;
        for (int f = 0; f < 6; ++f) {
            const Row face = face_of(p, f);
            const std::size_t first =
                face[0] == p[0] || face[0] == p[6] || face[2] == p[0] || face[2] == p[6] ? 0 : 1;
            all.emplace_back(face, Ends{face[first], face[first + 2]});
        }
        if (!set_diagonals(all)) return false;
        for (const auto& [a, b] : {std::pair(1, 2), {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}})
            data_.add_cell(CellKind::tetrahedron, Row{p[0], p[static_cast<std::size_t>(a)],
                                                      p[static_cast<std::size_t>(b)], p[6]});
        return true;
    }

    /// Adds a pyramid or two tetrahedra on each face, with a point at the centre.
    void add_cone(const Row& p, double share_of_tetrahedra) {
        Vec3 centre = Vec3::Zero();
        for (const std::int64_t at : p) centre += data_.points[static_cast<std::size_t>(at)] / 8.0;
        data_.points.push_back(centre);
        const std::int64_t apex = std::ssize(data_.points) - 1;
        for (int f = 0; f < 6; ++f) {
            const Row out = face_of(p, f), in{out.rbegin(), out.rend()};
            if (random_.uniform() >= share_of_tetrahedra) {
                data_.add_cell(CellKind::pyramid, Row{in[0], in[1], in[2], in[3], apex});
                continue;
            }
            const std::size_t k = first_end(in);
            for (const std::size_t first : {k, k + 2})
                data_.add_cell(CellKind::tetrahedron,
                               Row{in[first % 4], in[(first + 1) % 4], in[(first + 2) % 4], apex});
        }
    }

    MeshData& data_;
    Random random_;
    std::map<Row, Ends> diagonals_;  // by the sorted corners of a face
};

}  // namespace

MeshData brick_cube(Bricks bricks, int n, double jitter, std::uint64_t seed) {
    MeshData data;
    Random random(seed);
    const auto point = [&](int i, int j, int k) {
        return std::int64_t{(n + 1) * ((n + 1) * k + j) + i};
    };
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                Vec3 x = Vec3(i, j, k) / n;
                for (int c = 0; c < 3; ++c)
                    if (const double shift = random.uniform(-jitter, jitter) / n;
                        x[c] > 0.0 && x[c] < 1.0)
                        x[c] += shift;
                data.points.push_back(x);
            }
    JoinedBricks joined(data, seed);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Row p{point(i, j, k),
                            point(i + 1, j, k),
                            point(i + 1, j + 1, k),
                            point(i, j + 1, k),
                            point(i, j, k + 1),
                            point(i + 1, j, k + 1),
                            point(i + 1, j + 1, k + 1),
                            point(i, j + 1, k + 1)};
                const bool is_mixed = bricks == Bricks::mixed;
                // The same all along a column.
                if (bricks == Bricks::joined) {
                    joined.add(p);
                } else if (bricks == Bricks::wedges || (is_mixed && (i + 2 * j) % 3 == 0)) {
                    data.add_cell(CellKind::wedge, Row{p[0], p[2], p[1], p[4], p[6], p[5]});
                    data.add_cell(CellKind::wedge, Row{p[0], p[3], p[2], p[4], p[7], p[6]});
                } else if (bricks == Bricks::pyramids || (is_mixed && (i + j + k) % 2 == 0)) {
                    Vec3 centre = Vec3::Zero();
                    for (const std::int64_t at : p)
                        centre += data.points[static_cast<std::size_t>(at)] / 8.0;
                    data.points.push_back(centre);
                    const auto& hexahedron = traits(CellKind::hexahedron);
                    for (int f = 0; f < 6; ++f) {
                        Row row;  // the base of a pyramid runs the other way, seen from outside
                        for (const int c : hexahedron.face(f))
                            row.insert(row.begin(), p[static_cast<std::size_t>(c)]);
                        row.push_back(std::ssize(data.points) - 1);
                        data.add_cell(CellKind::pyramid, row);
                    }
                } else {
                    data.add_cell(CellKind::hexahedron, p);
                }
            }
    return data;
}

MeshData jittered_cube(int n, double jitter, std::uint64_t seed) {
    MeshData data = box_mesh(CellKind::tetrahedron, Vec3::Zero(), Vec3::Ones(), {n, n, n});
    Random random(seed);
    for (Vec3& x : data.points) {
        const Vec3 shift = random.vector(jitter / n);
        for (int c = 0; c < 3; ++c)
            if (x[c] > 0.0 && x[c] < 1.0) x[c] += shift[c];
    }
    return data;
}

MeshData soup_of(const MeshData& data) {
    MeshData soup = data;
    soup.points.clear();
    for (std::int64_t& corner : soup.corners) {
        soup.points.push_back(data.points[static_cast<std::size_t>(corner)]);
        corner = std::ssize(soup.points) - 1;
    }
    return soup;
}

/// Cubes whose centres are in a ball that has a hollow; some meet at edges and corners only.
MeshData voxels() {
    constexpr int n = 6;
    const MeshData all =
        box_mesh(CellKind::hexahedron, Vec3::Constant(-1.0), Vec3::Constant(2.0), {n, n, n});
    MeshData data;
    std::vector<std::int64_t> number(all.points.size(), -1);
    for (std::size_t c = 0; c < all.num_cells(); ++c) {
        Vec3 centre = Vec3::Zero();
        for (const auto corner : all.cell(c))
            centre += all.points[static_cast<std::size_t>(corner)] / 8.0;
        if (centre.norm() > 1.0 || (centre - Vec3(0.2, 0.1, 0.3)).norm() < 0.45) continue;
        std::vector<std::int64_t> corners;
        for (const auto corner : all.cell(c)) {
            auto& n_new = number[static_cast<std::size_t>(corner)];
            if (n_new < 0) {
                n_new = static_cast<std::int64_t>(data.points.size());
                data.points.push_back(all.points[static_cast<std::size_t>(corner)]);
            }
            corners.push_back(n_new);
        }
        data.add_cell(CellKind::hexahedron, corners);
    }
    return data;
}

const std::vector<MeshFamily>& mesh_families() {
    static const std::vector<MeshFamily> families = [] {
        const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0},
                                          {0, 0, 1}, {1, 1, 1.1}, {0.9, -1, 1}};
        std::vector<MeshFamily> all;
        all.push_back(
            {"one tetrahedron", tetrahedra({points.begin(), points.begin() + 4}, {{0, 1, 2, 3}})});
        all.push_back({"two by a face", tetrahedra({points.begin(), points.begin() + 5},
                                                   {{0, 1, 2, 3}, {3, 1, 2, 4}})});
        all.push_back(
            {"two by an edge",
             tetrahedra(
                 {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {1, 1, 0.5}, {-1, 0, 0.5}, {-1, -1, 0.5}},
                 {{0, 2, 3, 1}, {0, 4, 5, 1}})});
        all.push_back({"cube", jittered_cube(4, 0.2, 7)});
        all.push_back({"ring", ring(12)});
        all.push_back({"ball", ball(4)});
        all.push_back({"organ", organ()});
        all.push_back(
            {"hexahedra", box_mesh(CellKind::hexahedron, {-1, 0, 2}, {1, 1.25, 1.8}, {4, 4, 6})});
        all.push_back({"voxels", voxels()});
        all.push_back({"mixed", mixed()});
        all.push_back({"joined", brick_cube(Bricks::joined, 2, 0.08, 3)});
        return all;
    }();
    return families;
}

std::vector<const MeshFamily*> families_of(CellKind kind) {
    constexpr std::size_t most_cells = 400;
    std::vector<const MeshFamily*> families;
    for (const MeshFamily& family : mesh_families())
        if (!(is_sanitized && family.data.num_cells() > most_cells) &&
            std::all_of(family.data.kinds.begin(), family.data.kinds.end(),
                        [&](CellKind of_cell) { return of_cell == kind; }))
            families.push_back(&family);
    return families;
}

std::vector<const MeshFamily*> tetrahedral_families() { return families_of(CellKind::tetrahedron); }

std::vector<FaceId> inner_faces(const Mesh& mesh) {
    std::vector<FaceId> faces;
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < mesh.num_faces(e); ++f)
            if (FaceId{e, f} < mesh.neighbor({e, f})) faces.push_back({e, f});
    return faces;
}

std::vector<FacePair> open_pairs(const Mesh& mesh) {
    std::map<std::vector<double>, FaceId> seen;
    std::vector<FacePair> pairs;
    for (const FaceId f : boundary_faces(mesh)) {
        std::vector<std::array<double, 3>> corners;
        for (int p = 0; p < mesh.face_size(f); ++p) {
            const Vec3& x = mesh.rest_position(mesh.face_corner(f, p));
            corners.push_back({x.x(), x.y(), x.z()});
        }
        std::sort(corners.begin(), corners.end());
        std::vector<double> key;
        for (const auto& c : corners) key.insert(key.end(), c.begin(), c.end());
        const auto [place, is_new] = seen.try_emplace(key, f);
        if (!is_new) pairs.push_back({place->second, f});
    }
    return pairs;
}

ChangeSet random_edit(Mesh& mesh, Random& random) {
    MeshEdit edit(mesh);
    const std::size_t kind = random.below(6);
    const auto elements = living_elements(mesh);
    if (elements.empty()) return edit.commit();
    const std::size_t budget = 1 + (random.below(4) == 0 ? elements.size() / 20 : 0);

    if (kind == 0 || kind == 3) {  // removals, scattered or side by side
        std::vector<CellId> pending{elements[random.below(elements.size())]};
        for (std::size_t i = 0; i < budget && !pending.empty(); ++i) {
            const CellId e = pending.back();
            pending.pop_back();
            if (!mesh.is_alive(e)) continue;
            for (int f = 0; f < mesh.num_faces(e); ++f)
                if (mesh.neighbor({e, f}).is_valid()) pending.push_back(mesh.neighbor({e, f}).cell);
            edit.remove(e);
        }
    }
    if (kind == 1 || kind == 3) {  // openings: those across a random plane, or any
        const auto faces = inner_faces(mesh);
        const std::size_t count = faces.empty() ? 0 : 1 + random.below(3 * budget + 2);
        for (std::size_t i = 0; i < count; ++i) {
            const FaceId f = faces[random.below(faces.size())];
            if (mesh.is_alive(f.cell) && mesh.neighbor(f).is_valid()) edit.open(f);
        }
    }
    if (kind == 2) {  // all faces whose elements lie on two sides of a plane, in part of the body
        const FaceId through = [&] {
            const auto faces = inner_faces(mesh);
            return faces.empty() ? FaceId{} : faces[random.below(faces.size())];
        }();
        if (through.is_valid()) {
            const Vec3 normal = random.vector(1.0);
            const Vec3& point = mesh.rest_position(mesh.face_corner(through, 0));
            const auto side = [&](CellId e) {
                Vec3 sum = Vec3::Zero();
                for (const VertexId n : mesh.corners(e)) sum += mesh.rest_position(n) - point;
                return sum.dot(normal) > 0.0;
            };
            const double share = random.uniform();
            for (const FaceId f : inner_faces(mesh))
                if (side(f.cell) != side(mesh.neighbor(f).cell) && random.uniform() < share)
                    edit.open(f);
        }
    }
    if (kind == 5) {  // edges divided, near each other; then some of the faces about opened
        CellId e = elements[random.below(elements.size())];
        for (std::size_t i = 0; i < 2 * budget; ++i) {
            if (mesh.kind(e) != CellKind::tetrahedron) break;
            const auto [from, to] = longest_edge(mesh, e);  // any other would soon make slivers
            if (!from.is_valid() || !is_among_tetrahedra(mesh, from)) break;
            const MeshEdit::Bisection& halves =
                edit.bisect(e, from, to, random.uniform(0.25, 0.75));
            const auto& last = halves.elements[random.below(halves.elements.size())];
            for (const CellId part : {last.kept, last.added})
                for (int f = 0; f < 4; ++f)
                    if (mesh.neighbor({part, f}).is_valid() && random.below(4) == 0)
                        edit.open({part, f});
            e = random.below(2) == 0 ? last.kept : last.added;
        }
    }
    if (kind == 4 || kind == 3) {  // closings
        const auto pairs = open_pairs(mesh);
        const std::size_t count = pairs.empty() ? 0 : 1 + random.below(pairs.size());
        for (std::size_t i = 0; i < count; ++i) {
            const FacePair pair = pairs[random.below(pairs.size())];
            if (!mesh.neighbor(pair.a).is_valid() && !mesh.neighbor(pair.b).is_valid() &&
                pair.a.cell != pair.b.cell)
                edit.close(pair.a, pair.b);
        }
    }
    return edit.commit();
}

}  // namespace incise::test
