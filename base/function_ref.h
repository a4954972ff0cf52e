// A function that is called while the one that it is passed to runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <type_traits>

namespace incise {

template <class Signature>
class FunctionRef;

/// Refers to a callable object, and takes no memory as std::function does of one with several
/// captures. For parameters only: who gets one must not keep it, as the object may be gone when
/// the call is over.
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
