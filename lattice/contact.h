#pragma once

#include <cstdint>
#include <vector>

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

/// A contact at `distance` [m] whose spring is `stiffness` times that of a nearest-neighbour bond at rest,
/// A0 psi''(1) / l, and whose dashpot is `viscosity` times the bond's A0 eta / l.
ContactLaw contact_like_nearest_bond(const TriangularLattice &lattice, const Material &material, double distance,
                                     double stiffness, double viscosity);

/// Contact between sites that have lost bonds: debris, crack faces.
///
/// Candidates are the sites that have lost at least one bond and were not cut out; held ones may be among them. Two of
/// them touch when they are close and no bond joins them. Pairs come from a Verlet list: all that were closer than
/// distance + skin when it was made, which holds until a candidate has moved half the skin. The list is made anew then,
/// with link cells; a site that becomes a candidate is added to it. Pairs are kept sorted by place and summed one after
/// the other.
///
/// Ranks that share a sheet all follow all candidates, whose positions and velocities they tell each other before each
/// evaluation: candidates stand along a line, so they are few. Each rank keeps the pairs that have a site in its rows
/// and computes the forces on these.
class Contact : public SiteForces
{
public:
  /// @param band rows on whose sites to act @throws std::invalid_argument for a law out of its range or a periodic
  /// sheet
  Contact(const RowPartition &band, const ContactLaw &law);

  /// Finds the candidates among all sites; for a state that was cut or loaded from outside.
  void find_candidates(const State &state);

  /// Takes note of bonds that broke: their ends may touch others from now on, and each other.
  /// @param state with the positions of these ends, wherever they are
  void add_broken_bonds(const State &state, const std::vector<BrokenBond> &broken);

  const std::vector<SiteForce> &evaluate(const State &state, const Field &vx, const Field &vy) override;

  /// The candidates.
  const std::vector<std::size_t> &required_sites() const override { return places_; }

  /// Energy stored in the springs of the pairs whose first site is in the band, per sheet thickness [J/m].
  double elastic_energy(const State &state) const;

  std::size_t n_candidates() const { return places_.size(); }
  /// Pairs that overlapped at the last evaluation, those whose first site is in the band.
  std::size_t n_touching() const { return n_touching_; }
  /// Number of rebuilds of the list because candidates had moved.
  std::size_t n_list_builds() const { return n_list_builds_; }

private:
  struct Pair
  {
    std::size_t first, second; // places, first < second
    bool operator<(const Pair &other) const
    {
      return first != other.first ? first < other.first : second < other.second;
    }
  };

  bool has_moved(const State &state) const;
  void rebuild(const State &state);
  void add_candidate(const State &state, std::size_t place);
  bool may_touch(const State &state, std::size_t first, std::size_t second) const;
  void insert_pair(std::size_t a, std::size_t b);

  RowPartition band_;
  const TriangularLattice &lattice_;
  ContactLaw law_;
  double skin_;
  LinkCells cells_;                    // of candidates, by their index
  std::vector<std::size_t> places_;    // of candidates
  std::vector<Eigen::Vector2d> found_; // where each was when its pairs were found; empty: no list was made of them yet
  SiteFlags is_candidate_;             // by place
  std::vector<Pair> pairs_;
  std::vector<std::vector<Pair>> pairs_of_threads_;       // scratch
  std::vector<std::vector<SiteForce>> forces_of_threads_; // scratch
  std::size_t n_touching_ = 0;
  std::size_t n_list_builds_ = 0;
};

} // namespace latcon::lattice
