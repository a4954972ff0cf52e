// Who is let in to the server: hosts, and the token in the address.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace incise::live {

/// Returns 128 random bits as 32 hexadecimal digits.
std::string make_token();

/// The target of a request: its path, and the values of its parameters `token` and `once`; empty if
/// they are missing.
/// @lifetime  the text must outlive the object
struct Target {
    std::string_view path, token, once;
    explicit Target(std::string_view target);
};

/// Returns the name or address in a Host header, without the port. An IPv6 address keeps its
/// brackets. Empty if the header is anything but a host, or a host, a colon and a port.
std::string_view host_without_port(std::string_view header);

/// True for the names of this machine that no other machine can have, in capitals or not.
bool is_loopback_name(std::string_view host);

/// Compares texts in a time that does not tell how much of them is equal.
bool is_equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace incise::live
