// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string_view>

#include "incise/app/cut_tools.h"
#include "incise/app/help_formatter.h"
#include "incise/app/verbs.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/physics/elements/workers.h"
#include "incise/scenario/table_reader.h"

namespace incise::app {

namespace {

using Action = std::function<int()>;

constexpr std::string_view verbs[] = {"run",  "live",      "check",  "info",   "cut",  "convert",
                                      "mesh", "materials", "render", "report", "bench"};

constexpr const char* description =
    "Incise deforms and cuts soft tissue. Units are SI throughout: metres, kilograms, seconds,\n"
    "pascals, radians; any other consistent set works as well.";

constexpr const char* footer =
    "Examples:\n"
    "  incise check liver.toml                           find every problem of a scenario\n"
    "  incise run liver.toml                             simulate it; frames go to liver.out\n"
    "  incise run liver.toml --set material[0].young=2e3 the same with one number changed\n"
    "  incise live liver.toml                            cut it by hand, in the browser\n"
    "  incise info liver.vtu --json                      size, regions and quality of a mesh\n"
    "  incise cut liver.vtu --out halves.vtu --plane 0,0,0,1,0,0\n"
    "                                                    a cut without dynamics\n"
    "  incise convert liver.msh liver.vtu                from one format to another\n"
    "  incise mesh liver.stl liver.vtu --size 0.008      from a surface or a label image to "
    "tetrahedra\n"
    "  incise render liver.out --out liver.png           a picture of the last frame\n"
    "  incise report liver.out                           a page with pictures, plots and tables\n"
    "\n"
    "Exit status: 0 done; 1 done, but an [expect] failed; 2 the input or the usage is at fault;\n"
    "3 the physics went wrong; 4 output failed; 5 out of memory; 70 a fault of the program;\n"
    "130, 143 stopped by SIGINT, SIGTERM.";

std::string written_formats() {
    std::string text;
    for (const auto& suffix : io::writable_suffixes()) text += (text.empty() ? "" : ", ") + suffix;
    return text;
}

void declare_overrides(CLI::App* verb, std::vector<std::string>& overrides) {
    verb->add_option("--set", overrides, "Change a value of the scenario; repeatable")
        ->type_name("KEY.PATH=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void declare_threads(CLI::App* verb, int& num_threads) {
    verb->add_option("--threads", num_threads,
                     "How many threads compute (default: one a core); results are the same bits")
        ->type_name("N")
        ->check(CLI::Range(1, physics::Workers::max_threads).description(""));
}

void declare_run(CLI::App& app, Action& action) {
    auto options = std::make_shared<RunOptions>();
    auto* verb = app.add_subcommand("run", "Simulate a scenario and write its frames and figures");
    verb->add_option("SCENARIO", options->scenario, "Scenario file (.toml)")
        ->required()
        ->type_name("PATH");
    verb->add_option("--out", options->out, "Folder for the results (default: NAME.out)")
        ->type_name("PATH");
    auto* end_time = verb->add_option("--end-time", options->end_time,
                                      "Stop at this simulated time, in seconds");
    declare_overrides(verb, options->overrides);
    declare_threads(verb, options->num_threads);
    auto* resume = verb->add_flag(
        "--resume", options->resume,
        "Go on with a run that was stopped, from its last checkpoint, to the same files as if it "
        "had not been; with the SCENARIO, --out and --set that it began with. A later end makes a "
        "finished run longer. Begin if nothing is there");
    verb->add_option("--replay", options->replay,
                     "Repeat what was done in a session of incise live, from its recording, to the "
                     "same bits; the folder is then named after the recording")
        ->type_name("FILE")
        ->excludes(resume)
        ->excludes(end_time);
    verb->add_flag("--force", options->force, "Replace another run that is in the folder")
        ->excludes(resume);
    verb->add_flag("--dry-run", options->dry_run, "Do everything but simulate and write");
    verb->add_flag("--quiet", options->quiet, "No progress, only problems");
    verb->footer(
        "Examples:\n"
        "  incise run liver.toml --out results --end-time 0.5\n"
        "  incise run liver.toml --set dynamics.damping=2 --set material[0].young=2e3\n"
        "  incise run liver.toml --out results --end-time 0.5 --resume\n"
        "  incise run liver.toml --replay hands.jsonl\n"
        "Elements of lists are counted from 0.");
    verb->callback([options, &action] { action = [options] { return run(*options); }; });
}

void declare_live(CLI::App& app, Action& action) {
    auto options = std::make_shared<LiveOptions>();
    auto* verb = app.add_subcommand("live", "Simulate in real time, and use tools in the browser");
    verb->add_option("SCENARIO", options->scenario, "Scenario file (.toml)")
        ->required()
        ->type_name("PATH");
    verb->add_option("--port", options->port, "Port of the page; 0 for any that is free")
        ->type_name("N")
        ->check(CLI::Range(0, 65535).description(""))
        ->capture_default_str();
    verb->add_option("--host", options->host,
                     "Address to listen on. With another one than that of this machine itself, "
                     "whoever has the address of the page can use it")
        ->type_name("ADDRESS")
        ->capture_default_str();
    verb->add_option("--record", options->record,
                     "Write what you do to this file, for incise run --replay")
        ->type_name("FILE.jsonl");
    verb->add_flag("--force", options->force, "Replace a recording that is there");
    declare_overrides(verb, options->overrides);
    declare_threads(verb, options->num_threads);
    verb->add_option("--tick", options->tick,
                     "Simulated time after which new orders count, in seconds")
        ->type_name("SECONDS")
        ->check(CLI::Range(1e-5, 1.0).description(""))
        ->capture_default_str();
    verb->add_option("--igtl", options->igtl,
                     "Let OpenIGTLink lead tools: listen on this port, usually 18944")
        ->type_name("PORT")
        ->check(CLI::Range(0, 65535).description(""));
    verb->add_option(
            "--tool", options->tools,
            "A tool for OpenIGTLink, with the keys of a [[tool]]; repeatable. NAME is that "
            "of the device")
        ->type_name("NAME={...}")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    verb->add_flag_callback(
        "--no-open", [options] { options->open = false; },
        "Do not open the page, only print its address");
    verb->footer(
        "Prints the address of the page, and runs until Ctrl-C. The page works over a forwarded\n"
        "port too: ssh -L 8080:localhost:8080 HOST.\n"
        "\n"
        "Examples:\n"
        "  incise live liver.toml\n"
        "  incise live liver.toml --record hands.jsonl\n"
        "  incise run liver.toml --replay hands.jsonl        the same again, with frames to keep\n"
        "  incise live liver.toml --igtl 18944 \\\n"
        "      --tool 'scalpel={kind=\"blade\", edge=[[0,0,0.01],[0,0,-0.02]]}'");
    verb->callback([options, &action] { action = [options] { return live(*options); }; });
}

void declare_bench(CLI::App& app, Action& action) {
    auto options = std::make_shared<BenchOptions>();
    auto* verb = app.add_subcommand(
        "bench", "Measure how fast this machine computes forces, steps and edits");
    verb->add_option("--json", options->json,
                     "Also write all figures to this file; - to stdout, instead of the tables")
        ->type_name("FILE");
    verb->footer(
        "Makes its own meshes and takes some minutes. For figures that mean something let nothing\n"
        "else run meanwhile; ratios of figures of one run hold best.\n"
        "\n"
        "Example: incise bench --json machine.json");
    verb->callback([options, &action] { action = [options] { return bench(*options); }; });
}

void declare_region_array(CLI::App* verb, std::string& region_array) {
    verb->add_option("--region-array", region_array,
                     "Cell array of VTK files that holds the regions")
        ->capture_default_str();
}

void declare_linear(CLI::App* verb, bool& linear) {
    verb->add_flag("--linear", linear,
                   "Read second-order cells, and those of higher order, by their corners as linear "
                   "ones");
}

void declare_check(CLI::App& app, Action& action) {
    auto options = std::make_shared<CheckOptions>();
    auto* verb =
        app.add_subcommand("check", "Report every problem of scenarios, meshes and surfaces");
    verb->add_option("FILE", options->files, "Scenario (.toml), mesh or surface files")
        ->required()
        ->type_name("PATH ...");
    declare_linear(verb, options->input.linear);
    verb->add_flag("--weld", options->input.weld, "Join points at the same position first");
    verb->footer(
        "--linear and --weld are for meshes; a scenario has keys of these names in [mesh].\n"
        "Example: incise check liver.toml liver.vtu");
    verb->callback([options, &action] { action = [options] { return check(*options); }; });
}

void declare_info(CLI::App& app, Action& action) {
    auto options = std::make_shared<InfoOptions>();
    auto* verb = app.add_subcommand(
        "info", "Describe a mesh, a surface or a label image: counts, size, quality");
    verb->add_option("MESH", options->mesh, "Mesh file, or a surface (.stl, .ply, .off, .obj)")
        ->required()
        ->type_name("PATH");
    declare_region_array(verb, options->input.region_array);
    declare_linear(verb, options->input.linear);
    verb->add_flag("--weld", options->input.weld, "Join points at the same position first");
    verb->add_flag("--json", options->json, "One JSON object on stdout");
    verb->footer("Example: incise info liver.vtu --json");
    verb->callback([options, &action] { action = [options] { return info(*options); }; });
}

constexpr const char* cut_footer =
    "The tools act at rest, one after the other, on what those before left. Planes, surfaces and\n"
    "sweeps part the body where they pass. Points of a blade's edge have ; between, poses have |\n"
    "between; all poses have the same number of points. From pose to pose each segment of the\n"
    "edge sweeps two triangles: give more poses where it twists.\n"
    "\n"
    "Mode split divides elements along the cut, within the tolerance --snap of it. The mesh\n"
    "has thin parts then, which do not shorten the steps of a run. Mode separate divides nothing:\n"
    "it opens existing faces next to the cut, those between elements whose centres it parts, so\n"
    "the cut follows the faces of the mesh.\n"
    "\n"
    "What is reported: cut_area is that of one side of the opened faces. surface_distance is how\n"
    "far they are from the surface that was given, at most: max at their nodes, the middles of\n"
    "their edges and their centres; relative is max over the mean length of the edges before;\n"
    "nodes is at their nodes alone, which is less where the surface has folds.\n"
    "mean_angle_deg is between the faces and a plane. fragments are the elements of a run: parts "
    "of\n"
    "a cell that hang together. stable_step_ratio is geometric: what their shape does to the\n"
    "stable step of a body of one material. microseconds_per_crossed_element is the time of the\n"
    "splits alone, without reading, measuring and writing. JSON has null where there is nothing\n"
    "to measure.\n"
    "\n"
    "A .vtu file that is written knows which parts make up a cell. To cut it again at another\n"
    "place gives the same as to give all tools at once, and incise run takes its full step. The\n"
    "same surface or sweep once more may cut small flakes off: the file does not know them. Other\n"
    "formats lose the cells: there each part is an element.\n"
    "\n"
    "Examples:\n"
    "  incise cut liver.vtu --out halves.vtu --plane 0,0,0,1,0,0\n"
    "  incise cut liver.vtu --out core.vtu --surface tumour.stl --json -\n"
    "  incise cut block.vtu --out slit.vtu --snap 0.1 \\\n"
    "      --sweep \"0,-1,2; 0,1,2 | 0,-1,0.5; 0,1,0.5\" --remove-sphere 0.5,0,1,0.2";

void declare_cut(CLI::App& app, Action& action) {
    auto options = std::make_shared<CutOptions>();
    auto* verb = app.add_subcommand("cut", "Cut a mesh at rest, without dynamics");
    verb->add_option("MESH", options->mesh, "Mesh file")->required()->type_name("PATH");
    verb->add_option("--out", options->out, "Mesh file to write; replaced if it is there")
        ->required()
        ->type_name("PATH");
    verb->add_option("--json", options->json,
                     "Write what was done as JSON to a file, or with - to stdout, instead of a "
                     "table")
        ->type_name("PATH");
    verb->add_option("--mode", options->mode,
                     "split, which divides elements, or separate (default: split)")
        ->type_name("MODE");
    verb->add_option(
            "--snap", options->snap,
            "Mode split: ends of crossed edges that are nearer to the cut than this share of the "
            "edge count as on it; from 0, exact, to 0.5 (default: " +
                format_number(cutting::default_snap) + ")")
        ->type_name("SHARE");
    declare_region_array(verb, options->region_array);
    for (const CutToolOption& tool : cut_tool_options())
        verb->add_option_function<std::string>(
                tool.name,
                [options, name = tool.name](const std::string& text) {
                    options->tools.push_back({name, text});
                },
                tool.meaning)
            ->type_name(tool.form)
            ->trigger_on_parse()  // at each occurrence: the order of options matters
            ->group("Tools, applied in the order given, each any number of times");
    verb->footer("Formats to write: " + written_formats() + "\n" + cut_footer);
    verb->callback([options, &action] { action = [options] { return cut(*options); }; });
}

void declare_convert(CLI::App& app, Action& action) {
    auto options = std::make_shared<ConvertOptions>();
    auto* verb = app.add_subcommand("convert", "Write a mesh in the format of the new name");
    verb->add_option("IN", options->in, "Mesh file")->required()->type_name("PATH");
    verb->add_option("OUT", options->out, "Mesh file to write; replaced if it is there")
        ->required()
        ->type_name("PATH");
    declare_region_array(verb, options->input.region_array);
    declare_linear(verb, options->input.linear);
    verb->add_flag("--weld", options->input.weld,
                   "Join points at the same position, and check the mesh that this makes");
    verb->add_option("--cells", options->cells,
                     "tetrahedra: divide all other cells, with points inside, for programs that "
                     "know no polyhedra (default: polyhedra, all cells as they are)")
        ->type_name("KIND");
    verb->footer("Formats to write: " + written_formats() +
                 "\nExamples:\n"
                 "  incise convert liver.msh liver.vtu\n"
                 "  incise convert cut_bricks.vtu cut_bricks.msh --cells tetrahedra");
    verb->callback([options, &action] { action = [options] { return convert(*options); }; });
}

constexpr const char* mesh_footer =
    "IN is a closed surface, or several: STL, PLY, OFF or OBJ (.stl, .ply, .off, .obj). Of one "
    "file\n"
    "each closed part is a region; a part that faces inwards within another one is a cavity. Of\n"
    "several files each is a region. Parts may enclose and touch each other.\n"
    "\n"
    "Or IN is a segmentation: NIfTI (.nii, .nii.gz), MetaImage (.mha, .mhd) or NRRD (.nrrd, "
    ".nhdr)\n"
    "of one whole number a voxel. Each label other than 0 is a region. With --hex each of its "
    "voxels\n"
    "becomes a box.\n"
    "\n"
    "Lengths are in the unit of OUT, which is that of IN times --scale: --scale 0.001 makes metres "
    "of\n"
    "millimetres. Points are placed as IN says: NIfTI to the right, front and head; MetaImage and\n"
    "NRRD in their own frame, usually to the left, back and head.\n"
    "\n"
    "The same input gives the same bytes. The least altitude that is printed limits the time step "
    "of\n"
    "a run: a larger --size-surface makes it larger.\n"
    "\n"
    "Examples:\n"
    "  incise mesh liver.stl liver.vtu --size 0.008 --size-surface 0.004 --scale 0.001\n"
    "  incise mesh bone.stl marrow.stl femur.vtu --size 0.004 --features 40\n"
    "  incise mesh liver.nii.gz liver.vtu --size 0.005 --scale 0.001\n"
    "  incise mesh liver.nii.gz liver.vtu --hex --size 0.004 --scale 0.001";

void declare_mesh(CLI::App& app, Action& action) {
    auto options = std::make_shared<MeshOptions>();
    auto* verb = app.add_subcommand("mesh", "Make a mesh of closed surfaces or of a label image");
    verb->add_option("FILES", options->files,
                     "IN, one label image or any number of surfaces, then OUT, the mesh file to "
                     "write; replaced if it is there")
        ->required()
        ->type_name(" ");
    verb->add_flag("--hex", options->hex, "Hexahedra of a label image (default: tetrahedra)");
    verb->add_option(
            "--size", options->size,
            "Length of the edges of tetrahedra inside. With --hex: the image is sampled at "
            "the centres of cubes of this edge, which become the cells (default: one cell "
            "a voxel)")
        ->type_name("EDGE");
    verb->add_option("--size-surface", options->size_surface,
                     "Length of edges on surfaces; they grow inwards up to --size (default: "
                     "--size)")
        ->type_name("EDGE");
    verb->add_option("--features", options->features,
                     "Keep edges at which a surface turns by at least this angle, in degrees "
                     "(default: edges are rounded off)")
        ->type_name("ANGLE");
    verb->add_flag("--labels", options->labels,
                   "Take the values as labels, also where the image looks like a scan");
    verb->add_option("--scale", options->scale, "Multiply all coordinates (default: 1)")
        ->type_name("FACTOR");
    verb->footer("Formats to write: " + written_formats() + "\n" + mesh_footer);
    verb->callback([options, &action] { action = [options] { return mesh(*options); }; });
}

void declare_materials(CLI::App& app, Action& action) {
    auto options = std::make_shared<MaterialsOptions>();
    auto* verb =
        app.add_subcommand("materials", "List the laws and the tissues, with limits and sources");
    verb->add_option("NAME", options->name, "One of them, in detail");
    verb->add_flag("--json", options->json, "One JSON object on stdout");
    verb->footer("Example: incise materials neo-hookean");
    verb->callback([options, &action] { action = [options] { return materials(*options); }; });
}

void declare_report(CLI::App& app, Action& action) {
    auto options = std::make_shared<ReportOptions>();
    auto* verb =
        app.add_subcommand("report", "Make a page of a run: pictures, plots, tables, warnings");
    verb->add_option("DIR", options->folder, "Folder that incise run made")
        ->required()
        ->type_name("PATH");
    verb->add_option("--out", options->out,
                     "File to write; replaced if it is there (default: DIR/report.html)")
        ->type_name("FILE.html");
    constexpr int most_pictures = 60;
    verb->add_option("--pictures", options->num_pictures,
                     "How many pictures: the first and the last frame, and others between them")
        ->type_name("N")
        ->check(CLI::Range(0, most_pictures).description(""))
        ->capture_default_str();
    verb->add_option("--color", options->color,
                     "Field that colours the pictures; see incise render --help")
        ->type_name("FIELD");
    verb->add_option("--view", options->view, "From where one looks; see incise render --help")
        ->type_name("X,Y,Z");
    verb->footer(
        "The page is one file. It opens in any browser, without a network. The path of the page\n"
        "goes to stdout. A run that was stopped or that failed has a report too.\n"
        "\n"
        "Examples:\n"
        "  incise report liver.out\n"
        "  incise report liver.out --out liver.html --color von_mises --view=0.3,-1,0.2");
    verb->callback([options, &action] { action = [options] { return report(*options); }; });
}

/// Declares the verb without options. All arguments, also --help, go to incise-render.
void declare_render(CLI::App& app, Action& action) {
    auto* verb = app.add_subcommand("render", "Draw pictures of a finished run, off screen");
    verb->set_help_flag();
    verb->prefix_command();
    verb->callback([verb, &action] {
        action = [arguments = verb->remaining()] { return render({arguments}); };
    });
}

/// Makes all options refuse empty values. An empty value usually comes from a shell variable that
/// is not set.
void refuse_empty_words(CLI::App& app) {
    const auto complaint = [](const std::string& word) {
        return std::string(word.empty() ? "must not be empty; give a value or leave it out" : "");
    };
    for (CLI::App* verb : app.get_subcommands({}))
        for (CLI::Option* option : verb->get_options())
            if (option->get_items_expected_max() > 0) option->check(complaint);
}

/// Throws InputError if the first word is no verb, with a better message than that of CLI11.
void check_verb(int argc, const char* const* argv) {
    if (argc < 2)
        throw InputError("a verb is missing: one of " + scenario::list_of(verbs) +
                         "; incise --help tells more");
    const std::string_view word = argv[1];
    if (word.starts_with('-')) return;
    if (const auto complaint = scenario::complaint(word, {verbs}))
        throw InputError("verb " + scenario::in_quotes(word) + ": " + *complaint);
}

}  // namespace

int dispatch(int argc, const char* const* argv) {
    check_verb(argc, argv);
    Action action;
    CLI::App app(description, "incise");
    app.formatter(std::make_shared<HelpFormatter>());  // before the verbs, which inherit it
    app.set_version_flag("--version", "incise " INCISE_VERSION);
    app.require_subcommand(1);
    declare_run(app, action);
    declare_live(app, action);
    declare_check(app, action);
    declare_info(app, action);
    declare_cut(app, action);
    declare_convert(app, action);
    declare_mesh(app, action);
    declare_materials(app, action);
    declare_render(app, action);
    declare_report(app, action);
    declare_bench(app, action);
    refuse_empty_words(app);
    app.footer(footer);  // after the verbs, which would inherit it
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // help or version
        const auto parsed = app.get_subcommands();
        throw InputError(std::string(error.what()) + "\nsee incise " +
                         (parsed.empty() ? "" : parsed.front()->get_name() + " ") + "--help");
    }
    return action();
}

}  // namespace incise::app
