#pragma once

#include "support/mpi_session.h"

namespace latcon::continuum
{
/// MPI with the libraries that finite elements need, from construction to destruction: deal.II (one thread), p4est and
/// Zoltan. To be made once, at the start of main, and destroyed after all objects of this library.
///
/// The counterpart of deal.II's MPI_InitFinalize without PETSc and SLEPc, which latcon does not use. Those read options
/// from the program's arguments, from PETSC_OPTIONS, and from `.petscrc` and `petscrc` in the home folder and the
/// current folder; among them are options that start other programs and write files.
class ParallelSession
{
public:
  /// @throws std::runtime_error as MpiSession does, or if Zoltan cannot be started
  ParallelSession();
  ~ParallelSession();

  ParallelSession(const ParallelSession &) = delete;
  ParallelSession &operator=(const ParallelSession &) = delete;

private:
  support::MpiSession mpi_;
};
} // namespace latcon::continuum
