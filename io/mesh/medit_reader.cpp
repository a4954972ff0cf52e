// Meshes of MEDIT (.mesh), as text.
// Source: P. Frey, "MEDIT: an interactive mesh visualization software" (INRIA RT-0253, 2001),
// appendix; the keywords of libMeshb 7.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/medit_reader.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "incise/base/error.h"
#include "incise/io/files/scanner.h"
#include "incise/io/mesh/cell_form.h"

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

struct CellSection {
    std::string_view keyword;  ///< in lower case
    CellForm form;
};

// In cells of higher order, the corners come first. In a prism of MEDIT, the normal of the first
// triangle points to the second triangle; in VTK it points away.
constexpr CellSection cell_sections[] = {
    {"edges", {0, "line", 2, ignore}},
    {"triangles", {0, "triangle", 3, ignore}},
    {"quadrilaterals", {0, "quadrilateral", 4, ignore}},
    {"tetrahedra", {0, "tetrahedron", 4, keep, CellKind::tetrahedron}},
    {"prisms", {0, "wedge", 6, keep, CellKind::wedge, {0, 2, 1, 3, 5, 4}}},
    {"pyramids", {0, "pyramid", 5, keep, CellKind::pyramid}},
    {"hexahedra", {0, "hexahedron", 8, keep, CellKind::hexahedron}},
    {"hexaedra", {0, "hexahedron", 8, keep, CellKind::hexahedron}},  // as in the report of 2001
    {"edgesp2", {0, "second-order line", 3, ignore}},
    {"trianglesp2", {0, "second-order triangle", 6, ignore}},
    {"quadrilateralsq2", {0, "second-order quadrilateral", 9, ignore}},
    {"tetrahedrap2", {0, "second-order tetrahedron", 10, by_corners, CellKind::tetrahedron}},
    {"prismsp2", {0, "second-order wedge", 18, by_corners, CellKind::wedge, {0, 2, 1, 3, 5, 4}}},
    {"pyramidsp2", {0, "second-order pyramid", 14, by_corners, CellKind::pyramid}},
    {"hexahedraq2", {0, "second-order hexahedron", 27, by_corners, CellKind::hexahedron}},
    {"edgesp3", {0, "third-order line", 4, ignore}},
    {"trianglesp3", {0, "third-order triangle", 10, ignore}},
    {"tetrahedrap3", {0, "third-order tetrahedron", 20, by_corners, CellKind::tetrahedron}},
};

/// Sections of numbers that a volume mesh does not need. A warning reports other sections that are
/// left out.
constexpr std::string_view skipped_sections[] = {
    "corners",
    "ridges",
    "normals",
    "tangents",
    "normalatvertices",
    "normalattrianglevertices",
    "normalatquadrilateralvertices",
    "tangentatvertices",
    "tangentatedges",
    "requiredvertices",
    "requirededges",
    "requiredtriangles",
    "requiredquadrilaterals",
    "subdomainfrommesh",
    "subdomainfromgeom",
    "vertexongeometricvertex",
    "vertexongeometricedge",
    "vertexongeometrictriangle",
    "vertexongeometricquadrilateral",
    "edgeongeometricedge",
    "angleofcornerbound",
    "boundingbox",
    "iterations",
    "time",
};

class MeditReader {
  public:
    MeditReader(const InputFile& file, const ReadOptions& options)
        : file_(file),
          scanner_(file, Comments::before_any_word),
          collector_(file.name(), "MEDIT section", options) {}

    MeshFile read() {
        bool has_end = false;
        while (!has_end && !scanner_.at_end()) {
            const auto keyword = scanner_.token("a keyword");
            const auto lower = lower_case(keyword);
            has_end = lower == "end";
            if (!has_end) read_section(keyword, lower);
        }
        if (num_unknown_ > 0)
            result_.warnings.push_back("left out sections that are not known: " + unknown_ +
                                       (num_unknown_ > most_listed ? ", ..." : ""));
        if (!has_end) result_.warnings.emplace_back("has no End: the last sections may be missing");
        if (!has_vertices_) throw InputError(file_.name() + ": has no section Vertices");
        collector_.finish(result_.mesh, result_.warnings);
        return std::move(result_);
    }

  private:
    void read_section(std::string_view keyword, const std::string& lower) {
        if (parse_number<double>(keyword))
            scanner_.fail_expected("a keyword behind the rows of the section before", keyword);
        if (lower == "meshversionformatted") {
            require_between("the version", 1, 4, "save it as version 2");
        } else if (lower == "dimension") {
            require_between("the dimension", 3, 3, "a volume mesh has points in space");
        } else if (lower == "vertices") {
            read_vertices();
        } else if (lower == "identifier" || lower == "geometry") {
            // Any text, on the rest of this line or on the next line.
            if (scanner_.rest_of_line().find_first_not_of(" \t") == std::string_view::npos)
                scanner_.rest_of_line();
        } else {
            const auto* section =
                std::ranges::find(cell_sections, std::string_view(lower), &CellSection::keyword);
            if (section != std::end(cell_sections))
                read_cells(section->form, keyword);
            else
                skip_section(keyword, lower);
        }
    }

    void require_between(std::string_view what, int lowest, int highest, const char* remedy) {
        const auto found = scanner_.number<int>(what);
        if (found < lowest || found > highest)
            scanner_.fail(std::string(what) + " is " + std::to_string(found) + "; it must be " +
                          (lowest == highest
                               ? std::to_string(lowest)
                               : std::to_string(lowest) + " to " + std::to_string(highest)) +
                          ": " + remedy);
    }

    // n, then n times: x y z reference
    void read_vertices() {
        if (has_vertices_) scanner_.fail("has a second section Vertices");
        has_vertices_ = true;
        const auto num_vertices = scanner_.count("the number of vertices", 4 * bytes_of_number);
        auto& points = result_.mesh.points;
        points.reserve(num_vertices);
        for (std::size_t i = 0; i < num_vertices; ++i) {
            const double x = scanner_.coordinate("an x coordinate");
            const double y = scanner_.coordinate("a y coordinate");
            const double z = scanner_.coordinate("a z coordinate");
            points.emplace_back(x, y, z);
            scanner_.number<double>("the reference of a vertex");
            result_.mesh.source_points.push_back(std::ssize(points));
        }
    }

    // n, then n times: the vertices, numbered from 1, and a reference
    void read_cells(const CellForm& form, std::string_view keyword) {
        const auto num_nodes = static_cast<std::size_t>(form.num_nodes);
        const auto num_cells = scanner_.count("the number of rows of " + std::string(keyword),
                                              (num_nodes + 1) * bytes_of_number);
        if (num_cells == 0) return;
        if (collector_.refuses(form)) collector_.refuse(form, scanner_.location(), keyword);
        if (form.use == ignore) {
            for (std::size_t i = 0; i < num_cells * (num_nodes + 1); ++i)
                scanner_.number<std::int64_t>("a vertex or a reference");
            collector_.ignore(form, num_cells);
            return;
        }
        if (!has_vertices_) scanner_.fail(std::string(keyword) + " comes before Vertices");
        const auto nodes = std::span(nodes_).first(num_nodes);
        for (std::size_t i = 0; i < num_cells; ++i) {
            for (auto& node : nodes) node = read_node(form, i);
            const auto region = scanner_.number<int>("a reference, a whole number of 32 bits");
            collector_.keep(form, static_cast<std::int64_t>(i) + 1, nodes, region, result_.mesh);
        }
    }

    std::int64_t read_node(const CellForm& form, std::size_t row) {
        const auto vertex = scanner_.number<std::int64_t>("a vertex");
        const auto num_vertices = std::ssize(result_.mesh.points);
        if (vertex < 1 || vertex > num_vertices)
            scanner_.fail(std::string(form.name) + " " + std::to_string(row + 1) + ": vertex " +
                          std::to_string(vertex) + " is out of range (" +
                          std::to_string(num_vertices) + " vertices, numbered from 1)");
        return vertex - 1;
    }

    /// Skips all words up to the next one that is no number.
    void skip_section(std::string_view keyword, const std::string& lower) {
        if (std::ranges::find(skipped_sections, lower) == std::end(skipped_sections) &&
            num_unknown_++ < most_listed)
            unknown_ += (unknown_.empty() ? "" : ", ") + in_quotes(keyword);
        while (scanner_.skip_number()) {
        }
    }

    static constexpr std::size_t bytes_of_number = 2;  // at least a digit and a blank
    static constexpr std::size_t most_listed = 5;

    const InputFile& file_;
    Scanner scanner_;
    CellCollector collector_;
    std::array<std::int64_t, 27> nodes_{};  ///< of the current cell; no form has more
    MeshFile result_;
    bool has_vertices_ = false;
    std::size_t num_unknown_ = 0;  ///< unknown sections
    std::string unknown_;          ///< list of the first of them
};

}  // namespace

MeshFile read_medit(const InputFile& file, const ReadOptions& options) {
    return MeditReader(file, options).read();
}

}  // namespace incise::io
