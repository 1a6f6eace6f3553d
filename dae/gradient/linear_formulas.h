#pragma once
// Formulas of neighbouring scenes. A formula f(x; θ) that a run evaluates, of a force, a drive, a
// loop, a Lagrangian, is known as a formula of θ too, so that its derivative is exact (core/
// expression/gradient.cpp): in the scene of θ + d,
//
//   f(x; θ) + d ∂f/∂θ (x; θ)
//
// takes its place, whose differences have ∂f/∂θ to rounding however often f turns between θ and
// θ + d, and wherever it has corners: of abs, max, if(…) that of the piece which x is on at θ.

#include <momenta/core/scene/scene.h>

#include <vector>

namespace momenta {

/// Of scenes at θ + k h, in the order of sixth_order::points, `own` that of θ: all formulas in
/// which they differ, laws of drives of every kind but tables among them. Those stay that call
/// functions by points of what θ changes. O(text) for each
void make_formulas_linear(const Scene& own, double h, std::vector<Scene>& near);

}  // namespace momenta
