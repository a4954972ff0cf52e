// What is fuzzed: a function from the bytes of a file for each family of readers. Each returns
// after the file is read or refused with InputError; anything else is a finding.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

namespace incise::fuzz {

void vtu(std::string_view bytes);
void legacy_vtk(std::string_view bytes);
void gmsh(std::string_view bytes);
void medit(std::string_view bytes);
/// The two files of the pair, divided by a line ----.
void tetgen(std::string_view bytes);
void abaqus(std::string_view bytes);
void febio(std::string_view bytes);
void usda(std::string_view bytes);
/// STL, PLY and OFF by their first bytes, else OBJ.
void surface(std::string_view bytes);
void label_image(std::string_view bytes);
void scenario(std::string_view bytes);

struct Target {
    const char* name;  ///< also of its folder in corpus
    void (*read)(std::string_view bytes);
};

inline constexpr Target targets[] = {
    {"vtu", vtu},         {"legacy_vtk", legacy_vtk},   {"gmsh", gmsh},         {"medit", medit},
    {"tetgen", tetgen},   {"abaqus", abaqus},           {"febio", febio},       {"usda", usda},
    {"surface", surface}, {"label_image", label_image}, {"scenario", scenario},
};

}  // namespace incise::fuzz
