// Serves the page of a live session, and talks to it through WebSockets.
// The only file that includes Boost is server.cpp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace incise::live {

/// A file of the page.
struct PageFile {
    std::string_view path;  ///< such as "/app.js"; "/" needs the token
    std::string_view type;  ///< such as "text/javascript"
    std::string_view content;
};

/// A picture of the body for all pages: the newest one is sent, older ones that a slow page has not
/// got yet are left out.
struct Picture {
    std::uint64_t topology_version = 0;
    /// A page that has this version of the topology is sent head_without_topology and `moving`,
    /// another page head_with_topology, `topology` and `moving`.
    std::string head_with_topology, head_without_topology, moving;
    std::shared_ptr<const std::string> topology;
    std::string state;  ///< JSON, sent after it
};

/// Something that a page, or the person in front of it, wants.
struct Request {
    enum class Kind { opened, closed, text, download } kind = Kind::text;
    std::uint64_t page = 0;  ///< number of the page, or of the download
    std::string text;        ///< what a page has sent, or the path to download
};

struct ServerOptions {
    std::string host = "127.0.0.1";           ///< address to listen on
    std::uint16_t port = 8080;                ///< 0: any that is free
    std::vector<PageFile> files = {};         ///< their texts must outlive the server
    std::vector<std::string> downloads = {};  ///< paths, such as "/recording.jsonl"
};

/// A server with a thread of its own. Nothing that a page does or leaves undone makes a caller
/// wait.
///
/// Only requests to a loopback name are answered, unless the server listens on another address:
/// the header Origin of a WebSocket must then name the same host as the header Host. A secret
/// token in the address keeps other users of the machine out. Messages of pages are at most 64 KiB
/// long. A page that sends faster than its messages are taken has to wait; one that reads too
/// slowly misses pictures; one that does not read at all is disconnected.
///
/// @thread  all functions may be called from any thread
class Server {
  public:
    static constexpr std::size_t longest_message = 64 * 1024;  ///< bytes
    static constexpr std::size_t most_pages = 16;

    /// Begins to listen. Throws OutputError if the address cannot be listened on.
    explicit Server(ServerOptions options);
    /// Disconnects all pages.
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    std::uint16_t port() const;
    /// Returns the address to open in a browser, with the token.
    std::string address() const;
    /// Returns an address that leads to address() one time: for where others may read it, such as
    /// the arguments of a program. It takes the place of the last one.
    std::string address_for_once();

    /// Returns the requests since the last call, in their order.
    std::vector<Request> take_requests();
    /// Waits until there is a request, at most until a time.
    void wait_for_request(std::chrono::steady_clock::time_point until);

    /// Sets a text that pages get first when they connect; empty for none.
    void greet_with(std::string text);
    /// Sends a text to one page. A page that is gone gets nothing.
    void send(std::uint64_t page, std::string text);
    /// Sends a text to all pages that are connected.
    void send_to_all(const std::string& text);
    /// Sends a picture to all pages, and to those that connect later.
    void show(std::shared_ptr<const Picture> picture);
    /// Answers a download with a file.
    void answer(std::uint64_t download, std::string content, std::string_view type,
                std::string_view file_name);
    /// Answers a download with a failure.
    void fail(std::uint64_t download, std::string text);

  private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::live
