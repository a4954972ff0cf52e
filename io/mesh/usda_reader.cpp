// Meshes of USD as text (.usda): prims of the type TetMesh.
// Source: OpenUSD 24.03, schemas UsdGeomTetMesh, UsdGeomSubset and UsdGeomMetrics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/usda_reader.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/element_sets.h"
#include "incise/io/mesh/usda_tokens.h"

namespace incise::io {

namespace {

using topology::CellKind;
using Kind = UsdaToken::Kind;

constexpr CellForm right_handed{0, "tetrahedron", 4, CellForm::Use::keep, CellKind::tetrahedron};
constexpr CellForm left_handed{
    0, "tetrahedron", 4, CellForm::Use::keep, CellKind::tetrahedron, {0, 2, 1, 3}};

/// A list of tuples of numbers, with the places of the tuples.
template <class T>
struct Tuples {
    std::vector<T> numbers;
    std::vector<std::size_t> places;
};

struct Subset {
    std::string name;
    Tuples<std::int64_t> indices;
};

/// What is read of a prim.
struct Prim {
    std::string_view type, name;
    std::size_t place = 0;
    bool is_defined = false;  ///< it and all prims around it are defined, not only changed
    std::optional<Tuples<double>> points;
    std::optional<Tuples<std::int64_t>> tetrahedra, indices;
    std::string_view orientation = "rightHanded", element_type = "face";
    std::optional<std::size_t> time_samples;    ///< place of points that change in time
    std::optional<std::size_t> transformation;  ///< place of an order of transformations
    std::vector<Subset> subsets;
};

class UsdaReader {
  public:
    UsdaReader(const InputFile& file, const ReadOptions& options)
        : file_(file), tokens_(file), collector_(file.name(), "type", options) {}

    MeshFile read() {
        if (tokens_.next().is('(')) read_metadata(true);
        Prim root;
        root.is_defined = true;
        while (tokens_.next().kind != Kind::end) read_statement(root, 0);
        if (num_meshes_ == 0)
            throw InputError(
                (other_file_ ? tokens_.location_of(*other_file_) +
                                   ": refers to another file, which is not read, and there"
                             : file_.name() + ": there") +
                " is no prim defined as a TetMesh here; save the mesh of tetrahedra in one file, "
                "flat");
        set_regions();
        set_unit();
        if (num_meshes_ > 1)
            result_.warnings.push_back(std::to_string(num_meshes_) +
                                       " meshes were put one behind the other");
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    /// Reads the metadata of the file, a prim or a property: assignments between ( and ).
    void read_metadata(bool is_of_file = false) {
        tokens_.expect('(', "before metadata");
        while (!tokens_.accept(')')) {
            const auto token = tokens_.next();
            if (token.kind == Kind::end) tokens_.fail_expected("')' behind metadata");
            if (token.kind == Kind::asset && !other_file_) other_file_ = token.byte;
            if (token.is('(') || token.is('{')) {
                tokens_.skip_value();
                continue;
            }
            tokens_.take();
            if (is_of_file && token.is_word("metersPerUnit") && tokens_.accept('='))
                meters_per_unit_ = number<double>("the metres per unit");
        }
    }

    void read_statement(Prim& prim, std::size_t depth) {
        const auto& next = tokens_.next();
        if (tokens_.accept(';')) return;
        if (next.is_word("def") || next.is_word("over") || next.is_word("class"))
            return read_prim(prim, depth);
        if (next.kind != Kind::word) tokens_.fail_expected("a prim or a property");
        if (next.is_word("variantSet")) {
            while (!next.is('{') && next.kind != Kind::end) tokens_.take();
            return tokens_.skip_value();
        }
        read_property(prim);
    }

    void read_prim(Prim& parent, std::size_t depth) {
        constexpr std::size_t deepest = 200;  // bounds the recursion
        Prim prim;
        const auto specifier = tokens_.take();
        prim.place = specifier.byte;
        if (depth == deepest)
            tokens_.fail(prim.place, "prims lie in each other more than " +
                                         std::to_string(deepest) + " deep; save the file flat");
        prim.is_defined = parent.is_defined && specifier.text == "def";
        if (tokens_.next().kind == Kind::word) prim.type = tokens_.take().text;
        if (tokens_.next().kind != Kind::string) tokens_.fail_expected("the name of a prim");
        prim.name = tokens_.take().text;
        if (tokens_.next().is('(')) read_metadata();
        tokens_.expect('{', "before the contents of a prim");
        const auto num_meshes_before = num_meshes_;
        while (!tokens_.accept('}')) read_statement(prim, depth + 1);
        if (!prim.is_defined) return;
        if (prim.type == "TetMesh") add_mesh(prim);
        if (prim.type == "GeomSubset" && prim.element_type == "tetrahedron" && prim.indices)
            parent.subsets.push_back({std::string(prim.name), std::move(*prim.indices)});
        if (prim.transformation && num_meshes_ > num_meshes_before)
            tokens_.fail(*prim.transformation,
                         "the mesh is moved by xformOpOrder of " + in_quotes(prim.name) +
                             ", which is not done here; save its points where they are in the "
                             "world, without transformations");
    }

    /// Reads a property: words, the last of which is its name, a value, metadata.
    void read_property(Prim& prim) {
        UsdaToken name = tokens_.take();
        while (!tokens_.next().begins_line &&
               (tokens_.next().kind == Kind::word || tokens_.next().is('['))) {
            if (tokens_.accept('['))
                tokens_.expect(']', "behind the type of a list");
            else
                name = tokens_.take();
        }
        if (tokens_.accept('=')) read_value(prim, name);
        if (tokens_.next().is('(') && !tokens_.next().begins_line) read_metadata();
    }

    void read_value(Prim& prim, const UsdaToken& name) {
        const auto& next = tokens_.next();
        if (next.is_word("None")) {
            tokens_.take();
        } else if (prim.type == "TetMesh" && name.text == "points") {
            prim.points = tuples<double>(3, "a coordinate");
        } else if (prim.type == "TetMesh" && name.text == "tetVertexIndices") {
            prim.tetrahedra = tuples<std::int64_t>(4, "a point of a tetrahedron");
        } else if (prim.type == "GeomSubset" && name.text == "indices") {
            prim.indices = tuples<std::int64_t>(1, "an element");
        } else if (name.text == "orientation" && next.kind == Kind::string) {
            prim.orientation = tokens_.take().text;
        } else if (name.text == "elementType" && next.kind == Kind::string) {
            prim.element_type = tokens_.take().text;
        } else {
            if (name.text == "points.timeSamples" || name.text == "tetVertexIndices.timeSamples")
                prim.time_samples = name.byte;
            if (name.text == "xformOpOrder" && next.is('[')) {
                tokens_.take();
                if (!tokens_.next().is(']')) prim.transformation = name.byte;
                while (!tokens_.accept(']')) {
                    if (tokens_.next().kind == Kind::end) tokens_.fail_expected("']'");
                    tokens_.take();
                }
                return;
            }
            tokens_.skip_value();
        }
    }

    template <class T>
    T number(std::string_view what) {
        const auto token = tokens_.next();
        const auto parsed = token.kind == Kind::word ? parse_number<T>(token.text) : std::nullopt;
        if (!parsed && token.kind == Kind::word)
            tokens_.fail(token.byte, "expected " + std::string(what) + ", found " +
                                         in_quotes(token.text) + range_remark<T>(token.text));
        if (!parsed) tokens_.fail_expected(what);
        if constexpr (std::floating_point<T>)
            if (!std::isfinite(*parsed))
                tokens_.fail(token.byte,
                             std::string(what) + " is " + shown(*parsed) + "; it must be finite");
        tokens_.take();
        return *parsed;
    }

    /// Reads a list of tuples: [(1, 2, 3), ...], or of numbers if the size is 1.
    template <class T>
    Tuples<T> tuples(std::size_t size, std::string_view what) {
        Tuples<T> list;
        tokens_.expect('[', "before a list");
        while (!tokens_.accept(']')) {
            list.places.push_back(tokens_.next().byte);
            if (size > 1) tokens_.expect('(', "before " + std::to_string(size) + " numbers");
            for (std::size_t i = 0; i < size; ++i) {
                if (i > 0) tokens_.expect(',', "between numbers");
                list.numbers.push_back(number<T>(what));
            }
            if (size > 1) tokens_.expect(')', "behind " + std::to_string(size) + " numbers");
            if (!tokens_.next().is(']')) tokens_.expect(',', "or ']' in a list");
        }
        return list;
    }

    void add_mesh(const Prim& prim) {
        const std::string name = "TetMesh " + in_quotes(prim.name);
        if (prim.time_samples && !(prim.points && prim.tetrahedra))
            tokens_.fail(*prim.time_samples,
                         name +
                             " changes in time; save it at one time, as a value of points and "
                             "of tetVertexIndices");
        if (!prim.points || !prim.tetrahedra)
            tokens_.fail(prim.place, name + " has no " +
                                         (prim.points ? "tetVertexIndices" : "points") +
                                         "; save it in one file, flat");
        if (prim.orientation != "rightHanded" && prim.orientation != "leftHanded")
            tokens_.fail(prim.place, name + ": the orientation is " + in_quotes(prim.orientation) +
                                         "; it must be rightHanded or leftHanded");
        const auto& form = prim.orientation == "leftHanded" ? left_handed : right_handed;
        auto& mesh = result_.mesh;
        const auto first_point = std::ssize(mesh.points);
        const auto first_cell = static_cast<std::int64_t>(mesh.num_cells());
        const auto& x = prim.points->numbers;
        for (std::size_t i = 0; i + 2 < x.size(); i += 3)
            mesh.points.emplace_back(x[i], x[i + 1], x[i + 2]);
        const auto num_points = std::ssize(mesh.points) - first_point;
        const auto num_cells = std::ssize(prim.tetrahedra->places);
        std::array<std::int64_t, 4> corners{};
        for (std::int64_t c = 0; c < num_cells; ++c) {
            const auto at = static_cast<std::size_t>(c);
            for (std::size_t k = 0; k < 4; ++k) {
                const auto point = prim.tetrahedra->numbers[4 * at + k];
                if (point < 0 || point >= num_points)
                    tokens_.fail(prim.tetrahedra->places[at],
                                 "tetrahedron " + std::to_string(c) + ": point " +
                                     std::to_string(point) + " is out of range (" +
                                     std::to_string(num_points) + " points, numbered from 0)");
                corners[k] = first_point + point;
            }
            collector_.keep(form, first_cell + c, corners, 0, mesh);
        }
        for (const Subset& subset : prim.subsets) add_subset(subset, first_cell, num_cells);
        ++num_meshes_;
    }

    void add_subset(const Subset& subset, std::int64_t first_cell, std::int64_t num_cells) {
        // A name in USD cannot have the sign of a negative number.
        constexpr std::string_view negative = "REGION_m";
        std::string name = subset.name;
        if (name.starts_with(negative)) name.replace(negative.size() - 1, 1, "-");
        const auto set = sets_.define(name, ElementSets::Role::of_list);
        for (std::size_t i = 0; i < subset.indices.numbers.size(); ++i) {
            const auto cell = subset.indices.numbers[i];
            if (cell < 0 || cell >= num_cells)
                tokens_.fail(subset.indices.places[i],
                             "subset " + in_quotes(subset.name) + ": tetrahedron " +
                                 std::to_string(cell) + " is out of range (" +
                                 std::to_string(num_cells) + " tetrahedra, numbered from 0)");
            const auto number = first_cell + cell + 1;
            sets_.add(set, {number, number, 1});
        }
    }

    void set_regions() {
        std::vector<std::int64_t> numbers;
        for (std::size_t c = 0; c < result_.mesh.num_cells(); ++c)
            numbers.push_back(static_cast<std::int64_t>(c) + 1);
        auto [regions, warnings] = sets_.regions(numbers);
        result_.mesh.regions = std::move(regions);
        result_.warnings.insert(result_.warnings.end(), warnings.begin(), warnings.end());
    }

    /// Turns the coordinates into metres.
    void set_unit() {
        if (!meters_per_unit_) {
            result_.warnings.emplace_back(
                "has no metersPerUnit: coordinates are taken as metres, though by the default of "
                "USD they are centimetres; add metersPerUnit to the file, or scale the mesh");
            return;
        }
        if (!(*meters_per_unit_ > 0.0))
            throw InputError(file_.name() + ": metersPerUnit is " + shown(*meters_per_unit_) +
                             "; it must be above 0");
        if (*meters_per_unit_ == 1.0) return;
        result_.mesh.scale(*meters_per_unit_);
        for (const auto& point : result_.mesh.points)
            if (!point.allFinite())
                throw InputError(file_.name() + ": metersPerUnit of " + shown(*meters_per_unit_) +
                                 " makes coordinates beyond the range of numbers");
        result_.warnings.push_back("coordinates were multiplied by metersPerUnit, " +
                                   shown(*meters_per_unit_) + ", which makes them metres");
    }

    const InputFile& file_;
    UsdaTokens tokens_;
    CellCollector collector_;
    ElementSets sets_;
    MeshFile result_;
    std::optional<double> meters_per_unit_;
    std::optional<std::size_t> other_file_;  ///< place of the first reference to another file
    std::size_t num_meshes_ = 0;
};

}  // namespace

MeshFile read_usda(const InputFile& file, const ReadOptions& options) {
    return UsdaReader(file, options).read();
}

}  // namespace incise::io
