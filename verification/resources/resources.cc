#include "verification/resources/resources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include <omp.h>

#include "lattice/simulation.h"
#include "support/errors.h"
#include "support/machine_memory.h"
#include "support/ranks.h"
#include "support/task_thread.h"
#include "support/text_wrap.h"
#include "verification/bridge/small_strain.h"
#include "verification/output/near_tip_record.h"

namespace latcon::resources
{
namespace
{

// Bytes per slot in State, its snapshot, Forces and the integrator, and additional bytes of RungeKuttaChebyshev.
constexpr double bytes_of_place = 196., bytes_of_chebyshev_place = 48.;
// Bytes per slot in a copy of State, of which each pending frame has one.
constexpr double bytes_of_place_in_copy = 64.;
// Bytes per site and per bond while a frame is gathered and written, and per site in the image of a checkpoint.
constexpr double bytes_of_site_in_frame = 640., bytes_of_bond_in_frame = 50., bytes_of_site_in_checkpoint = 150.;
// Bytes per site in the window around the tip, in the sums over all samples and over samples not yet folded.
constexpr double bytes_of_site_near_tip = 2700.;
// Bytes per variable of the memory of bonds, and of their stretch, in the history, in its snapshot and in the image of
// a checkpoint.
constexpr double bytes_of_variable = 8.;
// Memory of the small versions of the claims, for any case.
constexpr double bytes_of_claims = 7e7;

// Measured on one core of 3 to 4 GHz.
constexpr double nanoseconds_per_site_evaluation = 15., nanoseconds_per_bond_evaluation = 5.;
constexpr double seconds_of_site_in_frame = 9e-6;
// Force evaluations of FIRE from noise to round-off, and per column, because long waves have to cross the sheet.
constexpr double evaluations_relaxed = 7000., evaluations_relaxed_per_column = 30.;
// Cost of contact, tip search, near-tip samples and energies, relative to the kernel.
constexpr double beside_kernel = 1.2;

// With more steps, a step does not change a time in double precision.
constexpr double max_steps = 1e15;

// Current and additional memory of the ranks on this machine.
std::array<double, 2> on_machine(const MemoryNeed &need)
{
  std::array<double, 2> sums{support::resident_memory(),
                             need.shared / support::n_ranks() + (support::is_root_rank() ? need.first_rank : 0.)};
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, machine);
  MPI_Comm_free(&machine);
  return sums;
}

// Bonds per site.
double bonds_of_site(const input::Case &input)
{
  return 0.5 * input.material().coordination(input.sheet());
}

} // namespace

double bytes_of_history(const lattice::Material &material, const lattice::TriangularLattice &sheet)
{
  double values = 0.;
  for (std::size_t kind = 0; kind < sheet.n_kinds(); ++kind)
    if (const lattice::Shell *const shell = material.shell(sheet, kind))
      if (const std::size_t variables = lattice::properties(shell->memory).n_variables; variables > 0)
        values += static_cast<double>(variables) + 1.;
  return bytes_of_variable * values;
}

MemoryNeed lattice_memory(const input::Case &input, const RunKind run, const bool claims)
{
  const lattice::TriangularLattice sheet = input.sheet();
  const double places = static_cast<double>(sheet.n_places()), sites = static_cast<double>(sheet.n_sites());
  const bool is_chebyshev =
    run != RunKind::equilibrium && input.integrator == input::Case::Integrator::runge_kutta_chebyshev;
  const double bonds = bonds_of_site(input);
  const double frame = sites * (bytes_of_site_in_frame + bonds * bytes_of_bond_in_frame);
  const double history = run != RunKind::equilibrium ? bytes_of_history(input.material(), sheet) : 0.;
  const double checkpoint = run != RunKind::equilibrium ? sites * (bytes_of_site_in_checkpoint + history) : 0.;
  const lattice::Disorder disorder = input.disorder.disorder();
  const bool strengths = run == RunKind::fracture && !disorder.strength.is_none();
  const double factors = bytes_of_variable * bonds * ((disorder.stiffness.is_none() ? 0. : 1.) + (strengths ? 1. : 0.));
  const double fields =
    places * (bytes_of_place + (is_chebyshev ? bytes_of_chebyshev_place : 0.) + 2. * history + factors);
  // The state is copied for each pending frame, and for the one that waits for them.
  const double copies = run != RunKind::equilibrium ? static_cast<double>(support::TaskThread::max_pending + 1) * places *
                                                        (bytes_of_place_in_copy + history + factors)
                                                    : 0.;
  MemoryNeed need;
  // Equilibrium is computed on the root rank only.
  (run == RunKind::equilibrium ? need.first_rank : need.shared) = fields;
  need.first_rank += std::max(frame + copies, checkpoint);
  if (run == RunKind::fracture && output::near_tip_interval(input) > 0.)
    need.first_rank += output::near_tip_window(input) / sheet.site_area() * bytes_of_site_near_tip;
  if (claims && need.shared + need.first_rank < bytes_of_claims)
    need.shared = bytes_of_claims - need.first_rank;
  return need;
}

void require_memory(const MemoryNeed &need)
{
  const double needed = on_machine(need)[1];
  const double available = support::available_memory();
  // All ranks report the same numbers, those of the machine with the largest deficit.
  const int rank = static_cast<int>(support::rank());
  struct
  {
    double missing;
    int rank;
  } worst{needed - available, rank};
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, MPI_COMM_WORLD);
  std::array<double, 2> numbers{needed, available};
  MPI_Bcast(numbers.data(), 2, MPI_DOUBLE, worst.rank, MPI_COMM_WORLD);
  if (!(worst.missing > 0.))
    return;
  std::ostringstream text;
  text.precision(0);
  text << std::fixed << "not enough memory: the run would take about " << numbers[0] << " bytes ("
       << support::readable_bytes(numbers[0]) << ") in addition to the current memory of latcon, and this machine has "
       << numbers[1] << " bytes (" << support::readable_bytes(numbers[1])
       << ") available; use a smaller or coarser sheet, or more machines; use --yes to run it anyway";
  throw support::InputError(text.str());
}

std::string memory_text(const MemoryNeed &need)
{
  const auto [held, needed] = on_machine(need);
  std::ostringstream text;
  text.precision(0);
  text << std::fixed << "# memory: about " << held + needed << " bytes (" << support::readable_bytes(held + needed)
       << ") at the peak, of which the program itself takes " << held
       << " bytes; available: " << support::available_memory() << " bytes\n";
  return text.str();
}

double lattice_seconds(const input::Case &input, const lattice::TimeStepping &stepping, const RunKind run,
                       const double steps, const double frames)
{
  const lattice::TriangularLattice sheet = input.sheet();
  const double written = seconds_of_start + frames * static_cast<double>(sheet.n_sites()) * seconds_of_site_in_frame;
  if (run == RunKind::equilibrium)
    return written + core_seconds(input, std::max(evaluations_relaxed,
                                                  evaluations_relaxed_per_column *
                                                    static_cast<double>(std::max(sheet.columns(), sheet.rows())))) /
                       omp_get_max_threads();
  return written + (run == RunKind::fracture ? beside_kernel : 1.) *
                     core_seconds(input, steps * stepping.evaluations()) / (support::n_ranks() * omp_get_max_threads());
}

double expected_steps(const input::Case &input, const lattice::TimeStepping &stepping)
{
  const double way = (input.stop_position - input.seed_position) * input.sheet().length();
  const double passage = way / bridge::small_strain(input.lattice(), input.material()).shear_speed;
  return std::ceil(std::min(input.end_time, passage) / stepping.step);
}

double parts_of_first_step(const input::Case &input, const lattice::TimeStepping &stepping, const RunKind run)
{
  const lattice::TriangularLattice sheet = input.sheet();
  const lattice::Material material = input.material();
  const Eigen::Matrix2d F = input.deformation();
  std::optional<lattice::ContactLaw> contact;
  if (run == RunKind::fracture && input.has_contact)
    contact = input.contact_law();
  double parts = 1.;
  for (std::size_t kind = 0; kind < sheet.n_kinds(); ++kind)
  {
    const lattice::Shell *const shell = material.shell(sheet, kind);
    const double stretch = (F * sheet.bond_vector(kind)).norm() / sheet.rest_length(kind);
    if (shell == nullptr || std::holds_alternative<lattice::LinearBond>(shell->law) ||
        stretch >= lattice::short_stretch)
      continue;
    const double longest =
      lattice::recoil_step(stepping, sheet, material, kind, std::max(stretch, lattice::Simulation::shortest), contact);
    parts = std::max(parts, std::exp2(std::ceil(std::log2(stepping.step / longest))));
  }
  return std::min(parts, static_cast<double>(lattice::Simulation::most_parts));
}

double core_seconds(const input::Case &input, const double evaluations)
{
  const lattice::TriangularLattice sheet = input.sheet();
  return static_cast<double>(sheet.n_sites()) * evaluations * 1e-9 *
         (sheet.is_triangular() ? nanoseconds_per_site_evaluation
                                : nanoseconds_per_bond_evaluation * bonds_of_site(input));
}

void check_steps(const input::Case &input, const double step, input::Parameters &parameters)
{
  if (input.end_time / step <= max_steps)
    return;
  parameters.error("Time/end", support::text_of("the run would take ", input.end_time / step, " time steps of ", step,
                                                " s, more than the limit of ", max_steps));
}

} // namespace latcon::resources
