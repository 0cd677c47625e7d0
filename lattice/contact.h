#pragma once

#include <limits>
#include <vector>

#include <boost/container/flat_map.hpp>
#include <boost/container/flat_set.hpp>

#include "lattice/fracture.h"
#include "lattice/link_cells.h"
#include "lattice/site_forces.h"

namespace latcon::lattice
{

/// Repulsion of two sites at distance r: max(0, k o + c do/dt), o = distance - r > 0 being their overlap (theory.md,
/// eq. (L.12)). It never attracts. Two sites that fly at each other part with the coefficient of restitution of eq.
/// (L.13).
struct ContactLaw
{
  double distance;  ///< delta [m], > 0: sites touch below it
  double stiffness; ///< k per sheet thickness [Pa], > 0
  double viscosity; ///< c per sheet thickness [Pa s], >= 0
};

/// A contact at `distance` [m] whose spring is `stiffness` times that of a nearest-neighbour bond of the lattice at
/// rest, A0 psi''(1) / l, and whose dashpot is `viscosity` times the bond's A0 eta / l. Both times the square of the
/// area of a site over that of the lattice, so that flanks repel each other alike on grids of any spacing.
ContactLaw contact_like_nearest_bond(const TriangularLattice &lattice, const Material &material, double distance,
                                     double stiffness, double viscosity);

/// Contact between sites that have lost bonds: debris, crack faces.
///
/// Candidates are the sites that have lost at least one bond and were not cut out; held ones may be among them. Two of
/// them touch when they are close and no bond joins them. Each candidate has a Verlet list of the candidates that are
/// closer than distance + skin where both were listed. Sites of a grid finer than the lattice that never had a bond
/// with each other touch only if they are at least the distance apart in the reference configuration. A candidate that
/// has moved half the skin since is listed again, alone, with link cells. Pairs that touch are summed one after the
/// other, by increasing places.
///
/// Ranks that share a sheet all follow where all candidates were listed, which their owners tell the others. Each rank
/// lists the pairs that have a site in its rows and computes the forces on these. Positions and velocities between
/// listings go only to the ranks that have listed a pair with them.
class Contact : public SiteForces
{
public:
  /// @param band rows on whose sites to act @throws std::invalid_argument for a law out of its range or a periodic
  /// sheet
  Contact(const RowPartition &band, const ContactLaw &law);

  /// Finds the candidates among all sites; for a state that was cut or loaded from outside.
  void find_candidates(const State &state);

  /// Makes the ends of bonds that broke candidates, which may touch others from now on, and each other.
  void add_broken_bonds(const std::vector<BrokenBond> &broken);

  const std::vector<SiteForce> &evaluate(State &state, VectorField &velocity) override;

  const ContactLaw &law() const { return law_; } ///< as given

private:
  struct Candidate
  {
    bool is_listed = false; // since it last lost a bond
    // Its position then [m]; infinitely far: not listed yet.
    Eigen::Vector2d listed_at = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    // Candidates at larger places in its list, or in whose list it is; some have left since.
    boost::container::flat_set<std::size_t> above;
  };

  void update_lists(const State &state);
  void list(const State &state, std::size_t place, const Eigen::Vector2d &here);
  bool may_touch(const State &state, std::size_t first, std::size_t second) const;
  void exchange(std::size_t first, std::size_t second);

  RowPartition band_;
  const TriangularLattice &lattice_;
  ContactLaw law_;
  double skin_;
  LinkCells cells_;                                               // of candidates, by their places
  boost::container::flat_map<std::size_t, Candidate> candidates_; // by place
  SitesOfRanks sent_, received_;
};

} // namespace latcon::lattice
