// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/server/server.h"

#include <algorithm>
#include <array>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>  // before Boost 1.74, which uses std::exchange without it
#include <variant>

#include "incise/base/error.h"
#include "incise/live/server/access.h"

namespace incise::live {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;
using beast::error_code;
using std::chrono::seconds;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

constexpr const char* no_token_page =
    "<!doctype html><title>Incise</title><p>This address has no valid token. Open the address that "
    "<code>incise live</code> has printed.";

}  // namespace

/// The state of the server. All but the requests belongs to its thread.
class Server::Parts {
  public:
    class Page;
    class Connection;

    explicit Parts(ServerOptions given) : options(std::move(given)), token(make_token()) {}
    ~Parts() {
        // Connections that still wait are destroyed with the context, and use what is below.
        pages.clear();
        downloads.clear();
        acceptor.reset();
        pause_of_accept.reset();
        io.reset();
    }

    void listen();
    void accept();
    bool close_a_stranger();
    void stop();
    std::string root() const;
    void note(Request request) {
        {
            const std::scoped_lock lock(mutex);
            requests.push_back(std::move(request));
        }
        has_requests.notify_all();
    }
    /// Calls a function in the thread of the server.
    template <class F>
    void later(F f) {
        asio::post(*io, std::move(f));
    }
    bool is_host_allowed(std::string_view header) const {
        const std::string_view host = host_without_port(header);
        return !host.empty() && (is_open_to_all || is_loopback_name(host) || host == options.host);
    }

    ServerOptions options;
    std::string token;
    std::string key_for_once;     // leads to the token, and is forgotten then; empty: none
    bool is_open_to_all = false;  // listens on an address that is no loopback
    std::unique_ptr<asio::io_context> io = std::make_unique<asio::io_context>(1);
    std::optional<tcp::acceptor> acceptor{*io};
    std::optional<asio::steady_timer> pause_of_accept{*io};
    std::uint16_t port = 0;

    std::map<std::uint64_t, std::shared_ptr<Page>> pages;
    std::map<std::uint64_t, std::shared_ptr<Connection>> downloads;
    std::uint64_t last_number = 0;
    std::map<std::uint64_t, Connection*> connections;  // by their age; those of pages are none
    std::shared_ptr<const Picture> picture;
    std::string greeting;

    std::mutex mutex;
    std::condition_variable has_requests;
    std::vector<Request> requests;

    std::thread thread;  // last member, as it uses the others
};

/// A page that is connected.
class Server::Parts::Page : public std::enable_shared_from_this<Page> {
  public:
    Page(tcp::socket socket, Parts& parts, std::uint64_t number)
        : socket_(std::move(socket)), parts_(parts), number_(number) {}

    void start(const HttpRequest& request) {
        auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.idle_timeout = seconds(20);
        timeout.keep_alive_pings = true;
        socket_.set_option(timeout);
        socket_.read_message_max(longest_message);
        socket_.async_accept(request, [self = shared_from_this()](error_code error) {
            if (error) return;
            self->is_open_ = true;
            self->parts_.pages[self->number_] = self;
            self->parts_.note({Request::Kind::opened, self->number_, {}});
            if (!self->parts_.greeting.empty()) self->send(self->parts_.greeting);
            self->show();
            self->read();
        });
    }
    void send(std::string text) {
        // A page that is so far behind does not read at all.
        constexpr std::size_t most_waiting = 256;
        if (texts_.size() >= most_waiting) return close();
        texts_.push_back(std::move(text));
        write();
    }
    void show() {
        has_new_picture_ = parts_.picture != nullptr;
        write();
    }
    void close() {
        if (!is_open_) return;
        is_open_ = false;
        error_code ignored;
        socket_.next_layer().socket().close(ignored);
        parts_.pages.erase(number_);
        parts_.note({Request::Kind::closed, number_, {}});
    }
    /// The requests of the page were taken: it may send further ones.
    void take() {
        num_untaken_ = 0;
        if (!is_reading_ && is_open_) read();
    }

  private:
    void read() {
        is_reading_ = true;
        socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
            self->is_reading_ = false;
            if (error) return self->close();
            self->parts_.note({Request::Kind::text, self->number_,
                               beast::buffers_to_string(self->buffer_.data())});
            self->buffer_.clear();
            constexpr int most_untaken = 64;
            if (++self->num_untaken_ < most_untaken) self->read();
        });
    }
    /// Sends what is next: texts in their order, then the newest picture.
    void write() {
        if (is_writing_ || !is_open_) return;
        if (!texts_.empty()) {
            sent_text_ = std::move(texts_.front());
            texts_.pop_front();
            return write(std::array{asio::buffer(sent_text_)}, true);
        }
        if (!has_new_picture_) return;
        has_new_picture_ = false;
        sent_picture_ = parts_.picture;
        const Picture& sent = *sent_picture_;
        texts_.push_back(sent.state);
        const bool has_topology = topology_ == sent.topology_version;
        topology_ = sent.topology_version;
        if (has_topology)
            write(std::array{asio::buffer(sent.head_without_topology), asio::buffer(sent.moving)},
                  false);
        else
            write(std::array{asio::buffer(sent.head_with_topology), asio::buffer(*sent.topology),
                             asio::buffer(sent.moving)},
                  false);
    }
    void write(const auto& buffers, bool is_text) {
        is_writing_ = true;
        socket_.text(is_text);
        socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
            self->is_writing_ = false;
            if (error) return self->close();
            self->write();
        });
    }

    websocket::stream<beast::tcp_stream> socket_;
    Parts& parts_;
    std::uint64_t number_;
    beast::flat_buffer buffer_;
    std::deque<std::string> texts_;
    std::string sent_text_;
    std::shared_ptr<const Picture> sent_picture_;
    std::optional<std::uint64_t> topology_;  // that the page has
    bool has_new_picture_ = false, is_writing_ = false, is_reading_ = false, is_open_ = false;
    int num_untaken_ = 0;
};

/// A connection that asks for a file, or to become that of a page.
class Server::Parts::Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(tcp::socket socket, Parts& parts)
        : socket_(std::move(socket)), parts_(parts), number_(++parts.last_number) {
        parts_.connections[number_] = this;
    }
    ~Connection() { parts_.connections.erase(number_); }

    /// True if it is of somebody who has shown the token.
    bool is_known() const { return is_known_; }
    void close() { socket_.close(); }

    void read() {
        parser_.emplace();
        parser_->header_limit(8 * 1024);
        parser_->body_limit(0);
        socket_.expires_after(seconds(10));
        http::async_read(
            socket_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
                if (!error) return self->answer();
                if (error == http::error::header_limit || error == http::error::body_limit)
                    self->refuse(http::status::payload_too_large, "too long");
            });
    }
    void respond(http::status status, std::string_view type, std::string content,
                 std::string_view file_name = {}) {
        socket_.expires_after(seconds(60));
        response_ = {};
        response_.version(11);
        response_.result(status);
        response_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
        response_.set("X-Content-Type-Options", "nosniff");
        response_.set("X-Frame-Options", "DENY");
        response_.set("Referrer-Policy", "no-referrer");
        response_.set("Cross-Origin-Resource-Policy", "same-origin");
        response_.set("Content-Security-Policy",
                      "default-src 'self'; frame-ancestors 'none'; base-uri 'none'");
        response_.set(http::field::cache_control, "no-store");
        if (status == http::status::see_other) response_.set(http::field::location, content);
        if (!file_name.empty())
            response_.set(http::field::content_disposition,
                          "attachment; filename=\"" + std::string(file_name) + "\"");
        response_.keep_alive(parser_->get().keep_alive() && status == http::status::ok);
        response_.body() = parser_->get().method() == http::verb::head ? "" : std::move(content);
        response_.prepare_payload();
        http::async_write(socket_, response_,
                          [self = shared_from_this()](error_code error, std::size_t) {
                              if (error) return;
                              if (self->response_.keep_alive()) return self->read();
                              error_code ignored;
                              self->socket_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                          });
    }

  private:
    void refuse(http::status status, std::string_view text) {
        respond(status, "text/plain; charset=utf-8", std::string(text) + "\n");
    }
    void answer() {
        const HttpRequest& request = parser_->get();
        const std::string_view host = view(request[http::field::host]);
        if (request.count(http::field::host) != 1 || !parts_.is_host_allowed(host))
            return refuse(http::status::misdirected_request, "this host is not served here");
        const Target target(view(request.target()));
        const bool knows_token = is_equal_in_constant_time(target.token, parts_.token);
        is_known_ = is_known_ || knows_token;
        if (websocket::is_upgrade(request)) {
            const std::string_view origin = view(request[http::field::origin]);
            if (target.path != "/ws") return refuse(http::status::not_found, "not found");
            if (!knows_token || origin != "http://" + std::string(host))
                return refuse(http::status::forbidden, "forbidden");
            if (parts_.pages.size() >= most_pages)
                return refuse(http::status::service_unavailable, "too many pages are open");
            socket_.expires_never();
            std::make_shared<Page>(socket_.release_socket(), parts_, ++parts_.last_number)
                ->start(request);
            return;
        }
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return refuse(http::status::method_not_allowed, "only GET and HEAD");
        for (const std::string& path : parts_.options.downloads) {
            if (path != target.path) continue;
            if (!knows_token) return refuse(http::status::forbidden, "forbidden");
            const std::uint64_t number = ++parts_.last_number;
            parts_.downloads[number] = shared_from_this();
            socket_.expires_never();  // until the simulation is between two ticks
            return parts_.note({Request::Kind::download, number, path});
        }
        if (target.path == "/" && request.method() == http::verb::get &&
            !parts_.key_for_once.empty() &&
            is_equal_in_constant_time(target.once, parts_.key_for_once)) {
            parts_.key_for_once.clear();
            return respond(http::status::see_other, "text/plain", "/?token=" + parts_.token);
        }
        for (const PageFile& file : parts_.options.files) {
            if (file.path != target.path) continue;
            if (file.path == "/" && !knows_token)
                return respond(http::status::forbidden, "text/html; charset=utf-8", no_token_page);
            return respond(http::status::ok, file.type, std::string(file.content));
        }
        refuse(http::status::not_found, "not found");
    }

    beast::tcp_stream socket_;
    Parts& parts_;
    std::uint64_t number_;
    bool is_known_ = false;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::empty_body>> parser_;
    HttpResponse response_;
};

void Server::Parts::listen() {
    const std::string place = options.host + ":" + std::to_string(options.port);
    error_code error;
    const auto address =
        asio::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, error);
    if (error) throw InputError("--host " + options.host + ": is no address, such as 127.0.0.1");
    is_open_to_all = !address.is_loopback();
    const tcp::endpoint endpoint(address, options.port);
    acceptor->open(endpoint.protocol(), error);
    if (!error) acceptor->set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor->bind(endpoint, error);
    if (!error) acceptor->listen(asio::socket_base::max_listen_connections, error);
    if (error == boost::system::errc::address_not_available)
        throw InputError("--host " + options.host + ": is no address of this machine");
    if (error)
        throw OutputError(place + ": cannot be listened on: " + error.message() +
                          "; choose another port with --port, or any free one with --port 0");
    port = acceptor->local_endpoint().port();
    accept();
}

void Server::Parts::accept() {
    acceptor->async_accept([this](error_code error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        constexpr std::size_t most_connections = 64;
        if (!error && (connections.size() < most_connections || close_a_stranger()))
            std::make_shared<Connection>(std::move(socket), *this)->read();
        if (!error) return accept();
        // As without a free file descriptor: the next try would fail as well.
        pause_of_accept->expires_after(std::chrono::milliseconds(100));
        pause_of_accept->async_wait([this](error_code ended) {
            if (!ended) accept();
        });
    });
}

/// Closes the oldest connection of those that have shown no token: without one, nobody can keep
/// others out. Returns false if there is none.
bool Server::Parts::close_a_stranger() {
    const auto oldest =
        std::ranges::find_if(connections, [](const auto& one) { return !one.second->is_known(); });
    if (oldest == connections.end()) return false;
    oldest->second->close();
    return true;
}

void Server::Parts::stop() {
    error_code ignored;
    acceptor->close(ignored);
    for (auto all = pages; const auto& [number, page] : all) page->close();
    downloads.clear();
    io->stop();
}

Server::Server(ServerOptions options) : parts_(std::make_unique<Parts>(std::move(options))) {
    parts_->listen();
    parts_->thread = std::thread([io = parts_->io.get()] { io->run(); });
}

Server::~Server() {
    parts_->later([parts = parts_.get()] { parts->stop(); });
    parts_->thread.join();
}

std::uint16_t Server::port() const { return parts_->port; }

std::string Server::Parts::root() const {
    // What listens on all addresses is reached by the name of the machine.
    const bool is_everywhere = options.host == "0.0.0.0" || options.host == "::";
    const bool is_ipv6 = !is_everywhere && options.host.find(':') != std::string::npos;
    error_code no_name;
    std::string name = is_everywhere ? asio::ip::host_name(no_name) : options.host;
    if (no_name) name = options.host;
    if (is_ipv6) name = "[" + name + "]";
    return "http://" + name + ":" + std::to_string(port) + "/";
}

std::string Server::address() const { return parts_->root() + "?token=" + parts_->token; }

std::string Server::address_for_once() {
    const std::string key = make_token();
    parts_->later([parts = parts_.get(), key] { parts->key_for_once = key; });
    return parts_->root() + "?once=" + key;
}

std::vector<Request> Server::take_requests() {
    std::vector<Request> requests;
    {
        const std::scoped_lock lock(parts_->mutex);
        requests.swap(parts_->requests);
    }
    if (!requests.empty())
        parts_->later([parts = parts_.get()] {
            for (auto all = parts->pages; const auto& [number, page] : all) page->take();
        });
    return requests;
}

void Server::wait_for_request(std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(parts_->mutex);
    parts_->has_requests.wait_until(lock, until, [&] { return !parts_->requests.empty(); });
}

void Server::greet_with(std::string text) {
    parts_->later([parts = parts_.get(), text = std::move(text)] { parts->greeting = text; });
}

void Server::send(std::uint64_t page, std::string text) {
    parts_->later([parts = parts_.get(), page, text = std::move(text)] {
        if (const auto found = parts->pages.find(page); found != parts->pages.end())
            found->second->send(text);
    });
}

void Server::send_to_all(const std::string& text) {
    parts_->later([parts = parts_.get(), text] {
        for (auto all = parts->pages; const auto& [number, page] : all) page->send(text);
    });
}

void Server::show(std::shared_ptr<const Picture> picture) {
    parts_->later([parts = parts_.get(), picture = std::move(picture)] {
        parts->picture = picture;
        for (auto all = parts->pages; const auto& [number, page] : all) page->show();
    });
}

void Server::answer(std::uint64_t download, std::string content, std::string_view type,
                    std::string_view file_name) {
    parts_->later([parts = parts_.get(), download, content = std::move(content),
                   type = std::string(type), name = std::string(file_name)]() mutable {
        const auto found = parts->downloads.find(download);
        if (found == parts->downloads.end()) return;
        found->second->respond(http::status::ok, type, std::move(content), name);
        parts->downloads.erase(found);
    });
}

void Server::fail(std::uint64_t download, std::string text) {
    parts_->later([parts = parts_.get(), download, text = std::move(text)]() mutable {
        const auto found = parts->downloads.find(download);
        if (found == parts->downloads.end()) return;
        found->second->respond(http::status::internal_server_error, "text/plain; charset=utf-8",
                               std::move(text));
        parts->downloads.erase(found);
    });
}

}  // namespace incise::live
