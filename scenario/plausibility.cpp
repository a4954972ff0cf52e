// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/plausibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "incise/scenario/body_problems.h"
#include "incise/scenario/tool_path.h"

namespace incise::scenario {

namespace {

// A body is a part of a human or of a large animal, or a sample of some cells.
constexpr double longest_body = 3.0, shortest_body = 1e-4;       // m
constexpr double lowest_density = 100.0, highest_density = 5e3;  // kg/m3: lung, enamel
constexpr double lowest_young = 50.0, highest_young = 1e11;      // Pa: mucus, enamel
/// Own weight over stiffness: above it, the bottom of a column is squeezed by a quarter.
constexpr double largest_own_strain = 0.25;

class Findings {
  public:
    template <class... Parts>
    void add(const std::string& location, const Parts&... parts) {
        std::ostringstream text;
        text.precision(4);
        (text << ... << parts);
        warnings_.push_back(located(location, text.str()));
    }
    std::vector<std::string> take() { return std::move(warnings_); }

  private:
    std::vector<std::string> warnings_;
};

void look_at_size(const Scenario& scenario, const Box& body, Findings& findings) {
    const double longest = body.sizes().maxCoeff();
    if (longest > longest_body)
        findings.add(scenario.mesh.location, "the body is ", longest,
                     " m long; if its coordinates are in millimetres, write scale = 0.001 in "
                     "[mesh]");
    else if (longest < shortest_body)
        findings.add(scenario.mesh.location, "the body is only ", longest,
                     " m long; coordinates are in metres: check 'scale' in [mesh]");
}

void look_at_materials(const Scenario& scenario, const physics::MaterialTable& materials,
                       Findings& findings) {
    for (std::size_t i = 0; i < materials.materials.size(); ++i) {
        const double density = materials.materials[i].density;
        const double young = physics::young_at_rest(materials.materials[i]);
        const std::string& location = scenario.materials[i].location;
        if (const auto doubt = doubt_of_density(i + 1, density)) findings.add(location, *doubt);
        // Moduli of a tissue are no slip of the pen: skin has 30 Pa at rest, and stiffens.
        if (!scenario.materials[i].has_published_moduli &&
            (young < lowest_young || young > highest_young))
            findings.add(location, "material ", i + 1, " has a Young's modulus of ", young,
                         " Pa at rest; soft tissue has 100 to 1e6 (moduli are in pascals: 5 kPa "
                         "is 5000)");
    }
}

/// True if something may bear the body: a constraint, or in motion an obstacle, a probe, a grasper
/// or a load.
bool is_borne(const Scenario& scenario) {
    if (scenario.dynamics.mode == Mode::statics) return !scenario.constraints.empty();
    return !scenario.constraints.empty() || !scenario.loads.empty() ||
           std::ranges::any_of(scenario.tools, [](const ToolSpec& tool) {
               return !cutting::traits_of(tool.shape).cuts;
           });
}

void look_at_support(const Scenario& scenario, Findings& findings) {
    if (scenario.dynamics.gravity.isZero(0.0) || !scenario.knows_what_holds || is_borne(scenario))
        return;
    findings.add(scenario.mesh.location,
                 scenario.dynamics.mode == Mode::statics
                     ? "nothing holds the body against gravity, so there is no equilibrium: "
                       "add a [[constraint]]"
                     : "nothing holds the body against gravity, so it falls: add a "
                       "[[constraint]], or an [[obstacle]] below it");
}

void look_at_weight(const Scenario& scenario, const Box& body,
                    const physics::MaterialTable& materials, Findings& findings) {
    const Vec3& gravity = scenario.dynamics.gravity;
    if (gravity.isZero(0.0)) return;
    const double height = body.sizes().dot(gravity.cwiseAbs()) / gravity.norm();
    double softest = std::numeric_limits<double>::infinity(), heaviest = 0.0;
    for (const physics::Material& material : materials.materials) {
        softest = std::min(softest, physics::young_at_rest(material));
        heaviest = std::max(heaviest, material.density);
    }
    const double pressure = heaviest * gravity.norm() * height;
    if (scenario.dynamics.mode == Mode::dynamic && pressure > largest_own_strain * softest)
        findings.add(scenario.materials.front().location,
                     "the weight of the body makes a pressure of "
                     "up to ",
                     pressure, " Pa, and its softest material has a Young's modulus of ", softest,
                     " Pa: where it hangs or rests on little, its own weight may crush it. "
                     "Give more support, less gravity, or a material that stiffens");
}

/// Returns the area that the edge of a blade sweeps over the one that it would sweep if it moved
/// across itself; nothing if it does not move.
std::optional<double> sharpness_of_motion(const cutting::Blade& blade, const ToolPath& path) {
    constexpr int parts = 8;  // of the way from key to key: a blade may turn on it
    double swept = 0.0, most = 0.0;
    const auto& keys = path.keys();
    for (std::size_t k = 0; k + 1 < keys.size(); ++k)
        for (int part = 0; part < parts; ++part) {
            const double first = keys[k].time, length = (keys[k + 1].time - first) / parts;
            const Pose from = path.pose(first + part * length),
                       to = path.pose(first + (part + 1) * length);
            for (std::size_t i = 0; i + 1 < blade.edge.size(); ++i) {
                const Vec3 a = from.to_world(blade.edge[i]), b = from.to_world(blade.edge[i + 1]);
                const Vec3 c = to.to_world(blade.edge[i]), d = to.to_world(blade.edge[i + 1]);
                swept += 0.5 * ((b - a).cross(c - a).norm() + (c - b).cross(d - b).norm());
                most += 0.5 * (b - a).norm() * ((c - a).norm() + (d - b).norm());
            }
        }
    if (most == 0.0) return std::nullopt;
    return swept / most;
}

void look_at_blades(const Scenario& scenario, Findings& findings) {
    constexpr double along_itself = 0.01;
    for (const ToolSpec& tool : scenario.tools) {
        const auto* blade = std::get_if<cutting::Blade>(&tool.shape);
        if (!blade || tool.path.size() < 2) continue;
        const auto sharpness = sharpness_of_motion(*blade, ToolPath(tool.path));
        if (!sharpness)
            findings.add(
                tool.location, "tool '", tool.name,
                "' does not move, so it cuts nothing: give its path another 'at' or 'rotate'");
        else if (*sharpness < along_itself)
            findings.add(tool.location, "tool '", tool.name,
                         "' moves along its own edge, so it cuts only where tissue moves across "
                         "it: move it across the edge, or turn the edge");
    }
}

}  // namespace

std::vector<std::string> implausible(const Scenario& scenario, const topology::Mesh& mesh,
                                     const physics::MaterialTable* materials) {
    Findings findings;
    Box body;
    for (const VertexId n : mesh.nodes()) body.extend(mesh.rest_position(n));
    if (body.isEmpty()) return {};
    look_at_size(scenario, body, findings);
    if (materials) look_at_materials(scenario, *materials, findings);
    look_at_support(scenario, findings);
    if (materials) look_at_weight(scenario, body, *materials, findings);
    look_at_blades(scenario, findings);
    return findings.take();
}

std::optional<std::string> doubt_of_density(std::size_t number, double density) {
    if (density >= lowest_density && density <= highest_density) return std::nullopt;
    std::ostringstream text;
    text.precision(4);
    text << "material " << number << " has a density of " << density
         << " kg/m3; soft tissue has some 1000 (1 g/cm3 is 1000 kg/m3)";
    return text.str();
}

std::optional<std::string> warning_of_costly_elements(const physics::Model& model) {
    constexpr std::size_t most_named = 5;
    constexpr double costly = 0.5;  // of the step without them
    std::vector<std::pair<double, ElementId>> steps;
    for (const ElementId e : model.fragments().elements())
        steps.emplace_back(model.structure().element_stable_step(e), e);
    const auto num_compared = static_cast<std::ptrdiff_t>(std::min(most_named + 1, steps.size()));
    std::ranges::partial_sort(steps, steps.begin() + num_compared);
    for (std::size_t k = 1; k <= most_named && k < steps.size(); ++k) {
        const double ratio = steps.front().first / steps[k].first;
        if (ratio > costly) continue;
        std::ostringstream text;
        text.precision(3);
        text << (k == 1 ? "element " : "elements ");
        for (std::size_t i = 0; i < k; ++i)
            text << (i == 0 ? "" : ", ")
                 << model.mesh().label(model.fragments().cells_of(steps[i].second).front());
        text << (k == 1 ? " is" : " are") << " so thin or stiff that steps are "
             << model.structure().rest_stable_step() << " s; without " << (k == 1 ? "it" : "them")
             << " they would be about " << model.structure().rest_stable_step() / ratio
             << " s: mesh anew there";
        return text.str();
    }
    return std::nullopt;
}

}  // namespace incise::scenario
