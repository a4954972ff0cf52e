// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/server/access.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>

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

std::string_view host_without_port(std::string_view header) {
    const bool is_ipv6 = header.starts_with("[");
    const std::size_t end_of_host = is_ipv6 ? header.find(']') + 1 : header.find(':');
    const std::string_view host = header.substr(0, end_of_host);  // empty without that bracket
    if (host.empty()) return {};
    const bool is_host =
        is_ipv6 ? host.find_first_not_of("0123456789abcdefABCDEF:.", 1) == host.size() - 1
                : host.find_first_not_of(
                      "0123456789abcdefghijklmnopqrstuvwxyz"
                      "ABCDEFGHIJKLMNOPQRSTUVWXYZ-_.") == host.npos;
    if (!is_host) return {};
    const std::string_view rest = header.substr(host.size());
    if (rest.empty()) return host;
    std::uint16_t port = 0;
    const char* const end = rest.data() + rest.size();
    const auto read = std::from_chars(rest.data() + 1, end, port);
    const bool is_port = rest.front() == ':' && read.ec == std::errc() && read.ptr == end;
    return is_port ? host : std::string_view();
}

bool is_loopback_name(std::string_view host) {
    static constexpr std::string_view name = "localhost";
    const auto is_same_letter = [](char given, char lower) {
        return given == lower || (given >= 'A' && given <= 'Z' && given - 'A' + 'a' == lower);
    };
    return host == "127.0.0.1" || host == "[::1]" ||
           std::equal(host.begin(), host.end(), name.begin(), name.end(), is_same_letter);
}

bool is_equal_in_constant_time(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned>(a[i]) ^ static_cast<unsigned>(b[i]);
    return difference == 0;
}

}  // namespace incise::live
