// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/law.h"

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

}  // namespace incise::physics
