#include <iostream>

#include "continuum/field_writer.h"
#include "continuum/static_solver.h"
#include "verification/affine_displacement.h"
#include "verification/commands/command.h"
#include "verification/subject.h"

namespace verification
{

ExitCode run_continuum(const Options &options)
{
  Case input;
  Parameters parameters;
  read_case(options, input, parameters);
  parameters.finish();

  const lattice::TriangularLattice sheet = input.lattice();
  if (options.dry_run)
  {
    const unsigned int unknowns = 2 * (input.degree * input.cells_x + 1) * (input.degree * input.cells_y + 1);
    if (!options.quiet)
      std::cout << parameters.resolved_text() << "# continuum: " << input.cells_x * input.cells_y << " cells, "
                << unknowns << " unknowns, " << sheet.length() << " m x " << sheet.height() << " m\n";
    return ExitCode::done;
  }

  const Subject material = subject(input);
  const continuum::MooneyRivlin mooney_rivlin(material.mooney_rivlin.law);
  const continuum::Material *law = &material.cauchy_born;
  if (input.law == ContinuumLaw::mooney_rivlin)
    law = &mooney_rivlin;

  Run run(options, parameters);
  // The size of the lattice after rounding to whole rows, so that both sides are the same sheet.
  dealii::parallel::distributed::Triangulation<2> mesh(MPI_COMM_WORLD);
  continuum::make_rectangle(mesh, {sheet.length(), sheet.height(), input.cells_x, input.cells_y});
  continuum::StaticSettings settings;
  settings.degree = input.degree;
  continuum::StaticSolver solver(mesh, *law, affine_boundary(input.deformation()), settings);
  continuum::FieldWriter fields(MPI_COMM_WORLD, run.directory());
  const auto write_frame = [&](double load_factor)
  { fields.add_frame(load_factor, solver.sheet(), solver.displacement()); };
  write_frame(0.);
  continuum::SolverReport history;
  {
    const auto phase = run.info().stopwatch().phase("solve");
    history = solver.solve(write_frame);
  }
  if (run.talks())
    std::cout << history.text();

  Results results;
  const auto add = [&results](const std::string &quantity, const std::string &unit, double value) {
    results.add({"continuum", quantity, unit, {}, value, {}, {}, {}});
  };
  add("elastic energy per thickness", "J/m", solver.total_energy());
  const auto reactions = solver.reactions();
  add("force on the right edge per thickness", "N/m", reactions.at(continuum::edge::right)[0]);
  add("force on the top edge per thickness", "N/m", reactions.at(continuum::edge::top)[1]);
  return run.finish(results);
}

} // namespace verification
