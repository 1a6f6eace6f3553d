#pragma once
// Workspaces made when first needed.

#include <memory>

namespace momenta {

template <class Sweeps>
class Lazy {
 public:
  /// @pre the same tree in every call
  template <class Tree>
  Sweeps& get(const Tree& tree) {
    if (!sweeps_) sweeps_ = std::make_unique<Sweeps>(tree);
    return *sweeps_;
  }

 private:
  std::unique_ptr<Sweeps> sweeps_;
};

}  // namespace momenta
