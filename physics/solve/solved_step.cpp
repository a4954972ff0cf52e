// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/solved_step.h"

#include <algorithm>
#include <cmath>

namespace incise::physics {

void begin_solved_step(Model& model) {
    model.boundary().update();
    model.boundary().clear_reactions();
    model.state().set_largest_move(0.0);
}

double take_solved_step(Model& model, std::span<const Vec3> positions,
                        std::span<const Vec3> velocities, std::span<const Vec3> reactions,
                        double dt) {
    const double largest_move = model.state().largest_move();
    begin_solved_step(model);
    Boundary& boundary = model.boundary();
    const State::Values values = model.state().change();
    double largest_square = 0.0;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        if (model.masses()[n] == 0.0) continue;  // dead
        largest_square =
            std::max(largest_square, (positions[n] - values.positions[n]).squaredNorm());
        if (const auto* constraint_of = boundary.constraints().of_node(n))
            for (int c = 0; c < 3; ++c)
                if (const int s = (*constraint_of)[static_cast<std::size_t>(c)]; s >= 0)
                    boundary.add_reaction(s, c, reactions[n][c], positions[n],
                                          boundary.reactions());
    }
    model.state().set_largest_move(largest_move + std::sqrt(largest_square));
    const double taken = model.advance_history(values.positions, positions, dt);
    std::copy(positions.begin(), positions.end(), values.positions.begin());
    std::copy(velocities.begin(), velocities.end(), values.velocities.begin());
    return taken;
}

}  // namespace incise::physics
