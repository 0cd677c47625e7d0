#pragma once

#include "continuum/material.h"

namespace latcon::continuum
{
/// Value of a function of the invariants I = |F|^2 and J = det F of an in-plane deformation, with its partial
/// derivatives by I, J, twice by I, by both, and twice by J.
using InvariantFunction = dealii::Tensor<1, 6>;

/// Returns an energy W(I, J) [Pa] at F with its derivatives by F up to `order` (theory-continuum.md, eqs. (C.55),
/// (C.56)).
Response response(const InvariantFunction &W, const dealii::Tensor<2, 2> &F, Order order);

/// Means over all directions N, for principal stretches l1 and l2 of F, of the stretch l = |F N|.
struct StretchMeans
{
  InvariantFunction stretch; ///< of l [-]: perimeter of the ellipse with semi-axes l1 and l2, over 2 pi
  InvariantFunction inverse; ///< of 1/l [-]: one over Gauss's arithmetic-geometric mean of l1 and l2
};

/// Returns the means of l and 1/l with their derivatives, each with a relative error of several machine epsilons for
/// every ratio of the principal stretches (theory-continuum.md, eqs. (C.51) to (C.54)). Requires J > 0, I >= 2 J up to
/// rounding, and finite I/J.
StretchMeans stretch_means(double I, double J);
} // namespace latcon::continuum
