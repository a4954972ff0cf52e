// Trackers, haptic devices and 3D Slicer in a live session, through OpenIGTLink.
// docs/slicer.md describes the messages. The only file that includes the library is igtl_link.cpp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "incise/live/loop/device.h"
#include "incise/scenario/document.h"

namespace incise::live {

struct IgtlOptions {
    std::string host = "127.0.0.1";  ///< address to listen on
    std::uint16_t port = 18944;      ///< 0: any that is free
    /// The tools that messages lead: by the name of the device, a definition as for AddTool.
    std::map<std::string, scenario::Value> tools;
};

/// An OpenIGTLink server with a thread of its own.
///
/// In, in versions 1 and 2 of the header: TRANSFORM is where the tool of this device name is to be;
/// the first one takes the tool. STRING is what it does: "close", "open" or "drop". When a
/// connection ends, its tools are dropped. What cannot be used is told once for each connection and
/// cause. Out: POLYDATA, the surface of the body, 30 times a second; SENSOR, force and torque on
/// each tool, 1000 times a second.
///
/// Lengths in messages are mm, in the frame RAS, which is that of the scenario times 1000. Forces
/// are N and N m in the same frame, and zero while nothing moves.
class IgtlLink : public Device {
  public:
    static constexpr std::size_t longest_message = 64 * 1024;  ///< bytes
    static constexpr std::size_t most_connections = 8;

    /// Begins to listen. Throws OutputError if the address cannot be listened on, and InputError if
    /// the host is no address.
    explicit IgtlLink(IgtlOptions options);
    ~IgtlLink() override;

    std::uint16_t port() const;
    std::vector<Order> orders(const Session& session) override;
    void publish(const Session& session, const DisplayMesh& surface) override;
    void rest() override;
    std::vector<std::string> complaints() override;

  private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace incise::live
