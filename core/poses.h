#pragma once
// Where the bodies of an open chain are, and nothing else of it: for pictures and measures of
// mechanisms, whose loops are cut or left out first.

#include <momenta/core/scene/scene.h>
#include <momenta/core/tree/tree.h>

#include <memory>
#include <vector>

namespace momenta {

/// The open chain of a scene: it without its loops and their drives. q of a mechanism is laid out
/// as its chain's.
Scene open_chain_of(Scene scene);

/// Owns its model and workspace; one object serves one thread.
class Poses {
 public:
  explicit Poses(const Scene& open_chain);
  ~Poses();
  Poses(const Poses&) = delete;
  Poses& operator=(const Poses&) = delete;

  /// Frame of each body of the tree in ground axes [m] at (t, q), q of nq numbers. O(bodies).
  std::vector<Eigen::Isometry3d> operator()(double t, const double* q);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace momenta
