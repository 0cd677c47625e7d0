/* Bond law for the cases of latcon, as a shared library: the Gent rod of bond_law.cc,
 *   psi = -(mu Jm / 2) ln s,   s = 1 - (lam^2 + 2/lam - 3) / Jm,
 * A. N. Gent, Rubber Chem. Technol. 69, 59 (1996). Without CMake:
 *   cc -O2 -shared -fPIC -I PREFIX/include/latcon gent_law.c -o gent_law.so -lm
 * In a case:
 *   set law = library
 *   set library = gent_law.so
 *   set parameters = mu = 80 kPa, Jm = 30 */
#include <math.h>

#include "lattice/bonds/bond_law_library.h"

int latcon_bond_law_version(void)
{
  return LATCON_BOND_LAW_VERSION;
}

const char *latcon_bond_law_parameters(void)
{
  return "mu Jm";
}

/* Remaining length of the chains: 1 at rest; NaN beyond the stretch at which they lock. */
static double slack(double lam, double Jm)
{
  const double s = 1. - (lam * lam + 2. / lam - 3.) / Jm;
  return s > 0. ? s : NAN;
}

double latcon_bond_law_force(double lam, const double *parameters)
{
  const double mu = parameters[0], Jm = parameters[1];
  return mu * (lam - 1. / (lam * lam)) / slack(lam, Jm);
}

void latcon_bond_law_derivatives(double lam, const double *parameters, double psi[5])
{
  const double mu = parameters[0], Jm = parameters[1], s = slack(lam, Jm), i = 1. / lam;
  /* r_k: k-th derivative of s, over s. */
  const double r1 = -2. * (lam - i * i) / (Jm * s), r2 = -2. * (1. + 2. * i * i * i) / (Jm * s);
  const double r3 = 12. * i * i * i * i / (Jm * s), r4 = -48. * i * i * i * i * i / (Jm * s);
  const double factor = -0.5 * mu * Jm;
  psi[0] = factor * log(s);
  psi[1] = factor * r1;
  psi[2] = factor * (r2 - r1 * r1);
  psi[3] = factor * (r3 - 3. * r1 * r2 + 2. * r1 * r1 * r1);
  psi[4] = factor * (r4 - 4. * r1 * r3 - 3. * r2 * r2 + 12. * r1 * r1 * r2 - 6. * r1 * r1 * r1 * r1);
}
