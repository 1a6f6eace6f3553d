// Forward dynamics of an open chain on canonical momenta: core alone.
#include <momenta/core/open_chain.h>
#include <momenta/core/scene/read_scene.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  momenta::OpenChain chain(momenta::read_scene(argv[1]));
  const Eigen::VectorXd q = chain.tree().q0, u = chain.tree().u0;
  Eigen::VectorXd p(chain.nv()), qdot(chain.nq()), pdot(chain.nv());

  chain.momenta(0, q, u, p);                // p = M u, never forming M
  if (!chain.rates(0, q, p, qdot, pdot)) {  // two sweeps, O(bodies)
    std::cerr << chain.failure() << "\n";
    return 1;
  }
  std::cout << "dp/dt of the first joint: " << pdot[0] << "\n";  // the moment of gravity there
  return 0;
}
