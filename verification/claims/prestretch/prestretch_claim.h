#pragma once

#include <string>

#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Claim `prestretch`: a lattice sheet between held edges, relaxed from noise, and a finite element sheet of the same
/// size with the same edge displacements, agree in energy density, edge tractions and fields; exactly (to solver
/// tolerance) with the Cauchy-Born law, reported with the calibrated Mooney-Rivlin law. A loaded lattice that buckles
/// fails and is not compared. Collective over MPI_COMM_WORLD.
struct PrestretchOptions
{
  double length = 40.; ///< of the sheet, in spacings
  double height = 30.; ///< likewise
  double noise = 0.05; ///< initial displacement of the sites, in spacings
  unsigned int cells_x = 8, cells_y = 6, degree = 2;
};

/// Checks the claim. Where the lattice does not relax, or the finite elements with the Cauchy-Born law find no
/// equilibrium, a row fails; an equilibrium that the Mooney-Rivlin law lacks is reported.
output::Results prestretch_claim(const bridge::Subject &subject, const PrestretchOptions &options);

} // namespace latcon::claims
