// incise report: makes one page of HTML of the folder of a run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <ctime>
#include <iostream>

#include "incise/app/dates.h"
#include "incise/app/messages.h"
#include "incise/app/report/page.h"
#include "incise/app/report/page_data.h"
#include "incise/app/report/run_record.h"
#include "incise/app/run_pictures.h"
#include "incise/app/shell_word.h"
#include "incise/app/verbs.h"
#include "incise/io/files/atomic_file.h"

namespace incise::app {

namespace {

std::string report_command(const ReportOptions& options) {
    std::string text = "incise report " + shell_word(options.folder.string());
    if (options.out) text += " --out " + shell_word(options.out->string());
    const ReportOptions usual;
    if (options.num_pictures != usual.num_pictures)
        text += " --pictures " + std::to_string(options.num_pictures);
    if (!options.color.empty()) text += " --color " + shell_word(options.color);
    if (!options.view.empty()) text += " --view=" + shell_word(options.view);
    return text;
}

/// Returns a command that makes the run again from the scenario that it has kept.
std::string rerun_command(const report::RunRecord& run) {
    if (!run.scenario_text) return {};
    return "incise run " + shell_word((run.folder / (run.name + ".toml")).string()) +
           " --out again";
}

}  // namespace

int report(const ReportOptions& options) {
    const report::RunRecord run = report::read_run(options.folder);
    const auto out = options.out.value_or(run.folder / "report.html");
    // Another ending is more likely a slip: the file may be one of the run's own.
    if (out.extension() != ".html" && out.extension() != ".htm")
        throw InputError("--out " + out.string() + ": the name of a page ends in .html");
    io::require_writable(out);  // pictures take a while
    const report::Pictures pictures =
        draw_run(run, {options.num_pictures, options.color, options.view});
    if (!pictures.note.empty() && options.num_pictures > 0) print_warning(pictures.note);
    const report::Json data = report::page_data(
        run, pictures, {report_command(options), utc_text(std::time(nullptr)), rerun_command(run)});
    io::write_file(out, report::page_of(run.title(), data));
    std::cout << out.string() << '\n';
    return done;
}

}  // namespace incise::app
