// Readers that are given the path of a file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <fstream>

#include "incise/io/image/label_image.h"
#include "incise/io/image/label_mesh.h"
#include "incise/io/surface/surface_reader.h"
#include "tests/fuzz/findings.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/written_file.h"

namespace incise::fuzz {

void surface(std::string_view bytes) {
    const WrittenFile file("fuzz.obj", bytes);
    read_or_refuse(file.name(), [&] {
        const auto surface = io::read_surface(file.path()).surface;
        const auto num_points = static_cast<std::int64_t>(surface.points.size());
        for (const auto& triangle : surface.triangles)
            for (const auto corner : triangle)
                if (corner < 0 || corner >= num_points) require_none("a corner out of range");
    });
}

void label_image(std::string_view bytes) {
    const WrittenFile file("fuzz.nii", bytes);
    read_or_refuse(file.name(), [&] {
        const auto image = io::read_label_image(file.path());
        const auto& d = image.dimensions;
        if (image.labels.size() != static_cast<std::size_t>(d[0] * d[1] * d[2]))
            require_none("labels that do not fit the dimensions");
        if (!(image.spacing.array() > 0.0).all() || !image.directions.allFinite())
            require_none("a spacing or directions that cannot be");
    });
}

}  // namespace incise::fuzz
