// One small mesh in every format and encoding that the readers know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// A file by what it is called and what is in it.
struct Sample {
    std::string name;
    std::string bytes;
};

/// One cell of each kind with positive volume, and regions. In the files there are a line and
/// two triangles besides.
topology::MeshData sample_mesh();
inline constexpr std::array<std::array<long long, 3>, 2> sample_triangles = {
    {{0, 1, 2}, {1, 3, 2}}};

/// The number that a node has in a file: descending, with gaps.
int tag_of(std::int64_t node);
/// The corners of a cell in the order of Gmsh, Medit, Abaqus and FEBio.
std::vector<std::int64_t> nodes_in_files(const topology::MeshData& mesh, std::size_t c);

/// Written by VTK: ascii, inline, appended raw and in base64; all compressors; headers of 32 and
/// 64 bits; both byte orders.
std::vector<Sample> vtu_samples();
/// Written by VTK: ascii and binary, versions 4.2 and 5.1, among all kinds of other attributes.
std::vector<Sample> legacy_vtk_samples();
/// Version 1; versions 2.2 and 4.1, ascii and binary in both byte orders, with and without
/// parameters of nodes; tags with gaps, in disorder.
std::vector<Sample> gmsh_samples();
/// Every section that cells may be in.
std::vector<Sample> medit_samples();
/// Numbers of nodes and elements with gaps, in disorder; regions as sets.
std::vector<Sample> abaqus_samples();
/// Versions 2.5, 3.0 and 4.0; the blocks of elements name the regions.
std::vector<Sample> febio_samples();
std::vector<Sample> all_samples();

/// Reads bytes as a file of this name in a temporary folder.
MeshFile read_bytes(const std::string& name, std::string_view bytes,
                    const ReadOptions& options = {});
/// The message with which they are refused, without the folder; fails the test if they are not.
std::string refusal(const std::string& name, std::string_view bytes,
                    const ReadOptions& options = {});
/// `text` with the first `from` replaced by `to`; fails the test if there is none.
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// Expects one wedge whose first triangle faces away from the second one, at a distance of 1.
void expect_wedge_of_unit_height(const topology::MeshData& mesh);
/// Expects the same points, cells and regions, to the bit.
void expect_same_mesh(const topology::MeshData& actual, const topology::MeshData& expected);

}  // namespace incise::io
