#ifndef LATCON_BOND_LAW_LIBRARY_H
#define LATCON_BOND_LAW_LIBRARY_H

/* Functions of a shared library with a bond law, which a case names by `law = library`, `library = FILE`. C, so that
 * any language can provide them. lam is the stretch of a bond [-], > 0; psi its energy per reference volume [Pa], of
 * which a constant does not matter. `parameters` are the values of the case in the order of latcon_bond_law_parameters,
 * in SI units. Several threads call the functions at once. Where the law has no value they return NaN or infinity. */

/* Version of this interface. */
#define LATCON_BOND_LAW_VERSION 1

#ifdef __cplusplus
extern "C"
{
#endif

  /* Returns LATCON_BOND_LAW_VERSION. */
  int latcon_bond_law_version(void);

  /* Returns the names of the parameters, separated by blanks; empty for none. */
  const char *latcon_bond_law_parameters(void);

  /* Returns psi'(lam) [Pa], the axial force per reference cross-section. The lattice calls this for every bond. */
  double latcon_bond_law_force(double lam, const double *parameters);

  /* Writes psi(lam) and its first four derivatives [Pa]. The lattice uses psi and psi'', the continuum all of them. */
  void latcon_bond_law_derivatives(double lam, const double *parameters, double psi[5]);

#ifdef __cplusplus
}
#endif
#endif
