// Meshes of Gmsh (.msh), versions 1, 2.x and 4.1.
// Source: Gmsh reference manual, "Gmsh file formats" (4.8): MSH 4.1, MSH 2 (legacy), MSH 1
// (legacy). SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/gmsh_reader.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/node_tags.h"

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

// In cells of higher order, the corners come first. In a prism of Gmsh, the normal of the first
// triangle points to the second triangle; in VTK it points away.
constexpr CellForm gmsh_forms[] = {
    {1, "line", 2, ignore},
    {2, "triangle", 3, ignore},
    {3, "quadrilateral", 4, ignore},
    {4, "tetrahedron", 4, keep, CellKind::tetrahedron},
    {5, "hexahedron", 8, keep, CellKind::hexahedron},
    {6, "wedge", 6, keep, CellKind::wedge, {0, 2, 1, 3, 5, 4}},
    {7, "pyramid", 5, keep, CellKind::pyramid},
    {8, "second-order line", 3, ignore},
    {9, "second-order triangle", 6, ignore},
    {10, "second-order quadrilateral", 9, ignore},
    {11, "second-order tetrahedron", 10, by_corners, CellKind::tetrahedron},
    {12, "second-order hexahedron", 27, by_corners, CellKind::hexahedron},
    {13, "second-order wedge", 18, by_corners, CellKind::wedge, {0, 2, 1, 3, 5, 4}},
    {14, "second-order pyramid", 14, by_corners, CellKind::pyramid},
    {15, "point element", 1, ignore},
    {16, "second-order quadrilateral", 8, ignore},
    {17, "second-order hexahedron", 20, by_corners, CellKind::hexahedron},
    {18, "second-order wedge", 15, by_corners, CellKind::wedge, {0, 2, 1, 3, 5, 4}},
    {19, "second-order pyramid", 13, by_corners, CellKind::pyramid},
    {20, "third-order triangle", 9, ignore},
    {21, "third-order triangle", 10, ignore},
    {22, "fourth-order triangle", 12, ignore},
    {23, "fourth-order triangle", 15, ignore},
    {24, "fifth-order triangle", 15, ignore},
    {25, "fifth-order triangle", 21, ignore},
    {26, "third-order line", 4, ignore},
    {27, "fourth-order line", 5, ignore},
    {28, "fifth-order line", 6, ignore},
    {29, "third-order tetrahedron", 20, by_corners, CellKind::tetrahedron},
    {30, "fourth-order tetrahedron", 35, by_corners, CellKind::tetrahedron},
    {31, "fifth-order tetrahedron", 56, by_corners, CellKind::tetrahedron},
    {92, "third-order hexahedron", 64, by_corners, CellKind::hexahedron},
    {93, "fourth-order hexahedron", 125, by_corners, CellKind::hexahedron},
};
static_assert(std::is_sorted(std::begin(gmsh_forms), std::end(gmsh_forms),
                             [](const auto& a, const auto& b) { return a.code < b.code; }));

class GmshReader {
  public:
    GmshReader(const InputFile& file, const ReadOptions& options)
        : file_(file), scanner_(file), collector_(file.name(), "Gmsh element type", options) {}

    MeshFile read() {
        while (!scanner_.at_end()) {
            const auto line = scanner_.rest_of_line();
            if (line.starts_with('$')) read_section(line.substr(1));
        }
        if (!has_format_ && !is_version_1_)
            throw InputError(file_.name() +
                             ": has no $MeshFormat section, so it is no mesh of Gmsh; save it as "
                             "Gmsh version 4.1 or 2.2");
        const auto section = [&](const char* word, const char* word_1) {
            return std::string("$") + (is_version_1_ ? word_1 : word);
        };
        if (!has_nodes_)
            throw InputError(file_.name() + ": has no " + section("Nodes", "NOD") + " section");
        if (!has_elements_)
            throw InputError(file_.name() + ": has no " + section("Elements", "ELM") + " section");
        auto& warnings = result_.warnings;
        if (num_shared_entities_ > 0)
            warnings.push_back(std::to_string(num_shared_entities_) +
                               " volumes are in several physical groups; the first of each is "
                               "taken as the region");
        collector_.finish(result_.mesh, warnings);
        return std::move(result_);
    }

  private:
    void read_section(std::string_view line) {
        const auto name = line.substr(0, line.find_first_of(" \t"));
        auto end_prefix = std::string("$End");
        if (name == "NOD" || name == "NOE" || name == "ELM") {
            if (has_format_)
                scanner_.fail("$" + std::string(name) +
                              " belongs to version 1, which has no $MeshFormat; save the mesh anew "
                              "as Gmsh version 4.1 or 2.2");
            is_version_1_ = true;
            end_prefix = "$END";
            name == "ELM" ? read_elements_1() : read_nodes_2(false);
        } else if (name == "MeshFormat") {
            read_format();
        } else if (name == "Nodes" || name == "ParametricNodes" || name == "Elements" ||
                   name == "Entities" || name == "PartitionedEntities") {
            if (!has_format_) scanner_.fail("$" + std::string(name) + " comes before $MeshFormat");
            if (name == "Nodes") is_version_2_ ? read_nodes_2(false) : read_nodes_4();
            if (name == "ParametricNodes") {
                if (!is_version_2_)
                    scanner_.fail(
                        "$ParametricNodes belongs to version 2; save the mesh anew as "
                        "Gmsh version 4.1 or 2.2");
                read_nodes_2(true);
            }
            if (name == "Elements") is_version_2_ ? read_elements_2() : read_elements_4();
            if (name == "Entities") read_entities(false);
            if (name == "PartitionedEntities") read_entities(true);
        } else {
            const auto end = "$End" + std::string(name);
            // A name may contain the mark, which then does not begin a line. In other sections the
            // mark need not begin a line.
            const bool may_quote = name == "PhysicalNames";
            if (!(may_quote ? scanner_.skip_past_line(end) : scanner_.skip_past(end)))
                scanner_.fail("section " + in_quotes(name) + " has no " + in_quotes(end) +
                              "; the file is cut short");
            return;
        }
        const auto end = end_prefix + std::string(name);
        if (scanner_.at_end()) fail_unclosed(name, end, "the end of the file");
        const auto found = scanner_.token(end);
        if (found == end) return;
        if (found.starts_with('$')) fail_unclosed(name, end, in_quotes(found));
        scanner_.fail_expected(end, found);
    }

    [[noreturn]] void fail_unclosed(std::string_view name, const std::string& end,
                                    const std::string& before) const {
        scanner_.fail("section " + in_quotes(name) + " has no " + in_quotes(end) + " before " +
                      before + "; the file is damaged: save the mesh anew, or add that line");
    }

    void read_format() {
        if (has_format_) scanner_.fail("has a second $MeshFormat section");
        if (is_version_1_)
            scanner_.fail("$MeshFormat comes behind sections of version 1; put it first");
        const auto version = scanner_.token("the version");
        is_version_2_ = version == "2" || version.starts_with("2.");
        if (!is_version_2_ && version != "4.1")
            scanner_.fail("version " + in_quotes(version) +
                          " cannot be read; save the mesh as Gmsh version 4.1 or 2.2");
        const auto file_type = scanner_.number<int>("the file type, 0 or 1");
        if (file_type != 0 && file_type != 1)
            scanner_.fail("file type is " + std::to_string(file_type) +
                          "; it must be 0 (ascii) or 1 (binary)");
        const auto data_size = scanner_.number<int>("the data size");
        has_short_sizes_ = data_size == 4 && !is_version_2_;
        if (data_size != 8 && !has_short_sizes_)
            scanner_.fail("data size is " + std::to_string(data_size) + "; it must be 8");
        has_format_ = true;
        if (file_type == 0) return;
        scanner_.rest_of_line();
        scanner_.set_binary(true, false);
        const auto one = scanner_.value<std::int32_t>("the number 1 that tells the byte order");
        if (one != 1 && one != 0x01000000)
            scanner_.fail("the number that tells the byte order is " + std::to_string(one) +
                          "; it must be 1");
        scanner_.set_binary(true, one != 1);
    }

    // The next three functions read the types size_t, int and double of MSH 4.1, as text or binary.
    std::int64_t size_value(std::string_view what) {
        const auto value = scanner_.is_binary() && has_short_sizes_
                               ? scanner_.value<std::uint32_t>(what)
                               : scanner_.value<std::uint64_t>(what);
        if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
            scanner_.fail(std::string(what) + " is " + std::to_string(value) +
                          "; the file is damaged");
        return static_cast<std::int64_t>(value);
    }
    int int_value(std::string_view what) { return scanner_.value<std::int32_t>(what); }
    double real_value(std::string_view what) { return scanner_.value<double>(what); }

    /// Reads the count of items that follow. Each has at least `numbers_each` numbers, of at least
    /// `bytes_each` bytes in a binary file.
    std::size_t count_value(std::string_view what, std::size_t numbers_each,
                            std::size_t bytes_each) {
        const auto count = static_cast<std::uint64_t>(size_value(what));
        scanner_.require_room(count, numbers_each * (scanner_.is_binary() ? bytes_each : 2), what);
        return static_cast<std::size_t>(count);
    }
    void skip_ints(std::size_t count, std::string_view what) {
        for (std::size_t i = 0; i < count; ++i) int_value(what);
    }
    void skip_reals(std::size_t count, std::string_view what) {
        for (std::size_t i = 0; i < count; ++i) real_value(what);
    }

    /// The same for a count that is text also in a binary file, on a line before the data.
    std::size_t text_count(std::string_view what, std::size_t numbers_each,
                           std::size_t bytes_each) {
        const auto count =
            scanner_.count(what, numbers_each * (scanner_.is_binary() ? bytes_each : 2));
        if (scanner_.is_binary()) scanner_.rest_of_line();
        return count;
    }

    int entity_dimension() {
        const int dimension = int_value("the dimension of an entity");
        if (dimension < 0 || dimension > 3)
            scanner_.fail("the dimension of an entity is " + std::to_string(dimension) +
                          "; it must be 0 to 3");
        return dimension;
    }

    void add_point() {
        const double x = scanner_.coordinate("an x coordinate");
        const double y = scanner_.coordinate("a y coordinate");
        const double z = scanner_.coordinate("a z coordinate");
        result_.mesh.points.emplace_back(x, y, z);
    }

    void finish_nodes() {
        has_nodes_ = true;
        if (const auto twice = node_tags_.sort())
            throw InputError(file_.name() + ": node tag " + *twice);
        result_.mesh.source_points = node_tags_.in_order();
    }

    void begin_nodes() {
        if (has_nodes_) scanner_.fail("has a second section of nodes");
    }

    void begin_elements() {
        if (!has_nodes_) scanner_.fail("the elements come before the nodes; put the nodes first");
        has_elements_ = true;
    }

    const CellForm& form_of(int type) const {
        const auto* form = find_form(gmsh_forms, type);
        if (form == nullptr)
            scanner_.fail("element type " + std::to_string(type) +
                          " is not known; export linear elements");
        return *form;
    }

    static std::string element_name(std::int64_t tag) { return "element " + std::to_string(tag); }

    void refuse_form(const CellForm& form, std::int64_t tag) const {
        if (collector_.refuses(form))
            collector_.refuse(form, scanner_.location() + ": " + element_name(tag));
    }

    /// Keeps the element whose node tags are in nodes_. Replaces the tags there by point numbers.
    void keep_element(const CellForm& form, std::int64_t tag, int region) {
        const auto nodes = std::span(nodes_).first(static_cast<std::size_t>(form.num_nodes));
        for (auto& node : nodes) {
            const auto found = node_tags_.find(node);
            if (!found)
                scanner_.fail(element_name(tag) + ": node tag " + std::to_string(node) +
                              " is not one of the " + std::to_string(node_tags_.size()) + " nodes");
            node = *found;
        }
        collector_.keep(form, tag, nodes, region, result_.mesh);
    }

    // --- versions 1 and 2: n, then n times: tag x y z. A parametric node also has the dimension
    // and the tag of its entity, and one parameter on a curve or two on a surface.
    void read_nodes_2(bool are_parametric) {
        begin_nodes();
        const auto num_nodes = text_count("the number of nodes", are_parametric ? 6 : 4, 4);
        result_.mesh.points.reserve(num_nodes);
        for (std::size_t i = 0; i < num_nodes; ++i) {
            node_tags_.add(int_value("a node tag"));
            add_point();
            if (!are_parametric) continue;
            const int dimension = entity_dimension();
            int_value("the tag of an entity");
            if (dimension == 1 || dimension == 2)
                skip_reals(static_cast<std::size_t>(dimension), "a parameter of a node");
        }
        finish_nodes();
    }

    // --- version 1: n, then n times: tag type physical_group entity num_nodes nodes
    void read_elements_1() {
        begin_elements();
        const auto num_elements = text_count("the number of elements", 6, 4);
        for (std::size_t i = 0; i < num_elements; ++i) {
            const auto tag = int_value("an element tag");
            const auto& form = form_of(int_value("an element type"));
            const auto region = int_value("a physical group");
            int_value("the tag of an entity");
            const auto num_nodes = int_value("the number of nodes of an element");
            if (num_nodes != form.num_nodes)
                scanner_.fail(element_name(tag) + ": has " + std::to_string(num_nodes) +
                              " nodes; a " + form.name + " has " + std::to_string(form.num_nodes));
            read_element(form, tag, region);
        }
    }

    // --- version 2: n, then in a text file n times: tag type num_tags tags nodes;
    // in a binary file blocks: type count num_tags, then count times: tag tags nodes
    void read_elements_2() {
        begin_elements();
        const auto num_elements = text_count("the number of elements", 2, 4);
        std::size_t num_read = 0;
        while (num_read < num_elements) {
            std::size_t num_in_block = 1;
            std::int64_t tag = 0;
            if (!scanner_.is_binary()) tag = int_value("an element tag");
            const int type = int_value("an element type");
            const auto& form = form_of(type);
            if (scanner_.is_binary()) {
                const int count = int_value("the number of elements that follow");
                if (count < 1 || static_cast<std::size_t>(count) > num_elements - num_read)
                    scanner_.fail(std::to_string(count) + " elements follow, but " +
                                  std::to_string(num_elements - num_read) + " are left");
                num_in_block = static_cast<std::size_t>(count);
            }
            const int num_tags = int_value("the number of tags");
            if (num_tags < 0)
                scanner_.fail("the number of tags is " + std::to_string(num_tags) +
                              "; it must be 0 or more");
            for (std::size_t i = 0; i < num_in_block; ++i) {
                if (scanner_.is_binary()) tag = int_value("an element tag");
                read_element_2(form, tag, num_tags);
            }
            num_read += num_in_block;
        }
    }

    void read_element_2(const CellForm& form, std::int64_t tag, int num_tags) {
        int region = 0;
        for (int i = 0; i < num_tags; ++i) {
            const int value = int_value("a tag of an element");
            if (i == 0) region = value;  // the first tag is the physical group
        }
        read_element(form, tag, region);
    }

    /// Reads the nodes of an element of version 1 or 2.
    void read_element(const CellForm& form, std::int64_t tag, int region) {
        refuse_form(form, tag);
        if (form.use == ignore) {
            skip_ints(static_cast<std::size_t>(form.num_nodes), "a node of an element");
            collector_.ignore(form);
            return;
        }
        for (int i = 0; i < form.num_nodes; ++i)
            nodes_[static_cast<std::size_t>(i)] = int_value("a node of an element");
        keep_element(form, tag, region);
    }

    // --- version 4.1: points, curves, surfaces, volumes. Only the physical groups of the volumes
    // are kept. An entity of a partition begins with its parent entity.
    void read_entities(bool are_partitioned) {
        if (has_elements_)
            scanner_.fail(
                "the entities come behind $Elements, whose regions they tell; put $Elements last, "
                "or save the mesh anew with Gmsh");
        if (are_partitioned) {
            size_value("the number of partitions");
            const auto num_ghosts = count_value("the number of ghost entities", 2, 4);
            skip_ints(2 * num_ghosts, "a ghost entity");
        }
        std::array<std::size_t, 4> counts{};
        for (auto& count : counts) count = count_value("the number of entities", 4, 4);
        for (std::size_t dimension = 0; dimension < counts.size(); ++dimension)
            for (std::size_t i = 0; i < counts[dimension]; ++i)
                read_entity(dimension, are_partitioned);
    }

    void read_entity(std::size_t dimension, bool is_partitioned) {
        const int tag = int_value("the tag of an entity");
        if (is_partitioned) {
            skip_ints(2, "the parent of an entity");
            skip_ints(count_value("the number of partitions", 1, 4), "a partition");
        }
        skip_reals(dimension == 0 ? 3 : 6, "the bounds of an entity");
        const auto num_groups = count_value("the number of physical groups", 1, 4);
        for (std::size_t i = 0; i < num_groups; ++i) {
            // A negative group has the opposite orientation.
            const auto group = std::abs(std::int64_t{int_value("a physical group")});
            if (dimension != 3 || i > 0) continue;
            if (group > std::numeric_limits<int>::max())
                scanner_.fail("physical group " + std::to_string(group) + " is too large");
            group_of_volume_[tag] = static_cast<int>(group);
        }
        if (dimension == 3 && num_groups > 1) ++num_shared_entities_;
        if (dimension > 0)
            skip_ints(count_value("the number of bounding entities", 1, 4), "a bounding entity");
    }

    // --- version 4.1: blocks of the nodes of an entity: first the tags, then the coordinates
    void read_nodes_4() {
        begin_nodes();
        const auto num_blocks = count_value("the number of node blocks", 4, 4);
        const auto num_nodes = count_value("the number of nodes", 4, 4);
        size_value("the lowest node tag");
        size_value("the highest node tag");
        result_.mesh.points.reserve(num_nodes);
        for (std::size_t b = 0; b < num_blocks; ++b) {
            const int dimension = entity_dimension();
            int_value("the tag of an entity");
            const bool is_parametric = int_value("whether nodes are parametric") != 0;
            const auto num_in_block = count_value("the number of nodes in a block", 4, 4);
            for (std::size_t i = 0; i < num_in_block; ++i) node_tags_.add(size_value("a node tag"));
            for (std::size_t i = 0; i < num_in_block; ++i) {
                add_point();
                if (is_parametric)
                    skip_reals(static_cast<std::size_t>(dimension), "a parameter of a node");
            }
        }
        if (node_tags_.size() != num_nodes)
            scanner_.fail("the blocks hold " + std::to_string(node_tags_.size()) + " nodes, but " +
                          std::to_string(num_nodes) + " are announced");
        finish_nodes();
    }

    // --- version 4.1: blocks of the elements of an entity, all of one type: tag nodes
    void read_elements_4() {
        begin_elements();
        const auto num_blocks = count_value("the number of element blocks", 4, 4);
        const auto num_elements = count_value("the number of elements", 2, 4);
        size_value("the lowest element tag");
        size_value("the highest element tag");
        std::size_t num_read = 0;
        for (std::size_t b = 0; b < num_blocks; ++b) {
            const int dimension = int_value("the dimension of an entity");
            const int entity = int_value("the tag of an entity");
            const auto& form = form_of(int_value("an element type"));
            const auto num_in_block = count_value("the number of elements in a block", 2, 4);
            const auto group = group_of_volume_.find(entity);
            const bool has_group = dimension == 3 && group != group_of_volume_.end();
            for (std::size_t i = 0; i < num_in_block; ++i)
                read_element_4(form, has_group ? group->second : 0);
            num_read += num_in_block;
        }
        if (num_read != num_elements)
            scanner_.fail("the blocks hold " + std::to_string(num_read) + " elements, but " +
                          std::to_string(num_elements) + " are announced");
    }

    void read_element_4(const CellForm& form, int region) {
        const auto tag = size_value("an element tag");
        refuse_form(form, tag);
        for (int i = 0; i < form.num_nodes; ++i)
            nodes_[static_cast<std::size_t>(i)] = size_value("a node of an element");
        if (form.use == ignore)
            collector_.ignore(form);
        else
            keep_element(form, tag, region);
    }

    const InputFile& file_;
    Scanner scanner_;
    CellCollector collector_;
    NodeTags node_tags_;
    std::map<int, int> group_of_volume_;
    std::array<std::int64_t, 125> nodes_{};  ///< of the current element; no form has more
    MeshFile result_;
    std::size_t num_shared_entities_ = 0;
    bool is_version_1_ = false;
    bool is_version_2_ = false;
    bool has_short_sizes_ = false;
    bool has_format_ = false;
    bool has_nodes_ = false;
    bool has_elements_ = false;
};

}  // namespace

MeshFile read_gmsh(const InputFile& file, const ReadOptions& options) {
    return GmshReader(file, options).read();
}

}  // namespace incise::io
