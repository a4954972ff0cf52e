// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/mesh/abaqus_element.h"

#include <algorithm>

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

// The code is the number of nodes; corners come first. In a wedge of Abaqus, the normal of the
// first triangle points to the second triangle; in VTK it points away.
constexpr CellForm solids[] = {
    {4, "tetrahedron", 4, keep, CellKind::tetrahedron},
    {5, "pyramid", 5, keep, CellKind::pyramid},
    {6, "wedge", 6, keep, CellKind::wedge, {0, 2, 1, 3, 5, 4}},
    {8, "hexahedron", 8, keep, CellKind::hexahedron},
    {10, "second-order tetrahedron", 10, by_corners, CellKind::tetrahedron},
    {13, "second-order pyramid", 13, by_corners, CellKind::pyramid},
    {15, "second-order wedge", 15, by_corners, CellKind::wedge, {0, 2, 1, 3, 5, 4}},
    {20, "second-order hexahedron", 20, by_corners, CellKind::hexahedron},
    {27, "second-order hexahedron", 27, by_corners, CellKind::hexahedron},
};
constexpr CellForm surfaces[] = {
    {3, "triangle", 3, ignore},
    {4, "quadrilateral", 4, ignore},
    {6, "second-order triangle", 6, ignore},
    {8, "second-order quadrilateral", 8, ignore},
    {9, "second-order quadrilateral", 9, ignore},
};
constexpr std::string_view solid_families[] = {"C3D", "DC3D", "AC3D", "Q3D", "F3D"};
constexpr std::string_view surface_families[] = {"S",   "STRI", "M3D",   "R3D", "CPS",
                                                 "CPE", "CAX",  "SFM3D", "DS",  "DC2D"};

struct OtherFamily {
    std::string_view name;
    CellForm form;
};
constexpr OtherFamily other_families[] = {
    {"T2D", {0, "line", 0, ignore}},        {"T3D", {0, "line", 0, ignore}},
    {"B2", {0, "line", 0, ignore}},         {"B3", {0, "line", 0, ignore}},
    {"PIPE", {0, "line", 0, ignore}},       {"SPRING", {0, "spring", 0, ignore}},
    {"DASHPOT", {0, "dashpot", 0, ignore}}, {"CONN", {0, "connector", 0, ignore}},
    {"GAP", {0, "gap element", 0, ignore}}, {"DCOUP", {0, "coupling element", 0, ignore}},
    {"MASS", {0, "mass point", 0, ignore}}, {"ROTARYI", {0, "rotary inertia", 0, ignore}},
};

/// A pipe or another passage for fluids, of CalculiX.
constexpr CellForm network_element{0, "network element", 0, ignore};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the number after the name of a family, of at most `most_digits` digits. Returns 0 if the
/// type does not belong to the family.
int number_behind(std::string_view family, std::string_view type, std::size_t most_digits) {
    if (!type.starts_with(family)) return 0;
    int number = 0;
    for (const char c : type.substr(family.size(), most_digits)) {
        if (!is_digit(c)) break;
        number = 10 * number + (c - '0');
    }
    return number;
}

}  // namespace

const CellForm* abaqus_form(std::string_view type) {
    for (const auto family : solid_families)
        if (const int nodes = number_behind(family, type, 2)) return find_form(solids, nodes);
    // One digit: no surface has ten nodes or more. STRI65 has six, with five degrees of freedom.
    for (const auto family : surface_families)
        if (const int nodes = number_behind(family, type, 1)) return find_form(surfaces, nodes);
    if (type == "D") return &network_element;
    const auto* other = std::ranges::find_if(
        other_families, [&](const auto& family) { return type.starts_with(family.name); });
    return other == std::end(other_families) ? nullptr : &other->form;
}

}  // namespace incise::io
