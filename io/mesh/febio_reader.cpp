// Meshes of FEBio (.feb).
// Source: FEBio User Manual 2.9, 3.6 and 4.4, chapter 3, "Geometry section" and "Mesh section".
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/febio_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/element_sets.h"
#include "incise/io/mesh/febio_files.h"
#include "incise/io/mesh/node_tags.h"

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

struct ElementType {
    std::string_view word;  ///< in lower case
    CellForm form;
};

// In cells of higher order, the corners come first. In a penta of FEBio, the normal of the first
// triangle points to the second triangle; in VTK it points away.
constexpr ElementType element_types[] = {
    {"tet4", {0, "tetrahedron", 4, keep, CellKind::tetrahedron}},
    {"ut4", {0, "tetrahedron", 4, keep, CellKind::tetrahedron}},
    {"hex8", {0, "hexahedron", 8, keep, CellKind::hexahedron}},
    {"penta6", {0, "wedge", 6, keep, CellKind::wedge, {0, 2, 1, 3, 5, 4}}},
    {"pyra5", {0, "pyramid", 5, keep, CellKind::pyramid}},
    {"tet5", {0, "tetrahedron with a node inside", 5, by_corners, CellKind::tetrahedron}},
    {"tet10", {0, "second-order tetrahedron", 10, by_corners, CellKind::tetrahedron}},
    {"tet15", {0, "second-order tetrahedron", 15, by_corners, CellKind::tetrahedron}},
    {"tet20", {0, "third-order tetrahedron", 20, by_corners, CellKind::tetrahedron}},
    {"hex20", {0, "second-order hexahedron", 20, by_corners, CellKind::hexahedron}},
    {"hex27", {0, "second-order hexahedron", 27, by_corners, CellKind::hexahedron}},
    {"penta15", {0, "second-order wedge", 15, by_corners, CellKind::wedge, {0, 2, 1, 3, 5, 4}}},
    {"pyra13", {0, "second-order pyramid", 13, by_corners, CellKind::pyramid}},
    {"tri3", {0, "triangle", 3, ignore}},
    {"tri6", {0, "second-order triangle", 6, ignore}},
    {"tri7", {0, "second-order triangle", 7, ignore}},
    {"tri10", {0, "third-order triangle", 10, ignore}},
    {"quad4", {0, "quadrilateral", 4, ignore}},
    {"quad8", {0, "second-order quadrilateral", 8, ignore}},
    {"quad9", {0, "second-order quadrilateral", 9, ignore}},
    {"line2", {0, "line", 2, ignore}},
    {"line3", {0, "second-order line", 3, ignore}},
    {"truss2", {0, "line", 2, ignore}},
};

/// Returns the text behind the declarations and comments at the beginning of XML.
std::string_view behind_prolog(std::string_view text) {
    while (true) {
        text = trimmed(text);
        const bool is_comment = text.starts_with("<!--");
        if (!is_comment && !text.starts_with("<?")) return text;
        const std::string_view mark = is_comment ? "-->" : "?>";
        const auto end = text.find(mark);
        if (end == text.npos) return {};
        text.remove_prefix(end + mark.size());
    }
}

class FebioReader {
  public:
    FebioReader(const FebioFile& file, const ReadOptions& options)
        : file_(file), collector_(file.name(), "type", options) {}

    MeshFile read() {
        const auto mesh = file_.mesh();
        for (const auto* name : {"Part", "Instance"})
            if (const auto part = mesh.child(name))
                fail(part, std::string(name) +
                               " is not read; save the mesh as one, with Nodes and Elements alone");
        for (const auto nodes : mesh.children("Nodes")) read_nodes(nodes);
        if (const auto twice = node_tags_.sort())
            throw InputError(file_.name() + ": node " + *twice);
        result_.mesh.source_points = node_tags_.in_order();
        for (const auto elements : mesh.children("Elements")) read_elements(elements);
        std::ranges::stable_sort(elements_, {}, &Element::id);
        for (const auto set : mesh.children("ElementSet")) read_set(set);
        set_regions();
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    /// Some programs begin the numbers of the elements anew in each block.
    struct Element {
        std::int64_t id;      ///< in the file
        std::int64_t number;  ///< from 1, of those that are kept; 0 for the others
    };

    [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
        file_.fail(node, message);
    }

    /// Returns the number in an attribute, 1 or more.
    std::int64_t id_of(pugi::xml_node node) const {
        const std::string_view text = node.attribute("id").value();
        const auto id = parse_number<std::int64_t>(text);
        if (!id || *id < 1)
            fail(node, std::string(node.name()) + ": the id is " + in_quotes(text) +
                           "; it must be a whole number from 1 on" +
                           range_remark<std::int64_t>(text));
        return *id;
    }

    /// Returns the numbers in the text of a node, which commas or blanks separate.
    template <class T>
    std::vector<T> numbers_in(pugi::xml_node node, std::string_view what) const {
        std::vector<T> numbers;
        std::string_view text = node.child_value();
        while (!(text = trimmed(text)).empty()) {
            const auto end =
                std::ranges::find_if(text, [](char c) { return c == ',' || is_blank(c); });
            const std::string_view word(text.begin(), end);
            const auto number = parse_number<T>(word);
            if (!number)
                fail(node, "expected " + std::string(what) + ", found " + in_quotes(word) +
                               range_remark<T>(word));
            numbers.push_back(*number);
            text = trimmed({end, text.end()});
            if (text.starts_with(',')) text.remove_prefix(1);
        }
        return numbers;
    }

    void read_nodes(pugi::xml_node nodes) {
        for (const auto node : nodes.children("node")) {
            node_tags_.add(id_of(node));
            const auto x = numbers_in<double>(node, "a coordinate");
            if (x.size() != 3)
                fail(node,
                     "a node has " + std::to_string(x.size()) + " coordinates; it must have 3");
            for (const double value : x)
                if (!std::isfinite(value))
                    fail(node, "a coordinate is " + shown(value) + "; it must be finite");
            result_.mesh.points.emplace_back(x[0], x[1], x[2]);
        }
    }

    const CellForm& form_of(pugi::xml_node elements) const {
        const std::string_view type = elements.attribute("type").value();
        // Letters behind a g name the integration, such as tet10g8.
        const auto word = lower_case(type.substr(0, type.find_first_of("gG")));
        const auto* found =
            std::ranges::find(element_types, std::string_view(word), &ElementType::word);
        if (found == std::end(element_types))
            fail(elements, "type " + in_quotes(type) +
                               " of Elements is not known; export tet4, hex8, penta6 or pyra5");
        return found->form;
    }

    void read_elements(pugi::xml_node elements) {
        const auto& form = form_of(elements);
        const std::string_view type = elements.attribute("type").value();
        if (form.use == ignore) {
            for (const auto element : elements.children("elem")) {
                elements_.push_back({id_of(element), 0});
                collector_.ignore(form);
            }
            return;
        }
        const auto region = region_of(elements);
        for (const auto element : elements.children("elem")) {
            const auto id = id_of(element);
            const auto here = "element " + std::to_string(id) + ": ";
            if (collector_.refuses(form))
                collector_.refuse(
                    form, file_.location_of(element) + ": element " + std::to_string(id), type);
            auto nodes = numbers_in<std::int64_t>(element, "a node of an element");
            if (nodes.size() != static_cast<std::size_t>(form.num_nodes))
                fail(element, here + "has " + std::to_string(nodes.size()) + " nodes; a " +
                                  form.name + " has " + std::to_string(form.num_nodes));
            for (auto& node : nodes) {
                const auto found = node_tags_.find(node);
                if (!found)
                    fail(element, here + "node " + std::to_string(node) + " is not one of the " +
                                      std::to_string(node_tags_.size()) + " nodes");
                node = *found;
            }
            collector_.keep(form, id, nodes, 0, result_.mesh);
            const auto number = static_cast<std::int64_t>(result_.mesh.num_cells());
            elements_.push_back({id, number});
            if (region) sets_.add(*region, {number, number, 1});
        }
    }

    /// Returns the set of a block of elements: its material or its name, if it has one.
    std::optional<std::size_t> region_of(pugi::xml_node elements) {
        if (const auto material = elements.attribute("mat"); material && file_.is_version_2()) {
            const std::string_view text = material.value();
            const auto number = parse_number<int>(text);
            if (!number)
                fail(elements,
                     "mat is " + in_quotes(text) + "; it must be the number of a material");
            return sets_.define("REGION_" + std::to_string(*number), ElementSets::Role::of_section);
        }
        const std::string name = elements.attribute("name").value();
        if (name.empty()) return std::nullopt;
        return sets_.define(name, ElementSets::Role::of_elements);
    }

    /// Reads a set: a list of numbers (version 4), or of rows with the numbers.
    void read_set(pugi::xml_node set) {
        const std::string name = set.attribute("name").value();
        if (name.empty()) fail(set, "ElementSet has no name");
        const auto index = sets_.define(name, ElementSets::Role::of_list);
        for (const auto row : set.children("elem")) add_to_set(index, id_of(row), row);
        for (const auto id : numbers_in<std::int64_t>(set, "the number of an element"))
            add_to_set(index, id, set);
    }

    void add_to_set(std::size_t set, std::int64_t id, pugi::xml_node place) {
        const auto begin = std::ranges::lower_bound(elements_, id, {}, &Element::id);
        const auto end = std::ranges::upper_bound(elements_, id, {}, &Element::id);
        const auto name = "element " + std::to_string(id) + " of an ElementSet is ";
        if (begin == end)
            fail(place, name + "not one of the " + std::to_string(elements_.size()) + " elements");
        if (end - begin > 1)
            fail(place, name + "the number of " + std::to_string(end - begin) +
                            " elements; give each element a number of its own");
        if (begin->number > 0) sets_.add(set, {begin->number, begin->number, 1});
    }

    void set_regions() {
        std::vector<std::int64_t> numbers(result_.mesh.num_cells());
        std::iota(numbers.begin(), numbers.end(), std::int64_t{1});
        auto [regions, warnings] = sets_.regions(numbers);
        result_.mesh.regions = std::move(regions);
        result_.warnings.insert(result_.warnings.end(), warnings.begin(), warnings.end());
    }

    const FebioFile& file_;
    CellCollector collector_;
    NodeTags node_tags_;
    std::vector<Element> elements_;
    ElementSets sets_;
    MeshFile result_;
};

}  // namespace

bool begins_as_febio(std::string_view text) { return behind_prolog(text).starts_with("<febio_"); }

MeshFile read_febio(const InputFile& file, const ReadOptions& options) {
    return FebioReader(*febio_file_with_mesh(file), options).read();
}

}  // namespace incise::io
