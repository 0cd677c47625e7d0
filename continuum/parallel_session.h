#pragma once

#include <optional>

#include "support/mpi_session.h"

namespace latcon::continuum
{
/// Initialises MPI, unless that was done before, and the libraries of the finite element code on construction and
/// finalises them on destruction: deal.II (one thread), p4est and Zoltan. To be created once, before other objects of
/// this library, and destroyed after them.
///
/// Replaces deal.II's MPI_InitFinalize, which also initialises PETSc and SLEPc. latcon does not use these two. They
/// would read options from the arguments of the program, from PETSC_OPTIONS, and from `.petscrc` and `petscrc` in the
/// home folder and the current folder; some of these options start other programs and write files.
class ParallelSession
{
public:
  /// @throws std::runtime_error as MpiSession does, or if Zoltan cannot be started
  ParallelSession();
  ~ParallelSession();

  ParallelSession(const ParallelSession &) = delete;
  ParallelSession &operator=(const ParallelSession &) = delete;

private:
  std::optional<support::MpiSession> mpi_;
};
} // namespace latcon::continuum
