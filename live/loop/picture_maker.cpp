// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/loop/picture_maker.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "incise/fragments/fragment_mesh.h"

namespace incise::live {

namespace {

constexpr std::uint32_t magic = 0x31434E49;  // INC1
enum Flag : std::uint32_t { has_topology = 1, has_values = 2 };

// Pages read little-endian numbers, as all machines are that this runs on.
template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void append(std::string& bytes, std::span<const T> values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

void append(std::vector<float>& numbers, const Vec3& v) {
    for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<float>(v[i]));
}

double von_mises(const Eigen::Matrix3d& stress) {
    const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
    return std::sqrt(1.5) * deviator.norm();
}

}  // namespace

const std::vector<ShownField>& PictureMaker::fields() {
    static const std::vector<ShownField> all = {{"none", ""},          {"displacement", "m"},
                                                {"speed", "m/s"},      {"von_mises", "Pa"},
                                                {"volume_ratio", "1"}, {"energy_density", "J/m3"}};
    return all;
}

bool PictureMaker::show(std::string_view field) {
    const auto found = std::ranges::find(fields(), field, &ShownField::name);
    if (found == fields().end()) return false;
    field_ = static_cast<std::size_t>(found - fields().begin());
    values_.clear();
    return true;
}

const DisplayMesh& PictureMaker::follow(Session& session) {
    sim::World& world = session.world();
    const topology::BoundarySurface& surface = world.surface();
    const bool is_changed = !world.take_surface_changes().empty();
    if (has_surface_ && !is_changed) return mesh_;
    has_surface_ = true;
    ++version_;
    mesh_.update(surface, world.mesh());
    values_.clear();
    rest_.clear();
    for (const VertexId n : mesh_.nodes()) append(rest_, world.mesh().rest_position(n));
    std::string bytes;
    bytes.reserve(mesh_.triangles().size_bytes() + rest_.size() * 4 + mesh_.tags().size_bytes());
    append(bytes, mesh_.triangles());
    append(bytes, std::span<const float>(rest_));
    append(bytes, mesh_.tags());
    topology_ = std::make_shared<const std::string>(std::move(bytes));
    return mesh_;
}

/// Adds the values of the field. Those of elements are costly: of these, a part is computed anew
/// for each picture.
void PictureMaker::add_values(const Session& session, std::string& bytes) {
    const sim::World& world = session.world();
    const auto nodes = mesh_.nodes();
    const std::string_view name = field();
    const bool is_of_nodes = name == "displacement" || name == "speed";
    constexpr std::size_t most_elements = 150;
    std::size_t count = is_of_nodes || values_.empty() ? nodes.size() : most_elements;
    values_.resize(nodes.size());
    const auto value = [&](std::size_t i) {
        const VertexId n = nodes[i];
        if (name == "displacement")
            return (world.positions()[n.index()] - world.mesh().rest_position(n)).norm();
        if (name == "speed") return world.velocities()[n.index()].norm();
        const physics::Model& model = world.model();
        const physics::ElementResult result =
            model.element_result(model.fragments().fragment_of_cell(mesh_.elements()[i]));
        if (name == "von_mises") return von_mises(result.cauchy_stress);
        if (name == "volume_ratio") return result.volume_ratio;
        return result.energy / result.volume;
    };
    for (count = std::min(count, nodes.size()); count > 0; --count) {
        if (next_value_ >= nodes.size()) next_value_ = 0;
        values_[next_value_] = static_cast<float>(value(next_value_));
        ++next_value_;
    }
    append(bytes, std::span<const float>(values_));
}

std::shared_ptr<Picture> PictureMaker::make(Session& session) {
    follow(session);
    auto picture = std::make_shared<Picture>();
    picture->topology_version = version_;
    picture->topology = topology_;
    const auto positions = session.world().positions();
    const auto nodes = mesh_.nodes();
    std::vector<float> shown;
    append(shown, nodes.empty() ? Vec3(Vec3::Zero()) : positions[nodes.front().index()]);
    const Vec3 origin(shown[0], shown[1], shown[2]);

    const auto header = [&](std::uint32_t flags, std::size_t num_triangles) {
        std::string bytes;
        append(bytes, magic);
        append(bytes, field_ == 0 ? flags : flags | has_values);
        append(bytes, static_cast<std::uint32_t>(version_));
        append(bytes, static_cast<std::uint32_t>(session.num_ticks()));
        append(bytes, static_cast<std::uint32_t>(nodes.size()));
        append(bytes, static_cast<std::uint32_t>(num_triangles));
        append(bytes, std::span<const float>(shown));
        append(bytes, std::uint32_t{0});
        return bytes;
    };
    picture->head_with_topology = header(has_topology, mesh_.triangles().size());
    picture->head_without_topology = header(0, 0);
    moving_.clear();
    for (const VertexId n : nodes) append(moving_, positions[n.index()] - origin);
    std::string& moving = picture->moving;
    moving.reserve(nodes.size() * 16);
    append(moving, std::span<const float>(moving_));
    if (field_ > 0) add_values(session, moving);
    return picture;
}

}  // namespace incise::live
