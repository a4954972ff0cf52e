// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/edit_line.h"

#include <nlohmann/json.hpp>

namespace incise::runner {

using Json = nlohmann::ordered_json;

namespace {

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json to_json(const sim::BodyTotals& body_totals) {
    return {{"nodes", body_totals.nodes},
            {"elements", body_totals.elements},
            {"components", body_totals.components},
            {"mass", body_totals.totals.mass},
            {"volume", body_totals.totals.rest_volume},
            {"kinetic_energy", body_totals.totals.kinetic_energy},
            {"elastic_energy", body_totals.totals.elastic_energy},
            {"momentum", to_json(body_totals.totals.momentum)},
            {"angular_momentum", to_json(body_totals.totals.angular_momentum)},
            {"centre_of_mass", to_json(body_totals.totals.centre_of_mass)},
            {"stable_step", body_totals.stable_step}};
}

}  // namespace

std::string edit_line(const sim::EditRecord& edit) {
    const Json json = {{"time", edit.time},
                       {"step", edit.step},
                       {"tool", edit.tool},
                       {"elements_removed", edit.elements_removed},
                       {"elements_crossed", edit.elements_crossed},
                       {"elements_split", edit.elements_split},
                       {"elements_added", edit.elements_added},
                       {"faces_opened", edit.faces_opened},
                       {"nodes_added", edit.nodes_added},
                       {"nodes_duplicated", edit.nodes_duplicated},
                       {"nodes_removed", edit.nodes_removed},
                       {"nodes_snapped", edit.nodes_snapped},
                       {"cut_area", edit.cut_area},
                       {"mass_removed", edit.mass_removed},
                       {"fragments_copied", edit.fragments_copied},
                       {"fragment_nodes_copied", edit.fragment_nodes_copied},
                       {"volume_joined", edit.volume_joined},
                       {"volume_released", edit.volume_released},
                       {"min_altitude_ratio", edit.min_altitude_ratio},
                       {"before", to_json(edit.before)},
                       {"after", to_json(edit.after)}};
    // Names are UTF-8, except in a forged checkpoint.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace incise::runner
