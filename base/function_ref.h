// A reference to a callable object, for parameters of functions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <type_traits>

namespace incise {

template <class Signature>
class FunctionRef;

/// Reference to a callable object. In contrast to std::function, it never allocates memory. It is
/// meant for parameters only.
///
/// Lifetime: the function that receives a FunctionRef must not keep it, since the object may be
/// destroyed when the call ends.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
  public:
    template <class Callable>
    requires std::is_invocable_r_v<Result, const Callable&, Arguments...> FunctionRef(
        const Callable& callable)
        : object_(std::addressof(callable)), call_([](const void* object, Arguments... arguments) {
              return (*static_cast<const Callable*>(object))(arguments...);
          }) {}

    Result operator()(Arguments... arguments) const { return call_(object_, arguments...); }

  private:
    const void* object_;
    Result (*call_)(const void* object, Arguments... arguments);
};

}  // namespace incise
