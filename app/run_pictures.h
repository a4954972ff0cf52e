// Pictures of a run for its report, which incise-render draws.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/app/report/pictures.h"
#include "incise/app/report/run_record.h"

namespace incise::app {

struct PictureOptions {
    int count = 0;
    std::string color, view;  ///< as incise-render has them; if empty, its defaults
};

/// Returns pictures of evenly spread frames, among them the first and the last, with one camera and
/// one range of colours. Returns none, with a note that says why, if the run has no frames or if
/// incise-render cannot draw them. Throws InputError if it refuses the options.
/// Cost: incise-render reads and draws each of the frames.
report::Pictures draw_run(const report::RunRecord& run, const PictureOptions& options);

}  // namespace incise::app
