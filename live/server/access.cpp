// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/server/access.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <random>

namespace incise::live {

std::string make_token() {
    std::random_device random;
    std::string token;
    for (int i = 0; i < 4; ++i) {
        std::array<char, 9> digits;
        std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(random()));
        token += digits.data();
    }
    return token;
}

Target::Target(std::string_view target) : path(target.substr(0, target.find('?'))) {
    std::string_view query = target.substr(std::min(path.size() + 1, target.size()));
    while (!query.empty()) {
        const std::string_view parameter = query.substr(0, query.find('&'));
        if (parameter.starts_with("token=")) token = parameter.substr(6);
        if (parameter.starts_with("once=")) once = parameter.substr(5);
        query.remove_prefix(std::min(parameter.size() + 1, query.size()));
    }
}

std::string_view without_port(std::string_view host) {
    if (host.starts_with("[")) return host.substr(0, host.find(']') + 1);
    return host.substr(0, host.rfind(':'));
}

bool is_loopback_name(std::string_view host) {
    return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

bool is_equal_in_constant_time(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned>(a[i]) ^ static_cast<unsigned>(b[i]);
    return difference == 0;
}

}  // namespace incise::live
