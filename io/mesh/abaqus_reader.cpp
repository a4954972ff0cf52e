// Meshes of Abaqus and CalculiX (.inp).
// Source: Abaqus 6.14 Analysis User's Guide, 1.2.1 "Input syntax rules" and 2.1 to 2.2 on nodes,
// elements and sets; CalculiX CrunchiX 2.20 user's manual, chapter 7.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_reader.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/mesh/abaqus_element.h"
#include "incise/io/mesh/abaqus_lines.h"
#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/element_sets.h"
#include "incise/io/mesh/node_tags.h"

namespace incise::io {

namespace {

using Role = ElementSets::Role;

/// Keywords that would change the mesh, and the reason in the error message.
constexpr std::pair<std::string_view, const char*> refused_keywords[] = {
    {"NGEN", "nodes are not generated; export all of them"},
    {"NFILL", "nodes are not generated; export all of them"},
    {"NCOPY", "nodes are not copied; export all of them"},
    {"NMAP", "nodes are not mapped; export them where they are"},
    {"SYSTEM", "nodes are not moved to other axes; export them in global coordinates"},
    {"ELGEN", "elements are not generated; export all of them"},
    {"ELCOPY", "elements are not copied; export all of them"},
};

class AbaqusReader {
  public:
    AbaqusReader(const InputFile& file, const ReadOptions& options)
        : file_(file), lines_(file), collector_(file.name(), "TYPE", options) {}

    MeshFile read() {
        while (lines_.next()) {
            if (lines_.is_keyword())
                begin_section();
            else if (read_row_ != nullptr)
                (this->*read_row_)();
            else if (keyword_.name.empty())
                leave_out_line();
        }
        finish_element();
        add_elements();
        warn_of_short_nodes();
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    struct Element {
        std::int64_t number;
        std::size_t place;  ///< its first byte in the file
        const CellForm* form;
        std::size_t first_node;  ///< in nodes_
    };
    enum class Scope : std::uint8_t { model, part, assembly, instance };

    /// Some decks begin with a text that is no comment.
    void leave_out_line() {
        if (!std::exchange(has_text_before_, true))
            result_.warnings.push_back(
                "left out what comes before the first keyword, and is no comment with **");
    }

    void begin_section() {
        finish_element();
        read_row_ = nullptr;
        keyword_ = lines_.keyword();
        const auto& keyword = keyword_.name;
        if (keyword == "NODE") return begin_nodes();
        if (keyword == "ELEMENT") return begin_elements();
        if (keyword == "ELSET") return begin_set();
        if (keyword == "SOLIDSECTION") return give_section();
        if (keyword == "PART") return enter(Scope::part);
        if (keyword == "INSTANCE") return begin_instance();
        if (keyword == "ASSEMBLY" || keyword == "ENDINSTANCE") return enter(Scope::assembly);
        if (keyword == "ENDPART" || keyword == "ENDASSEMBLY") return enter(Scope::model);
        for (const auto& [refused, reason] : refused_keywords)
            if (keyword == refused) lines_.fail("*" + keyword + ": " + reason);
    }

    void enter(Scope scope) {
        scope_ = scope;
        if (scope == Scope::part || scope == Scope::instance) ++num_scopes_;
    }

    void begin_instance() {
        if (has_instance_)
            lines_.fail("has a second *INSTANCE; export one part, or the assembly as one mesh");
        has_instance_ = true;
        enter(Scope::instance);
        read_row_ = &AbaqusReader::read_instance_row;
    }

    void read_instance_row() {
        for (const auto field : lines_.fields())
            if (!field.empty() && lines_.real(field, "a translation or rotation") != 0.0)
                lines_.fail(
                    "*INSTANCE moves the part, which is not done here; export the nodes where "
                    "they are in the assembly");
    }

    /// True if this section is part of the mesh. An assembly itself has only reference points and
    /// their sets, which are skipped. Throws InputError for a second part with nodes or elements.
    bool is_of_mesh() {
        if (scope_ == Scope::assembly) return false;
        const auto scope = scope_ == Scope::model ? 0 : num_scopes_;
        if (mesh_scope_.value_or(scope) != scope)
            lines_.fail(
                "nodes or elements of a second part; export one part, or the assembly as one "
                "mesh");
        mesh_scope_ = scope;
        return true;
    }

    // --- *NODE: number, x, y, z; coordinates that are left out are 0

    void begin_nodes() {
        if (!is_of_mesh()) return;
        const auto system = keyword_.parameter("SYSTEM").value_or("R");
        if (system != "R")
            lines_.fail("SYSTEM=" + in_quotes(system) +
                        ": cannot be read; export the nodes in rectangular coordinates");
        read_row_ = &AbaqusReader::read_node;
    }

    void read_node() {
        const auto fields = lines_.fields();
        constexpr std::array names = {"coordinate x", "coordinate y", "coordinate z"};
        node_tags_.add(lines_.number(fields[0], "the number of a node"));
        Vec3 point;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto field = 1 + i < fields.size() ? fields[1 + i] : std::string_view();
            const double value = field.empty() ? 0.0 : lines_.real(field, names[i]);
            point[static_cast<Eigen::Index>(i)] = value;
        }
        // An empty field is meant to be 0; a row that ends early may be damaged.
        if (fields.size() < 1 + names.size() && num_short_nodes_++ == 0)
            first_short_node_ = fields[0];
        result_.mesh.points.push_back(point);
    }

    void warn_of_short_nodes() {
        if (num_short_nodes_ == 0) return;
        const auto first = "node " + first_short_node_;
        result_.warnings.push_back(
            (num_short_nodes_ == 1
                 ? first + " has"
                 : std::to_string(num_short_nodes_) + " nodes, the first " + first + ", have") +
            " less than three coordinates; those that are left out are taken as 0");
    }

    // --- *ELEMENT: number, nodes; a row may continue on the next lines

    void begin_elements() {
        if (!is_of_mesh()) return;
        type_ = keyword_.parameter("TYPE").value_or("");
        if (type_.empty()) lines_.fail("*ELEMENT has no TYPE");
        form_ = abaqus_form(type_);
        if (form_ == nullptr)
            lines_.fail(
                "TYPE=" + in_quotes(type_) +
                ": is not known here; export solid elements alone (C3D4, C3D5, C3D6, C3D8)");
        const bool is_ignored = form_->use == CellForm::Use::ignore;
        element_set_.reset();
        if (const auto name = keyword_.parameter("ELSET"))
            element_set_ = sets_.define(*name, is_ignored ? Role::internal : Role::of_elements);
        read_row_ = is_ignored ? &AbaqusReader::ignore_element : &AbaqusReader::read_element;
    }

    void ignore_element() {
        // Not all forms have a number of nodes. A row that continues ends with a comma.
        if (!goes_on_) collector_.ignore(*form_);
        goes_on_ = lines_.goes_on();
    }

    void read_element() {
        auto fields = lines_.fields();
        if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
        const bool is_new = row_.empty();
        for (const auto field : fields)
            row_.push_back(
                lines_.number(field, row_.empty() ? "the number of an element" : "a node"));
        if (is_new) row_place_ = lines_.byte();
        if (collector_.refuses(*form_))
            collector_.refuse(*form_, lines_.location() + ": " + element_name(row_.front()), type_);
        const auto num_nodes = row_.size() - 1, wanted = static_cast<std::size_t>(form_->num_nodes);
        if (num_nodes < wanted) return;
        if (num_nodes > wanted)
            lines_.fail(element_name(row_.front()) + ": has " + std::to_string(num_nodes) +
                        " nodes; a " + form_->name + " has " + std::to_string(wanted));
        elements_.push_back({row_.front(), row_place_, form_, nodes_.size()});
        nodes_.insert(nodes_.end(), row_.begin() + 1, row_.end());
        if (element_set_) sets_.add(*element_set_, {row_.front(), row_.front(), 1});
        row_.clear();
    }

    /// Throws InputError if the last row of a section is not complete.
    void finish_element() {
        goes_on_ = false;
        if (row_.empty()) return;
        lines_.point_to(row_place_);
        lines_.fail(element_name(row_.front()) + ": has " + std::to_string(row_.size() - 1) +
                    " of the " + std::to_string(form_->num_nodes) + " nodes of a " + form_->name +
                    "; the file is cut short or damaged");
    }

    static std::string element_name(std::int64_t number) {
        return "element " + std::to_string(number);
    }

    // --- *ELSET: elements and sets; with GENERATE: first, last, step

    void begin_set() {
        if (scope_ == Scope::assembly) return;
        const auto name = keyword_.parameter("ELSET").value_or("");
        if (name.empty()) lines_.fail("*ELSET has no name, ELSET=...");
        set_ = sets_.define(name, keyword_.parameter("INTERNAL") ? Role::internal : Role::of_list);
        read_row_ = keyword_.parameter("GENERATE") ? &AbaqusReader::read_range
                                                   : &AbaqusReader::read_set_row;
    }

    void read_set_row() {
        for (const auto field : lines_.fields()) {
            if (field.empty()) continue;
            if (const auto element = parse_number<std::int64_t>(field))
                sets_.add(set_, range(*element, *element, 1));
            else if (const auto remark = range_remark<std::int64_t>(field); !remark.empty())
                lines_.fail("expected an element, found " + in_quotes(field) + remark);
            else
                sets_.add_subset(set_, sets_.refer(abaqus_word(field), lines_.byte()));
        }
    }

    void read_range() {
        const auto fields = lines_.fields();
        if (fields.size() < 2) lines_.fail("GENERATE needs a first and a last element");
        const bool has_step = fields.size() > 2 && !fields[2].empty();
        sets_.add(set_, range(lines_.number(fields[0], "the first element"),
                              lines_.number(fields[1], "the last element"),
                              has_step ? lines_.number(fields[2], "the step") : 1));
    }

    ElementSets::Range range(std::int64_t first, std::int64_t last, std::int64_t step) const {
        if (first < 1 || last < first || step < 1)
            lines_.fail("elements " + std::to_string(first) + " to " + std::to_string(last) +
                        " by steps of " + std::to_string(step) +
                        " are no range; elements and steps begin with 1");
        return {first, last, step};
    }

    void give_section() {
        if (const auto name = keyword_.parameter("ELSET"))
            sets_.refer(*name, lines_.byte(), Role::of_section);
        else
            lines_.fail("*SOLID SECTION has no ELSET");
    }

    // --- at the end: elements in order, with their nodes and regions

    void add_elements() {
        const auto& points = result_.mesh.points;
        const auto are_same = [&](std::int64_t a, std::int64_t b) {
            return points[static_cast<std::size_t>(a)] == points[static_cast<std::size_t>(b)];
        };
        if (const auto twice = node_tags_.sort(are_same))
            throw InputError(file_.name() + ": number " + *twice);
        result_.mesh.source_points = node_tags_.in_order();
        std::ranges::stable_sort(elements_, {}, &Element::number);
        const auto twin = std::ranges::adjacent_find(elements_, {}, &Element::number);
        if (twin != elements_.end()) {
            lines_.point_to(std::next(twin)->place);
            lines_.fail("number " + std::to_string(twin->number) + " is given to two elements");
        }
        if (const auto unknown = sets_.first_unknown()) {
            lines_.point_to(unknown->place);
            lines_.fail("element set " + in_quotes(unknown->name) + " is not defined");
        }
        std::vector<std::int64_t> numbers;
        numbers.reserve(elements_.size());
        for (const auto& element : elements_) numbers.push_back(element.number);
        const auto [regions, warnings] = sets_.regions(numbers);
        result_.warnings.insert(result_.warnings.end(), warnings.begin(), warnings.end());
        for (std::size_t e = 0; e < elements_.size(); ++e) add_element(elements_[e], regions[e]);
    }

    void add_element(const Element& element, int region) {
        const auto nodes = std::span(nodes_).subspan(
            element.first_node, static_cast<std::size_t>(element.form->num_nodes));
        for (auto& node : nodes) {
            const auto found = node_tags_.find(node);
            lines_.point_to(element.place);
            if (!found)
                lines_.fail(element_name(element.number) + ": node " + std::to_string(node) +
                            " is not one of the " + std::to_string(node_tags_.size()) + " nodes");
            node = *found;
        }
        collector_.keep(*element.form, element.number, nodes, region, result_.mesh);
    }

    const InputFile& file_;
    AbaqusLines lines_;
    CellCollector collector_;
    AbaqusKeyword keyword_;                       ///< of the current section
    void (AbaqusReader::*read_row_)() = nullptr;  ///< null: rows are skipped

    Scope scope_ = Scope::model;
    int num_scopes_ = 0;             ///< parts and instances so far
    std::optional<int> mesh_scope_;  ///< number of the one with the mesh; 0: the model itself
    bool has_instance_ = false;
    bool has_text_before_ = false;  ///< before the first keyword

    NodeTags node_tags_;
    std::size_t num_short_nodes_ = 0;  ///< with less than three coordinates
    std::string first_short_node_;     ///< number of the first one
    std::string type_;                 ///< of the current elements, as are the next two
    const CellForm* form_ = nullptr;
    std::optional<std::size_t> element_set_;
    std::vector<std::int64_t> row_;  ///< number and nodes of the current element, so far
    std::size_t row_place_ = 0;
    bool goes_on_ = false;  ///< true if the row of an ignored element continues
    std::vector<Element> elements_;
    std::vector<std::int64_t> nodes_;  ///< of all elements
    std::size_t set_ = 0;              ///< the current *ELSET
    ElementSets sets_;
    MeshFile result_;
};

}  // namespace

MeshFile read_abaqus(const InputFile& file, const ReadOptions& options) {
    return AbaqusReader(file, options).read();
}

}  // namespace incise::io
