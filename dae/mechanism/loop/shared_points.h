#pragma once
// Ties that meet in one point, paired anew. Where s ties join s + 1 bodies at the same point of
// each, Φ says that these points agree, two by two; any other tree of pairs on the same bodies says
// it too. With Φ' the rows of the other tree
//
//   Φ = S Φ',  Φ' = T Φ,  S and T of 0 and ±1, T = S⁻¹
//   Φ_qᵀσ = Φ'_qᵀσ',  σ' = Sᵀσ,  σ = Tᵀσ'
//
// and ṗ of (8) is the same in both, S being constant: ties stand along the axes of the ground. A
// star on one body keeps all its impulses open in every body from there to the ground. A path along
// the bodies in the order of the sweeps keeps two at a time, and where the ground is one of them
// each of the others is tied to it.

#include <momenta/dae/mechanism/loop/loop_model.h>

namespace momenta {

class SharedPoints {
 public:
  /// Ties of bodies that share more than this in one point stay as they are.
  static constexpr std::size_t most_bodies = 64;

  // Out of line: the sweeps that copy them are compiled for several instruction levels.
  SharedPoints();
  SharedPoints(const SharedPoints&);
  SharedPoints& operator=(const SharedPoints&);
  ~SharedPoints();
  /// Pairs anew, in `paired_anew`, the ties of bodies (given by their parents, −1: the ground) that
  /// no third one carries: two on one branch may have too little freedom between them to close
  /// there. O(loops · log loops + Σ bodies² over the shared points).
  template <class Space>
  SharedPoints(const std::vector<int>& parents, const LoopModel<Space>& loops,
               LoopModel<Space>& paired_anew);

  /// Whether no tie was paired anew.
  bool empty() const { return count_ == 0; }
  /// σ' to σ = Tᵀσ' in place, components `stride` apart.
  void to_given(double* sigma, std::ptrdiff_t stride);
  /// σ' = Sᵀσ (m); valid until the next call.
  const double* to_paired(const double* sigma);

 private:
  struct Term {
    int to, from;  ///< places in rows_
    double sign;
  };
  void exchange(const std::vector<Term>& terms, double* sigma, std::ptrdiff_t stride);

  std::size_t count_ = 0;
  std::vector<int> rows_;             ///< changed rows of Φ
  std::vector<Term> given_, paired_;  ///< by destination
  std::vector<double> before_, all_;
};

}  // namespace momenta
