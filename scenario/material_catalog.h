// The list of methods, laws and elastic parameters that a scenario can name. The reader checks
// scenarios against this list, and `incise materials` prints it.
// Source of laws and methods: HEML 2015, HybMSS 2020; docs/theory.md derives them.
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

/// The elastic parameters that a scenario gives for a material.
struct ElasticParameters {
    std::array<std::optional<double>, num_parameters> values;  ///< for `terms`: their number
    std::vector<physics::Ogden::Term> terms;                   ///< for the law of Ogden

    std::optional<double>& operator[](Parameter p) { return values[static_cast<std::size_t>(p)]; }
    const std::optional<double>& operator[](Parameter p) const {
        return values[static_cast<std::size_t>(p)];
    }
};

/// Parameters that together determine a material.
using ParameterSet = std::vector<Parameter>;

/// Moduli at small strain, Pa.
struct ElasticConstants {
    double lambda = 0.0;  ///< first Lame parameter
    double mu = 0.0;      ///< shear modulus

    double bulk_modulus() const { return lambda + 2.0 * mu / 3.0; }
    double young() const { return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu); }
    double poisson() const { return lambda / (2.0 * (lambda + mu)); }
};

/// A law of HEML, or a method without laws, with the parameters that it takes.
struct MaterialModel {
    std::string_view key;
    std::string_view title;
    std::string_view energy;  ///< w: per rest volume; W: total
    std::vector<ParameterSet> parameter_sets;
    ParameterSet optional = {};  ///< may be given in addition to one of the sets
    std::string_view admissible;
    std::string_view use;
    std::string_view limits;
    bool has_fibres = false;  ///< needs the direction of the fibres
    /// Returns the shear modulus at rest, Pa, from the constants of one of the sets. Null if every
    /// set has young, shear_modulus or lame_mu.
    double (*shear_modulus)(const ElasticParameters& given) = nullptr;
    /// For a law of HEML: makes the law from its moduli at rest and the other parameters of the
    /// set. Throws InputError, without the name of the law, if no such law exists.
    physics::Law (*make)(const ElasticConstants& at_rest, const ElasticParameters& given) = nullptr;
};

std::span<const ParameterInfo> parameters();
const ParameterInfo& info(Parameter parameter);

std::span<const MaterialModel> laws();
/// Throws std::invalid_argument if there is no such law.
const MaterialModel& law_named(std::string_view key);
const MaterialModel& mass_spring_model();
const MaterialModel& hybmss_model();

/// Returns the model of a material. Only HEML uses `law`.
const MaterialModel& model(Method method, std::string_view law);

/// Returns the names of the methods in a scenario, indexed by Method.
std::span<const std::string_view> method_names();

/// Returns the sets as text, such as "young + poisson, or shear_modulus + bulk_modulus".
std::string list_of_sets(std::span<const ParameterSet> sets);
/// Returns the parameters of a model as text, such as "c1 + bulk_modulus + k1 + k2; dispersion may
/// be added".
std::string list_of_parameters(const MaterialModel& model);

}  // namespace incise::scenario
