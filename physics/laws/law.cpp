// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/law.h"

#include <limits>

#include "incise/physics/laws/stiffening.h"

namespace incise::physics {

LawResponse<double> response(const Law& law, const LinkStrain<double>& strain, double J0) {
    return std::visit([&](const auto& l) { return l.response(strain, J0); }, law);
}

LawResponse<Dual> response(const Law& law, const LinkStrain<Dual>& strain, double J0) {
    return std::visit([&](const auto& l) { return l.response(strain, J0); }, law);
}

double rest_lambda(const Law& law) {
    return std::visit([](const auto& l) { return l.rest_lambda(); }, law);
}

double rest_mu(const Law& law) {
    return std::visit([](const auto& l) { return l.rest_mu(); }, law);
}

RestFibres rest_fibres(const Law& law) {
    return std::visit(
        []<class L>(const L& l) {
            if constexpr (HasFibres<L>)
                return RestFibres{l.rest_fibre_modulus(), l.dispersion};
            else
                return RestFibres{};
        },
        law);
}

bool has_fibres(const Law& law) {
    return std::visit([]<class L>(const L&) { return HasFibres<L>; }, law);
}

double stiffening(const CustomLaw& law, const LinkStrain<double>& s, double J0) {
    using Number = DualOf<double, 3>;
    const LawResponse<Dual> r = law.response(with_derivatives(s), J0);
    const auto number = [](const Dual& x) {
        Number y(x.value);
        for (int i = 0; i < 3; ++i) y.gradient[static_cast<std::size_t>(i)] = x.gradient[i];
        return y;
    };
    const LawResponse<Number> converted{number(r.w), number(r.w_a), number(r.w_b), number(r.w_J)};
    const PrincipalStretches<double> at(s, std::numeric_limits<double>::epsilon());
    return principal_moduli(converted, at).largest() /
           (std::abs(law.rest_lambda()) + 2.0 * law.rest_mu());
}

double stiffening(const Law& law, const LinkStrain<double>& strain, double J0) {
    return std::visit(
        [&](const auto& l) {
            return stiffening(l, strain, J0, std::numeric_limits<double>::epsilon());
        },
        law);
}

}  // namespace incise::physics
