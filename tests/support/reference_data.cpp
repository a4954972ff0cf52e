// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/reference_data.h"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

namespace incise::test {

using nlohmann::json;
using topology::CellKind;

namespace {

json read(const std::string& name) {
    std::ifstream file(std::string(INCISE_DATA_DIR) + "/references/" + name);
    return json::parse(file);
}

Vec3 vector(const json& x) {
    const auto v = x.get<std::array<double, 3>>();
    return {v[0], v[1], v[2]};
}

ReferenceLaw law(const std::string& name, const json& entry) {
    return {name, entry.at("params").get<std::map<std::string, double>>()};
}

/// What the two kinds of file have in common.
CutReference body(const std::string& name, const json& entry) {
    CutReference reference;
    reference.name = name;
    for (const auto& x : entry.at("nodes")) reference.mesh.points.push_back(vector(x));
    for (const auto& tet : entry.at("tets"))
        reference.mesh.add_cell(CellKind::tetrahedron, tet.get<std::vector<std::int64_t>>());
    entry.at("cut_faces").get_to(reference.cut_faces);
    entry.at("cut_tets").get_to(reference.cut_tets);
    entry.at("origin").get_to(reference.origin);
    return reference;
}

StaticSolution solution(const std::string& law_name, bool is_cut, const json& entry) {
    StaticSolution s{law(law_name, entry), is_cut, {}, {}, {}};
    for (const auto& u : entry.at("u")) s.displacements.push_back(vector(u));
    s.reaction.setConstant(std::numeric_limits<double>::quiet_NaN());
    return s;
}

}  // namespace

std::vector<UniaxialReference> uniaxial_references() {
    std::vector<UniaxialReference> references;
    const json file = read("uniaxial.json");
    for (const auto& [name, entry] : file.at("data").items()) {
        const json& moduli = entry.at("rest_moduli");
        UniaxialReference reference{law(name, entry), moduli.at("E"), moduli.at("nu"), {}};
        for (const auto& row : entry.at("rows"))
            reference.rows.push_back({row.at(0), row.at(1), row.at(2), row.at(3)});
        references.push_back(std::move(reference));
    }
    return references;
}

CutReference organ_reference() {
    const json file = read("organ_ellipsoid.json");
    CutReference reference = body("organ", file);
    file.at("fixed").get_to(reference.fixed);
    file.at("moved").get_to(reference.moved);
    reference.displacement = vector(file.at("disp"));
    for (const auto& [key, entry] : file.at("results").items()) {
        const std::size_t slash = key.find('/');
        auto s = solution(key.substr(slash + 1), key.substr(0, slash) == "cut", entry);
        s.reaction = vector(entry.at("reaction_on_moved_set"));
        s.deformed_volume = entry.at("deformed_volume").get<double>();
        reference.solutions.push_back(std::move(s));
    }
    return reference;
}

std::vector<CutReference> notch_references() {
    std::vector<CutReference> references;
    for (const auto& entry : read("notch_p1_exact.json")) {
        CutReference reference =
            body("notch " + std::to_string(entry.at("a").get<double>()), entry);
        const Vec3 size = vector(entry.at("L"));
        reference.displacement = {0, 0, entry.at("d").get<double>() * size.z()};
        for (std::size_t i = 0; i < reference.mesh.points.size(); ++i) {
            const double z = reference.mesh.points[i].z();
            if (z == 0.0) reference.fixed.push_back(static_cast<std::int64_t>(i));
            if (z > size.z() * (1 - 1e-9)) reference.moved.push_back(static_cast<std::int64_t>(i));
        }
        for (const auto& [law_name, result] : entry.at("results").items()) {
            auto s = solution(law_name, true, result);
            s.reaction.z() = result.at("Fz_top");
            s.deformed_volume =
                result.at("volume_ratio").get<double>() * size.x() * size.y() * size.z();
            reference.solutions.push_back(std::move(s));
        }
        references.push_back(std::move(reference));
    }
    return references;
}

}  // namespace incise::test
