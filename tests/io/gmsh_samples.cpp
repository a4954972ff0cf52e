// The sample mesh in every version and encoding of Gmsh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tests/io/reader_samples.h"

namespace incise::io {

using topology::CellKind;
using topology::MeshData;

namespace {

/// Emits the numbers of a Gmsh file.
class GmshText {
  public:
    enum class Mode { ascii, binary, swapped };
    explicit GmshText(Mode mode) : mode_(mode) {}

    void text(std::string_view line) { bytes_ += line; }
    void integer(int value) { put(static_cast<std::int32_t>(value)); }
    void size(std::size_t value) { put(static_cast<std::uint64_t>(value)); }
    void real(double value) { put(value); }
    void end_line() {
        if (mode_ == Mode::ascii) bytes_ += "\n";
    }
    void format(const std::string& version) {
        text("$MeshFormat\n" + version + (mode_ == Mode::ascii ? " 0 8\n" : " 1 8\n"));
        if (mode_ != Mode::ascii) {
            integer(1);
            text("\n");
        }
        text("$EndMeshFormat\n");
    }
    /// The start or end of a section.
    void mark(const std::string& name) {
        text((name.starts_with("End") && mode_ != Mode::ascii ? "\n$" : "$") + name + "\n");
    }
    bool is_ascii() const { return mode_ == Mode::ascii; }
    const std::string& bytes() const { return bytes_; }

  private:
    template <class T>
    void put(T value) {
        if (mode_ == Mode::ascii) {
            bytes_ += std::to_string(value) + " ";
            return;
        }
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), &value, sizeof(T));
        if (mode_ == Mode::swapped) std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.data(), raw.size());
    }

    Mode mode_;
    std::string bytes_;
};

int gmsh_type(CellKind kind) {
    switch (kind) {
        case CellKind::tetrahedron:
            return 4;
        case CellKind::hexahedron:
            return 5;
        case CellKind::wedge:
            return 6;
        case CellKind::pyramid:
            return 7;
        case CellKind::polyhedron:
            break;
    }
    return 0;
}

std::string gmsh_1() {
    const auto mesh = sample_mesh();
    GmshText out(GmshText::Mode::ascii);
    out.text("$NOD\n" + std::to_string(mesh.points.size()) + "\n");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        out.integer(tag_of(static_cast<std::int64_t>(i)));
        for (const double x : mesh.points[i]) out.real(x);
        out.end_line();
    }
    out.text("$ENDNOD\n$ELM\n" + std::to_string(mesh.num_cells() + 3) + "\n");
    int tag = 1;
    const auto element = [&](int type, int region, const auto& nodes) {
        for (const int value : {tag++, type, region, 77, static_cast<int>(std::size(nodes))})
            out.integer(value);
        for (const auto node : nodes) out.integer(tag_of(node));
        out.end_line();
    };
    element(1, 9, std::array<std::int64_t, 2>{0, 1});
    for (const auto& triangle : sample_triangles) element(2, 9, triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        element(gmsh_type(mesh.kinds[c]), mesh.regions[c], nodes_in_files(mesh, c));
    out.text("$ENDELM\n");
    return out.bytes();
}

/// Nodes are on points, curves, surfaces and in volumes by turns, with parameters if asked for.
std::string gmsh_2(GmshText::Mode mode, bool is_parametric) {
    const auto mesh = sample_mesh();
    GmshText out(mode);
    out.text("$Comments\nmade by hand; $Nodes are below\n$EndComments\n");
    out.format("2.2");
    out.text("$PhysicalNames\n1\n3 4 \"liver\"\n$EndPhysicalNames\n");
    const std::string section = is_parametric ? "ParametricNodes" : "Nodes";
    out.text("$" + section + "\n" + std::to_string(mesh.points.size()) + "\n");
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        out.integer(tag_of(static_cast<std::int64_t>(i)));
        for (const double x : mesh.points[i]) out.real(x);
        if (is_parametric) {
            const int dimension = static_cast<int>(i) % 4;
            out.integer(dimension);
            out.integer(10);
            for (int k = 0; dimension < 3 && k < dimension; ++k) out.real(0.125);
        }
        out.end_line();
    }
    out.mark("End" + section);
    int tag = 1;
    // In ascii the type precedes the tags of each element; in binary it heads a block.
    const auto block = [&](int type, std::size_t count) {
        if (out.is_ascii()) return;
        out.integer(type);
        out.integer(static_cast<int>(count));
        out.integer(2);
    };
    const auto element = [&](int type, int region, const auto& nodes) {
        out.integer(tag++);
        if (out.is_ascii()) {
            out.integer(type);
            out.integer(2);
        }
        out.integer(region);
        out.integer(77);
        for (const auto node : nodes) out.integer(tag_of(node));
        out.end_line();
    };
    out.text("$Elements\n" + std::to_string(mesh.num_cells() + 3) + "\n");
    block(1, 1);
    element(1, 9, std::array<std::int64_t, 2>{0, 1});
    block(2, 2);
    for (const auto& triangle : sample_triangles) element(2, 9, triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        block(gmsh_type(mesh.kinds[c]), 1);
        element(gmsh_type(mesh.kinds[c]), mesh.regions[c], nodes_in_files(mesh, c));
    }
    out.mark("EndElements");
    out.text("$NodeData\n1\n\"T\"\n0\n0\n$EndNodeData\n");
    return out.bytes();
}

/// One volume a region, tagged 10 times as high; of a partitioned mesh if asked for.
std::string gmsh_4(GmshText::Mode mode, bool is_partitioned) {
    const auto mesh = sample_mesh();
    GmshText out(mode);
    out.format("4.1");
    out.mark(is_partitioned ? "PartitionedEntities" : "Entities");
    if (is_partitioned) {
        out.size(2);  // partitions
        out.size(1);  // ghost entities
        out.integer(500);
        out.integer(2);
        out.end_line();
    }
    for (const std::size_t count : {1, 1, 1, 3}) out.size(count);
    out.end_line();
    const auto entity = [&](int dimension, int tag, const std::vector<int>& groups) {
        out.integer(tag);
        if (is_partitioned) {
            out.integer(dimension);
            out.integer(1);
            out.size(1);
            out.integer(2);
        }
        for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) out.real(0.5 * i);
        out.size(groups.size());
        for (const int group : groups) out.integer(group);
        if (dimension > 0) {
            out.size(2);
            out.integer(1);
            out.integer(-1);
        }
        out.end_line();
    };
    entity(0, 1, {});
    entity(1, 1, {7});
    entity(2, 10, {8, 9});
    entity(3, 10, {1});
    entity(3, 20, {-2});
    entity(3, 40, {4});
    out.mark(is_partitioned ? "EndPartitionedEntities" : "EndEntities");

    // Nodes in two blocks, the first with parameters.
    const std::size_t num_first = 5;
    out.mark("Nodes");
    for (const std::size_t n :
         {std::size_t{2}, mesh.points.size(), std::size_t{1}, std::size_t{1000}})
        out.size(n);
    out.end_line();
    const auto nodes = [&](int dimension, bool is_parametric, std::size_t begin, std::size_t end) {
        out.integer(dimension);
        out.integer(10);
        out.integer(is_parametric ? 1 : 0);
        out.size(end - begin);
        out.end_line();
        for (std::size_t i = begin; i < end; ++i)
            out.size(static_cast<std::size_t>(tag_of(static_cast<std::int64_t>(i))));
        out.end_line();
        for (std::size_t i = begin; i < end; ++i) {
            for (const double x : mesh.points[i]) out.real(x);
            for (int k = 0; is_parametric && k < dimension; ++k) out.real(0.125);
            out.end_line();
        }
    };
    nodes(2, true, 0, num_first);
    nodes(3, false, num_first, mesh.points.size());
    out.mark("EndNodes");

    out.mark("Elements");
    for (const std::size_t n :
         {mesh.num_cells() + 2, mesh.num_cells() + 3, std::size_t{1}, mesh.num_cells() + 3})
        out.size(n);
    out.end_line();
    std::size_t tag = 1;
    const auto block = [&](int dimension, int entity_tag, int type, std::size_t count) {
        out.integer(dimension);
        out.integer(entity_tag);
        out.integer(type);
        out.size(count);
        out.end_line();
    };
    const auto element = [&](const auto& element_nodes) {
        out.size(tag++);
        for (const auto node : element_nodes) out.size(static_cast<std::size_t>(tag_of(node)));
        out.end_line();
    };
    block(1, 1, 1, 1);
    element(std::array<std::int64_t, 2>{0, 1});
    block(2, 10, 2, 2);
    for (const auto& triangle : sample_triangles) element(triangle);
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        block(3, 10 * mesh.regions[c], gmsh_type(mesh.kinds[c]), 1);
        element(nodes_in_files(mesh, c));
    }
    out.mark("EndElements");
    return out.bytes();
}

}  // namespace

std::vector<Sample> gmsh_samples() {
    using enum GmshText::Mode;
    std::vector<Sample> samples{{"ascii-1.msh", gmsh_1()}};
    for (const auto& [mode, name] :
         {std::pair{ascii, "ascii"}, std::pair{binary, "binary"}, std::pair{swapped, "swapped"}}) {
        samples.push_back({std::string(name) + "-2.msh", gmsh_2(mode, false)});
        samples.push_back({std::string(name) + "-2-parametric.msh", gmsh_2(mode, true)});
        samples.push_back({std::string(name) + "-4.msh", gmsh_4(mode, false)});
        samples.push_back({std::string(name) + "-4-partitioned.msh", gmsh_4(mode, true)});
    }
    return samples;
}

}  // namespace incise::io
