// The keys of a carver.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tools/kinds.h"
#include "incise/scenario/tools/tool_shapes.h"

namespace incise::scenario {

namespace {

using cutting::Carver;

constexpr ToolKey carver_keys[] = {{"shape", shape_hint, true}};

class CarverKind final : public ToolKind {
  public:
    CarverKind() : ToolKind(Carver::traits, carver_keys, {}) {}

    bool reads_unknown_kinds() const override { return true; }
    void read(const TableReader& tool, const std::filesystem::path&,
              ToolSpec& spec) const override {
        Carver carver{cutting::Sphere{1.0}};
        if (const auto shape = read_shape_of(tool)) carver.shape = *shape;
        spec.shape = carver;
    }
    std::optional<Extent> extent(const cutting::ToolShape& shape) const override {
        return extent_of(std::get<Carver>(shape).shape);
    }
    Table describe(const cutting::ToolShape& shape) const override {
        return {shape_entry(std::get<Carver>(shape).shape)};
    }
};

}  // namespace

template <>
struct KindFor<cutting::Carver> {
    using type = CarverKind;
};
template const ToolKind& kind_for<cutting::Carver>();

}  // namespace incise::scenario
