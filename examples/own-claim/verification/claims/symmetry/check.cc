#include <cmath>
#include <functional>

#include <Eigen/Geometry>

#include "support/largest_error.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{
namespace
{

// Each side sums about ten bonds in another order: a few hundred round-offs.
const output::Tolerance round_off{1e-10, "a few hundred round-offs of sums over about ten bonds"};

using Response = bridge::LatticeResponse; // energy density [J/m^3] and first Piola stress [Pa]
using ResponseOf = std::function<Response(const Eigen::Matrix2d &F)>;

// Deformed sheet whose responses are compared: without symmetry, and with energy for every law.
Eigen::Matrix2d deformation()
{
  Eigen::Matrix2d F;
  F << 1.3, 0.2, 0.1, 1.7;
  return F;
}

// Response of the sheet, and the largest relative changes of it by rotations.
struct Changes
{
  Response reference;
  support::LargestError energy = {}, stress = {};

  void add(const Response &rotated)
  {
    energy.add_relative(rotated.energy_density, reference.energy_density);
    stress.add((rotated.first_piola_stress - reference.first_piola_stress).norm() /
               reference.first_piola_stress.norm());
  }
};

// Objectivity: W(Q F) = W(F), P(Q F) = Q P(F) for every rotation Q.
Changes changes_by_rotations_of_deformed_sheet(const ResponseOf &response, unsigned int n_rotations)
{
  Changes changes{response(deformation())};
  for (unsigned int i = 1; i <= n_rotations; ++i)
  {
    const Eigen::Matrix2d Q = Eigen::Rotation2Dd(2. * M_PI * i / (n_rotations + 1.)).toRotationMatrix();
    Response rotated = response(Q * deformation());
    rotated.first_piola_stress = Q.transpose() * rotated.first_piola_stress;
    changes.add(rotated);
  }
  return changes;
}

// Symmetry of the lattice: W(F R) = W(F), P(F R) = P(F) R for rotations R by multiples of 60 degrees.
Changes changes_by_rotations_of_undeformed_sheet(const ResponseOf &response)
{
  Changes changes{response(deformation())};
  for (unsigned int i = 1; i < 6; ++i)
  {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(M_PI / 3. * i).toRotationMatrix();
    Response rotated = response(deformation() * R);
    rotated.first_piola_stress *= R.transpose();
    changes.add(rotated);
  }
  return changes;
}

} // namespace

ClaimOutcome check_symmetry(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  const lattice::TriangularLattice sheet = subject.sheet(12.);
  const ResponseOf lattice_response = [&](const Eigen::Matrix2d &F)
  { return bridge::homogeneous_response(sheet, subject.material, F); };
  const ResponseOf continuum_response = [&](const Eigen::Matrix2d &F)
  {
    const dealii::Tensor<2, 2> gradient = bridge::to_continuum(F);
    return Response{subject.cauchy_born.energy(gradient),
                    bridge::to_lattice(subject.cauchy_born.first_piola_stress(gradient))};
  };

  ClaimOutcome outcome;
  const Rows rows(outcome.results, "symmetry", subject.name + ": ");
  const auto add = [&](const std::string &rotation, const Changes &a, const Changes &b)
  {
    rows.add("energy density, " + rotation, "J/m^3", of_both(a.reference.energy_density, b.reference.energy_density),
             support::largest_of({a.energy.error(), b.energy.error()}), round_off);
    rows.add("first Piola stress, " + rotation, "Pa",
             of_both(a.reference.first_piola_stress.norm(), b.reference.first_piola_stress.norm()),
             support::largest_of({a.stress.error(), b.stress.error()}), round_off);
  };
  const unsigned int n_rotations = input.quick ? 5 : 50;
  add("rotated deformed sheet", changes_by_rotations_of_deformed_sheet(lattice_response, n_rotations),
      changes_by_rotations_of_deformed_sheet(continuum_response, n_rotations));
  add("rotated undeformed sheet", changes_by_rotations_of_undeformed_sheet(lattice_response),
      changes_by_rotations_of_undeformed_sheet(continuum_response));
  return outcome;
}

} // namespace latcon::claims
