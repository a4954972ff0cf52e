// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/motion_failure.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "incise/physics/body/model.h"

namespace incise::physics {

namespace {

/// Returns the fragment at the node with the lowest volume ratio before the step, and that ratio.
std::pair<ElementId, double> most_crushed_before(const Model& model, NodeId n, double dt) {
    std::vector<Vec3> before(model.positions().begin(), model.positions().end());
    for (std::size_t i = 0; i < before.size(); ++i) before[i] -= dt * model.velocities()[i];
    std::vector<ElementId> star;
    const fragments::FragmentMesh& fragments = model.fragments();
    fragments.star(n, star);
    std::pair<ElementId, double> lowest{star.front(), std::numeric_limits<double>::infinity()};
    for (const ElementId e : star)
        if (const double J =
                model.structure().elements().block_of(fragments, e).least_volume_ratio(e, before);
            J < lowest.second)
            lowest = {e, J};
    return lowest;
}

struct Lost {
    NodeId node;
    double speed;  // m/s; not finite if the velocity is not finite
};

/// Returns the first node whose velocity is not finite, or else the fastest node.
Lost lost_node(const Model& model) {
    Lost lost{NodeId(0), -1.0};
    for (const NodeId n : model.fragments().nodes()) {
        if (!std::isfinite(lost.speed)) break;
        const double speed = model.velocities()[n.index()].norm();
        if (!(speed <= lost.speed)) lost = {n, speed};
    }
    return lost;
}

/// Returns the likely cause and appends it to the text.
FailureCause find_cause(const Model& model, NodeId n, double dt, std::ostream& text) {
    const double stable_step = model.structure().rest_stable_step();
    const Vec3 &outer = model.boundary().outer_forces()[n.index()],
               &elastic = model.elastic_forces()[n.index()];
    if (dt > stable_step) {
        text << "the step of " << dt << " s is above the stable step of " << stable_step << " s";
        return FailureCause::step_above_bound;
    }
    if (model.boundary().constraints().of_node(n.index())) {
        text << "its constraint moves too fast";
        return FailureCause::constraint_too_fast;
    }
    if (outer.norm() > elastic.norm()) {
        text << "the load on it of " << outer.norm() << " N, with a mass of "
             << model.masses()[n.index()] << " kg";
        return FailureCause::load_too_large;
    }
    constexpr double crushed = 0.2;
    const auto [element, J] = most_crushed_before(model, n, dt);
    if (J < crushed)
        text << "element " << model.mesh().label(model.fragments().cells_of(element).front())
             << (J < 0.0 ? " there was turned inside out" : " there was crushed")
             << " (its volume ratio was " << J << "), where tissue is stiffer than at rest";
    else
        text << "strain so large that it has stiffened the tissue";
    text << " (the step of " << dt << " s is " << dt / stable_step << " of what is stable at rest)";
    return J < crushed ? FailureCause::crushed_element : FailureCause::stiffened_tissue;
}

}  // namespace

MotionFailure failure_of_step(const Model& model, double time, double dt) {
    const auto [n, speed] = lost_node(model);
    const topology::Mesh& mesh = model.mesh();
    const fragments::FragmentMesh& fragments = model.fragments();
    const CellId cell = fragments.cells_of(fragments.incident_element(n)).front();
    const VertexId vertex = fragments.vertex_of_origin(mesh, n);
    std::ostringstream text;
    text << "element " << mesh.label(cell) << ", node "
         << (vertex.is_valid() ? std::to_string(mesh.label(vertex)) + " " : "") << "(at rest at "
         << fragments.rest_position(n).transpose() << ") ";
    if (std::isfinite(speed))
        text << "moved by " << speed * dt << " m in the step from t = " << time
             << " s, farther than the body is wide";
    else
        text << "is no longer at a finite place after the step from t = " << time << " s";
    text << "; likely cause: ";
    const FailureCause cause = find_cause(model, n, dt, text);
    MotionFailure failure(cause, text.str());
    failure.cell = cell;
    failure.vertex = vertex;
    return failure;
}

}  // namespace incise::physics
