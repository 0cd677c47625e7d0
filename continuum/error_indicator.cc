#include "continuum/error_indicator.h"

#include "continuum/collective.h"
#include "continuum/lifted_shapes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/fe/fe_interface_values.h>
#include <deal.II/grid/filtered_iterator.h>

#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
class FaceIntegrator
{
public:
  FaceIntegrator(const Sheet &sheet, const Sheet::Vector &u)
    : sheet_(sheet), u_(u),
      values_(sheet.mapping(), sheet.element(), QGauss<1>(sheet.degree() + 1),
              update_gradients | update_hessians | update_JxW_values | update_normal_vectors | update_quadrature_points)
  {
    const Tensor<2, 2> I(unit_symmetric_tensor<2>());
    shear_modulus_ = sheet.constitution().local->tangent(I)[0][1][0][1];
    normal_stiffness_ = sheet.has_gradient() ? sheet.constitution().gradient->normal_stiffness() : 0.;
  }

  // Returns the share of a cell in the squared jumps across one of its faces.
  double operator()(const LiftedFace::Cell &cell, const LiftedFace &at)
  {
    values_.reinit(cell, at.face, at.subface, at.neighbor, at.neighbor_face, at.neighbor_subface);
    const double h = std::min(cell->measure() / cell->face(at.face)->measure(),
                              at.neighbor->measure() / at.neighbor->face(at.neighbor_face)->measure());
    for (unsigned int s = 0; s < 2; ++s)
    {
      gradients_[s].resize(values_.n_quadrature_points);
      hessians_[s].resize(values_.n_quadrature_points);
      const auto &side = values_.get_fe_face_values(s)[FEValuesExtractors::Vector(0)];
      side.get_function_gradients(u_, gradients_[s]);
      side.get_function_hessians(u_, hessians_[s]);
    }
    const double p = sheet_.degree();
    double sum = 0.;
    for (unsigned int q = 0; q < values_.n_quadrature_points; ++q)
    {
      const Tensor<1, 2> N = values_.normal(q);
      Tensor<2, 2> P_jump;
      Tensor<1, 2> slope_jump;
      Tensor<1, 2> double_traction_jump;
      for (unsigned int s = 0; s < 2; ++s)
      {
        const double sign = s == 0 ? 1. : -1.;
        Tensor<2, 2> F = gradients_[s][q];
        slope_jump += sign * (F * N);
        for (unsigned int i = 0; i < 2; ++i)
          F[i][i] += 1.;
        const GradientResponse W =
          sheet_.constitution().evaluate(values_.get_quadrature_points()[q], F, hessians_[s][q]);
        P_jump += sign * W.first_piola;
        double_traction_jump += sign * ((W.double_stress * N) * N);
      }
      double at_point = h / (2. * p * shear_modulus_) * (P_jump * N).norm_square();
      if (sheet_.has_gradient())
        at_point += 2. * p * (p + 1.) / h * normal_stiffness_ * slope_jump.norm_square() +
                    h / normal_stiffness_ * double_traction_jump.norm_square();
      sum += at_point * values_.JxW(q);
    }
    return 0.5 * sum;
  }

private:
  const Sheet &sheet_;
  const Sheet::Vector &u_;
  FEInterfaceValues<2> values_;
  double shear_modulus_;
  double normal_stiffness_;
  std::vector<Tensor<2, 2>> gradients_[2]; // on both sides of the face
  std::vector<Tensor<3, 2>> hessians_[2];
};
} // namespace

Vector<float> error_indicators(const Sheet &sheet, const Sheet::Vector &u)
{
  Vector<float> eta(sheet.mesh().n_active_cells());
  run_collectively(sheet.communicator(),
                   [&]
                   {
                     FaceIntegrator squared_jumps(sheet, u);
                     for (const auto &cell :
                          sheet.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
                     {
                       double sum = 0.;
                       for (const LiftedFace &face : lifted_faces(sheet, cell))
                         sum += face.condition == nullptr ? squared_jumps(cell, face) : 0.;
                       eta[cell->active_cell_index()] = std::sqrt(sum);
                     }
                   });
  return eta;
}
} // namespace latcon::continuum
