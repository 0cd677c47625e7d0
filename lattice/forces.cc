#include "lattice/forces.h"

#include <cmath>

namespace lattice
{
namespace
{

struct RowOfBonds
{
  std::size_t n;
  const double *x, *y, *vx, *vy;                 // near ends
  const double *far_x, *far_y, *far_vx, *far_vy; // far ends
  const double *breaking_stretch;
  double *fx, *fy;
  double rest_length, cross_section, damping;
  double retraction_stretch, initial_breaking_stretch;
};

struct RowSums
{
  double viscous_power;
  double events;
};

// One copy of the loop per instruction set, chosen at run time. Without contraction to fused multiply-add all copies
// round alike; the sanitizers cannot run before such a choice is made.
#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)
#define LATCON_PER_INSTRUCTION_SET
#else
#define LATCON_PER_INSTRUCTION_SET __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif

template <class Law>
LATCON_PER_INSTRUCTION_SET RowSums evaluate_bonds(const Law law, const RowOfBonds &row)
{
  // Locals, since a store through fx might otherwise change what `row` refers to.
  const std::size_t n = row.n;
  const double *const x = row.x, *const y = row.y, *const vx = row.vx, *const vy = row.vy;
  const double *const far_x = row.far_x, *const far_y = row.far_y;
  const double *const far_vx = row.far_vx, *const far_vy = row.far_vy;
  const double *const breaking_stretch = row.breaking_stretch;
  double *__restrict const fx = row.fx;
  double *__restrict const fy = row.fy;
  const double rest_length = row.rest_length, inverse_rest_length = 1. / row.rest_length;
  const double cross_section = row.cross_section, damping = row.damping;
  const double retraction_stretch = row.retraction_stretch, initial_breaking_stretch = row.initial_breaking_stretch;

  double power = 0.;
  double events = 0.; // a count; SSE2 has no 64-bit integer comparisons to vectorise with
#pragma omp simd reduction(+ : power, events)
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = far_x[i] - x[i];
    const double dy = far_y[i] - y[i];
    const double distance = std::sqrt(dx * dx + dy * dy);
    const double inverse = 1. / distance;
    const double nx = dx * inverse;
    const double ny = dy * inverse;
    const double rate = (far_vx[i] - vx[i]) * nx + (far_vy[i] - vy[i]) * ny;
    const double stretch = distance * inverse_rest_length;
    const double viscous = damping * rate;
    const double axial = cross_section * law.force(stretch, rest_length * inverse) + viscous;
    const double limit = breaking_stretch[i];
    // Selections, not products: an absent bond may have coinciding ends, and 0 * NaN is no zero.
    fx[i] = limit > 0. ? axial * nx : 0.;
    fy[i] = limit > 0. ? axial * ny : 0.;
    power += limit > 0. ? viscous * rate : 0.;
    // Nested selections instead of logical operators, which gcc would turn into branches.
    const double breaks = (limit > 0. ? stretch : 0.) > limit ? 1. : 0.;
    const double retracts =
      (limit == initial_breaking_stretch ? stretch : retraction_stretch) < retraction_stretch ? 1. : 0.;
    events += breaks + retracts;
  }
  return {power, events};
}

} // namespace

Forces::Forces(const TriangularLattice &lattice, const Material &material)
  : lattice_(lattice), fx_(lattice.n_places(), 0.), fy_(lattice.n_places(), 0.), row_viscous_power_(lattice.rows(), 0.),
    row_events_(lattice.rows(), 0)
{
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
  {
    const Shell *shell = material.shell(kind);
    const double rest_length = lattice.rest_length(kind);
    const double section = shell != nullptr ? cross_section(*shell, lattice) : 0.;
    const double viscosity = shell != nullptr ? shell->viscosity : 0.;
    kinds_[kind] = {shell, rest_length, section, section * viscosity / rest_length};
    bond_fx_[kind].assign(lattice.n_places(), 0.);
    bond_fy_[kind].assign(lattice.n_places(), 0.);
  }
}

void Forces::watch_retraction(const std::array<double, n_bond_kinds> &stretch, double initial_breaking_stretch)
{
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    kinds_[kind].retraction_stretch = stretch[kind];
  initial_breaking_stretch_ = initial_breaking_stretch;
}

void Forces::evaluate(const State &state, const Field &vx, const Field &vy)
{
  const auto n_rows = static_cast<std::ptrdiff_t>(lattice_.rows());
#pragma omp parallel if (lattice_.n_places() >= worth_threads)
  {
#pragma omp for schedule(static)
    for (std::ptrdiff_t row = 0; row < n_rows; ++row)
      bonds_of_row(static_cast<std::size_t>(row), state, vx, vy);
      // A site gathers from the places around it, so bonds that start beyond a periodic edge must be there.
#pragma omp single
    for (const TriangularLattice::Image &image : lattice_.images())
      for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      {
        bond_fx_[kind][image.place] = bond_fx_[kind][image.site];
        bond_fy_[kind][image.place] = bond_fy_[kind][image.site];
      }
#pragma omp for schedule(static)
    for (std::ptrdiff_t row = 0; row < n_rows; ++row)
      gather_row(static_cast<std::size_t>(row));
  }
  // Summed row after row, whatever thread did which.
  viscous_power_ = 0.;
  for (const double power : row_viscous_power_)
    viscous_power_ += power;
}

void Forces::bonds_of_row(std::size_t row, const State &state, const Field &vx, const Field &vy)
{
  row_viscous_power_[row] = 0.;
  row_events_[row] = 0;
  const std::size_t first = lattice_.index(row, 0);
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
  {
    const Kind &k = kinds_[kind];
    if (k.shell == nullptr)
      continue;
    const std::size_t far = first + static_cast<std::size_t>(lattice_.shift(kind, row));
    const RowOfBonds bonds{lattice_.columns(),
                           &state.x[first],
                           &state.y[first],
                           &vx[first],
                           &vy[first],
                           &state.x[far],
                           &state.y[far],
                           &vx[far],
                           &vy[far],
                           &state.breaking_stretch[kind][first],
                           &bond_fx_[kind][first],
                           &bond_fy_[kind][first],
                           k.rest_length,
                           k.cross_section,
                           k.damping,
                           k.retraction_stretch,
                           initial_breaking_stretch_};
    const RowSums sums = std::visit([&](const auto &law) { return evaluate_bonds(law, bonds); }, k.shell->law);
    row_viscous_power_[row] += sums.viscous_power;
    row_events_[row] += sums.events;
  }
}

void Forces::gather_row(std::size_t row)
{
  const std::size_t first = lattice_.index(row, 0);
  // Bonds from below start in a row of the other parity, except along the row and from two rows below.
  const auto below = [&](std::size_t kind) { return first - static_cast<std::size_t>(lattice_.shift(kind, row + 1)); };
  const std::array<const std::array<Field, n_bond_kinds> *, 2> components{{&bond_fx_, &bond_fy_}};
  const std::array<Field *, 2> totals{{&fx_, &fy_}};
  for (std::size_t component = 0; component < 2; ++component)
  {
    const std::array<Field, n_bond_kinds> &bond = *components[component];
    const double *right = &bond[0][first];
    const double *left = &bond[0][first - 1];
    const double *up_right = &bond[1][first];
    const double *up_left = &bond[2][first];
    const double *down_left = &bond[1][below(1)];
    const double *down_right = &bond[2][below(2)];
    const double *far_up_right = &bond[3][first];
    const double *far_up_left = &bond[4][first];
    const double *far_down_left = &bond[3][below(3)];
    const double *far_down_right = &bond[4][below(4)];
    const double *up = &bond[5][first];
    const double *down = &bond[5][first - static_cast<std::size_t>(lattice_.shift(5, row))];
    double *__restrict total = &(*totals[component])[first];
    // Pairs that a mirror exchanges are added first: exchanging the terms of a sum of two leaves its bits as they are.
#pragma omp simd
    for (std::size_t i = 0; i < lattice_.columns(); ++i)
      total[i] = ((right[i] - left[i]) + (up[i] - down[i])) +
                 (((up_right[i] - down_right[i]) + (up_left[i] - down_left[i])) +
                  ((far_up_right[i] - far_down_right[i]) + (far_up_left[i] - far_down_left[i])));
  }
}

void Forces::remove_bond(const State &state, const Field &vx, const Field &vy, std::size_t place, std::size_t kind)
{
  const std::size_t row = lattice_.row_of(place);
  const std::size_t far = place + static_cast<std::size_t>(lattice_.shift(kind, row));
  const Eigen::Vector2d bond(state.x[far] - state.x[place], state.y[far] - state.y[place]);
  const double rate = Eigen::Vector2d(vx[far] - vx[place], vy[far] - vy[place]).dot(bond.normalized());
  viscous_power_ -= kinds_[kind].damping * rate * rate;
  bond_fx_[kind][place] = 0.;
  bond_fy_[kind][place] = 0.;
  // Subtracting from the totals would leave round-off that depends on the order of breaking.
  gather_row(row);
  if (lattice_.row_of(far) != row)
    gather_row(lattice_.row_of(far));
}

} // namespace lattice
