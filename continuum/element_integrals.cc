#include "continuum/element_integrals.h"

#include "continuum/collective.h"
#include "continuum/element_kernels.h"
#include "continuum/errors.h"
#include "continuum/lifted_shapes.h"
#include "continuum/shape_tables.h"
#include "continuum/single_precision_matrix.h"
#include "continuum/vector_kernels.h"
#include "support/text_wrap.h"

#include <deal.II/base/mpi.h>

#include <Epetra_MultiVector.h>

#include <array>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
using Iterator = DoFHandler<2>::active_cell_iterator;
using MeshIterator = Triangulation<2>::cell_iterator;
using Add = std::function<void(const Contribution &)>;

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

// Integrates densities over cells, at one state u.
class Integrator
{
public:
  Integrator(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, const Order order)
    : sheet_(sheet), fields_{NodalValues(u, sheet.owned())}, load_factors_{forces.load_factor}, order_(order),
      forces_(forces), tables_(sheet), lifted_(sheet.degree())
  {
    if (forces.velocity)
    {
      fields_.emplace_back(*forces.velocity, sheet.owned());
      load_factors_.push_back(0.);
    }
    for (unsigned int n = 0; n < sheet.element().n_dofs_per_cell() / 2; ++n)
      for (unsigned int i = 0; i < 2; ++i)
        system_index_[i].push_back(sheet.element().component_to_system_index(i, n));
  }

  void cell(const Iterator &cell, const Add &add)
  {
    const ShapeTable &table = tables_.cell(MeshIterator(cell));
    const std::vector<LiftedFace> faces = forces_.gradient ? lifted_faces(sheet_, cell) : std::vector<LiftedFace>();
    const bool has_gradient = forces_.gradient && faces.empty();
    begin();
    add_nodes(cell, 0);
    start();
    for (unsigned int q = 0; q < table.n_points; ++q)
    {
      const Basis basis = {table.row(q, 0), table.row(q, 0)};
      evaluate(basis, sheet_.has_gradient() ? n_derivatives : n_first);
      const CellPoint point = cell_point(cell, table, q, 1);
      forces_.local(point, density_);
      if (has_gradient)
        add_gradient_density(point);
      add_point(basis, has_gradient ? n_derivatives : n_first, table.JxW[q]);
    }
    end(add);
    for (const LiftedFace &face : faces)
      lifted_face(cell, table, face, faces.size(), add);
    n_points_ += table.n_points;
  }

private:
  using Basis = std::array<const double *, 2>; // of each component

  // Adds the share of a face in the energy of the gradient law, and half of its penalty, eq. (C.28).
  void lifted_face(const Iterator &cell, const ShapeTable &table, const LiftedFace &at, const std::size_t n_faces,
                   const Add &add)
  {
    const ShapeTable &face = tables_.face(MeshIterator(cell), at.face, at.subface, 0);
    const ShapeTable *beyond = nullptr;
    begin();
    add_nodes(cell, 0);
    node_of_[1].clear();
    if (at.condition == nullptr)
    {
      beyond = &tables_.face(MeshIterator(at.neighbor), at.neighbor_face, at.neighbor_subface, 1);
      add_nodes(at.neighbor, 1);
    }
    start();
    lifted_.reinit(table, face, beyond, at, n_faces, node_of_[1], stride_);

    // Prescribed normal gradients at the points of the face; a component without one is not lifted.
    std::array<bool, 2> held = {true, true};
    std::array<std::vector<double>, 2> prescribed;
    if (at.condition != nullptr)
      for (const Point<2> &X : tables_.face_values(MeshIterator(cell), at.face).get_quadrature_points())
        for (unsigned int i = 0; i < 2; ++i)
        {
          held[i] = at.condition->components[i];
          prescribed[i].push_back(held[i] ? at.condition->field->value(X, i) : 0.);
        }

    for (unsigned int q = 0; q < table.n_points; ++q)
    {
      const Basis basis = {held[0] ? lifted_.basis(q) : table.row(q, 0), held[1] ? lifted_.basis(q) : table.row(q, 0)};
      evaluate(basis, n_derivatives);
      for (unsigned int i = 0; i < 2 && at.condition != nullptr; ++i)
      {
        const ComponentDerivatives of_prescribed = lifted_.lift(q, prescribed[i]);
        for (std::size_t field = 0; field < fields_.size(); ++field)
          for (unsigned int c = n_first; c < n_derivatives; ++c)
            derivatives_[field][i][c] -= load_factors_[field] * of_prescribed[c];
      }
      const CellPoint point = cell_point(cell, table, q, n_faces);
      add_gradient_density(point);
      add_point(basis, n_derivatives, point.JxW);
    }

    const double sigma = sheet_.penalty(cell->measure() / cell->face(at.face)->measure());
    for (unsigned int f = 0; f < face.n_points && forces_.has_penalty; ++f)
    {
      const Basis basis = {lifted_.jump(f), lifted_.jump(f)};
      evaluate(basis, 1);
      for (unsigned int i = 0; i < 2; ++i)
        if (held[i])
        {
          const double z = derivatives_[0][i][0] - (at.condition != nullptr ? load_factors_[0] * prescribed[i][f] : 0.);
          density_.value += 0.5 * sigma * z * z;
          density_.first[i][0] = sigma * z;
          density_.second[i][i][0][0] = sigma;
        }
      add_point(basis, 1, (at.condition == nullptr ? 0.5 : 1.) * face.JxW[f]);
    }
    end(add);
  }

  CellPoint cell_point(const Iterator &cell, const ShapeTable &table, const unsigned int q, const double n_times) const
  {
    return {n_points_ + q,          n_points_ + q,   1. / n_times,       cell->vertex(0) + table.offsets[q],
            table.JxW[q] / n_times, derivatives_[0], derivatives_.back()};
  }

  void add_gradient_density(CellPoint point)
  {
    point.number = n_gradient_points_++;
    forces_.gradient(point, density_);
  }

  void begin()
  {
    contribution_.energy = 0.;
    contribution_.dofs.clear();
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
  void start()
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
      work_.resize(n_derivatives * stride_);
      for (unsigned int block = 0; block < n_blocks(); ++block)
        second_[block].assign(stride_ * stride_, 0.);
    }
  }

  // Computes the derivatives of the fields from the basis, and clears the density.
  void evaluate(const Basis &basis, const unsigned int n_rows)
  {
    clear(density_, order_);
    derivatives_.resize(fields_.size());
    for (std::size_t f = 0; f < fields_.size(); ++f)
      evaluate_derivatives(basis, stride_, n_rows, &nodal_[2 * f * stride_], derivatives_[f]);
  }

  void add_point(const Basis &basis, const unsigned int n_rows, const double weight)
  {
    contribution_.energy += density_.value * weight;
    if (order_ == Order::first)
      for (unsigned int i = 0; i < 2; ++i)
        add_first(basis[i], stride_, n_rows, density_.first[i], weight, &first_[i * stride_], &magnitude_[i * stride_]);
    if (order_ == Order::second)
      for (unsigned int block = 0; block < n_blocks(); ++block)
      {
        const auto &[i, k] = components[block];
        add_second(basis[i], basis[k], stride_, n_rows, density_.second[i][k][0], weight,
                   i == k && forces_.is_symmetric, work_.data(), second_[block].data());
      }
  }

  // Passes the sums to add(contribution).
  void end(const Add &add)
  {
    Contribution &contribution = contribution_;
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
    if (order_ == Order::second)
      fill_tangent(contribution.tangent);
    add(contribution);
  }

  // Where the derivative is symmetric, only one triangle of the blocks of equal components was summed,
  // and only one of the two mixed blocks.
  void fill_tangent(FullMatrix<double> &K) const
  {
    const std::size_t n = nodes_.size();
    K.TableBase<2, double>::reinit(TableIndices<2>(2 * n, 2 * n), true); // every entry is overwritten
    for (unsigned int block = 0; block < n_blocks() && !forces_.is_symmetric; ++block)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          K(2 * a + components[block].first, 2 * b + components[block].second) = second_[block][a * stride_ + b];
    if (!forces_.is_symmetric)
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
  unsigned int n_blocks() const { return forces_.is_symmetric ? 3 : 4; }

  const Sheet &sheet_;
  std::vector<NodalValues> fields_; // u, and the velocity if there is one
  std::vector<double> load_factors_; // of prescribed normal gradients, per field
  Order order_;
  const PointForces &forces_;
  std::size_t n_points_ = 0;  // in the cells before
  std::size_t n_gradient_points_ = 0; // evaluated
  ShapeTables tables_;
  LiftedShapes lifted_;
  std::array<std::vector<unsigned int>, 2> system_index_; // of the scalar shape functions, per component

  std::vector<std::array<types::global_dof_index, 2>> nodes_; // degrees of freedom of both components
  std::array<std::vector<unsigned int>, 2> node_of_;          // node of each shape function, per side
  std::vector<types::global_dof_index> cell_dofs_;
  unsigned int stride_ = 0;
  std::vector<double> nodal_; // [field][component][node]
  std::vector<double> first_; // [component][node], as magnitude_
  std::vector<double> magnitude_;
  std::array<std::vector<double>, 4> second_; // [node][node]
  std::vector<double> work_;
  std::vector<FieldDerivatives> derivatives_; // per field
  PointIntegrand density_{};
  Contribution contribution_;
};

} // namespace

PointForces energy_densities(const Sheet &sheet, const double load_factor, const Order order)
{
  PointForces forces;
  forces.local = [&sheet, order](const CellPoint &point, PointIntegrand &density)
  { add_energy(sheet.constitution().local->at(point.X), point.u, order, density); };
  if (sheet.has_gradient())
    forces.gradient = [&sheet, order](const CellPoint &point, PointIntegrand &density)
    { add_energy(*sheet.constitution().gradient, point.u, order, density); };
  forces.is_symmetric = true;
  forces.has_penalty = true;
  forces.load_factor = load_factor;
  return forces;
}

void integrate(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, const Order order, const Add &add)
{
  Integrator integrator(sheet, u, forces, order);
  for (const Iterator &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      try
      {
        integrator.cell(cell, add);
      }
      catch (const NonPhysicalState &failure)
      {
        const Point<2> X = cell->center();
        throw NonPhysicalState(support::text_of(failure.what(), ", in the cell about X = (", X[0], ", ", X[1], ") m"));
      }
}

double add_forces(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces, Sheet::Vector &nodal,
                  Sheet::Vector *magnitude)
{
  double own = 0.;
  const DeferredException guarded(
    [&]
    {
      integrate(sheet, u, forces, Order::first,
                [&](const Contribution &part)
                {
                  own += part.energy;
                  sheet.conformity_constraints().distribute_local_to_global(part.residual, part.dofs, nodal);
                  if (magnitude)
                    sheet.conformity_constraints().distribute_local_to_global(part.magnitude, part.dofs, *magnitude);
                });
    });
  nodal.compress(VectorOperation::add);
  if (magnitude)
    magnitude->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
  return dealii::Utilities::MPI::sum(own, sheet.communicator());
}

template <class AnyMatrix>
void add_tangent(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces,
                 const AffineConstraints<double> &constraints, AnyMatrix &matrix, const Sheet::Vector *lift,
                 Sheet::Vector *product)
{
  const DeferredException guarded(
    [&]
    {
      dealii::Vector<double> local_lift;
      dealii::Vector<double> local_product;
      integrate(sheet, u, forces, Order::second,
                [&](const Contribution &part)
                {
                  constraints.distribute_local_to_global(part.tangent, part.dofs, matrix);
                  if (lift == nullptr)
                    return;
                  local_lift.reinit(part.dofs.size());
                  local_product.reinit(part.dofs.size());
                  for (unsigned int a = 0; a < local_lift.size(); ++a)
                    local_lift[a] = (*lift)(part.dofs[a]);
                  part.tangent.vmult(local_product, local_lift);
                  sheet.conformity_constraints().distribute_local_to_global(local_product, part.dofs, *product);
                });
    });
  matrix.compress(VectorOperation::add);
  if (lift != nullptr)
    product->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
}

template void add_tangent(const Sheet &, const Sheet::Vector &, const PointForces &, const AffineConstraints<double> &,
                          Sheet::Matrix &, const Sheet::Vector *, Sheet::Vector *);
template void add_tangent(const Sheet &, const Sheet::Vector &, const PointForces &, const AffineConstraints<double> &,
                          SinglePrecisionMatrix &, const Sheet::Vector *, Sheet::Vector *);

double integral(const Sheet &sheet, const Sheet::Vector &u, const PointForces &forces)
{
  double own = 0.;
  run_collectively(
    sheet.communicator(),
    [&] { integrate(sheet, u, forces, Order::value, [&](const Contribution &part) { own += part.energy; }); });
  return dealii::Utilities::MPI::sum(own, sheet.communicator());
}

void add_stresses(const Sheet &sheet, const Sheet::Vector &u, PointForces forces, std::vector<Tensor<2, 2>> &stresses)
{
  for (PointForces::Density *density : {&forces.local, &forces.gradient})
    if (*density)
      *density = [&stresses, stress = *density](const CellPoint &point, PointIntegrand &d)
      {
        clear(d, Order::first);
        stress(point, d);
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int J = 0; J < 2; ++J)
            stresses[point.number_in_cell][i][J] += point.share * d.first[i][J];
      };
  run_collectively(sheet.communicator(),
                   [&] { integrate(sheet, u, forces, Order::first, [](const Contribution &) {}); });
}
} // namespace latcon::continuum
