// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/element_store.h"

#include "physics/heml_kernel.h"
#include "physics/mass_spring_kernel.h"
#include "topology/error.h"

namespace incise::physics {

namespace {

std::unique_ptr<ElementBlock> make_block(const Material& material) {
    if (const auto* springs = std::get_if<MassSprings>(&material.method))
        return std::make_unique<KernelBlock<MassSpringKernel>>(MassSpringKernel{springs->young},
                                                               material.density);
    const auto& links = std::get<HyperElasticLinks>(material.method);
    return std::visit(
        [&](const auto& law) -> std::unique_ptr<ElementBlock> {
            using Kernel = HemlKernel<std::decay_t<decltype(law)>>;
            return std::make_unique<KernelBlock<Kernel>>(Kernel{law, links.inversion_threshold},
                                                         material.density);
        },
        links.law);
}

}  // namespace

ElementStore::ElementStore(const topology::Mesh& mesh, const MaterialTable& table) : table_(table) {
    for (std::size_t i = 0; i < mesh.element_capacity(); ++i)
        if (const ElementId e(i); mesh.is_alive(e)) {
            require_law(mesh, e);
            insert(mesh, e);
        }
}

void ElementStore::require_law(const topology::Mesh& mesh, ElementId e) const {
    const std::string name = "element " + std::to_string(mesh.label(e));
    if (!table_.of_region.contains(mesh.region(e)))
        throw InputError(name + " has region " + std::to_string(mesh.region(e)) +
                         ", for which there is no material; add one, or one without regions");
    if (mesh.kind(e) != topology::CellKind::tetrahedron)
        throw InputError(name + " is a " + traits(mesh.kind(e)).name +
                         "; the methods heml and mass-spring need tetrahedra");
}

std::size_t ElementStore::block_index(ElementId e, int region) const {
    return e.index() / chunk_size * table_.materials.size() + table_.of_region.at(region);
}

void ElementStore::insert(const topology::Mesh& mesh, ElementId e) {
    const std::size_t index = block_index(e, mesh.region(e));
    if (index >= blocks_.size()) blocks_.resize(index + 1);
    if (!blocks_[index])
        blocks_[index] = make_block(table_.materials[table_.of_region.at(mesh.region(e))]);
    blocks_[index]->insert(e, mesh.corners(e), mesh.rest_positions());
}

void ElementStore::replace(const topology::Mesh& mesh, ElementId e) {
    blocks_[block_index(e, mesh.region(e))]->replace(e, mesh.corners(e), mesh.rest_positions());
}

void ElementStore::erase(ElementId e, int region) { blocks_[block_index(e, region)]->erase(e); }

}  // namespace incise::physics
