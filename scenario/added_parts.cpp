// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/added_parts.h"

#include <utility>

#include "incise/scenario/body_parts.h"
#include "incise/scenario/definition.h"
#include "incise/scenario/scenario_sections.h"

namespace incise::scenario {

physics::Constraint build_added_constraint(const Value& definition, const std::string& name,
                                           const topology::Mesh& mesh,
                                           std::vector<std::string>& warnings) {
    ConstraintSpec spec = read_definition(definition, "constraint '" + name + "'", "fix = \"xyz\"",
                                          warnings, read_added_constraint);
    spec.name = name;
    return build_constraint(spec, mesh);
}

physics::Load build_added_load(const Value& definition, const std::string& name,
                               const topology::Mesh& mesh, std::vector<std::string>& warnings) {
    LoadSpec spec = read_definition(definition, "load '" + name + "'", "pressure = 100", warnings,
                                    read_added_load);
    spec.name = name;
    return build_load(spec, mesh);
}

AddedMaterial build_added_material(const Value& definition, std::vector<std::string>& warnings) {
    const MaterialSpec spec =
        read_definition(definition, "material", "young = 5000", warnings, read_added_material);
    AddedMaterial added{build_material(spec), spec.regions.value_or(std::vector<int>()), {}};
    if (const auto* fibre = std::get_if<Vec3>(&spec.fibre)) added.fibre = *fibre;
    return added;
}

}  // namespace incise::scenario
