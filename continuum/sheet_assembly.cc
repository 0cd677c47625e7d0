// Integrals of Sheet that depend on the state: energy, residual, tangent.
#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/point_density.h"
#include "continuum/sheet.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/meshworker/mesh_loop.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace dealii;

namespace continuum
{
namespace
{
// What one cell or face adds. Its unknowns are 2 n + i for scalar shape function n and component i.
struct Contribution
{
  double energy = 0.;
  std::vector<types::global_dof_index> dofs;
  Vector<double> residual;
  Vector<double> magnitude;
  FullMatrix<double> tangent;
};
using Contributions = std::vector<Contribution>;

using Iterator = DoFHandler<2>::active_cell_iterator;
using MeshIterator = Triangulation<2>::cell_iterator;

Jet shape_jet(const FEValuesBase<2> &values, const unsigned int n, const unsigned int q, const bool has_gradient)
{
  const Tensor<1, 2> &gradient = values.shape_grad(n, q);
  Jet jet{gradient[0], gradient[1], 0., 0., 0.};
  if (has_gradient)
  {
    const Tensor<2, 2> &hessian = values.shape_hessian(n, q);
    jet[2] = hessian[0][0];
    jet[3] = hessian[1][1];
    jet[4] = hessian[0][1];
  }
  return jet;
}

// Integrates densities over cells and faces for one state u. Copied once for a loop (see mesh_loop).
class Integrator
{
public:
  Integrator(const Sheet &sheet, const Sheet::Vector &u, const double load_factor, const Order order)
    : sheet_(sheet), u_(u), load_factor_(load_factor), order_(order), element_(sheet.degree()),
      cell_values_(sheet.mapping(), element_, QGauss<2>(sheet.degree() + 1), flags(sheet) | update_JxW_values)
  {
    if (sheet.has_gradient())
      for (unsigned int s = 0; s < 2; ++s)
      {
        face_values_[s] =
          std::make_unique<FEFaceValues<2>>(sheet.mapping(), element_, QGauss<1>(sheet.degree() + 1), face_flags());
        subface_values_[s] =
          std::make_unique<FESubfaceValues<2>>(sheet.mapping(), element_, QGauss<1>(sheet.degree() + 1), face_flags());
      }
  }
  Integrator(const Integrator &other) : Integrator(other.sheet_, other.u_, other.load_factor_, other.order_) {}

  void cell(const Iterator &cell, Contributions &contributions)
  {
    cell_values_.reinit(MeshIterator(cell));
    begin(contributions);
    take_nodes(cell, 0);
    const bool has_gradient = sheet_.has_gradient();
    const std::size_t n = nodes_.size();
    for (unsigned int q = 0; q < cell_values_.n_quadrature_points; ++q)
    {
      basis_.resize(n);
      for (std::size_t a = 0; a < n; ++a)
        basis_[a][0] = shape_jet(cell_values_, a, q, has_gradient);
      start_point(1);
      cell_density(sheet_.constitution(), has_gradient, jets_[0], order_, density_);
      add_point(1, has_gradient ? n_jet : n_first, cell_values_.JxW(q), contributions.back());
    }
    end(contributions.back());
  }

  void boundary(const Iterator &cell, const unsigned int face, Contributions &contributions)
  {
    for (const PrescribedNormalGradient &condition : sheet_.conditions().normal_gradients)
      if (condition.boundary == cell->face(face)->boundary_id())
      {
        FEFaceValues<2> &values = *face_values_[0];
        values.reinit(MeshIterator(cell), face);
        begin(contributions);
        take_nodes(cell, 0);
        integrate_face({&values, nullptr}, 1, sheet_.penalty(extent(cell, face)), &condition, contributions.back());
        return; // the first in the list holds, as for displacements
      }
  }

  void interior(const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
                const unsigned int neighbor_face, const unsigned int neighbor_subface, Contributions &contributions)
  {
    const auto side = [this](const unsigned int s, const Iterator &there, const unsigned int f,
                             const unsigned int sub) -> const FEFaceValuesBase<2> *
    {
      if (sub == numbers::invalid_unsigned_int)
      {
        face_values_[s]->reinit(MeshIterator(there), f);
        return face_values_[s].get();
      }
      subface_values_[s]->reinit(MeshIterator(there), f, sub);
      return subface_values_[s].get();
    };
    const std::array<const FEFaceValuesBase<2> *, 2> values = {side(0, cell, face, subface),
                                                               side(1, neighbor, neighbor_face, neighbor_subface)};
    begin(contributions);
    take_nodes(cell, 0);
    take_nodes(neighbor, 1);
    const double penalty = sheet_.penalty(std::min(extent(cell, face), extent(neighbor, neighbor_face)));
    integrate_face(values, 2, penalty, nullptr, contributions.back());
  }

private:
  static UpdateFlags flags(const Sheet &sheet)
  {
    return update_gradients | (sheet.has_gradient() ? update_hessians : update_default);
  }
  static UpdateFlags face_flags()
  {
    return update_gradients | update_hessians | update_JxW_values | update_normal_vectors | update_quadrature_points;
  }

  // Of a cell across a face [m].
  static double extent(const Iterator &cell, const unsigned int face)
  {
    return cell->measure() / cell->face(face)->measure();
  }

  struct Node
  {
    types::global_dof_index dofs[2];
    unsigned int local[2]; // number of the scalar shape function on each side; invalid where it is not
    double u[2];
  };

  void begin(Contributions &contributions)
  {
    contributions.emplace_back();
    nodes_.clear();
  }

  // Adds the shape functions of a cell; those that the other side has too are one and the same.
  void take_nodes(const Iterator &cell, const unsigned int side)
  {
    const auto &system = sheet_.element();
    cell_dofs_.resize(system.n_dofs_per_cell());
    cell->get_dof_indices(cell_dofs_);
    const std::size_t n_before = nodes_.size();
    for (unsigned int n = 0; n < element_.n_dofs_per_cell(); ++n)
    {
      const types::global_dof_index dof = cell_dofs_[system.component_to_system_index(0, n)];
      const auto end_before = nodes_.begin() + n_before;
      const auto known =
        std::find_if(nodes_.begin(), end_before, [dof](const Node &node) { return node.dofs[0] == dof; });
      if (known != end_before)
      {
        known->local[side] = n;
        continue;
      }
      Node node{{dof, cell_dofs_[system.component_to_system_index(1, n)]},
                {numbers::invalid_unsigned_int, numbers::invalid_unsigned_int},
                {}};
      node.local[side] = n;
      for (unsigned int i = 0; i < 2; ++i)
        node.u[i] = u_(node.dofs[i]);
      nodes_.push_back(node);
    }
  }

  void integrate_face(const std::array<const FEFaceValuesBase<2> *, 2> &values, const unsigned int n_sides,
                      const double penalty, const PrescribedNormalGradient *condition, Contribution &contribution)
  {
    for (unsigned int q = 0; q < values[0]->n_quadrature_points; ++q)
    {
      basis_.resize(nodes_.size());
      for (unsigned int s = 0; s < n_sides; ++s)
        for (std::size_t a = 0; a < nodes_.size(); ++a)
          basis_[a][s] = nodes_[a].local[s] == numbers::invalid_unsigned_int
                           ? Jet{}
                           : shape_jet(*values[s], nodes_[a].local[s], q, true);
      Tensor<1, 2> prescribed;
      if (condition != nullptr)
        for (unsigned int i = 0; i < 2; ++i)
          prescribed[i] = load_factor_ * condition->gradient->value(values[0]->quadrature_point(q), i);
      start_point(n_sides);
      face_density(*sheet_.constitution().gradient, jets_, n_sides, values[0]->normal_vector(q), prescribed, penalty,
                   order_, density_);
      add_point(n_sides, n_jet, values[0]->JxW(q), contribution);
    }
    end(contribution);
  }

  // Jets of u from the basis, and a blank density.
  void start_point(const unsigned int n_sides)
  {
    clear(density_, order_);
    for (unsigned int s = 0; s < n_sides; ++s)
      for (unsigned int i = 0; i < 2; ++i)
      {
        Jet &jet = jets_[s][i];
        jet.fill(0.);
        for (std::size_t a = 0; a < nodes_.size(); ++a)
          for (unsigned int c = 0; c < n_jet; ++c)
            jet[c] += basis_[a][s][c] * nodes_[a].u[i];
      }
  }

  void add_point(const unsigned int n_sides, const unsigned int n_derivatives, const double JxW,
                 Contribution &contribution)
  {
    contribution.energy += density_.value * JxW;
    const std::size_t n = nodes_.size();
    if (order_ == Order::first)
    {
      if (contribution.residual.size() == 0)
      {
        contribution.residual.reinit(2 * n);
        contribution.magnitude.reinit(2 * n);
      }
      for (std::size_t a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 2; ++i)
        {
          double sum = 0.;
          double magnitude = 0.;
          for (unsigned int s = 0; s < n_sides; ++s)
            for (unsigned int c = 0; c < n_derivatives; ++c)
            {
              const double term = density_.first[s][i][c] * basis_[a][s][c];
              sum += term;
              magnitude += std::abs(term);
            }
          contribution.residual[2 * a + i] += sum * JxW;
          contribution.magnitude[2 * a + i] += magnitude * JxW;
        }
    }
    if (order_ != Order::second)
      return;

    if (contribution.tangent.m() == 0)
      contribution.tangent.reinit(2 * n, 2 * n);
    FullMatrix<double> &K = contribution.tangent;
    for (std::size_t b = 0; b < n; ++b)
      for (unsigned int k = 0; k < 2; ++k)
      {
        // The density's first derivatives, changed by a unit of unknown (b, k).
        std::array<FieldJet, 2> change;
        for (unsigned int s = 0; s < n_sides; ++s)
          for (unsigned int i = 0; i < 2; ++i)
            for (unsigned int c = 0; c < n_derivatives; ++c)
            {
              double sum = 0.;
              for (unsigned int t = 0; t < n_sides; ++t)
                for (unsigned int e = 0; e < n_derivatives; ++e)
                  sum += density_.second[s][t][i][c][k][e] * basis_[b][t][e];
              change[s][i][c] = sum * JxW;
            }
        for (std::size_t a = 0; a <= b; ++a)
          for (unsigned int i = 0; i < 2; ++i)
          {
            double sum = 0.;
            for (unsigned int s = 0; s < n_sides; ++s)
              for (unsigned int c = 0; c < n_derivatives; ++c)
                sum += change[s][i][c] * basis_[a][s][c];
            K(2 * a + i, 2 * b + k) += sum;
          }
      }
  }

  void end(Contribution &contribution)
  {
    for (const Node &node : nodes_)
      contribution.dofs.insert(contribution.dofs.end(), node.dofs, node.dofs + 2);
    // Blocks on and above the diagonal were summed; the second derivative is symmetric.
    FullMatrix<double> &K = contribution.tangent;
    for (unsigned int row = 0; row < K.m(); ++row)
      for (unsigned int column = 0; column < row / 2 * 2; ++column)
        K(row, column) = K(column, row);
  }

  const Sheet &sheet_;
  const Sheet::Vector &u_;
  double load_factor_;
  Order order_;
  FE_Q<2> element_;
  FEValues<2> cell_values_;
  std::array<std::unique_ptr<FEFaceValues<2>>, 2> face_values_;
  std::array<std::unique_ptr<FESubfaceValues<2>>, 2> subface_values_;

  std::vector<Node> nodes_;
  std::vector<types::global_dof_index> cell_dofs_;
  std::vector<std::array<Jet, 2>> basis_; // of each node, on each side
  std::array<FieldJet, 2> jets_;          // of u on each side
  Density density_;
};

// Calls add(contribution) for every own cell and for every face that falls to this rank.
template <typename Add>
void integrate(const Sheet &sheet, const Sheet::Vector &u, const double load_factor, const Order order, const Add &add)
{
  const auto cell_worker = [](const Iterator &cell, Integrator &integrator, Contributions &contributions)
  { integrator.cell(cell, contributions); };
  const auto copier = [&](const Contributions &contributions)
  {
    for (const Contribution &contribution : contributions)
      add(contribution);
  };
  const Integrator integrator(sheet, u, load_factor, order);
  const Iterator begin = sheet.dof_handler().begin_active();
  const Iterator end = sheet.dof_handler().end();
  if (!sheet.has_gradient())
  {
    MeshWorker::mesh_loop(begin, end, cell_worker, copier, integrator, Contributions(), MeshWorker::assemble_own_cells);
    return;
  }
  const auto boundary_worker = [](const Iterator &cell, const unsigned int face, Integrator &worker,
                                  Contributions &contributions) { worker.boundary(cell, face, contributions); };
  const auto face_worker = [](const Iterator &cell, const unsigned int face, const unsigned int subface,
                              const Iterator &neighbor, const unsigned int neighbor_face,
                              const unsigned int neighbor_subface, Integrator &worker, Contributions &contributions)
  { worker.interior(cell, face, subface, neighbor, neighbor_face, neighbor_subface, contributions); };
  MeshWorker::mesh_loop(begin, end, cell_worker, copier, integrator, Contributions(),
                        MeshWorker::assemble_own_cells | MeshWorker::assemble_boundary_faces |
                          MeshWorker::assemble_own_interior_faces_once | MeshWorker::assemble_ghost_faces_once,
                        boundary_worker, face_worker);
}
} // namespace

double Sheet::energy(const Vector &u, const double load_factor) const
{
  double own = 0.;
  collectively(communicator(),
               [&]
               {
                 integrate(*this, u, load_factor, Order::value,
                           [&](const Contribution &contribution) { own += contribution.energy; });
               });
  return Utilities::MPI::sum(own, communicator());
}

void Sheet::residual(const Vector &u, Vector &r, Vector &magnitude, const double load_factor) const
{
  r = 0.;
  magnitude = 0.;
  const GuardedWork guarded(
    [&]
    {
      integrate(*this, u, load_factor, Order::first,
                [&](const Contribution &contribution)
                {
                  continuity_.distribute_local_to_global(contribution.residual, contribution.dofs, r);
                  continuity_.distribute_local_to_global(contribution.magnitude, contribution.dofs, magnitude);
                });
    });
  r.compress(VectorOperation::add);
  magnitude.compress(VectorOperation::add);
  guarded.agree(communicator());
}

void Sheet::tangent(const Vector &u, const AffineConstraints<double> &constraints, Matrix &K, const double load_factor,
                    const Vector *lift, Vector *stiffness_times_lift) const
{
  K = 0.;
  if (lift != nullptr)
    *stiffness_times_lift = 0.;
  const GuardedWork guarded(
    [&]
    {
      dealii::Vector<double> local_lift;
      dealii::Vector<double> product;
      integrate(*this, u, load_factor, Order::second,
                [&](const Contribution &contribution)
                {
                  constraints.distribute_local_to_global(contribution.tangent, contribution.dofs, K);
                  if (lift == nullptr)
                    return;
                  local_lift.reinit(contribution.dofs.size());
                  product.reinit(contribution.dofs.size());
                  for (unsigned int a = 0; a < local_lift.size(); ++a)
                    local_lift[a] = (*lift)(contribution.dofs[a]);
                  contribution.tangent.vmult(product, local_lift);
                  continuity_.distribute_local_to_global(product, contribution.dofs, *stiffness_times_lift);
                });
    });
  K.compress(VectorOperation::add);
  if (lift != nullptr)
    stiffness_times_lift->compress(VectorOperation::add);
  guarded.agree(communicator());
}

void Sheet::make_matrix(const AffineConstraints<double> &constraints, Matrix &matrix) const
{
  TrilinosWrappers::SparsityPattern pattern(owned_, owned_, constraints.get_local_lines(), communicator());
  const types::subdomain_id own = Utilities::MPI::this_mpi_process(communicator());
  if (has_gradient())
    DoFTools::make_flux_sparsity_pattern(dof_handler_, pattern, constraints, false, own);
  else
    DoFTools::make_sparsity_pattern(dof_handler_, pattern, constraints, false, own);
  pattern.compress();
  matrix.reinit(pattern);
}

DeterminantRange Sheet::determinant_range(const Vector &u) const
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  FEValues<2> values(mapping_, element_, QGauss<2>(degree_ + 1), update_gradients);
  std::vector<Tensor<2, 2>> gradients(values.n_quadrature_points);
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      values[FEValuesExtractors::Vector(0)].get_function_gradients(u, gradients);
      for (const Tensor<2, 2> &H : gradients)
      {
        const double J = (1. + H[0][0]) * (1. + H[1][1]) - H[0][1] * H[1][0];
        smallest = std::min(smallest, J);
        largest = std::max(largest, J);
      }
    }
  return {Utilities::MPI::min(smallest, communicator()), Utilities::MPI::max(largest, communicator())};
}
} // namespace continuum
