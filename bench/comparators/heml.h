// HEML over any scalar, to count operations: as the paper prints it, with matrices and for Saint
// Venant-Kirchhoff tissue, and link by link. Incise itself uses physics/elements/heml_kernel.h.
// Source: HEML 2015, Table 3, (26), (B.2), (C.4), with the corrections of docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

#include "bench/comparators/element_loop.h"
#include "bench/comparators/link_traces.h"
#include "incise/physics/elements/heml_kernel.h"

namespace incise::bench {

/// Returns the matrices DLM_1 to DLM_3 of (B.2). DLM_i v^T is the derivative of the squared lengths
/// of the links 01, 02, 03, 12, 23, 31 by the position of corner i. The columns of v are the edges
/// from corner 0.
inline const std::array<Eigen::Matrix<double, 6, 3>, 3>& link_derivatives() {
    static const auto matrices = [] {
        std::array<Eigen::Matrix<double, 6, 3>, 3> d;
        d[0] << 2, 0, 0, 0, 0, 0, 0, 0, 0, 2, -2, 0, 0, 0, 0, 2, 0, -2;
        d[1] << 0, 0, 0, 0, 2, 0, 0, 0, 0, -2, 2, 0, 0, 2, -2, 0, 0, 0;
        d[2] << 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, -2, 2, -2, 0, 2;
        return d;
    }();
    return matrices;
}

template <class Scalar>
Eigen::Matrix<Scalar, 6, 1> squared_links(const Corners<Scalar>& x) {
    return {(x[1] - x[0]).squaredNorm(), (x[2] - x[0]).squaredNorm(), (x[3] - x[0]).squaredNorm(),
            (x[2] - x[1]).squaredNorm(), (x[3] - x[2]).squaredNorm(), (x[1] - x[3]).squaredNorm()};
}

/// Saint Venant-Kirchhoff tissue with the "characteristic matrices" of HEML 2006, section 3.1,
/// -2 Vol MW DLM_i for corners 1 to 3. The force on corner 0 is minus the sum of the others.
template <class Scalar>
struct PrintedHeml {
    struct Element {
        Eigen::Matrix<Scalar, 6, 1> rest_links;
        std::array<Eigen::Matrix<Scalar, 6, 3>, 3> matrices;
    };

    double lambda, mu;  ///< Pa

    Element precompute(const Corners<double>& X) const {
        const physics::LinkElement rest = physics::link_element(X);
        const LinkTraces traces = link_traces(rest);
        const Eigen::Matrix<double, 6, 6> MW =
            lambda / 8.0 * traces.vtr * traces.vtr.transpose() + mu / 4.0 * traces.Mtr;
        Element e;
        e.rest_links = rest.rest_links.cast<Scalar>();
        for (std::size_t i = 0; i < 3; ++i)
            e.matrices[i] = (-2.0 * rest.volume * MW * link_derivatives()[i]).cast<Scalar>();
        return e;
    }

    Corners<Scalar> forces(const Element& e, const Corners<Scalar>& x) const {
        const std::array<Vector<Scalar>, 3> v{x[1] - x[0], x[2] - x[0], x[3] - x[0]};
        const Vector<Scalar> v4 = v[1] - v[0], v5 = v[2] - v[1], v6 = v[0] - v[2];
        Eigen::Matrix<Scalar, 6, 1> l;
        l << v[0].squaredNorm(), v[1].squaredNorm(), v[2].squaredNorm(), v4.squaredNorm(),
            v5.squaredNorm(), v6.squaredNorm();
        const Eigen::Matrix<Scalar, 6, 1> dl = l - e.rest_links;
        Corners<Scalar> f;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector<Scalar> t = e.matrices[i].transpose() * dl;
            f[i + 1] = t[0] * v[0] + t[1] * v[1] + t[2] * v[2];
        }
        f[0] = -(f[1] + f[2] + f[3]);
        return f;
    }
};

/// The derivatives of an energy density by a = tr(2E), b = tr((2E)^2) and J; see
/// physics/laws/law_response.h.
template <class Scalar>
struct LinkResponse {
    Scalar w_a, w_b, w_J;
};
template <class Scalar>
LinkResponse<Scalar> respond(const physics::SaintVenantKirchhoff& law, Scalar a, Scalar) {
    return {0.25 * law.lambda * a, 0.25 * law.mu, 0.0};
}
template <class Scalar>
LinkResponse<Scalar> respond(const physics::NeoHookean& law, Scalar, Scalar J) {
    using std::log;
    return {law.c1, 0.0, (law.lambda * log(J) - 2.0 * law.c1) / J};
}
template <class Scalar>
LinkResponse<Scalar> respond(const physics::MooneyRivlin& law, Scalar a, Scalar J) {
    using std::log;
    return {law.c1 + law.c2 * (2.0 + a), -0.5 * law.c2,
            (law.lambda * log(J) - (2.0 * law.c1 + 4.0 * law.c2)) / J};
}

/// HEML link by link: the tensions of the six links, and the volume term of laws that have one.
/// @pre J > 0
template <class Scalar, class Law>
struct LinkHeml {
    struct Element {
        Scalar volume;
        Eigen::Matrix<Scalar, 6, 1> rest_links, vtr;
        Eigen::Matrix<Scalar, 6, 6> Mtr;
    };
    static constexpr bool has_volume_term = !std::is_same_v<Law, physics::SaintVenantKirchhoff>;
    static constexpr bool has_b_term = !std::is_same_v<Law, physics::NeoHookean>;

    Law law;

    Element precompute(const Corners<double>& X) const {
        const physics::LinkElement rest = physics::link_element(X);
        const LinkTraces traces = link_traces(rest);
        return {rest.volume, rest.rest_links.cast<Scalar>(), traces.vtr.cast<Scalar>(),
                traces.Mtr.cast<Scalar>()};
    }

    Corners<Scalar> forces(const Element& e, const Corners<Scalar>& x) const {
        const Vector<Scalar> v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
        const Vector<Scalar> n1 = v2.cross(v3);
        const Eigen::Matrix<Scalar, 6, 1> dl = squared_links(x) - e.rest_links;
        Scalar J(1.0);
        if constexpr (has_volume_term) J = v1.dot(n1) / (6.0 * e.volume);
        const LinkResponse<Scalar> r = respond<Scalar>(law, e.vtr.dot(dl), J);
        const Scalar scale = 2.0 * e.volume;
        Eigen::Matrix<Scalar, 6, 1> t = (scale * r.w_a) * e.vtr;
        if constexpr (has_b_term) t += (2.0 * scale * r.w_b) * (e.Mtr * dl).eval();
        Corners<Scalar> f;
        f[1] = t[3] * v2 + t[5] * v3 - (t[0] + t[3] + t[5]) * v1;
        f[2] = t[3] * v1 + t[4] * v3 - (t[1] + t[3] + t[4]) * v2;
        f[3] = t[4] * v2 + t[5] * v1 - (t[2] + t[4] + t[5]) * v3;
        if constexpr (has_volume_term) {
            const Scalar p = r.w_J / 6.0;
            f[1] -= p * n1;
            f[2] -= p * v3.cross(v1);
            f[3] -= p * v1.cross(v2);
        }
        f[0] = -(f[1] + f[2] + f[3]);
        return f;
    }
};

}  // namespace incise::bench
