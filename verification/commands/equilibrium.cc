#include "verification/commands/finite_elements.h"

#include <algorithm>
#include <iostream>

#include "continuum/field_writer.h"
#include "continuum/static_solver.h"
#include "verification/output/continuum_record.h"

namespace latcon::commands
{
namespace
{

continuum::StaticSettings static_settings(const input::Case &input)
{
  continuum::StaticSettings settings;
  settings.degree = input.continuum.degree;
  settings.relative_tolerance = input.continuum.relative_tolerance;
  settings.first_load_step = input.continuum.first_load_step;
  settings.smallest_load_step = std::min(settings.smallest_load_step, settings.first_load_step);
  settings.linear.direct_limit = input.continuum.direct_limit;
  return settings;
}

// Prints Newton iterations with their linear iterations, and records times.
void note(Run &run, const continuum::SolverReport &report)
{
  output::Stopwatch &stopwatch = run.info().stopwatch();
  stopwatch.add("assembly", report.times.assembly);
  stopwatch.add("preconditioner", report.times.preconditioner);
  stopwatch.add("linear solve", report.times.linear_solve);
  if (run.is_verbose())
    std::cout << report.text();
}

} // namespace

output::Results equilibrium(const input::Case &input, bridge::ContinuumModel &model, Run &run)
{
  output::ContinuumRecord record;
  continuum::FieldWriter fields(MPI_COMM_WORLD, run.directory());
  auto set_up = run.info().stopwatch().phase("set-up");
  continuum::StaticSolver solver(model.mesh(), model.constitution(), model.conditions(), static_settings(input));
  set_up.reset();
  const auto write_frame = [&](double load_factor)
  {
    const auto phase = run.info().stopwatch().phase("output");
    fields.add_frame(load_factor, solver.sheet(), solver.displacement());
  };
  write_frame(0.);
  const auto write_tables = [&]
  {
    if (run.is_root())
      record.write(run.directory());
  };
  const std::size_t n_cycles = input.continuum.adaptive_cycles;
  const auto find_equilibrium = [&](const std::string &phase_name, auto &&find)
  {
    const auto phase = run.info().stopwatch().phase(phase_name);
    try
    {
      const continuum::SolverReport report = find();
      record.newton(report);
      write_tables(); // what follows may refuse the state
      note(run, report);
    }
    catch (const continuum::SolverFailed &failure)
    {
      // Keeps the results so far.
      record.newton(failure.report());
      write_tables();
      throw;
    }
  };
  find_equilibrium("solve",
                   [&]
                   {
                     return solver.solve(
                       [&](double load_factor)
                       {
                         record.equilibrium(solver);
                         // The frame at full load is that of the last mesh.
                         if (load_factor < 1.)
                           write_frame(load_factor);
                         write_tables();
                       });
                   });
  record.mesh(solver);
  for (std::size_t cycle = 1; cycle <= n_cycles; ++cycle)
  {
    solver.refine(model.mesh(), input.continuum.refined_fraction);
    find_equilibrium("adaptive cycles", [&] { return solver.equilibrate(); });
    record.equilibrium(solver);
    record.mesh(solver);
    write_tables();
    if (run.is_verbose())
      std::cout << "cycle " << cycle << ": " << solver.sheet().mesh().n_global_active_cells() << " cells, "
                << solver.sheet().dof_handler().n_dofs() << " unknowns, largest reaction " << record.largest_reaction()
                << " N/m, changed by " << record.reaction_change() << "\n";
  }
  write_frame(1.);

  output::Results results;
  const claims::Rows rows(results, "continuum", "");
  const auto add = [&rows](const std::string &quantity, const std::string &unit, double value)
  { rows.add(quantity, unit, claims::of_continuum(value)); };
  add("unknowns", "1", solver.sheet().dof_handler().n_dofs());
  add("elastic energy per thickness", "J/m", solver.total_energy());
  for (const auto &[id, force] : solver.reactions())
    for (const unsigned int i : {0u, 1u})
      add("force on the " + output::edge_name(id) + " edge per thickness, " + (i == 0 ? "x" : "y"), "N/m", force[i]);
  const continuum::DeterminantRange range = solver.sheet().determinant_range(solver.displacement());
  add("smallest area ratio", "1", range.smallest);
  add("largest area ratio", "1", range.largest);
  if (n_cycles > 0)
    rows.add("largest reaction, relative change in the last adaptive cycle", "N/m",
             claims::of_continuum(record.largest_reaction()), record.reaction_change(),
             input.continuum.reaction_tolerance);
  if (run.is_root())
    record.write(run.directory());
  return results;
}

continuum::Sheet::Vector equilibrium_displacement(const input::Case &input, const bridge::ContinuumModel &model,
                                                  const continuum::Sheet &sheet, Run &run)
{
  const auto phase = run.info().stopwatch().phase("equilibrium");
  continuum::StaticSolver solver(sheet.mesh(), model.constitution(), model.conditions(), static_settings(input));
  note(run, solver.solve());
  continuum::Sheet::Vector u = sheet.make_owned();
  u = solver.displacement();
  return u;
}

} // namespace latcon::commands
