// What a run leaves behind, as scripts and viewers find it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/run_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/scenario/quantities.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

using nlohmann::json;
using support::read_text;

/// The soft cube, sagging, carved and cut; the run of a second test is the same one.
const std::string scene = soft_cube + two_tools +
                          dynamics(0.2, "gravity = [0, 0, -9.81]\ndamping = 2\n") +
                          "[output]\ninterval = 0.02\n";

std::vector<std::string> lines_of(const std::filesystem::path& path) {
    std::istringstream text(read_text(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> split(const std::string& line) {
    std::istringstream text(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
}

/// The values of all XML attributes of that name, in order.
std::vector<std::string> attributes(const std::string& text, const std::string& name) {
    const std::string before = " " + name + "=\"";
    std::vector<std::string> found;
    for (auto i = text.find(before); i != text.npos; i = text.find(before, i)) {
        i += before.size();
        found.push_back(text.substr(i, text.find('"', i) - i));
    }
    return found;
}

class RunFiles : public testing::Test {
  protected:
    RunFiles() : scenario_(folder_.scenario(scene)), simulation_(scenario_) {
        RunWriter writer(simulation_, folder_ / "out");
        simulation_.add_observer(writer);
        run(simulation_);
        writer.finish(simulation_, {"finished", "", 2.0});
    }
    const topology::Mesh& mesh() const { return simulation_.mesh(); }

    RunFolder folder_;
    Scenario scenario_;
    Simulation simulation_;
};

TEST_F(RunFiles, HistoryHasARowPerFrameAndEdit) {
    const auto lines = lines_of(folder_ / "out/history.csv");
    EXPECT_EQ(lines.at(0),
              "time,step,nodes,elements,components,mass,volume,kinetic_energy,elastic_energy,"
              "external_work,dissipated_energy,momentum_x,momentum_y,momentum_z,"
              "angular_momentum_x,angular_momentum_y,angular_momentum_z,min_J,time_step,"
              "stable_step,contacts,max_penetration,contact_dissipation,fracture_energy,"
              "reaction_floor_x,reaction_floor_y,reaction_floor_z,"
              "torque_floor_x,torque_floor_y,torque_floor_z");
    const auto& edits = simulation_.edits();
    ASSERT_GT(edits.size(), 2u);
    EXPECT_EQ(lines.size(), 1 + 11 + edits.size());
    const auto names = split(lines[0]);
    std::map<double, int> rows_at;
    double last = 0.0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const auto cells = split(lines[i]);
        ASSERT_EQ(cells.size(), names.size());
        for (const auto& cell : cells) {
            std::size_t length = 0;
            EXPECT_TRUE(std::isfinite(std::stod(cell, &length)));
            EXPECT_EQ(length, cell.size());
        }
        const double time = std::stod(cells[0]);
        EXPECT_GE(time, last);
        last = time;
        ++rows_at[time];
    }
    for (int k = 0; k <= 10; ++k) EXPECT_GE(rows_at[k * 0.02], 1) << k;
    for (const EditRecord& edit : edits) EXPECT_GE(rows_at[edit.time], 1);

    // What an edit left is in its row.
    const auto elastic = static_cast<std::size_t>(
        std::find(names.begin(), names.end(), "elastic_energy") - names.begin());
    ASSERT_LT(elastic, names.size());
    for (const EditRecord& edit : edits)
        EXPECT_TRUE(std::any_of(lines.begin() + 1, lines.end(), [&](const std::string& line) {
            const auto cells = split(line);
            return std::stod(cells[0]) == edit.time &&
                   std::stoull(cells[3]) == edit.after.elements &&
                   std::stod(cells[elastic]) == edit.after.totals.elastic_energy;
        })) << edit.time;

    // The first row is the body at rest; the last one that of the end, to the last bit.
    const auto first = split(lines[1]), end = split(lines.back());
    EXPECT_EQ(first[1], "0");
    EXPECT_EQ(first[3], "162");
    EXPECT_EQ(first[4], "1");
    EXPECT_EQ(first[17], "1");
    const auto row = history_row(simulation_);
    for (std::size_t c = 0; c < row.size(); ++c) {
        EXPECT_EQ(names[c], row[c].first);
        EXPECT_EQ(std::stod(end[c]), row[c].second);
    }
}

TEST_F(RunFiles, EditsAreLinesOfJson) {
    const auto lines = lines_of(folder_ / "out/edits.jsonl");
    const auto& edits = simulation_.edits();
    ASSERT_EQ(lines.size(), edits.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const json line = json::parse(lines[i]);
        EXPECT_EQ(line.at("time"), edits[i].time);
        EXPECT_EQ(line.at("step"), edits[i].step);
        EXPECT_EQ(line.at("tool"), edits[i].tool);
        EXPECT_EQ(line.at("elements_removed"), edits[i].elements_removed);
        EXPECT_EQ(line.at("elements_split"), 0);
        EXPECT_EQ(line.at("elements_added"), 0);
        EXPECT_EQ(line.at("faces_opened"), edits[i].faces_opened);
        EXPECT_EQ(line.at("nodes_added"), edits[i].nodes_added);
        EXPECT_EQ(line.at("nodes_removed"), edits[i].nodes_removed);
        EXPECT_EQ(line.at("mass_removed"), edits[i].mass_removed);
        EXPECT_EQ(line.at("fragments_copied"), edits[i].fragments_copied);
        EXPECT_EQ(line.at("fragment_nodes_copied"), edits[i].fragment_nodes_copied);
        EXPECT_EQ(line.at("volume_joined"), edits[i].volume_joined);
        EXPECT_EQ(line.at("volume_released"), edits[i].volume_released);
        for (const auto& [name, body_totals] :
             {std::pair{"before", edits[i].before}, std::pair{"after", edits[i].after}}) {
            const json& side = line.at(name);
            EXPECT_EQ(side.at("nodes"), body_totals.nodes);
            EXPECT_EQ(side.at("elements"), body_totals.elements);
            EXPECT_EQ(side.at("components"), body_totals.components);
            EXPECT_EQ(side.at("mass"), body_totals.totals.mass);
            EXPECT_EQ(side.at("kinetic_energy"), body_totals.totals.kinetic_energy);
            EXPECT_EQ(side.at("elastic_energy"), body_totals.totals.elastic_energy);
            EXPECT_EQ(side.at("momentum")[2], body_totals.totals.momentum.z());
            EXPECT_EQ(side.at("angular_momentum").size(), 3u);
        }
    }
}

TEST_F(RunFiles, SummaryTellsHowItEnded) {
    const json summary = json::parse(read_text(folder_ / "out/summary.json"));
    EXPECT_EQ(summary.at("status"), "finished");
    EXPECT_FALSE(summary.contains("message"));
    EXPECT_EQ(summary.at("scenario"), "scene");
    EXPECT_EQ(summary.at("scenario_hash"), scenario_.hash);
    EXPECT_EQ(summary.at("frames"), 11);
    EXPECT_EQ(summary.at("wall_time"), 2.0);
    EXPECT_EQ(summary.at("steps_per_second"), static_cast<double>(simulation_.num_steps()) / 2.0);
    EXPECT_EQ(summary.at("real_time_factor"), 0.1);
    EXPECT_GE(summary.at("threads"), 1);
    EXPECT_TRUE(summary.at("version").is_string());
    EXPECT_EQ(summary.at("warnings"), json(simulation_.warnings()));
    // The last row of the history, and the totals.
    for (const auto& [name, value] : history_row(simulation_))
        EXPECT_EQ(summary.at(name).get<double>(), value) << name;
    EXPECT_EQ(summary.at("edits"), simulation_.edits().size());
    EXPECT_TRUE(summary.at("elements").is_number_integer());
    EXPECT_EQ(summary.at("elements").get<std::size_t>() +
                  summary.at("elements_removed").get<std::size_t>(),
              162u);
    EXPECT_GT(summary.at("faces_opened"), 0);
    EXPECT_GT(summary.at("mass_removed"), 0.0);
    EXPECT_LE(summary.at("mass_error"), 1e-12);
    EXPECT_LE(summary.at("energy_error"), 0.01);
}

TEST_F(RunFiles, IndexesNameTheFramesAndTheirTimes) {
    const std::string pvd = read_text(folder_ / "out/scene.pvd");
    const auto files = attributes(pvd, "file"), times = attributes(pvd, "timestep");
    ASSERT_EQ(files.size(), 11u);
    ASSERT_EQ(times.size(), 11u);
    const json series = json::parse(read_text(folder_ / "out/scene.vtu.series"));
    ASSERT_EQ(series.at("files").size(), 11u);
    for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_EQ(std::stod(times[i]), static_cast<double>(i) * 0.02);
        EXPECT_EQ(series["files"][i].at("name"), files[i]);
        EXPECT_EQ(series["files"][i].at("time"), std::stod(times[i]));
        EXPECT_GT(io::read_mesh(folder_ / ("out/" + files[i])).mesh.num_cells(), 0u);
    }
    EXPECT_EQ(support::count_entries(folder_ / "out/frames"), 11u);
    EXPECT_EQ(support::count_entries(folder_ / "out"), 8u);
}

TEST_F(RunFiles, FramesDeclareTheArraysOfTheContract) {
    const std::string frame = read_text(folder_ / "out/frames/scene_000010.vtu");
    const auto section = [&](const std::string& name) {
        const auto begin = frame.find("<" + name), end = frame.find("</" + name + ">");
        EXPECT_LT(begin, end) << name;
        return frame.substr(begin, end - begin);
    };
    // Name -> type and number of components.
    const auto arrays = [](const std::string& text) {
        std::map<std::string, std::pair<std::string, int>> found;
        for (const char* element : {"<DataArray ", "<Array "})
            for (auto i = text.find(element); i != text.npos; i = text.find(element, i + 1)) {
                const std::string tag = text.substr(i, text.find('>', i) - i);
                const auto components = attributes(tag, "NumberOfComponents");
                found[attributes(tag, "Name").at(0)] = {
                    attributes(tag, "type").at(0),
                    components.empty() ? 1 : std::stoi(components[0])};
            }
        return found;
    };
    using Arrays = std::map<std::string, std::pair<std::string, int>>;
    EXPECT_EQ(arrays(section("PointData")), (Arrays{{"displacement", {"Float32", 3}},
                                                    {"rest_position", {"Float64", 3}},
                                                    {"velocity", {"Float32", 3}},
                                                    {"force", {"Float32", 3}},
                                                    {"contact_force", {"Float32", 3}},
                                                    {"contact_pressure", {"Float32", 1}},
                                                    {"mass", {"Float64", 1}},
                                                    {"node_id", {"Int64", 1}}}));
    EXPECT_NE(section("PointData").find("Vectors=\"displacement\""), std::string::npos);
    const Arrays cells = arrays(section("CellData"));
    EXPECT_EQ(cells.at("element_id"), (std::pair<std::string, int>{"Int64", 1}));
    EXPECT_EQ(cells.at("region").second, 1);
    EXPECT_EQ(cells.at("J").second, 1);
    EXPECT_EQ(cells.at("energy_density").second, 1);
    EXPECT_EQ(cells.at("stress").second, 9);
    EXPECT_EQ(cells.at("von_mises").second, 1);
    EXPECT_EQ(cells.at("cut_faces"), (std::pair<std::string, int>{"Int32", 1}));
    EXPECT_EQ(cells.size(), 7u);
    EXPECT_TRUE(arrays(section("FieldData")).contains("TimeValue"));
}

template <class Number>
const std::vector<Number>& values(const std::vector<io::Field>& fields, const std::string& name) {
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const io::Field& f) { return f.name == name; });
    if (found == fields.end()) throw std::out_of_range(name);
    return std::get<std::vector<Number>>(found->values);
}

TEST_F(RunFiles, FramesHoldTheState) {
    const auto& model = simulation_.model();
    const io::Frame frame = build_frame(model, simulation_.time(), scenario_.output.fields);
    EXPECT_EQ(frame.time, 0.2);
    std::vector<VertexId> nodes;
    std::vector<CellId> elements;
    const auto data = topology::to_mesh_data(mesh(), model.mesh_positions(), &nodes, &elements);
    EXPECT_EQ(frame.mesh.points, data.points);
    EXPECT_EQ(frame.mesh.corners, data.corners);
    EXPECT_EQ(frame.mesh.regions, data.regions);

    const auto& points = frame.point_fields;
    std::set<std::int64_t> ids;
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const VertexId n = nodes[i];
        const Vec3 &x = model.positions()[n.index()], &X = mesh().rest_position(n);
        EXPECT_EQ(frame.mesh.points[i], x);
        const double m = values<double>(points, "mass")[i];
        mass += m;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto k = static_cast<Eigen::Index>(c);
            EXPECT_EQ(values<double>(points, "rest_position")[3 * i + c], X[k]);
            EXPECT_EQ(values<float>(points, "displacement")[3 * i + c],
                      static_cast<float>(x[k] - X[k]));
            EXPECT_EQ(values<float>(points, "force")[3 * i + c],
                      static_cast<float>(model.elastic_forces()[n.index()][k]));
            const float v = values<float>(points, "velocity")[3 * i + c];
            EXPECT_EQ(v, static_cast<float>(model.velocities()[n.index()][k]));
            momentum[k] += m * v;
        }
        ids.insert(values<std::int64_t>(points, "node_id")[i]);
    }
    EXPECT_EQ(ids.size(), nodes.size());  // no two alike
    EXPECT_NEAR(mass, model.energetics().totals().mass, 1e-12);
    EXPECT_NEAR((momentum - model.energetics().totals().momentum).norm(), 0.0, 1e-6);

    const auto& cells = frame.cell_fields;
    double energy = 0.0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        EXPECT_EQ(values<std::int64_t>(cells, "element_id")[i], mesh().label(elements[i]));
        const auto result = model.element_result(model.fragments().fragment_of_cell(elements[i]));
        EXPECT_EQ(values<float>(cells, "J")[i], static_cast<float>(result.volume_ratio));
        energy += static_cast<double>(values<float>(cells, "energy_density")[i]) * result.volume;
        // von Mises from the components, by its textbook formula.
        const auto s = [&](std::size_t r, std::size_t c) {
            return static_cast<double>(values<float>(cells, "stress")[9 * i + 3 * r + c]);
        };
        EXPECT_NEAR(s(0, 1), s(1, 0), 1e-3);
        const double expected =
            std::sqrt(0.5 * (std::pow(s(0, 0) - s(1, 1), 2) + std::pow(s(1, 1) - s(2, 2), 2) +
                             std::pow(s(2, 2) - s(0, 0), 2)) +
                      3 * (s(0, 1) * s(0, 1) + s(1, 2) * s(1, 2) + s(2, 0) * s(2, 0)));
        EXPECT_NEAR(values<float>(cells, "von_mises")[i], expected, 1e-4 * (1 + expected));
    }
    EXPECT_NEAR(energy, model.energetics().totals().elastic_energy,
                1e-5 * model.energetics().totals().elastic_energy);
}

TEST_F(RunFiles, FramesReadAsTheCutBodyAtRest) {
    const std::string frame = "out/frames/scene_000010.vtu";
    const auto file = io::read_mesh(folder_ / frame);
    const auto data = topology::to_mesh_data(mesh(), mesh().rest_positions());
    EXPECT_EQ(file.mesh.points, data.points);
    EXPECT_EQ(file.mesh.corners, data.corners);
    EXPECT_EQ(file.mesh.regions, data.regions);

    // And goes on as a scenario's mesh: cut as it is.
    const Scenario next =
        folder_.scenario("[mesh]\nfile = \"" + frame +
                         "\"\n[[material]]\ndensity = 1000\nyoung = 1000\npoisson = "
                         "0.4\n" +
                         dynamics(0.02));
    const Simulation again(next);
    const auto &first = again.ledger().initial(), &last = simulation_.edits().back().after;
    EXPECT_EQ(first.nodes, last.nodes);
    EXPECT_EQ(first.elements, last.elements);
    EXPECT_EQ(first.components, last.components);
    EXPECT_NEAR(first.totals.mass, last.totals.mass, 1e-14);
    EXPECT_NEAR(first.totals.elastic_energy, 0.0, 1e-12);
    run(next, folder_ / "next");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "next/scene.pvd"));
}

TEST(FrameBuilder, FinishesTheFrameOfItsStartingTime) {
    Simulation simulation(scenario_of(scene));
    while (simulation.time() < 0.02) simulation.step();
    const auto& fields = simulation.scenario().output.fields;
    const io::Frame at_once = build_frame(simulation.model(), simulation.time(), fields);
    FrameBuilder builder(simulation.model(), simulation.time(), fields);
    const auto num_edits = simulation.edits().size();
    while (!simulation.is_finished()) simulation.step();
    EXPECT_GT(simulation.edits().size(), num_edits);
    EXPECT_EQ(io::vtu_text(builder.finish()), io::vtu_text(at_once));
}

TEST(RunWriter, WritesOnlyTheFieldsAskedFor) {
    const RunFolder folder;
    Scenario scenario =
        folder.scenario(soft_cube + dynamics(0.02) + "[output]\nfields = [\"J\", \"mass\"]\n");
    const Simulation simulation(scenario);
    const io::Frame frame = build_frame(simulation.model(), 0.0, scenario.output.fields);
    const auto names = [](const std::vector<io::Field>& fields) {
        std::set<std::string> all;
        for (const auto& field : fields) all.insert(field.name);
        return all;
    };
    EXPECT_EQ(names(frame.point_fields),
              (std::set<std::string>{"rest_position", "node_id", "mass"}));
    EXPECT_EQ(names(frame.cell_fields), (std::set<std::string>{"element_id", "J"}));
    EXPECT_EQ(frame.active_vectors, "");
}

TEST(RunWriter, AShorterRunReplacesALongerOne) {
    const RunFolder folder;
    run(folder.scenario(scene), folder / "out");
    const Scenario shorter = folder.scenario(soft_cube + dynamics(0.02));
    Simulation simulation(shorter);
    RunWriter writer(simulation, folder / "out");
    EXPECT_FALSE(std::filesystem::exists(folder / "out/summary.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/scene.pvd"));
    simulation.add_observer(writer);
    run(simulation);
    writer.finish(simulation, {});
    EXPECT_EQ(support::count_entries(folder / "out/frames"), 3u);
    EXPECT_EQ(read_text(folder / "out/edits.jsonl"), "");
    EXPECT_EQ(lines_of(folder / "out/history.csv").size(), 4u);
}

TEST(RunWriter, ARunWithoutFramesHasBeginningAndEnd) {
    const RunFolder folder;
    run(folder.scenario(soft_cube + dynamics(0.05) + "[output]\ninterval = 0\n"), folder / "out");
    const auto lines = lines_of(folder / "out/history.csv");
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(split(lines[1])[0], "0");
    EXPECT_EQ(split(lines[2])[0], "0.05");
    EXPECT_EQ(support::count_entries(folder / "out/frames"), 0u);
    EXPECT_EQ(json::parse(read_text(folder / "out/summary.json")).at("frames"), 0);
}

TEST(RunWriter, ARunThatLosesEverythingIsStillWritten) {
    const RunFolder folder;
    run(folder.scenario(soft_cube + R"(
[[tool]]
kind = "carver"
shape = { sphere = { radius = 1 } }
path = [{ time = 0.01, at = [0, 0, 0] }, { time = 0.02, at = [0, 0, 0] }]
)" + dynamics(0.05)),
        folder / "out");
    EXPECT_EQ(io::read_mesh(folder / "out/frames/scene_000001.vtu").mesh.num_cells(), 162u);
    const json summary = json::parse(read_text(folder / "out/summary.json"));
    EXPECT_EQ(summary.at("elements"), 0);
    EXPECT_EQ(summary.at("mass"), 0.0);
    EXPECT_EQ(lines_of(folder / "out/history.csv").size(), 1u + 6u + 1u);
}

TEST(Expectations, AreHeldAgainstTheEndOfTheRun) {
    const auto failures = [](const std::string& expect) {
        Simulation simulation(
            scenario_of(soft_cube + two_tools + dynamics(0.2) + "[expect]\n" + expect));
        run(simulation);
        return failed_expectations(simulation.scenario(), summary_quantities(simulation));
    };
    using Failures = std::vector<std::string>;
    EXPECT_EQ(failures("time = { min = 0.2, max = 0.2 }\nelements = { max = 161 }\n"
                       "components = { min = 2 }\nmass_error = { max = 1e-12 }"),
              Failures{});
    EXPECT_EQ(failures("time = { max = 0.1 }"),
              Failures{"expected time of at most 0.1, it is 0.2"});
    EXPECT_EQ(failures("time = { min = 0.3, max = 0.4 }"),
              Failures{"expected time of at least 0.3, it is 0.2"});
    EXPECT_EQ(failures("time = { max = 0 }\nelements = { min = 163 }").size(), 2u);
}

// Names in files may be of any encoding, and warnings quote them.
TEST(Summary, IsJsonWhateverItsTextsAre) {
    const RunFolder folder;
    Scenario scenario = folder.scenario(soft_cube + dynamics(0.01));
    scenario.title = "a \xff";
    run(scenario, folder / "out");
    EXPECT_EQ(json::parse(read_text(folder / "out/summary.json")).at("title"), "a \uFFFD");
}

// So that what the scenario reader lets through is there at the end of the run.
TEST(Expectations, CanNameExactlyTheQuantitiesOfTheSummary) {
    const Simulation simulation(scenario_of(soft_cube + dynamics(0.2)));
    std::vector<std::string> names;
    for (const auto& [name, value] : summary_quantities(simulation)) names.push_back(name);
    EXPECT_EQ(names, all_quantities(std::vector<std::string>{"floor"}, {}));
}

}  // namespace
}  // namespace incise::runner
