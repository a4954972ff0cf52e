// A client of the server of a live session.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "incise/live/json_values.h"

namespace incise::live {

/// How long what must come is waited for. No test depends on it: it ends a test that has failed.
inline constexpr std::chrono::minutes patience{5};

/// A client that knows nothing of HTTP but bytes.
class Client {
  public:
    explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("cannot connect");
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void send(const std::string& bytes) {
        for (std::size_t sent = 0; sent < bytes.size();) {
            const auto n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (n <= 0) return;  // the server has closed
            sent += static_cast<std::size_t>(n);
        }
    }
    /// Reads until the end, or until `is_enough`.
    const std::string& read(const std::function<bool(const std::string&)>& is_enough = {}) {
        const auto until = std::chrono::steady_clock::now() + patience;
        while (!(is_enough && is_enough(received_)) && std::chrono::steady_clock::now() < until) {
            pollfd waits{socket_, POLLIN, 0};
            if (::poll(&waits, 1, 100) <= 0) continue;
            std::array<char, 65536> buffer;
            const auto n = ::recv(socket_, buffer.data(), buffer.size(), 0);
            if (n <= 0) break;
            received_.append(buffer.data(), static_cast<std::size_t>(n));
        }
        return received_;
    }

  private:
    int socket_;
    std::string received_;
};

inline std::string frame(std::string_view text, unsigned char kind = 0x81) {
    std::string bytes(1, static_cast<char>(kind));
    if (text.size() < 126) {
        bytes += static_cast<char>(0x80u | text.size());
    } else if (text.size() < 65536) {
        bytes += static_cast<char>(0x80u | 126u);
        bytes += static_cast<char>(text.size() >> 8);
        bytes += static_cast<char>(text.size() & 0xff);
    } else {
        bytes += static_cast<char>(0x80u | 127u);
        for (int i = 7; i >= 0; --i)
            bytes += static_cast<char>((std::uint64_t{text.size()} >> (8 * i)) & 0xff);
    }
    bytes += std::string(4, '\0');  // a mask that changes nothing
    return bytes.append(text);
}

inline bool is_head_complete(const std::string& text) { return text.find("\r\n\r\n") != text.npos; }

/// Returns the request of a page that wants to be connected.
inline std::string upgrade_request(const std::string& target, const std::string& host,
                                   const std::string& origin) {
    return "GET " + target + " HTTP/1.1\r\nHost: " + host +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
           (origin.empty() ? "" : "Origin: " + origin + "\r\n") + "\r\n";
}

/// A page that is connected, and reads texts only.
class WebPage {
  public:
    /// @param address  Server::address()
    explicit WebPage(const std::string& address) : client_(port_of(address)) {
        const std::string host = "127.0.0.1:" + std::to_string(port_of(address));
        client_.send(upgrade_request("/ws" + address.substr(address.find("?token=")), host,
                                     "http://" + host));
        const std::string& head = client_.read(is_head_complete);
        at_ = head.find("\r\n\r\n") + 4;
        if (!head.starts_with("HTTP/1.1 101")) throw std::runtime_error("no page may connect");
    }
    static std::uint16_t port_of(const std::string& address) {
        return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    }

    void say(const std::string& wish) { client_.send(frame(wish)); }
    /// Returns the next message that is as wanted. Throws std::runtime_error if it does not come.
    Json wait_for(const std::function<bool(const Json&)>& is_wanted) {
        while (true) {
            const auto [kind, text] = next();
            if (kind != 1) continue;
            const Json message = parse_object(text);
            if (is_wanted(message)) return message;
        }
    }
    Json wait_for(const std::string& type) {
        return wait_for([&](const Json& message) { return message["type"] == type; });
    }

  private:
    std::pair<int, std::string> next() {
        const std::string& bytes = client_.read([&](const std::string& all) {
            return all.size() >= at_ + 2 && all.size() >= at_ + head_size(all) + body_size(all);
        });
        if (bytes.size() < at_ + 2) throw std::runtime_error("the connection has ended");
        const std::size_t begin = at_ + head_size(bytes), size = body_size(bytes);
        if (bytes.size() < begin + size) throw std::runtime_error("the message does not come");
        const int kind = bytes[at_] & 15;
        at_ = begin + size;
        return {kind, bytes.substr(begin, size)};
    }
    std::size_t head_size(const std::string& all) const {
        const int length = all[at_ + 1] & 127;
        return length < 126 ? 2 : length == 126 ? 4 : 10;
    }
    std::size_t body_size(const std::string& all) const {
        const std::size_t head = head_size(all);
        if (head == 2) return static_cast<std::size_t>(all[at_ + 1] & 127);
        if (all.size() < at_ + head) return all.size();
        std::size_t size = 0;
        for (std::size_t i = 2; i < head; ++i)
            size = size << 8 | static_cast<unsigned char>(all[at_ + i]);
        return size;
    }

    Client client_;
    std::size_t at_ = 0;
};

}  // namespace incise::live
