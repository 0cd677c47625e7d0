#pragma once

#include "continuum/constitution.h"

#include <array>

namespace latcon::continuum
{
/// Number of derivatives of a scalar field at a point by reference position: f_,1 f_,2 f_,11 f_,22 f_,12. Both
/// components of the displacement have the same scalar shape functions, so all kernels work on these five derivatives.
constexpr unsigned int n_derivatives = 5;
constexpr unsigned int n_first = 2;                             ///< number of first derivatives
using ComponentDerivatives = std::array<double, n_derivatives>; ///< of one component
using FieldDerivatives = std::array<ComponentDerivatives, 2>;   ///< one for each component

/// Density at a point as a function of the derivatives of u on one side (cells, boundary faces) or two sides (faces
/// between cells), with its first and second partial derivatives.
struct PointIntegrand
{
  double value = 0.;
  /// [component][side][derivative]
  double first[2][2][n_derivatives];
  /// [component][component'][side][derivative][side'][derivative']
  double second[2][2][2][n_derivatives][2][n_derivatives];
};

/// Sets the density and its derivatives up to `order` to zero.
void clear(PointIntegrand &density, Order order);

/// Returns F_iJ = delta_iJ + u_i,J of a displacement.
dealii::Tensor<2, 2> deformation_gradient(const FieldDerivatives &u);

/// Adds a first Piola stress P [Pa] to the first derivatives of the density of side 0.
void add_stress(PointIntegrand &density, const dealii::Tensor<2, 2> &P);

/// Adds factor * T for T = dP/dF [Pa], index order [i][J][k][L], to the second derivatives of the density on one side.
void add_F_F(PointIntegrand &density, unsigned int side, const dealii::Tensor<4, 2> &T, double factor);

/// Computes W(F) + W_g(F, G) [J/m^3] in a cell, eq. (C.28), as a density of side 0. `density` must have been cleared.
void cell_density(const Constitution &laws, bool has_gradient, const FieldDerivatives &u, Order order,
                  PointIntegrand &density);

/// Interior penalty of a face between or at the edge of cells, eq. (C.28).
struct FacePenalty
{
  double base;      ///< sigma [Pa m] of a state that is no stiffer than `supported`
  double supported; ///< stiffness_across() [Pa m^2] from which the penalty grows with it
};

/// Computes the mean over the sides of -B(F; G, z N N), plus (sigma/2) |z|^2, on a face with normal N, eq. (C.28). z is
/// the jump of the normal gradient: value on the first side minus value on the second side, or minus the
/// `prescribed` gradient on the boundary, where `n_sides` is 1. Components of z that are not `held` are zero. `density`
/// must have been cleared.
void face_density(const GradientLaw &law, const std::array<FieldDerivatives, 2> &u, unsigned int n_sides,
                  const dealii::Tensor<1, 2> &N, const dealii::Tensor<1, 2> &prescribed,
                  const std::array<bool, 2> &held, const FacePenalty &penalty, Order order, PointIntegrand &density);
} // namespace latcon::continuum
