// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/igtl/igtl_link.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <igtlPolyDataMessage.h>
#include <igtlSensorMessage.h>
#include <igtlUnit.h>
#include <igtl_util.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "incise/base/error.h"

namespace incise::live {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double mm = 1e-3;  // m
constexpr auto surface_period = std::chrono::microseconds(33333);
constexpr auto force_period = std::chrono::milliseconds(1);

template <class Message>
std::string bytes_of(Message& message) {
    message->Pack();
    return {static_cast<const char*>(message->GetPackPointer()),
            static_cast<std::size_t>(message->GetPackSize())};
}

std::uint64_t big_endian(const std::string& bytes) {
    std::uint64_t value = 0;
    for (const char byte : bytes) value = (value << 8) | static_cast<unsigned char>(byte);
    return value;
}

/// Returns a name of a message. Bytes that are no letters, digits or signs of ASCII are shown as
/// '?'.
std::string name_in(const std::string& field) {
    std::string name = field.substr(0, field.find('\0'));
    for (char& c : name)
        if (c < ' ' || c > '~') c = '?';
    return name;
}

/// Returns the content of a body: in version 2, it stands between an extended header and metadata.
/// Returns nothing for other versions, and if the sizes do not fit.
std::optional<std::string> content_of(std::uint64_t version, const std::string& body) {
    if (version == 1) return body;
    constexpr std::size_t least_extended_header = 12;
    if (version != 2 || body.size() < least_extended_header) return std::nullopt;
    const std::uint64_t extended_header = big_endian(body.substr(0, 2)),
                        metadata = big_endian(body.substr(2, 2)) + big_endian(body.substr(4, 4));
    if (extended_header < least_extended_header || extended_header + metadata > body.size())
        return std::nullopt;
    return body.substr(extended_header, body.size() - extended_header - metadata);
}

/// Returns the pose of the twelve numbers of a transform, in mm: the three columns of the rotation,
/// then the position. Returns nothing if it is no rigid motion.
std::optional<Pose> pose_of(const std::string& content) {
    const auto number = [&](int i) {
        const auto bits = big_endian(content.substr(4 * static_cast<std::size_t>(i), 4));
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    };
    Eigen::Matrix3d rotation;
    Pose pose;
    for (int i = 0; i < 3; ++i) {
        pose.position[i] = mm * number(9 + i);
        for (int j = 0; j < 3; ++j) rotation(i, j) = number(3 * j + i);
    }
    // Numbers of messages have 24 bits.
    const bool is_rigid =
        (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
        rotation.determinant() > 0.0;
    if (!is_rigid || !pose.position.allFinite()) return std::nullopt;
    pose.rotation = Eigen::Quaterniond(rotation).normalized();
    return pose;
}

void set_nonblocking(int socket) {
    ::fcntl(socket, F_SETFL, ::fcntl(socket, F_GETFL) | O_NONBLOCK);
}

}  // namespace

/// The thread of the link. It shares `events`, `surface`, `wrenches` and `complaints` with the
/// loop.
class IgtlLink::Parts {
  public:
    /// What messages say of a tool since the last tick, in their order.
    struct Event {
        enum class Kind { pose, close, open, drop } kind;
        Pose pose = {};
    };

    /// What is sent.
    struct Surface {
        std::vector<float> points;  // mm
        std::vector<std::array<std::uint32_t, 3>> triangles;
    };
    using Wrench = std::array<double, 6>;  // N, N m

    explicit Parts(IgtlOptions given) : options(std::move(given)) { listen(); }
    ~Parts() {
        is_ending = true;
        if (thread.joinable()) thread.join();
        for (const auto& connection : connections) ::close(connection->socket);
        if (listener >= 0) ::close(listener);
    }

    void start() {
        thread = std::thread([this] { run(); });
    }

    IgtlOptions options;
    std::uint16_t port = 0;

    std::mutex mutex;
    std::map<std::string, std::vector<Event>> events;  // by device
    std::shared_ptr<const Surface> surface;
    std::map<std::string, Wrench> wrenches;
    std::vector<std::string> complaints;

    // Of the loop.
    std::map<std::string, std::string> names;  // of the tools in the session, by device
    std::map<std::string, int> numbers;
    Clock::time_point next_surface = Clock::now();

  private:
    struct Header {
        std::uint64_t version;
        std::string type, device;
        std::uint64_t checksum;  // of the body
    };
    struct Connection {
        int socket;
        std::string in, out;
        std::set<std::string> tools;       // that it leads
        std::set<std::string> complaints;  // that were told
        bool is_over = false;
    };

    void listen() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(options.port);
        const std::string host = options.host == "localhost" ? "127.0.0.1" : options.host;
        if (::inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
            throw InputError("--host " + options.host +
                             ": --igtl needs an IPv4 address, such as 127.0.0.1");
        listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const int yes = 1;
        ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        if (listener < 0 ||
            ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listener, 8) != 0) {
            const std::string reason = std::strerror(errno);
            if (listener >= 0) ::close(listener);
            throw OutputError(options.host + ":" + std::to_string(options.port) +
                              ": cannot be listened on: " + reason +
                              "; choose another port with --igtl");
        }
        set_nonblocking(listener);
        socklen_t size = sizeof address;
        ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
        port = ntohs(address.sin_port);
    }

    void run() {
        auto next_force = Clock::now();
        std::shared_ptr<const Surface> sent;
        while (!is_ending) {
            wait_until(next_force);
            accept();
            for (const auto& connection : connections) {
                receive(*connection);
                send(*connection);
            }
            std::erase_if(connections, [&](const auto& connection) {
                if (connection->is_over) drop(*connection);
                return connection->is_over;
            });
            const auto now = Clock::now();
            if (now < next_force) continue;
            next_force = std::max(next_force + force_period, now);
            send_state(sent);
        }
    }

    void wait_until(Clock::time_point time) {
        const bool may_accept = Clock::now() >= next_accept;
        std::vector<pollfd> waits = {{may_accept ? listener : -1, POLLIN, 0}};
        for (const auto& connection : connections)
            waits.push_back(
                {connection->socket,
                 static_cast<short>(connection->out.empty() ? POLLIN : POLLIN | POLLOUT), 0});
        const auto rest =
            std::chrono::duration_cast<std::chrono::nanoseconds>(time - Clock::now()).count();
        // Without a connection there is nothing to send.
        const timespec timeout = {0, connections.empty() ? 50'000'000 : std::max(rest, 0L)};
        ::ppoll(waits.data(), waits.size(), &timeout, nullptr);
    }

    void accept() {
        const int socket = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
        // As without a free file descriptor: then ppoll() would return at once for ever.
        if (socket < 0 && errno != EAGAIN && errno != EINTR && errno != ECONNABORTED)
            next_accept = Clock::now() + std::chrono::milliseconds(100);
        if (socket < 0) return;
        if (connections.size() >= most_connections) {
            ::close(socket);
            return;
        }
        set_nonblocking(socket);
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        connections.push_back(std::make_unique<Connection>());
        connections.back()->socket = socket;
    }

    void receive(Connection& connection) {
        std::array<char, 16384> buffer;
        // A device that floods is read no faster than the others.
        const auto n = ::recv(connection.socket, buffer.data(), buffer.size(), 0);
        if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) connection.is_over = true;
        if (n <= 0) return;
        connection.in.append(buffer.data(), static_cast<std::size_t>(n));
        while (!connection.is_over && take_message(connection)) {
        }
    }

    /// Takes one message from what was received, if it is whole.
    bool take_message(Connection& connection) {
        constexpr std::size_t head = 58;
        if (connection.in.size() < head) return false;
        const std::uint64_t size = big_endian(connection.in.substr(42, 8));
        if (size > longest_message) {
            connection.is_over = true;  // there is no way back into step
            return false;
        }
        if (connection.in.size() < head + size) return false;
        std::string body = connection.in.substr(head, size);
        const Header header = {.version = big_endian(connection.in.substr(0, 2)),
                               .type = name_in(connection.in.substr(2, 12)),
                               .device = name_in(connection.in.substr(14, 20)),
                               .checksum = big_endian(connection.in.substr(50, 8))};
        connection.in.erase(0, head + size);
        read_message(connection, header, body);
        return true;
    }

    void read_message(Connection& connection, const Header& header, std::string& body) {
        if (header.type != "TRANSFORM" && header.type != "STRING") return;
        const auto complain = [&](const std::string& text) {
            constexpr std::size_t most = 64;  // of a connection, and that wait
            const std::string whole = "OpenIGTLink: device '" + header.device + "': " + text;
            if (connection.complaints.size() >= most || !connection.complaints.insert(whole).second)
                return;
            const std::scoped_lock lock(mutex);
            if (complaints.size() < most) complaints.push_back(whole);
        };
        const auto bytes = reinterpret_cast<unsigned char*>(body.data());
        if (crc64(bytes, body.size(), 0) != header.checksum)
            return complain("the checksum of a message is wrong");
        const auto content = content_of(header.version, body);
        if (!content)
            return complain(header.version == 2
                                ? "the sizes in a message do not fit together"
                                : "its messages are of an unknown version of the protocol");
        if (!options.tools.contains(header.device)) {
            std::string known;
            for (const auto& [name, definition] : options.tools)
                known += (known.empty() ? "'" : ", '") + name + "'";
            return complain("no --tool has this name; there are: " + known);
        }
        if (header.type == "TRANSFORM") {
            const auto pose = content->size() == 48 ? pose_of(*content) : std::nullopt;
            if (!pose) return complain("a transform is no rotation and translation, or is scaled");
            connection.tools.insert(header.device);
            return note(header.device, {Event::Kind::pose, *pose});
        }
        // Encoding, length, text.
        const bool is_whole =
            content->size() >= 4 && big_endian(content->substr(2, 2)) <= content->size() - 4;
        const std::string what =
            is_whole ? content->substr(4, big_endian(content->substr(2, 2))) : std::string();
        if (what == "close")
            note(header.device, {Event::Kind::close});
        else if (what == "open")
            note(header.device, {Event::Kind::open});
        else if (what == "drop")
            note(header.device, {Event::Kind::drop});
        else
            complain("a STRING says neither close, open nor drop");
    }

    /// Of several poses in a row only the last one counts.
    void note(const std::string& device, const Event& event) {
        const std::scoped_lock lock(mutex);
        auto& all = events[device];
        constexpr std::size_t most = 64;  // in a tick, or in a pause
        if (!all.empty() && all.back().kind == event.kind)
            all.back() = event;
        else if (all.size() < most)
            all.push_back(event);
    }

    void drop(const Connection& connection) {
        ::close(connection.socket);
        for (const std::string& device : connection.tools) note(device, {Event::Kind::drop});
    }

    void send(Connection& connection) {
        if (connection.out.empty()) return;
        const auto n =
            ::send(connection.socket, connection.out.data(), connection.out.size(), MSG_NOSIGNAL);
        if (n > 0) connection.out.erase(0, static_cast<std::size_t>(n));
        if (n < 0 && errno != EAGAIN && errno != EINTR) connection.is_over = true;
    }

    static std::string message_of(const Surface& surface) {
        auto message = igtl::PolyDataMessage::New();
        message->SetDeviceName("tissue");
        auto points = igtl::PolyDataPointArray::New();
        for (std::size_t i = 0; i + 2 < surface.points.size(); i += 3)
            points->AddPoint(surface.points[i], surface.points[i + 1], surface.points[i + 2]);
        auto polygons = igtl::PolyDataCellArray::New();
        for (auto triangle : surface.triangles) polygons->AddCell(3, triangle.data());
        message->SetPoints(points);
        message->SetPolygons(polygons);
        return bytes_of(message);
    }

    static std::string message_of(const std::string& tool, const Wrench& wrench) {
        auto message = igtl::SensorMessage::New();
        message->SetDeviceName(tool.c_str());
        message->SetLength(static_cast<unsigned>(wrench.size()));
        // A message has one unit, and these are newtons and newton metres: none is claimed.
        auto unit = igtl::Unit::New();
        unit->Init();
        message->SetUnit(unit);
        for (unsigned i = 0; i < wrench.size(); ++i) message->SetValue(i, wrench[i]);
        return bytes_of(message);
    }

    /// Gives forces, and a surface that is new, to those that have taken what was before.
    void send_state(std::shared_ptr<const Surface>& sent) {
        if (connections.empty()) return;
        std::string bytes;
        std::shared_ptr<const Surface> now;
        {
            const std::scoped_lock lock(mutex);
            now = surface;
            for (const auto& [tool, wrench] : wrenches) bytes += message_of(tool, wrench);
        }
        if (now && now != sent) bytes += message_of(*now);
        sent = now;
        for (const auto& connection : connections)
            if (connection->out.empty()) connection->out = bytes;
    }

    int listener = -1;
    Clock::time_point next_accept = {};
    std::vector<std::unique_ptr<Connection>> connections;
    std::atomic<bool> is_ending = false;
    std::thread thread;
};

IgtlLink::IgtlLink(IgtlOptions options) : parts_(std::make_unique<Parts>(std::move(options))) {
    parts_->start();
}

IgtlLink::~IgtlLink() = default;

std::uint16_t IgtlLink::port() const { return parts_->port; }

std::vector<Order> IgtlLink::orders(const Session& session) {
    std::map<std::string, std::vector<Parts::Event>> events;
    {
        const std::scoped_lock lock(parts_->mutex);
        events.swap(parts_->events);
    }
    using Kind = Parts::Event::Kind;
    std::vector<Order> orders;
    for (const auto& [device, all] : events) {
        std::string& name = parts_->names[device];
        const LedTool* tool = session.find(name);
        bool is_in_hand = tool && tool->is_in_hand && !tool->is_to_be_withdrawn;
        bool is_used = tool != nullptr;  // the name
        for (const Parts::Event& event : all) {
            if (event.kind == Kind::pose && !is_in_hand) {
                int& number = parts_->numbers[device];
                if (number == 0 || is_used) ++number;  // else the last one was refused
                is_used = true;
                name = number == 1 ? device : device + "_" + std::to_string(number);
                orders.push_back(AddTool{name, parts_->options.tools.at(device), event.pose});
                is_in_hand = true;
            } else if (!is_in_hand) {
                continue;
            } else if (event.kind == Kind::pose) {
                orders.push_back(MoveTool{name, event.pose});
            } else if (event.kind == Kind::close) {
                orders.push_back(CloseTool{name});
            } else if (event.kind == Kind::open) {
                orders.push_back(OpenTool{name});
            } else {
                orders.push_back(WithdrawTool{name});
                is_in_hand = false;
            }
        }
    }
    return orders;
}

void IgtlLink::publish(const Session& session, const DisplayMesh& mesh) {
    std::shared_ptr<const Parts::Surface> shown;
    if (const auto now = Clock::now(); now >= parts_->next_surface) {
        parts_->next_surface = std::max(parts_->next_surface + surface_period, now);
        auto made = std::make_shared<Parts::Surface>();
        const auto positions = session.world().positions();
        made->points.reserve(mesh.nodes().size() * 3);
        for (const VertexId n : mesh.nodes())
            for (int i = 0; i < 3; ++i)
                made->points.push_back(static_cast<float>(positions[n.index()][i] / mm));
        made->triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
        shown = std::move(made);
    }
    const std::scoped_lock lock(parts_->mutex);
    if (shown) parts_->surface = std::move(shown);
    parts_->wrenches.clear();
    for (const auto& [device, name] : parts_->names) {
        const LedTool* tool = session.find(name);
        if (!tool || !tool->is_in_hand) continue;
        Parts::Wrench& wrench = parts_->wrenches[device];
        const auto [force, torque] = session.tool_forces().of(tool->id);
        std::copy_n(force.data(), 3, wrench.begin());
        std::copy_n(torque.data(), 3, wrench.begin() + 3);
    }
}

std::vector<std::string> IgtlLink::complaints() {
    const std::scoped_lock lock(parts_->mutex);
    return std::exchange(parts_->complaints, {});
}

// Else a haptic device would go on pushing the hand, whatever that does.
void IgtlLink::rest() {
    const std::scoped_lock lock(parts_->mutex);
    for (auto& [device, wrench] : parts_->wrenches) wrench = {};
}

}  // namespace incise::live
