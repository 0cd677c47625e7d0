#include "continuum/sheet.h"

#include "continuum/collective.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools_cache.h>

#include <cmath>
#include <limits>
#include <sstream>

using namespace dealii;

namespace continuum
{
namespace
{
unsigned int checked_degree(const unsigned int degree)
{
  if (degree == 0)
    throw InvalidInput("elements need a degree of at least 1");
  return degree;
}

// Values, gradients and weights at the quadrature points of one cell: the integrand is smooth but not polynomial, and
// degree + 1 points integrate the element's own stiffness exactly on a parallelogram at small strain.
class CellLoop
{
public:
  CellLoop(const Sheet &sheet, const Sheet::Vector &u)
    : quadrature_(sheet.degree() + 1),
      values_(sheet.mapping(), sheet.element(), quadrature_, update_gradients | update_JxW_values), sheet_(sheet),
      u_(u), F_(quadrature_.size()), components_(sheet.element().n_dofs_per_cell()),
      dofs_(sheet.element().n_dofs_per_cell())
  {
    for (unsigned int a = 0; a < components_.size(); ++a)
      components_[a] = sheet.element().system_to_component_index(a).first;
  }

  // Calls body(cell data) for each own cell.
  template <typename Body>
  void run(const Body &body)
  {
    const FEValuesExtractors::Vector displacement(0);
    for (const auto &cell : sheet_.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        values_.reinit(cell);
        values_[displacement].get_function_gradients(u_, F_);
        for (Tensor<2, 2> &F : F_)
          for (unsigned int i = 0; i < 2; ++i)
            F[i][i] += 1.;
        cell->get_dof_indices(dofs_);
        body(*this);
      }
  }

  unsigned int n_points() const { return F_.size(); }
  unsigned int n_dofs() const { return dofs_.size(); }
  const Tensor<2, 2> &F(const unsigned int q) const { return F_[q]; }
  double JxW(const unsigned int q) const { return values_.JxW(q); }
  unsigned int component(const unsigned int a) const { return components_[a]; }
  // Gradient of the one component that the shape function has.
  const Tensor<1, 2> &gradient(const unsigned int a, const unsigned int q) const { return values_.shape_grad(a, q); }
  const std::vector<types::global_dof_index> &dofs() const { return dofs_; }

private:
  QGauss<2> quadrature_;
  FEValues<2> values_;
  const Sheet &sheet_;
  const Sheet::Vector &u_;
  std::vector<Tensor<2, 2>> F_;
  std::vector<unsigned int> components_;
  std::vector<types::global_dof_index> dofs_;
};
} // namespace

Sheet::Sheet(const parallel::distributed::Triangulation<2> &mesh, const Material &law, const unsigned int degree)
  : mesh_(mesh), law_(law), degree_(checked_degree(degree)), element_(FE_Q<2>(degree), 2), mapping_(1),
    dof_handler_(mesh)
{
  if (mesh.n_levels() == 0)
    throw InvalidInput("a sheet needs a mesh with cells");
  dof_handler_.distribute_dofs(element_);
  owned_ = dof_handler_.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler_, relevant_);
  hanging_nodes_.reinit(relevant_);
  DoFTools::make_hanging_node_constraints(dof_handler_, hanging_nodes_);
  hanging_nodes_.close();
}

double Sheet::energy(const Vector &u) const
{
  double own = 0.;
  collectively(communicator(),
               [&]
               {
                 CellLoop(*this, u).run(
                   [&](const CellLoop &cell)
                   {
                     for (unsigned int q = 0; q < cell.n_points(); ++q)
                       own += law_.energy(cell.F(q)) * cell.JxW(q);
                   });
               });
  return Utilities::MPI::sum(own, communicator());
}

void Sheet::residual(const Vector &u, Vector &r, Vector &magnitude) const
{
  r = 0.;
  magnitude = 0.;
  const GuardedWork guarded(
    [&]
    {
      dealii::Vector<double> cell_r(element_.n_dofs_per_cell());
      dealii::Vector<double> cell_magnitude(element_.n_dofs_per_cell());
      CellLoop(*this, u).run(
        [&](const CellLoop &cell)
        {
          cell_r = 0.;
          cell_magnitude = 0.;
          for (unsigned int q = 0; q < cell.n_points(); ++q)
          {
            const Tensor<2, 2> P = law_.first_piola_stress(cell.F(q)) * cell.JxW(q);
            for (unsigned int a = 0; a < cell.n_dofs(); ++a)
            {
              const Tensor<1, 2> &gradient = cell.gradient(a, q);
              const Tensor<1, 2> &row = P[cell.component(a)];
              cell_r[a] += row * gradient;
              cell_magnitude[a] += std::abs(row[0] * gradient[0]) + std::abs(row[1] * gradient[1]);
            }
          }
          hanging_nodes_.distribute_local_to_global(cell_r, cell.dofs(), r);
          hanging_nodes_.distribute_local_to_global(cell_magnitude, cell.dofs(), magnitude);
        });
    });
  r.compress(VectorOperation::add);
  magnitude.compress(VectorOperation::add);
  guarded.agree(communicator());
}

void Sheet::tangent(const Vector &u, const AffineConstraints<double> &constraints, Matrix &K, const Vector &lift,
                    Vector &stiffness_times_lift) const
{
  K = 0.;
  stiffness_times_lift = 0.;
  const GuardedWork guarded(
    [&]
    {
      const unsigned int n = element_.n_dofs_per_cell();
      FullMatrix<double> cell_K(n, n);
      dealii::Vector<double> cell_lift(n);
      dealii::Vector<double> cell_product(n);
      CellLoop(*this, u).run(
        [&](const CellLoop &cell)
        {
          cell_K = 0.;
          for (unsigned int q = 0; q < cell.n_points(); ++q)
          {
            const Tensor<4, 2> T = law_.tangent(cell.F(q)) * cell.JxW(q);
            for (unsigned int b = 0; b < n; ++b)
            {
              const unsigned int k = cell.component(b);
              const Tensor<1, 2> &gradient = cell.gradient(b, q);
              Tensor<2, 2> dP;
              for (unsigned int i = 0; i < 2; ++i)
                for (unsigned int J = 0; J < 2; ++J)
                  dP[i][J] = T[i][J][k] * gradient;
              for (unsigned int a = 0; a < n; ++a)
                cell_K(a, b) += dP[cell.component(a)] * cell.gradient(a, q);
            }
          }
          constraints.distribute_local_to_global(cell_K, cell.dofs(), K);
          for (unsigned int a = 0; a < n; ++a)
            cell_lift[a] = lift(cell.dofs()[a]);
          cell_K.vmult(cell_product, cell_lift);
          hanging_nodes_.distribute_local_to_global(cell_product, cell.dofs(), stiffness_times_lift);
        });
    });
  K.compress(VectorOperation::add);
  stiffness_times_lift.compress(VectorOperation::add);
  guarded.agree(communicator());
}

std::vector<PointState> Sheet::evaluate(const Vector &u, const std::vector<Point<2>> &points) const
{
  // Each cell has one owner, so summing over the cells that hold a point and dividing by their number gives the same
  // answer for every partition.
  constexpr unsigned int n_sums = 7; // u (2), F (4), number of cells
  std::vector<double> sums(n_sums * points.size(), 0.);
  collectively(
    communicator(),
    [&]
    {
      const FEValuesExtractors::Vector displacement(0);
      std::vector<Tensor<1, 2>> values;
      std::vector<Tensor<2, 2>> gradients;
      for (const auto &[cell, located] : locate(points))
      {
        FEValues<2> there(mapping_, element_, Quadrature<2>(located.unit_points), update_values | update_gradients);
        there.reinit(typename DoFHandler<2>::active_cell_iterator(&mesh_, cell->level(), cell->index(), &dof_handler_));
        values.resize(located.indices.size());
        gradients.resize(located.indices.size());
        there[displacement].get_function_values(u, values);
        there[displacement].get_function_gradients(u, gradients);
        for (std::size_t n = 0; n < located.indices.size(); ++n)
        {
          double *sum = &sums[n_sums * located.indices[n]];
          for (unsigned int i = 0; i < 2; ++i)
          {
            sum[i] += values[n][i];
            for (unsigned int J = 0; J < 2; ++J)
              sum[2 + 2 * i + J] += gradients[n][i][J];
          }
          sum[n_sums - 1] += 1.;
        }
      }
    });
  Utilities::MPI::sum(sums, communicator(), sums);

  std::vector<PointState> states(points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const double *sum = &sums[n_sums * p];
    const double count = sum[n_sums - 1];
    if (count == 0.)
    {
      std::ostringstream message;
      message << "the point (" << points[p] << ") m is not in the sheet";
      throw InvalidInput(message.str()); // the sums are the same on every rank, so all throw
    }
    PointState &state = states[p];
    state.X = points[p];
    for (unsigned int i = 0; i < 2; ++i)
    {
      state.displacement[i] = sum[i] / count;
      for (unsigned int J = 0; J < 2; ++J)
        state.F[i][J] = (i == J ? 1. : 0.) + sum[2 + 2 * i + J] / count;
    }
    state.P = law_.first_piola_stress(state.F);
    state.energy_density = law_.energy(state.F);
  }
  return states;
}

std::map<Sheet::Cell, Sheet::PointsInCell> Sheet::locate(const std::vector<Point<2>> &points) const
{
  constexpr double slack = 1e-8; // of a cell, so that a point on a cell boundary is found from both sides
  std::map<Cell, PointsInCell> located;
  const GridTools::Cache<2> cache(mesh_, mapping_);
  const auto &tree = cache.get_locally_owned_cell_bounding_boxes_rtree();
  if (tree.empty())
    return located;
  const auto bounds = tree.bounds();
  const double margin = slack * boost::geometry::distance(bounds.min_corner(), bounds.max_corner());
  std::vector<std::pair<BoundingBox<2>, Cell>> candidates;
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const Point<2> shift(margin, margin);
    const BoundingBox<2> box({points[p] - Tensor<1, 2>(shift), points[p] + shift});
    candidates.clear();
    tree.query(boost::geometry::index::intersects(box), std::back_inserter(candidates));
    for (const auto &candidate : candidates)
      try
      {
        const Point<2> unit = mapping_.transform_real_to_unit_cell(candidate.second, points[p]);
        if (GeometryInfo<2>::distance_to_unit_cell(unit) > slack)
          continue;
        PointsInCell &there = located[candidate.second];
        there.indices.push_back(p);
        there.unit_points.push_back(unit);
      }
      catch (const Mapping<2>::ExcTransformationFailed &)
      {
        // The point is in the bounding box, yet far outside the distorted cell.
      }
  }
  return located;
}

DeterminantRange Sheet::determinant_range(const Vector &u) const
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  CellLoop(*this, u).run(
    [&](const CellLoop &cell)
    {
      for (unsigned int q = 0; q < cell.n_points(); ++q)
      {
        const double J = determinant(cell.F(q));
        smallest = std::min(smallest, J);
        largest = std::max(largest, J);
      }
    });
  return {Utilities::MPI::min(smallest, communicator()), Utilities::MPI::max(largest, communicator())};
}

Sheet::Vector Sheet::make_owned() const
{
  return Vector(owned_, communicator());
}

Sheet::Vector Sheet::make_ghosted() const
{
  return Vector(owned_, relevant_, communicator());
}
} // namespace continuum
