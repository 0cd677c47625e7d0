#include "continuum/error_indicator.h"

#include "continuum/collective.h"
#include "continuum/mesh_loop.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/fe/fe_interface_values.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
struct FaceShare
{
  types::global_cell_index cells[2];
  double eta_squared;
};
using Iterator = DoFHandler<2>::active_cell_iterator;

// Values of the fields on one side of a face.
struct Side
{
  std::vector<Tensor<2, 2>> gradients;
  std::vector<Tensor<3, 2>> hessians;

  void read(const FEFaceValuesBase<2> &values, const Sheet::Vector &u)
  {
    gradients.resize(values.n_quadrature_points);
    hessians.resize(values.n_quadrature_points);
    values[FEValuesExtractors::Vector(0)].get_function_gradients(u, gradients);
    values[FEValuesExtractors::Vector(0)].get_function_hessians(u, hessians);
  }
};

class FaceIntegrator
{
public:
  FaceIntegrator(const Sheet &sheet, const Sheet::Vector &u)
    : sheet_(sheet), u_(u), values_(sheet.mapping(), sheet.element(), QGauss<1>(sheet.degree() + 1),
                                    update_gradients | update_hessians | update_JxW_values | update_normal_vectors)
  {
    const Tensor<2, 2> I(unit_symmetric_tensor<2>());
    shear_modulus_ = sheet.constitution().local->tangent(I)[0][1][0][1];
    normal_stiffness_ = sheet.has_gradient() ? sheet.constitution().gradient->normal_stiffness() : 0.;
  }

  FaceShare face(const Iterator &cell, const unsigned int f, const unsigned int sub, const Iterator &neighbor,
                 const unsigned int nf, const unsigned int nsub)
  {
    values_.reinit(cell, f, sub, neighbor, nf, nsub);
    const Constitution &laws = sheet_.constitution();
    const double h =
      std::min(cell->measure() / cell->face(f)->measure(), neighbor->measure() / neighbor->face(nf)->measure());
    for (unsigned int s = 0; s < 2; ++s)
      sides_[s].read(values_.get_fe_face_values(s), u_);
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
        Tensor<2, 2> F = sides_[s].gradients[q];
        slope_jump += sign * (F * N);
        for (unsigned int i = 0; i < 2; ++i)
          F[i][i] += 1.;
        P_jump += sign * laws.first_piola_stress(F, sides_[s].hessians[q]);
        if (sheet_.has_gradient())
          double_traction_jump += sign * ((laws.double_stress(F, sides_[s].hessians[q]) * N) * N);
      }
      double at_point = h / (2. * p * shear_modulus_) * (P_jump * N).norm_square();
      if (sheet_.has_gradient())
        at_point += 2. * p * (p + 1.) / h * normal_stiffness_ * slope_jump.norm_square() +
                    h / normal_stiffness_ * double_traction_jump.norm_square();
      sum += at_point * values_.JxW(q);
    }
    return {{cell->global_active_cell_index(), neighbor->global_active_cell_index()}, 0.5 * sum};
  }

private:
  const Sheet &sheet_;
  const Sheet::Vector &u_;
  FEInterfaceValues<2> values_;
  double shear_modulus_;
  double normal_stiffness_;
  Side sides_[2];
};

struct IndicatorVisitor
{
  FaceIntegrator integrator;
  LinearAlgebra::distributed::Vector<double> &eta_squared;

  void cell(const Iterator &) {}
  void boundary(const Iterator &, unsigned int) {}
  void interior(const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
                const unsigned int neighbor_face, const unsigned int neighbor_subface)
  {
    const FaceShare share = integrator.face(cell, face, subface, neighbor, neighbor_face, neighbor_subface);
    for (const types::global_cell_index each : share.cells)
      eta_squared(each) += share.eta_squared;
  }
  void cell_end() {}
};
} // namespace

Vector<float> error_indicators(const Sheet &sheet, const Sheet::Vector &u)
{
  // Each face, also between ranks, is evaluated once and adds to both of its cells.
  LinearAlgebra::distributed::Vector<double> eta_squared(sheet.mesh().global_active_cell_index_partitioner().lock());
  const DeferredException guarded(
    [&]
    {
      IndicatorVisitor visitor{{sheet, u}, eta_squared};
      for_each_cell_and_face(sheet.dof_handler(), visitor);
    });
  eta_squared.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());

  Vector<float> eta(sheet.mesh().n_active_cells());
  for (const auto &cell : sheet.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      eta[cell->active_cell_index()] = std::sqrt(eta_squared(cell->global_active_cell_index()));
  return eta;
}
} // namespace latcon::continuum
