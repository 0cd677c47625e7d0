#include "continuum/element_integrals.h"

#include "continuum/collective.h"
#include "continuum/element_kernels.h"
#include "continuum/errors.h"
#include "continuum/local_to_global.h"
#include "continuum/mesh_loop.h"
#include "continuum/shape_tables.h"
#include "continuum/vector_kernels.h"

#include <Epetra_MultiVector.h>

#include <algorithm>
#include <array>
#include <sstream>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
using Contributions = std::vector<Contribution>;
using Iterator = DoFHandler<2>::active_cell_iterator;
using MeshIterator = Triangulation<2>::cell_iterator;

// Read access to a ghosted vector, without a search for owned entries.
class NodalValues
{
public:
  NodalValues(const Sheet::Vector &u, const IndexSet &owned)
    : u_(u), begin_(owned.is_empty() ? 0 : owned.nth_index_in_set(0)), end_(begin_ + owned.n_elements()),
      own_(u.trilinos_vector()[0] + (begin_ < end_ ? u.trilinos_vector().Map().LID(static_cast<int>(begin_)) : 0))
  {
  }
  double operator()(const types::global_dof_index i) const
  {
    return i >= begin_ && i < end_ ? own_[i - begin_] : u_(i);
  }

private:
  const Sheet::Vector &u_;
  types::global_dof_index begin_;
  types::global_dof_index end_;
  const double *own_; // a ghosted vector is sorted, so the owned entries are contiguous
};

// Integrates over cells and faces, at one state u, densities of the energy or of other forces.
class Integrator
{
public:
  Integrator(const Sheet &sheet, const Sheet::Vector &u, const double load_factor, const Order order,
             const PointForces *forces = nullptr)
    : sheet_(sheet), fields_{NodalValues(u, sheet.owned())}, load_factor_(load_factor), order_(order), forces_(forces),
      tables_(sheet)
  {
    if (forces && forces->velocity)
      fields_.emplace_back(*forces->velocity, sheet.owned());
    for (unsigned int n = 0; n < sheet.element().n_dofs_per_cell() / 2; ++n)
      for (unsigned int i = 0; i < 2; ++i)
        system_index_[i].push_back(sheet.element().component_to_system_index(i, n));
  }

  // Whether densities depend on second derivatives, and faces have any.
  bool has_faces() const { return forces_ ? forces_->faces != nullptr : sheet_.has_gradient(); }

  void cell(const Iterator &cell, Contributions &contributions)
  {
    const ShapeTable &table = tables_.cell(MeshIterator(cell));
    begin(contributions);
    add_nodes(cell, 0);
    start(1);
    const Rows rows = {1, has_faces() ? n_derivatives : n_first};
    for (unsigned int q = 0; q < table.n_points; ++q)
    {
      const double *basis = table.row(q, 0);
      evaluate_sides(basis, rows);
      if (forces_)
        forces_->density({n_points_++, table.JxW[q], derivatives_[0], rates_[0]}, density_);
      else
        cell_density(sheet_.constitution(), sheet_.has_gradient(), derivatives_[0], order_, density_);
      add_point(basis, rows, table.JxW[q], contributions.back());
    }
    end(contributions.back());
  }

  void boundary(const Iterator &cell, const unsigned int face, Contributions &contributions)
  {
    for (const PrescribedNormalGradient &condition : sheet_.conditions().normal_gradients)
      if (condition.boundary == cell->face(face)->boundary_id())
      {
        constexpr unsigned int whole = numbers::invalid_unsigned_int;
        const std::array<const ShapeTable *, 2> tables = {&tables_.face(MeshIterator(cell), face, whole, 0), nullptr};
        const auto &points = tables_.face_values(MeshIterator(cell), face).get_quadrature_points();
        std::vector<Tensor<1, 2>> prescribed(points.size());
        for (std::size_t q = 0; q < points.size(); ++q)
          for (unsigned int i = 0; i < 2; ++i)
            prescribed[q][i] = (forces_ ? forces_->load_rate : load_factor_) * condition.gradient->value(points[q], i);
        begin(contributions);
        add_nodes(cell, 0);
        integrate_face(tables, 1, extent(cell, face), &prescribed, {condition.components[0], condition.components[1]},
                       contributions.back());
        return; // the first condition in the list applies, as for displacements
      }
  }

  void interior(const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
                const unsigned int neighbor_face, const unsigned int neighbor_subface, Contributions &contributions)
  {
    const std::array<const ShapeTable *, 2> tables = {
      &tables_.face(MeshIterator(cell), face, subface, 0),
      &tables_.face(MeshIterator(neighbor), neighbor_face, neighbor_subface, 1)};
    begin(contributions);
    add_nodes(cell, 0);
    add_nodes(neighbor, 1);
    const double smaller = std::min(extent(cell, face), extent(neighbor, neighbor_face));
    integrate_face(tables, 2, smaller, nullptr, {true, true}, contributions.back());
  }

private:
  // Returns the extent of a cell normal to a face [m].
  static double extent(const Iterator &cell, const unsigned int face)
  {
    return cell->measure() / cell->face(face)->measure();
  }

  void begin(Contributions &contributions)
  {
    contributions.emplace_back();
    nodes_.clear();
  }

  // Adds the nodes of the cell on one side; nodes shared with the other side are added once.
  void add_nodes(const Iterator &cell, const unsigned int side)
  {
    cell_dofs_.resize(sheet_.element().n_dofs_per_cell());
    cell->get_dof_indices(cell_dofs_);
    const std::size_t n_before = nodes_.size();
    node_of_[side].clear();
    for (unsigned int n = 0; n < system_index_[0].size(); ++n)
    {
      const types::global_dof_index dof = cell_dofs_[system_index_[0][n]];
      std::size_t node = 0;
      while (node < n_before && nodes_[node][0] != dof)
        ++node;
      if (node == n_before)
      {
        node = nodes_.size();
        nodes_.push_back({dof, cell_dofs_[system_index_[1][n]]});
      }
      node_of_[side].push_back(node);
    }
  }

  // Resizes the arrays to the nodes, with zeros in the padding.
  void start(const unsigned int n_sides)
  {
    const auto n = static_cast<unsigned int>(nodes_.size());
    stride_ = padded_size(n);
    nodal_.assign(2 * fields_.size() * stride_, 0.);
    for (std::size_t f = 0; f < fields_.size(); ++f)
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 2; ++i)
          nodal_[(2 * f + i) * stride_ + a] = fields_[f](nodes_[a][i]);
    if (order_ == Order::first)
    {
      first_.assign(2 * stride_, 0.);
      magnitude_.assign(2 * stride_, 0.);
    }
    if (order_ == Order::second)
    {
      work_.resize(2 * n_derivatives * stride_);
      for (unsigned int block = 0; block < n_blocks(); ++block)
        second_[block].assign(n * stride_, 0.);
    }
    basis_.assign(n_sides * n_derivatives * stride_, 0.);
  }

  void integrate_face(const std::array<const ShapeTable *, 2> &tables, const unsigned int n_sides, const double extent,
                      const std::vector<Tensor<1, 2>> *prescribed, const std::array<bool, 2> &held,
                      Contribution &contribution)
  {
    start(n_sides);
    const FacePenalty penalty{sheet_.penalty(extent), sheet_.supported_stiffness()};
    const Rows rows = {n_sides, n_derivatives};
    for (unsigned int q = 0; q < tables[0]->n_points; ++q)
    {
      for (unsigned int s = 0; s < n_sides; ++s)
        for (unsigned int c = 0; c < n_derivatives; ++c)
        {
          const double *from = tables[s]->row(q, c);
          double *to = &basis_[(s * n_derivatives + c) * stride_];
          for (std::size_t n = 0; n < node_of_[s].size(); ++n)
            to[node_of_[s][n]] = from[n];
        }
      evaluate_sides(basis_.data(), rows);
      const Tensor<1, 2> &N = tables[0]->normals[q];
      const Tensor<1, 2> given = prescribed ? (*prescribed)[q] : Tensor<1, 2>();
      if (forces_)
        forces_->faces->face_density(derivatives_, rates_, n_sides, N, given, held,
                                     sheet_.penalty(extent, forces_->faces->resistance_across(N)), order_,
                                     forces_->rate_by_displacement, density_);
      else
        face_density(*sheet_.constitution().gradient, derivatives_, n_sides, N, given, held, penalty, order_, density_);
      add_point(basis_.data(), rows, tables[0]->JxW[q], contribution);
    }
    end(contribution);
  }

  // Computes the derivatives of the fields from the basis, and clears the density.
  void evaluate_sides(const double *basis, const Rows &rows)
  {
    clear(density_, order_);
    evaluate_field(basis, rows, nodal_.data(), derivatives_);
    if (fields_.size() > 1)
      evaluate_field(basis, rows, &nodal_[2 * stride_], rates_);
  }

  void evaluate_field(const double *basis, const Rows &rows, const double *nodal,
                      std::array<FieldDerivatives, 2> &field) const
  {
    double derivatives[2][2][n_derivatives] = {};
    evaluate_derivatives(basis, stride_, rows, nodal, derivatives[0][0]);
    for (unsigned int s = 0; s < rows.n_sides; ++s)
      for (unsigned int i = 0; i < 2; ++i)
        std::copy(derivatives[i][s], derivatives[i][s] + n_derivatives, field[s][i].begin());
  }

  void add_point(const double *basis, const Rows &rows, const double JxW, Contribution &contribution)
  {
    contribution.energy += density_.value * JxW;
    if (order_ == Order::first)
      for (unsigned int i = 0; i < 2; ++i)
        add_first(basis, stride_, rows, density_.first[i][0], JxW, &first_[i * stride_], &magnitude_[i * stride_]);
    if (order_ == Order::second)
      for (unsigned int block = 0; block < n_blocks(); ++block)
      {
        const auto &[i, k] = components[block];
        add_second(basis, stride_, rows, density_.second[i][k][0][0][0], JxW, i == k && is_symmetric(), nodes_.size(),
                   work_.data(), second_[block].data());
      }
  }

  void end(Contribution &contribution)
  {
    const std::size_t n = nodes_.size();
    for (const auto &node : nodes_)
      contribution.dofs.insert(contribution.dofs.end(), node.begin(), node.end());
    if (order_ == Order::first)
    {
      contribution.residual.reinit(2 * n, true);
      contribution.magnitude.reinit(2 * n, true);
      for (std::size_t a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 2; ++i)
        {
          contribution.residual[2 * a + i] = first_[i * stride_ + a];
          contribution.magnitude[2 * a + i] = magnitude_[i * stride_ + a];
        }
    }
    if (order_ != Order::second)
      return;
    // The second derivative of an energy is symmetric: only one triangle of the blocks of equal components was summed,
    // and only one of the two mixed blocks.
    FullMatrix<double> &K = contribution.tangent;
    K.reinit(2 * n, 2 * n);
    for (unsigned int block = 0; block < n_blocks() && !is_symmetric(); ++block)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          K(2 * a + components[block].first, 2 * b + components[block].second) = second_[block][a * stride_ + b];
    if (!is_symmetric())
      return;
    for (std::size_t a = 0; a < n; ++a)
    {
      for (std::size_t b = a; b < n; ++b)
        for (unsigned int i = 0; i < 2; ++i)
          K(2 * a + i, 2 * b + i) = K(2 * b + i, 2 * a + i) = second_[i][a * stride_ + b];
      for (std::size_t b = 0; b < n; ++b)
        K(2 * a, 2 * b + 1) = K(2 * b + 1, 2 * a) = second_[2][a * stride_ + b];
    }
  }

  static constexpr std::pair<unsigned int, unsigned int> components[4] = {{0, 0}, {1, 1}, {0, 1}, {1, 0}}; // of second_
  bool is_symmetric() const { return !forces_ || forces_->is_symmetric; }
  unsigned int n_blocks() const { return is_symmetric() ? 3 : 4; }

  const Sheet &sheet_;
  std::vector<NodalValues> fields_; // u, and the velocity if there is one
  double load_factor_;
  Order order_;
  const PointForces *forces_; // nullptr: those of the energy
  std::size_t n_points_ = 0;  // visited
  ShapeTables tables_;
  std::array<std::vector<unsigned int>, 2> system_index_; // of the scalar shape functions, per component

  std::vector<std::array<types::global_dof_index, 2>> nodes_; // degrees of freedom of both components
  std::array<std::vector<unsigned int>, 2> node_of_;          // node of each shape function, per side
  std::vector<types::global_dof_index> cell_dofs_;
  unsigned int stride_ = 0;
  std::vector<double> basis_; // see element_kernels.h
  std::vector<double> nodal_; // [field][component][node]
  std::vector<double> first_; // [component][node], as magnitude_
  std::vector<double> magnitude_;
  std::array<std::vector<double>, 4> second_; // [node][node]
  std::vector<double> work_;
  std::array<FieldDerivatives, 2> derivatives_; // of u, per side
  std::array<FieldDerivatives, 2> rates_;       // of the velocity, per side
  PointIntegrand density_{};
};

// Passes the contributions of a cell and its faces to `add`, in the order of visits.
struct AddingVisitor
{
  Integrator &integrator;
  const std::function<void(const Contribution &)> &add;
  Contributions contributions;

  void cell(const Iterator &cell)
  {
    try
    {
      integrator.cell(cell, contributions);
    }
    catch (const NonPhysicalState &failure)
    {
      std::ostringstream place;
      place << ", in the cell about X = (" << cell->center()[0] << ", " << cell->center()[1] << ") m";
      throw NonPhysicalState(failure.what() + place.str());
    }
  }
  void boundary(const Iterator &cell, const unsigned int face) { integrator.boundary(cell, face, contributions); }
  void interior(const Iterator &cell, const unsigned int face, const unsigned int subface, const Iterator &neighbor,
                const unsigned int neighbor_face, const unsigned int neighbor_subface)
  {
    integrator.interior(cell, face, subface, neighbor, neighbor_face, neighbor_subface, contributions);
  }
  void cell_end()
  {
    for (const Contribution &contribution : contributions)
      add(contribution);
    contributions.clear();
  }
};

void integrate_with(Integrator &integrator, const Sheet &sheet, const std::function<void(const Contribution &)> &add)
{
  AddingVisitor visitor{integrator, add, {}};
  if (integrator.has_faces())
  {
    for_each_cell_and_face(sheet.dof_handler(), visitor);
    return;
  }
  for (const Iterator &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      visitor.cell(cell);
      visitor.cell_end();
    }
}
} // namespace

void integrate(const Sheet &sheet, const Sheet::Vector &u, const double load_factor, const Order order,
               const std::function<void(const Contribution &)> &add)
{
  Integrator integrator(sheet, u, load_factor, order);
  integrate_with(integrator, sheet, add);
}

void integrate(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, const Order order,
               const std::function<void(const Contribution &)> &add)
{
  Integrator integrator(sheet, u, 0., order, &forces);
  integrate_with(integrator, sheet, add);
}

void add_forces(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Sheet::Vector &nodal,
                Sheet::Vector *magnitude)
{
  VectorAssembly to_nodal(sheet.conformity_constraints(), nodal);
  VectorAssembly to_magnitude(sheet.conformity_constraints(), magnitude ? *magnitude : nodal);
  const DeferredException guarded(
    [&]
    {
      integrate(sheet, u, forces, Order::first,
                [&](const Contribution &part)
                {
                  to_nodal.add(part.residual, part.dofs);
                  if (magnitude)
                    to_magnitude.add(part.magnitude, part.dofs);
                });
    });
  nodal.compress(VectorOperation::add);
  if (magnitude)
    magnitude->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
}

void add_tangent(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces,
                 const AffineConstraints<double> &constraints, Sheet::Matrix &matrix)
{
  MatrixAssembly to_matrix(constraints, matrix);
  const DeferredException guarded(
    [&]
    {
      integrate(sheet, u, forces, Order::second,
                [&](const Contribution &part) { to_matrix.add(part.tangent, part.dofs); });
    });
  matrix.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
}

void for_each_point(const Sheet &sheet, const Sheet::Vector &u, const std::function<void(const CellPoint &)> &visit)
{
  PointForces none;
  none.density = [&](const CellPoint &point, PointIntegrand &) { visit(point); };
  run_collectively(sheet.communicator(), [&] { integrate(sheet, u, none, Order::value, [](const Contribution &) {}); });
}

void add_stresses(const Sheet &sheet, const Sheet::Vector &u, PointForces forces, std::vector<Tensor<2, 2>> &stresses)
{
  forces.density = [&, density = forces.density](const CellPoint &point, PointIntegrand &d)
  {
    density(point, d);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        stresses[point.number][i][J] += d.first[i][0][J];
  };
  run_collectively(sheet.communicator(),
                   [&] { integrate(sheet, u, forces, Order::first, [](const Contribution &) {}); });
}
} // namespace latcon::continuum
