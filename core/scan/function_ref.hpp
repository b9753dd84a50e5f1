// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace convexcut {

// A callable that is called before the function that takes it returns: a parameter type only. Does
// not own, does not allocate; the callable must not throw.
template <class Signature>
class FunctionRef;

template <class Result, class... Args>
class FunctionRef<Result(Args...)> {
 public:
  // Implicit: a lambda is passed as it stands.
  template <class Callable, std::enable_if_t<!std::is_same_v<std::decay_t<Callable>, FunctionRef> &&
                                                 std::is_invocable_r_v<Result, Callable&, Args...>,
                                             int> = 0>
  FunctionRef(Callable&& callable) noexcept
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): call_ gives it its const back
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* object, Args... args) -> Result {
          return (*static_cast<std::remove_reference_t<Callable>*>(object))(
              std::forward<Args>(args)...);
        }) {}

  Result operator()(Args... args) const { return call_(object_, std::forward<Args>(args)...); }

 private:
  void* object_;
  Result (*call_)(void*, Args...);
};

}  // namespace convexcut
