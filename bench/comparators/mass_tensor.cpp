// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/mass_tensor.h"

#include <map>
#include <tuple>

namespace incise::bench {

namespace {

/// Sums of the coefficients of one node.
struct Sums {
    std::map<std::uint32_t, Matrix<double>> linear;
    std::map<std::array<std::uint32_t, 2>, std::array<Vector<double>, 2>> quadratic;
    std::map<std::array<std::uint32_t, 3>, double> cubic;
};

template <class Map, class Key, class Value>
void add(Map& map, const Key& key, const Value& value) {
    const auto [place, is_new] = map.try_emplace(key, value);
    if (!is_new) place->second += value;
}

/// The tensors of one element, by its corners, from the gradients g of the shape functions.
/// Equations: docs/comparison.md.
struct Tensors {
    double volume, lambda, mu;
    std::array<Vector<double>, 4> g;

    Matrix<double> B(std::size_t j, std::size_t k) const {
        return volume * (lambda * g[j] * g[k].transpose() + mu * g[k] * g[j].transpose() +
                         mu * g[j].dot(g[k]) * Matrix<double>::Identity());
    }
    Vector<double> C(std::size_t j, std::size_t k, std::size_t l) const {
        return 0.5 * volume *
               (lambda * g[k].dot(g[l]) * g[j] +
                mu * (g[j].dot(g[k]) * g[l] + g[j].dot(g[l]) * g[k]));
    }
    double D(std::size_t j, std::size_t k, std::size_t l, std::size_t m) const {
        return 0.125 * volume *
               (lambda * g[j].dot(g[k]) * g[l].dot(g[m]) +
                2.0 * mu * g[j].dot(g[m]) * g[k].dot(g[l]));
    }
};

void add_element(const Tensors& t, const Nodes& n, std::vector<Sums>& sums) {
    for (std::size_t p = 0; p < 4; ++p) {
        Sums& sum = sums[n[p]];
        for (std::size_t j = 0; j < 4; ++j) {
            add(sum.linear, n[j], Matrix<double>(-t.B(p, j)));
            for (std::size_t k = 0; k < 4; ++k) {
                const std::array<std::uint32_t, 2> pair{n[j], n[k]};
                auto& C =
                    sum.quadratic
                        .try_emplace(pair, std::array<Vector<double>, 2>{Vector<double>::Zero(),
                                                                         Vector<double>::Zero()})
                        .first->second;
                C[0] -= 2.0 * t.C(j, k, p);
                C[1] -= t.C(p, j, k);
                for (std::size_t l = 0; l < 4; ++l)
                    add(sum.cubic, std::array<std::uint32_t, 3>{n[j], n[k], n[l]},
                        -4.0 * t.D(j, k, l, p));
            }
        }
    }
}

}  // namespace

MassTensor::MassTensor(const physics::SaintVenantKirchhoff& law, std::span<const Nodes> tetrahedra,
                       std::span<const Vec3> rest_positions)
    : rest_positions_(rest_positions.begin(), rest_positions.end()), nodes_(rest_positions.size()) {
    std::vector<Sums> sums(rest_positions.size());
    for (const Nodes& nodes : tetrahedra) {
        const ShapeFunctions N(corners_of(nodes, rest_positions));
        add_element({N.volume,
                     law.lambda,
                     law.mu,
                     {N.gradient(0), N.gradient(1), N.gradient(2), N.gradient(3)}},
                    nodes, sums);
    }
    for (std::size_t p = 0; p < nodes_.size(); ++p) {
        for (const auto& [j, B] : sums[p].linear) nodes_[p].linear.push_back({j, B});
        for (const auto& [jk, C] : sums[p].quadratic)
            nodes_[p].quadratic.push_back({jk[0], jk[1], C[0], C[1]});
        for (const auto& [jkl, D] : sums[p].cubic)
            nodes_[p].cubic.push_back({jkl[0], jkl[1], jkl[2], D});
    }
}

std::size_t MassTensor::num_coefficients() const {
    std::size_t sum = 0;
    for (const Node& node : nodes_)
        sum += 9 * node.linear.size() + 6 * node.quadratic.size() + node.cubic.size();
    return sum;
}

}  // namespace incise::bench
