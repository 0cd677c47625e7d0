#include "verification/claims/prestretch/prestretch_claim.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "continuum/static_solver.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"

namespace latcon::claims
{
namespace
{

using Mesh = dealii::parallel::distributed::Triangulation<2>;

void make_mesh(Mesh &mesh, const CutSheet &sheet, const bridge::EquivalentSheet &domain, const CutMesh &settings)
{
  if (!sheet.is_hole())
    return continuum::make_notched_rectangle(mesh,
                                             {domain.length(), domain.height(), domain.cut, settings.refinements});
  continuum::make_rectangle_with_hole(mesh, {domain.length(), domain.height(), domain.cut, settings.refinements});
  const dealii::Point<2> centre(0.5 * domain.length(), 0.);
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center().distance(centre) - domain.cut < 0.5 * cell->diameter())
      cell->set_refine_flag();
  mesh.execute_coarsening_and_refinement();
}

continuum::BoundaryConditions conditions(const CutSheet &sheet)
{
  const auto displacement = std::make_shared<bridge::AffineDisplacement>(sheet.F);
  const bool held[] = {sheet.held.left, sheet.held.right, sheet.held.bottom, sheet.held.top};
  std::vector<continuum::BoundaryField> list;
  for (dealii::types::boundary_id id = 0; id < 4; ++id)
    if (held[id])
      list.push_back({id, displacement});
  return continuum::BoundaryConditions(list);
}

// Point of the continuum at which fields are evaluated, in its own coordinates, and continued linearly to the site: the
// rim of a hole recedes from sites, and sites stand outside of free edges.
class Points
{
public:
  Points(const CutLattice &cut, const bridge::EquivalentSheet &domain) : origin_(domain.left, 0.), F_(cut.sheet.F)
  {
    // A little off the boundary, which a mesh has to the accuracy of its polynomials.
    const double inside = 1e-4 * domain.cut;
    const Eigen::Vector2d centre(0.5 * domain.length(), 0.);
    for (const CutLattice::Site &site : cut.sites)
    {
      const Eigen::Vector2d X = cut.lattice.reference(site.place) - origin_;
      Eigen::Vector2d Y(std::clamp(X.x(), inside, domain.length() - inside),
                        std::clamp(X.y(), domain.bottom + inside, domain.top - inside));
      const double distance = (Y - centre).norm();
      if (cut.sheet.is_hole() && distance < domain.cut + inside)
        Y = centre + (Y - centre) / distance * (domain.cut + inside);
      points.emplace_back(Y.x(), Y.y());
      offsets_.push_back(X - Y);
    }
  }

  // Displacement [m] at the sites, in the coordinates of the lattice.
  std::vector<Eigen::Vector2d> displacements(const std::vector<continuum::PointState> &states) const
  {
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    std::vector<Eigen::Vector2d> u;
    for (std::size_t i = 0; i < states.size(); ++i)
      u.emplace_back(Eigen::Vector2d(states[i].displacement[0], states[i].displacement[1]) + (F_ - I) * origin_ +
                     (bridge::to_lattice(states[i].F) - I) * offsets_[i]);
    return u;
  }

  std::vector<dealii::Point<2>> points;

private:
  Eigen::Vector2d origin_; // of the continuum's coordinates in those of the lattice
  Eigen::Matrix2d F_;
  std::vector<Eigen::Vector2d> offsets_;
};

double rms_difference(const std::vector<Eigen::Vector2d> &a, const std::vector<Eigen::Vector2d> &b)
{
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// Opening of the cut [m]: of a hole, the factors of n_x and n_y that fit u_x and u_y over the sites at its rim,
// n pointing from the centre to the site; of a notch, the mean of u_y over the sites next to the mouth, above less
// below.
Eigen::Vector2d opening(const CutLattice &cut, const std::vector<Eigen::Vector2d> &u)
{
  const bool hole = cut.sheet.is_hole();
  const double d = cut.lattice.spacing();
  const Eigen::Vector2d centre(0.5 * cut.lattice.length(), 0.);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), weight = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < cut.sites.size(); ++i)
  {
    const Eigen::Vector2d X = cut.lattice.reference(cut.sites[i].place);
    if (hole && !cut.sites[i].has_all_bonds)
    {
      const Eigen::Vector2d n = (X - centre).normalized();
      sum += n.cwiseProduct(u[i]);
      weight += n.cwiseProduct(n);
    }
    if (!hole && X.x() < 0.25 * cut.sheet.size && std::abs(X.y()) < 1.1 * d)
    {
      sum.y() += X.y() > 0. ? u[i].y() : -u[i].y();
      weight.y() += 0.5;
    }
  }
  return {weight.x() > 0. ? sum.x() / weight.x() : 0., sum.y() / weight.y()};
}

// Length of a - b over that of b.
double relative(const Eigen::Vector2d &a, const Eigen::Vector2d &b)
{
  return (a - b).norm() / b.norm();
}

// Scale of the displacements [m].
double displacement_scale(const CutSheet &sheet)
{
  return sheet.size * (sheet.F - Eigen::Matrix2d::Identity()).norm();
}

CutSolution solution(const CutLattice &cut, const bridge::EquivalentSheet &domain,
                     const continuum::StaticSolver &solver, const std::vector<continuum::PointState> &states,
                     const std::vector<Eigen::Vector2d> &of_continuum)
{
  CutSolution found{{}, of_continuum, {}, opening(cut, of_continuum)};
  CutErrors &e = found.errors;
  support::LargestError displacement_max;
  const double scale = displacement_scale(cut.sheet);
  std::vector<Eigen::Vector2d> of_lattice;
  double stress = 0., stress_norm = 0., cauchy = 0., cauchy_norm = 0., product = 0., inside = 0., n_inside = 0.;
  for (std::size_t i = 0; i < cut.sites.size(); ++i)
  {
    const std::size_t place = cut.sites[i].place;
    const Eigen::Vector2d X = cut.lattice.reference(place);
    const Eigen::Matrix2d F = bridge::to_lattice(states[i].F), P = bridge::to_lattice(states[i].P);
    found.P.push_back(P);
    of_lattice.emplace_back(cut.state.position.x[place] - X.x(), cut.state.position.y[place] - X.y());
    displacement_max.add((of_lattice.back() - of_continuum[i]).norm() / scale);
    if (!cut.sites[i].has_all_bonds)
      continue;
    inside += (of_lattice.back() - of_continuum[i]).squaredNorm();
    ++n_inside;
    const Eigen::Matrix2d sigma = P * F.transpose() / F.determinant();
    stress += (cut.fields[place].first_piola_stress - P).squaredNorm();
    product += cut.fields[place].first_piola_stress.cwiseProduct(P).sum();
    stress_norm += P.squaredNorm();
    cauchy += (cut.fields[place].cauchy_stress - sigma).squaredNorm();
    cauchy_norm += sigma.squaredNorm();
  }
  e.displacement_max = displacement_max.error();
  e.displacement = std::sqrt(inside / n_inside) / scale;
  e.displacement_all = rms_difference(of_lattice, of_continuum) / scale;
  e.stress = std::sqrt(stress / stress_norm);
  e.stress_scale = product / stress_norm - 1.;
  e.cauchy_stress = std::sqrt(cauchy / cauchy_norm);

  const bool left_is_held = cut.sheet.held.left;
  const double width_of_energy = domain.right - (left_is_held ? domain.left : cut.left_of_energy);
  const double width_of_force = domain.right - (left_is_held ? domain.left : cut.left_of_force);
  const double energy = cut.energy_change + cut.homogeneous_energy * width_of_energy * domain.height();
  e.energy = energy / solver.total_energy() - 1.;

  const Eigen::Vector2d on_lattice(cut.reaction_change.x() + cut.homogeneous_P(0, 0) * domain.height(),
                                   cut.reaction_change.y() + cut.homogeneous_P(1, 1) * width_of_force);
  const auto forces = solver.reactions();
  const Eigen::Vector2d on_continuum(forces.at(continuum::edge::right)[0], forces.at(continuum::edge::top)[1]);
  e.reaction = (on_lattice - on_continuum).dot(on_continuum) / on_continuum.squaredNorm();
  e.reaction_vector = relative(on_lattice, on_continuum);
  e.shape = relative(opening(cut, of_lattice), found.opening);
  e.unknowns = static_cast<double>(solver.sheet().dof_handler().n_dofs());
  return found;
}

} // namespace

std::string no_equilibrium(const std::function<void()> &compute)
{
  try
  {
    compute();
  }
  catch (const continuum::NoSolution &error)
  {
    return error.what();
  }
  return {};
}

CutErrors distance(const CutLattice &lattice, const CutSolution &a, const CutSolution &b)
{
  double u = 0., P = 0., norm = 0., n = 0.;
  for (std::size_t i = 0; i < lattice.sites.size(); ++i)
    if (lattice.sites[i].has_all_bonds)
    {
      u += (a.u[i] - b.u[i]).squaredNorm();
      P += (a.P[i] - b.P[i]).squaredNorm();
      norm += b.P[i].squaredNorm();
      ++n;
    }
  CutErrors found;
  found.displacement = std::sqrt(u / n) / displacement_scale(lattice.sheet);
  found.stress = std::sqrt(P / norm);
  for (double CutErrors::*part : {&CutErrors::stress_scale, &CutErrors::energy, &CutErrors::reaction})
    found.*part = std::abs(a.errors.*part - b.errors.*part);
  found.shape = relative(a.opening, b.opening);
  return found;
}

std::optional<CutSolution> compare(const CutLattice &cut, const bridge::EquivalentSheet &domain,
                                   const continuum::Constitution &law, const CutMesh &mesh_settings,
                                   std::string &failure)
{
  Mesh mesh(MPI_COMM_WORLD);
  make_mesh(mesh, cut.sheet, domain, mesh_settings);
  continuum::StaticSettings settings;
  settings.degree = mesh_settings.degree;
  settings.relative_tolerance = 1e-9;
  settings.smallest_load_step = 1. / 16.;
  const Points points(cut, domain);
  std::optional<CutSolution> found;
  failure = no_equilibrium(
    [&]
    {
      continuum::StaticSolver solver(mesh, law, conditions(cut.sheet), settings);
      solver.solve();
      std::vector<continuum::PointState> states = solver.sheet().evaluate(solver.displacement(), points.points);
      std::vector<Eigen::Vector2d> u = points.displacements(states), coarser = u;
      for (unsigned int cycle = 0; cycle < mesh_settings.cycles; ++cycle)
      {
        solver.refine(mesh, mesh_settings.fraction);
        solver.equilibrate();
        if (cycle + 2 < mesh_settings.cycles)
          continue;
        coarser = std::move(u);
        states = solver.sheet().evaluate(solver.displacement(), points.points);
        u = points.displacements(states);
      }
      found = solution(cut, domain, solver, states, u);
      found->errors.fem = rms_difference(u, coarser) / displacement_scale(cut.sheet);
    });
  return found;
}

} // namespace latcon::claims
