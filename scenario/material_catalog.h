// Methods, laws and elastic parameters that a scenario can name: the one location that lists them.
// The reader checks scenarios against it and `incise materials` prints it.
// Source of laws and methods: HEML 2015, HybMSS 2020, derived in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "incise/physics/laws/law.h"
#include "incise/scenario/limits.h"

namespace incise::scenario {

enum class Method : std::uint8_t { heml, mass_spring, hybmss };

enum class Parameter : std::uint8_t {
    young,
    poisson,
    shear_modulus,
    bulk_modulus,
    lame_lambda,
    lame_mu,
    c1,
    c2,
    gamma,
    terms,
    c3,
    k1,
    k2,
    dispersion
};
inline constexpr std::size_t num_parameters = 14;

struct ParameterInfo {
    Parameter parameter;
    std::string_view key;
    std::string_view unit;
    std::string_view meaning;
    Limits limits;
};

/// What a scenario gives of a material's elastic parameters.
struct ElasticParameters {
    std::array<std::optional<double>, num_parameters> values;  ///< of `terms`: how many
    std::vector<physics::Ogden::Term> terms;                   ///< of Ogden's law

    std::optional<double>& operator[](Parameter p) { return values[static_cast<std::size_t>(p)]; }
    const std::optional<double>& operator[](Parameter p) const {
        return values[static_cast<std::size_t>(p)];
    }
};

/// Parameters that together determine a material.
using ParameterSet = std::vector<Parameter>;

/// Moduli of small strain about rest, Pa.
struct ElasticConstants {
    double lambda = 0.0;  ///< Lame's first parameter
    double mu = 0.0;      ///< shear modulus

    double bulk_modulus() const { return lambda + 2.0 * mu / 3.0; }
    double young() const { return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu); }
    double poisson() const { return lambda / (2.0 * (lambda + mu)); }
};

/// What takes parameters: a law of HEML, or a method without laws.
struct MaterialModel {
    std::string_view key;
    std::string_view title;
    std::string_view energy;  ///< w: per unit rest volume; W: in all
    std::vector<ParameterSet> parameter_sets;
    ParameterSet optional = {};  ///< may be given besides one of the sets
    std::string_view admissible;
    std::string_view use;
    std::string_view limits;
    bool has_fibres = false;  ///< asks for their direction
    /// The shear modulus at rest by the constants of one of the sets; null if all sets have young,
    /// shear_modulus or lame_mu.
    double (*shear_modulus)(const ElasticParameters& given) = nullptr;
    /// Of a law of HEML: the law with these moduli at rest and what else was given of one of its
    /// sets. Throws InputError, without the law's name, if there is none.
    physics::Law (*make)(const ElasticConstants& at_rest, const ElasticParameters& given) = nullptr;
};

std::span<const ParameterInfo> parameters();
const ParameterInfo& info(Parameter parameter);

std::span<const MaterialModel> laws();
/// Throws std::invalid_argument if there is no such law.
const MaterialModel& law_named(std::string_view key);
const MaterialModel& mass_spring_model();
const MaterialModel& hybmss_model();

/// The model that a material of this method and law follows.
const MaterialModel& model(Method method, std::string_view law);

/// Indexed by Method.
std::span<const std::string_view> method_names();

/// Such as "young + poisson, or shear_modulus + bulk_modulus".
std::string list_of_sets(std::span<const ParameterSet> sets);
/// All that a model takes, such as "c1 + bulk_modulus + k1 + k2; dispersion may be added".
std::string list_of_parameters(const MaterialModel& model);

}  // namespace incise::scenario
