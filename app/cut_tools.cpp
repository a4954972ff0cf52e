// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/cut_tools.h"

#include <array>

#include "incise/app/messages.h"
#include "incise/app/number_list.h"
#include "incise/base/error.h"
#include "incise/cutting/surfaces/surface_check.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/scenario/diagnostics.h"

namespace incise::app {

namespace {

enum class Kind { plane, surface, sweep, sphere, box, capsule };

constexpr std::array<CutToolOption, 6> tool_options = {{
    {"--plane", "px,py,pz,nx,ny,nz", "Cut through with the plane at p with normal n"},
    {"--surface", "FILE", "Cut along a triangulated surface, open or closed: STL, PLY, OFF, OBJ"},
    {"--sweep", "\"x,y,z;x,y,z | x,y,z;x,y,z\"",
     "Cut with a blade's edge that moves straight from pose to pose"},
    {"--remove-sphere", "cx,cy,cz,r", "Remove the elements whose centres a ball covers"},
    {"--remove-box", "x0,y0,z0,x1,y1,z1", "The same for a box from its lower corner to its upper"},
    {"--remove-capsule", "x0,y0,z0,x1,y1,z1,r",
     "The same for all within r of the line between two points"},
}};

using Numbers = std::vector<double>;

Vec3 point(const Numbers& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// A parser of one argument. Its errors name the argument.
struct Reader {
    const CutToolArgument& argument;
    const CutToolOption& option;
    double snap;

    [[noreturn]] void fail(const std::string& wrong) const {
        throw InputError(argument.option + ": " + scenario::in_quotes(argument.text) + wrong);
    }
    Numbers numbers() const { return parse_numbers(argument.option, argument.text, option.form); }
    double radius(double r) const {
        if (!(r > 0.0))
            fail(" has a radius of " + argument.text.substr(argument.text.rfind(',') + 1) +
                 "; it must be above 0");
        return r;
    }

    cutting::PlaneCut plane() const {
        const Numbers x = numbers();
        const Vec3 normal = point(x, 3);
        if (normal.isZero(0.0)) fail(" has a normal of zero length; give the plane a direction");
        return {point(x, 0), normal, snap};
    }

    cutting::Sweep sweep() const {
        cutting::Sweep sweep{{}, snap};
        for (const auto text : parts_of(argument.text, '|')) {
            const auto name = "pose " + std::to_string(sweep.poses.size() + 1);
            auto edge = parse_points(argument.option + ": " + name, text);
            if (edge.size() < 2)
                throw InputError(argument.option + ": " + name + ", " + scenario::in_quotes(text) +
                                 ", has 1 point; an edge needs at least 2, with ; between");
            if (!sweep.poses.empty() && sweep.poses.front().size() != edge.size())
                throw InputError(argument.option + ": " + name + " has " +
                                 std::to_string(edge.size()) + " points and pose 1 has " +
                                 std::to_string(sweep.poses.front().size()) +
                                 "; all poses need the same number");
            sweep.poses.push_back(std::move(edge));
        }
        if (sweep.poses.size() < 2) fail(" has 1 pose; a sweep needs at least 2, with | between");
        return sweep;
    }

    cutting::Removal sphere() const {
        const Numbers x = numbers();
        return {cutting::Sphere{radius(x[3])}, point(x, 0)};
    }

    cutting::Removal box() const {
        const Numbers x = numbers();
        for (std::size_t c = 0; c < 3; ++c)
            if (!(x[c] < x[c + 3]))
                fail(std::string(": ") + "xyz"[c] + "0 must be below " + "xyz"[c] +
                     "1; the lower corner comes first");
        const Vec3 low = point(x, 0), high = point(x, 3);
        return {cutting::Cuboid{high - low}, 0.5 * (low + high)};
    }

    cutting::Removal capsule() const {
        const Numbers x = numbers();
        const Vec3 from = point(x, 0), to = point(x, 3), middle = 0.5 * (from + to);
        return {cutting::Capsule{from - middle, to - middle, radius(x[6])}, middle};
    }
};

}  // namespace

std::span<const CutToolOption> cut_tool_options() { return tool_options; }

ParsedCutTool parse_cut_tool(const CutToolArgument& argument, double snap) {
    std::size_t row = 0;
    while (argument.option != tool_options.at(row).name) ++row;
    const Reader reader{argument, tool_options[row], snap};
    ParsedCutTool parsed;
    switch (static_cast<Kind>(row)) {
        case Kind::plane:
            parsed.tool.kind = reader.plane();
            break;
        case Kind::sweep:
            parsed.tool.kind = reader.sweep();
            break;
        case Kind::sphere:
            parsed.tool.kind = reader.sphere();
            break;
        case Kind::box:
            parsed.tool.kind = reader.box();
            break;
        case Kind::capsule:
            parsed.tool.kind = reader.capsule();
            break;
        case Kind::surface: {
            auto file = io::read_surface(argument.text);
            for (const auto& defect : cutting::defects_of_surface(file.surface))
                file.warnings.push_back(defect);
            for (const auto& warning : file.warnings)
                parsed.warnings.push_back(prefixed(argument.text + ": ", warning));
            parsed.tool.kind = cutting::SurfaceCut{std::move(file.surface), snap};
        }
    }
    // The values of sweeps can be too long for messages.
    constexpr std::size_t longest = 60;
    parsed.tool.name = argument.option + " " + argument.text.substr(0, longest) +
                       (argument.text.size() > longest ? "..." : "");
    return parsed;
}

}  // namespace incise::app
