// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/remedies.h"

namespace incise::scenario {

topology::WeldAdvice weld_advice() {
    return {
        "join them with 'incise convert --weld IN OUT' or with 'weld = true' in [mesh] of a "
        "scenario",
        "say 'weld = false' in [mesh] of a scenario"};
}

std::string linear_advice() {
    return "read them by their corners as linear ones with 'incise convert --linear IN OUT' or "
           "with 'linear = true' in [mesh] of a scenario";
}

std::string remedy_for(const physics::UnsuitableMaterial& misfit, const MaterialSpec* material) {
    switch (misfit.cause) {
        using enum physics::MaterialMisfit;
        case needs_tetrahedra:
            if (material && material->method == Method::heml)
                return ": leave out prony_rule = \"nodal\"";
            return ": give the region a material with method = \"heml\"";
        case needs_hexahedra:
            return ": give the region a material with method = \"heml\"";
        case needs_cubes:
            return "; use method = \"heml\", or make cubes of an image by incise mesh --hex --size";
        case other:
            return "";
    }
    return "";
}

std::string remedy_for(const physics::MotionFailure& failure) {
    const std::string gentler =
        "; use a smaller dynamics.safety, more damping, gentler motion, or ";
    switch (failure.cause) {
        using enum physics::FailureCause;
        case step_above_bound:
            return "; use time_step = \"auto\"";
        case constraint_too_fast:
            return "; move it more slowly";
        case load_too_large:
            return "; make it smaller or bring it up slowly";
        case crushed_element:
            return gentler + "with method heml law = \"stable-neo-hookean\", which stiffens least";
        case stiffened_tissue:
            return gentler + "a finer mesh there";
        case no_implicit_step:
            return "; use a smaller dynamics.time_step, or gentler motion of constraints and loads";
        case no_equilibrium:
            return ": use smaller loads or motion, more dynamics.steps, or mode = \"dynamic\" with "
                   "damping";
        case free_component_loaded:
            return "; hold it by a constraint, take the loads and gravity from it, or use mode = "
                   "\"dynamic\"";
    }
    return "";
}

}  // namespace incise::scenario
