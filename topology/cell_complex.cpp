// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_complex.h"

#include <algorithm>
#include <cassert>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

namespace incise::topology {

using Dart = CellComplex::Dart;

namespace {

/// A direction from a corner of a cell to another one, as one number.
std::size_t key_of(int from, int to) {
    return std::size_t{max_corners} * static_cast<std::size_t>(from) + static_cast<std::size_t>(to);
}

}  // namespace

Dart CellComplex::create(Vertex v, Volume e) {
    const Dart d = map_.create_dart();
    map_.set_dart_attribute<0>(d, v);
    map_.set_dart_attribute<3>(d, e);
    return d;
}

// CGAL erases a vertex with its last dart, and tells nobody.
void CellComplex::erase(Dart d) {
    const Vertex v = map_.attribute<0>(d);
    if (map_.get_attribute_ref_counting<0>(v) == 1)
        vertices_[map_.info_of_attribute<0>(v).index()] = nullptr;
    map_.erase_dart(d);
}

CellComplex::Vertex CellComplex::vertex_for(VertexId v, const Vec3& x) {
    if (v.index() >= vertices_.size()) vertices_.resize(v.index() + 1, nullptr);
    Vertex& vertex = vertices_[v.index()];
    if (vertex == nullptr) {
        vertex = map_.create_vertex_attribute(Map::Point(x.x(), x.y(), x.z()));
        map_.info_of_attribute<0>(vertex) = v;
    }
    return vertex;
}

CellComplex::Volume CellComplex::add_volume(CellId e) {
    const Volume volume = map_.create_attribute<3>();
    map_.info_of_attribute<3>(volume) = e;
    if (e.index() >= darts_.size()) darts_.resize(e.index() + 1, nullptr);
    return volume;
}

void CellComplex::set_dart_of(CellId e, Dart d) {
    darts_[e.index()] = d;
    map_.set_dart_of_attribute<3>(map_.attribute<3>(d), d);
}

template <class Visit>
void CellComplex::for_each_dart_of_cell(Dart start, Visit visit) const {
    std::vector<Dart> found{start};
    std::unordered_set<Dart> known{start};
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const Dart d : {next(found[i]), opposite(found[i])})
            if (known.insert(d).second) found.push_back(d);
        visit(found[i]);
    }
}

void CellComplex::face(Dart d, std::vector<Dart>& darts) const {
    const Dart first = d;
    do {
        darts.push_back(d);
        d = next(d);
    } while (d != first);
}

void CellComplex::faces(CellId e, std::vector<Dart>& faces) const {
    std::unordered_set<Dart> known;
    for_each_dart_of_cell(dart_of(e), [&](Dart d) {
        if (known.contains(d)) return;
        faces.push_back(d);
        for (Dart walking = d; known.insert(walking).second;) walking = next(walking);
    });
}

Vec3 CellComplex::area(Dart d) const {
    const Vec3 apex = position(d);
    Vec3 sum = Vec3::Zero();
    for (Dart walking = next(d); next(walking) != d; walking = next(walking))
        sum += 0.5 * (position(walking) - apex).cross(position(next(walking)) - apex);
    return sum;
}

double CellComplex::volume(CellId e) const {
    std::vector<Dart> of_cell;
    faces(e, of_cell);
    const Vec3 apex = position(of_cell.front());
    double sum = 0.0;
    for (const Dart f : of_cell) {
        const Vec3 corner = position(f) - apex;
        for (Dart d = next(f); next(d) != f; d = next(d))
            sum += corner.dot((position(d) - apex).cross(position(next(d)) - apex));
    }
    return sum / 6.0;
}

void CellComplex::add(CellId e, CellKind kind, std::span<const VertexId> corners,
                      std::span<const Vec3> x) {
    const CellTraits& t = traits(kind);
    const Volume volume = add_volume(e);
    std::array<Vertex, max_corners> vertices;
    for (std::size_t k = 0; k < corners.size(); ++k) vertices[k] = vertex_for(corners[k], x[k]);
    std::array<Dart, max_corners * max_corners> darts{};  // by their ends
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        std::array<Dart, max_face_corners> row{};
        for (std::size_t p = 0; p < face.size(); ++p) {
            row[p] = create(vertices[static_cast<std::size_t>(face[p])], volume);
            darts[key_of(face[p], face[(p + 1) % face.size()])] = row[p];
        }
        for (std::size_t p = 0; p < face.size(); ++p)
            map_.basic_link_beta_1(row[p], row[(p + 1) % face.size()]);
        if (f == 0) set_dart_of(e, row[0]);
    }
    for (int edge = 0; edge < t.num_edges; ++edge) {
        const auto [a, b] = t.edges[static_cast<std::size_t>(edge)];
        map_.basic_link_beta_for_involution<2>(darts[key_of(a, b)], darts[key_of(b, a)]);
    }
}

void CellComplex::remove(CellId e, std::vector<Dart>& opened) {
    std::vector<Dart> of_cell, others;
    for_each_dart_of_cell(dart_of(e), [&](Dart d) { of_cell.push_back(d); });
    faces(e, others);
    for (const Dart f : others)
        if (across(f) != nullptr) opened.push_back(open(f));
    // Vertices that another cell has without a joined face get one of its darts: rare, so that a
    // search of the whole map is good enough.
    std::unordered_set<Vertex> alone;
    for (const Dart d : of_cell)
        if (const Vertex v = map_.attribute<0>(d); cell(map_.dart_of_attribute<0>(v)) == e)
            alone.insert(v);
    std::unordered_map<Vertex, std::size_t> counts;
    for (const Dart d : of_cell) ++counts[map_.attribute<0>(d)];
    std::erase_if(alone, [&](Vertex v) {
        return map_.get_attribute_ref_counting<0>(v) == counts[v];  // it goes with the cell
    });
    for (auto d = map_.darts().begin(); !alone.empty() && d != map_.darts().end(); ++d)
        if (cell(d) != e && alone.erase(map_.attribute<0>(d)) > 0)
            map_.set_dart_of_attribute<0>(map_.attribute<0>(d), d);
    for (const Dart d : of_cell) erase(d);
    darts_[e.index()] = nullptr;
}

void CellComplex::join(Dart a, Dart b) {
    const Dart first = a;
    do {
        map_.basic_link_beta_for_involution<3>(a, b);
        a = next(a);
        b = previous(b);
    } while (a != first);
}

Dart CellComplex::open(Dart d) {
    const Dart other = across(d);
    Dart walking = d;
    do {
        // Either side may be removed next: then the vertex belongs to the other one.
        const Dart far = across(walking);
        map_.set_dart_of_attribute<0>(map_.attribute<0>(far), far);
        map_.unlink_beta_for_involution<3>(walking);
        walking = next(walking);
    } while (walking != d);
    return other;
}

namespace {

/// Appends the darts along an edge in the direction of `d`, one for each cell at it.
void collect_edge(const CellComplex& map, Dart d, std::vector<Dart>& darts) {
    for (Dart at = d;;) {
        darts.push_back(at);
        const Dart far = map.across(map.opposite(at));
        if (far == d) return;
        if (far == nullptr) break;
        at = far;
    }
    for (Dart far = map.across(d); far != nullptr;) {
        const Dart at = map.opposite(far);
        darts.push_back(at);
        far = map.across(at);
    }
}

}  // namespace

Dart CellComplex::divide_edge(Dart d, VertexId v, const Vec3& x) {
    std::vector<Dart> ring;
    collect_edge(*this, d, ring);
    const Vertex middle = vertex_for(v, x);
    for (const Dart a : ring) {
        const Dart b = opposite(a), after_a = next(a), after_b = next(b);
        const Volume volume = map_.attribute<3>(a);
        const Dart a2 = create(middle, volume), b2 = create(middle, volume);
        map_.basic_link_beta_1(a2, after_a);
        map_.basic_link_beta_1(a, a2);
        map_.basic_link_beta_1(b2, after_b);
        map_.basic_link_beta_1(b, b2);
        map_.basic_link_beta_for_involution<2>(a, b2);
        map_.basic_link_beta_for_involution<2>(a2, b);
    }
    for (const Dart a : ring)
        if (const Dart far = across(a); far != nullptr) {
            const Dart a2 = next(a), far2 = next(far);
            map_.basic_link_beta_for_involution<3>(a, far2);
            map_.basic_link_beta_for_involution<3>(a2, far);
        }
    return next(d);
}

void CellComplex::join_edge(Dart d) {
    std::vector<Dart> ring;
    collect_edge(*this, d, ring);
    // All links are read before the first one changes.
    struct Half {
        Dart gone, kept, kept_across;  // the dart behind the vertex, the one before it
    };
    std::vector<Half> halves;
    for (const Dart a2 : ring) {
        const Dart b2 = next(opposite(a2));
        halves.push_back({a2, previous(a2), across(a2)});
        halves.push_back({b2, previous(b2), across(b2)});
    }
    for (std::size_t i = 0; i < halves.size(); i += 2) {
        for (const std::size_t k : {i, i + 1})
            map_.basic_link_beta_1(halves[k].kept, next(halves[k].gone));
        map_.basic_link_beta_for_involution<2>(halves[i].kept, halves[i + 1].kept);
    }
    for (const Half& half : halves)
        if (half.kept_across != nullptr)
            map_.basic_link_beta_for_involution<3>(half.kept, half.kept_across);
    for (const Half& half : halves) {
        const CellId e = cell(half.gone);
        set_dart_of(e, half.kept);
        erase(half.gone);
    }
}

Dart CellComplex::divide_face(Dart from, Dart to) {
    const Dart before_from = previous(from), before_to = previous(to);
    const Volume volume = map_.attribute<3>(from);
    const Dart n = create(map_.attribute<0>(from), volume);
    const Dart m = create(map_.attribute<0>(to), volume);
    const Dart far_from = across(from), far_to = across(to);
    const Dart far_before_from = across(before_from), far_before_to = across(before_to);
    map_.basic_link_beta_1(n, to);
    map_.basic_link_beta_1(before_from, n);
    map_.basic_link_beta_1(m, from);
    map_.basic_link_beta_1(before_to, m);
    map_.basic_link_beta_for_involution<2>(n, m);
    if (far_from == nullptr) return n;
    // On the other side, darts that start at the two corners are across those that end there.
    const Volume other = map_.attribute<3>(far_from);
    const Dart far_n = create(map_.attribute<0>(far_before_to), other);
    const Dart far_m = create(map_.attribute<0>(far_before_from), other);
    map_.basic_link_beta_1(far_to, far_n);
    map_.basic_link_beta_1(far_n, far_before_from);
    map_.basic_link_beta_1(far_from, far_m);
    map_.basic_link_beta_1(far_m, far_before_to);
    map_.basic_link_beta_for_involution<2>(far_n, far_m);
    map_.basic_link_beta_for_involution<3>(n, far_n);
    map_.basic_link_beta_for_involution<3>(m, far_m);
    return n;
}

void CellComplex::join_faces(Dart d) {
    const auto join_side = [&](Dart n) {
        const Dart m = opposite(n);
        const Dart to = next(n), from = next(m), before_from = previous(n), before_to = previous(m);
        map_.basic_link_beta_1(before_from, from);
        map_.basic_link_beta_1(before_to, to);
        map_.set_dart_of_attribute<0>(map_.attribute<0>(from), from);
        map_.set_dart_of_attribute<0>(map_.attribute<0>(to), to);
        set_dart_of(cell(n), from);
        erase(n);
        erase(m);
    };
    const Dart far = across(d);
    join_side(d);
    if (far != nullptr) join_side(far);
}

Dart CellComplex::divide_cell(std::span<const Dart> loop, CellId e) {
    const CellId kept = cell(loop.front());
    const Volume volume = map_.attribute<3>(loop.front()), added = add_volume(e);
    const std::size_t size = loop.size();
    std::vector<Dart> near, far;  // of the new face: in the cell that stays, and in the new one
    for (std::size_t i = 0; i < size; ++i) {
        const Dart right = opposite(loop[i]);
        near.push_back(create(map_.attribute<0>(right), volume));
        far.push_back(create(map_.attribute<0>(loop[i]), added));
        map_.basic_link_beta_for_involution<2>(near[i], loop[i]);
        map_.basic_link_beta_for_involution<2>(far[i], right);
        map_.basic_link_beta_for_involution<3>(near[i], far[i]);
    }
    for (std::size_t i = 0; i < size; ++i) {
        map_.basic_link_beta_1(far[i], far[(i + 1) % size]);
        map_.basic_link_beta_1(near[(i + 1) % size], near[i]);
    }
    for_each_dart_of_cell(far.front(), [&](Dart d) { map_.set_dart_attribute<3>(d, added); });
    set_dart_of(kept, near.front());
    set_dart_of(e, far.front());
    return far.front();
}

void CellComplex::join_cells(Dart d) {
    std::vector<Dart> far;
    face(d, far);
    const CellId gone = cell(d), kept = cell(across(d));
    const Volume volume = map_.attribute<3>(across(d));
    const Dart stays = opposite(across(d));
    std::vector<Dart> near;
    near.reserve(far.size());
    for (const Dart f : far) near.push_back(across(f));
    std::vector<Dart> moved;
    for_each_dart_of_cell(d, [&](Dart f) { moved.push_back(f); });
    for (std::size_t i = 0; i < far.size(); ++i) {
        const Dart left = opposite(near[i]), right = opposite(far[i]);
        map_.basic_link_beta_for_involution<2>(left, right);
        map_.set_dart_of_attribute<0>(map_.attribute<0>(left), left);
    }
    for (const Dart f : moved) map_.set_dart_attribute<3>(f, volume);
    set_dart_of(kept, stays);
    darts_[gone.index()] = nullptr;
    for (std::size_t i = 0; i < far.size(); ++i) {
        erase(far[i]);
        erase(near[i]);
    }
}

CellId CellComplex::star(Dart d, std::vector<Dart>& darts) const {
    const std::size_t begin = darts.size();
    std::unordered_set<Dart> known{d};
    darts.push_back(d);
    CellId lowest = cell(d);
    for (std::size_t i = begin; i < darts.size(); ++i) {
        lowest = std::min(lowest, cell(darts[i]));
        const Dart before = previous(darts[i]);
        for (const Dart other : {opposite(before), across(before)})
            if (other != nullptr && known.insert(other).second) darts.push_back(other);
    }
    return lowest;
}

void CellComplex::set_vertex(Dart d, VertexId v, const Vec3& x) {
    std::vector<Dart> darts;
    star(d, darts);
    const Vertex vertex = vertex_for(v, x);
    for (const Dart at : darts) {
        const Vertex former = map_.attribute<0>(at);
        if (former == vertex) continue;
        if (map_.get_attribute_ref_counting<0>(former) == 1)
            vertices_[map_.info_of_attribute<0>(former).index()] = nullptr;
        map_.set_dart_attribute<0>(at, vertex);
    }
    map_.set_dart_of_attribute<0>(vertex, d);
}

std::vector<std::string> CellComplex::faults(double least_volume) const {
    std::vector<std::string> found;
    const auto report = [&](auto&&... parts) {
        std::ostringstream text;
        (text << ... << parts);
        found.push_back(text.str());
    };
    std::unordered_map<Vertex, std::size_t> starts;
    for (std::size_t i = 0; i < darts_.size(); ++i) {
        if (darts_[i] == nullptr) continue;
        const CellId e(i);
        std::size_t num_darts = 0;
        std::unordered_set<Vertex> vertices;
        for_each_dart_of_cell(darts_[i], [&](Dart d) {
            ++num_darts;
            ++starts[map().attribute<0>(d)];
            vertices.insert(map().attribute<0>(d));
            if (cell(d) != e) report("cell ", i, ": a dart of cell ", cell(d).value);
            if (previous(next(d)) != d) report("cell ", i, ": a face is no cycle");
            const Dart other = opposite(d);
            if (other == d || opposite(other) != d || vertex(other) != vertex(next(d)) ||
                vertex(next(other)) != vertex(d))
                report("cell ", i, ": an edge has other ends in its two faces");
            if (const Dart far = across(d);
                far != nullptr && (across(far) != d || vertex(far) != vertex(next(d)) ||
                                   across(next(d)) != previous(far)))
                report("cell ", i, ": a face has other corners on its other side");
        });
        std::vector<Dart> of_cell;
        faces(e, of_cell);
        for (const Dart f : of_cell) {
            std::vector<Dart> darts;
            face(f, darts);
            std::unordered_set<Vertex> corners;
            for (const Dart d : darts)
                if (!corners.insert(map().attribute<0>(d)).second)
                    report("cell ", i, ": a face meets vertex ", vertex(d).value, " twice");
            if (darts.size() < 3) report("cell ", i, ": a face of two corners");
        }
        const auto euler = static_cast<std::ptrdiff_t>(vertices.size() + of_cell.size()) -
                           static_cast<std::ptrdiff_t>(num_darts / 2);
        if (euler != 2) report("cell ", i, " is no ball: its Euler number is ", euler);
        if (const double v = volume(e); !(v >= least_volume))
            report("cell ", i, " has a volume of ", v, " m3");
    }
    for (const auto& [v, count] : starts)
        if (map().attribute<0>(map().dart_of_attribute<0>(v)) != v)
            report("vertex ", map().info_of_attribute<0>(v).value, " has a dart of another one");
    for (const auto& [v, count] : starts)
        if (map().get_attribute_ref_counting<0>(v) != count)
            report("vertex ", map().info_of_attribute<0>(v).value, " is counted wrong");
    std::size_t num_darts = 0;
    for (const auto& [v, count] : starts) num_darts += count;
    if (num_darts != map_.number_of_darts()) report("there are darts of no cell");
    return found;
}

}  // namespace incise::topology
