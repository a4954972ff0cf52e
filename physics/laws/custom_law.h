// A law that a program supplies to the library.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "incise/base/error.h"
#include "incise/physics/laws/law_response.h"

namespace incise::physics {

/// Holds any isotropic law; custom_law() makes one. The laws of the library are several times
/// faster. A CustomLaw computes one element at a time, by a virtual call that cannot be inlined.
class CustomLaw {
  public:
    /// The functions that a law provides.
    class Functions {
      public:
        virtual ~Functions() = default;
        /// Returns the response to a strain; see LawResponse. `J0` is the inversion threshold.
        virtual LawResponse<double> response(const LinkStrain<double>& s, double J0) const = 0;
        virtual LawResponse<Dual> response(const LinkStrain<Dual>& s, double J0) const = 0;
        virtual double rest_lambda() const = 0;  ///< Pa
        virtual double rest_mu() const = 0;      ///< Pa
    };

    /// Throws InputError for null.
    explicit CustomLaw(std::shared_ptr<const Functions> functions)
        : functions_(std::move(functions)) {
        if (!functions_) throw InputError("a law is given as null");
    }

    double rest_lambda() const { return functions_->rest_lambda(); }
    double rest_mu() const { return functions_->rest_mu(); }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Dual>) {
            return functions_->response(s, J0);
        } else {
            // T is a vector of lanes: compute them one after the other.
            LawResponse<T> all{0.0, 0.0, 0.0, 0.0};
            for (int lane = 0; lane < T::size; ++lane) {
                using Number = std::remove_cvref_t<decltype(s.a.v[lane])>;
                const LawResponse<double> one = functions_->response(
                    LinkStrain<double>{s.a.v[lane], s.b.v[lane], s.J.v[lane]}, J0);
                all.w.v[lane] = static_cast<Number>(one.w);
                all.w_a.v[lane] = static_cast<Number>(one.w_a);
                all.w_b.v[lane] = static_cast<Number>(one.w_b);
                all.w_J.v[lane] = static_cast<Number>(one.w_J);
            }
            return all;
        }
    }

  private:
    std::shared_ptr<const Functions> functions_;
};

/// Makes a law from a struct with the members that the structs in law.h have: rest_lambda(),
/// rest_mu() and the template response(). examples/custom_law.cpp shows one.
template <class L>
CustomLaw custom_law(L law) {
    class Held final : public CustomLaw::Functions {
      public:
        explicit Held(L held) : law_(std::move(held)) {}
        LawResponse<double> response(const LinkStrain<double>& s, double J0) const override {
            return law_.response(s, J0);
        }
        LawResponse<Dual> response(const LinkStrain<Dual>& s, double J0) const override {
            return law_.response(s, J0);
        }
        double rest_lambda() const override { return law_.rest_lambda(); }
        double rest_mu() const override { return law_.rest_mu(); }

      private:
        L law_;
    };
    return CustomLaw(std::make_shared<const Held>(std::move(law)));
}

}  // namespace incise::physics
