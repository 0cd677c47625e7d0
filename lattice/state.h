#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "lattice/bond_states.h"
#include "lattice/material.h"
#include "lattice/row_partition.h"

namespace latcon::lattice
{

/// Sheets of fewer places are computed by one thread: starting the others would take longer than they save. Results are
/// the same bits either way.
inline constexpr std::size_t min_places_for_threads = 4096;

/// A breaking stretch that no bond reaches.
inline constexpr double unbreakable = std::numeric_limits<double>::infinity();

/// The axes x and y by their numbers.
inline constexpr std::array<std::size_t, 2> axes{{0, 1}};

/// A vector at each place of a lattice. Make one of zeros as VectorField(n): see ZeroPages.
struct VectorField
{
  VectorField() = default;
  explicit VectorField(std::size_t n) : x(n), y(n) {}

  Field x, y; ///< components

  Field &operator[](std::size_t axis) { return axis == 0 ? x : y; }
  const Field &operator[](std::size_t axis) const { return axis == 0 ? x : y; }
  Eigen::Vector2d at(std::size_t place) const { return {x[place], y[place]}; }
  void set(std::size_t place, const Eigen::Vector2d &vector) { x[place] = vector.x(), y[place] = vector.y(); }
  void add(std::size_t place, const Eigen::Vector2d &vector) { set(place, at(place) + vector); }
  /// Value at one place minus that at another.
  Eigen::Vector2d difference(std::size_t from, std::size_t to) const { return at(to) - at(from); }
};

/// One factor per bond, by the place where it starts; nothing is stored if all are 1.
struct BondFactors
{
  std::vector<Field> kinds; ///< by kind, empty where there are no such bonds; none: all factors are 1 [-]

  bool empty() const { return kinds.empty(); } ///< whether all factors are 1
  /// Factors of bonds of a kind from the one that starts at a place on; nullptr: all 1.
  const double *from(std::size_t place, std::size_t kind) const
  {
    return kinds.empty() || kinds[kind].empty() ? nullptr : &kinds[kind][place];
  }
  /// Factor of a bond [-].
  double of(std::size_t place, std::size_t kind) const
  {
    const double *const factor = from(place, kind);
    return factor != nullptr ? *factor : 1.;
  }
};

/// History of bonds with a memory, by the place where they start: their stretch and the variables of their memory at
/// the last update. Nothing is stored for kinds of bonds without a memory.
///
/// A rank holds values for the bonds that it computes: those that start in its own rows, and in the rows below
/// them that bonds reach from, which the rank that owns those rows updates alike.
struct BondHistory
{
  /// Bonds of one kind.
  struct Kind
  {
    Field stretch;                ///< [-]; 0 for absent bonds
    std::vector<Field> variables; ///< one field per variable of BondMemory; none: no memory
  };
  std::vector<Kind> kinds; ///< none: no bond has a memory

  bool remembers(std::size_t kind) const { return !kinds.empty() && !kinds[kind].variables.empty(); }

  /// Returns whether no bond remembers anything.
  bool empty() const
  {
    return std::all_of(kinds.begin(), kinds.end(), [](const Kind &kind) { return kind.variables.empty(); });
  }

  /// Variables of one bond, 0 beyond.
  std::array<double, max_history_variables> variables_of(std::size_t place, std::size_t kind) const
  {
    std::array<double, max_history_variables> variables{};
    for (std::size_t v = 0; v < kinds[kind].variables.size(); ++v)
      variables[v] = kinds[kind].variables[v][place];
    return variables;
  }
};

/// Everything that changes while a sheet moves and breaks, as a structure of arrays over the places of the lattice.
/// Positions and velocities are current ones.
///
/// On a rank that shares the sheet with others values are those of the rows it knows (see RowPartition), and of these
/// some of its own rows alone: velocities, accelerations, which bonds are toughened. Held and removed sites, lost bonds
/// and which bonds have broken are known everywhere.
struct State
{
  double time = 0.;                       ///< [s]
  VectorField position;                   ///< current position [m]
  VectorField velocity;                   ///< [m/s]
  VectorField acceleration;               ///< [m/s^2]; 0 at held sites and in the margin
  BondStates bonds;                       ///< by the place where they start
  BondHistory history;                    ///< of bonds with a memory; see relax_memory()
  BondFactors stiffness;                  ///< of volumes, hence of energies of bonds; from homogeneous_state()
  double breaking_stretch = unbreakable;  ///< [-], below which no bond breaks; set by Fracture::configure()
  double toughened_stretch = unbreakable; ///< that of toughened bonds [-]; set likewise
  BondFactors strength;                   ///< of both, bond by bond; set likewise
  Field inverse_mass;                     ///< h / m [m/kg]; 0 at held and removed sites and in the margin
  SiteFlags held;                         ///< 1 at sites whose motion is prescribed, 0 at removed ones
  SiteFlags rollers;                      ///< components prescribed at sites that are not held, 1: x, 2: y
  SiteFlags removed;                      ///< 1 at sites cut out as seed crack
  SiteFlags lost_bonds;                   ///< bonds a site has lost, to breaking or to removed neighbours
  Eigen::Matrix2d periods = Eigen::Matrix2d::Identity(); ///< F that takes reference periods to current ones [-]

  /// Returns whether no motion is prescribed for a site along an axis.
  bool is_free(std::size_t place, std::size_t axis) const
  {
    return held[place] == 0 && (rollers[place] >> axis & 1) == 0;
  }
};

/// Calls visit(name, field) for each field of a state that changes from step to step and is known in own rows and halo,
/// with the name that it has in files.
template <class Visitor>
void for_each_field(State &state, const TriangularLattice &lattice, const Visitor &visit)
{
  for (const auto &[prefix, field] :
       {std::pair("", &state.position), std::pair("v", &state.velocity), std::pair("a", &state.acceleration)})
    for (const std::size_t axis : axes)
      visit(std::string(prefix) + "xy"[axis], (*field)[axis]);
  for (std::size_t word = 0; word < state.bonds.storage().size(); ++word)
    visit(word == 0                 ? "bonds"
          : lattice.is_triangular() ? "bonds_of_third_shell"
                                    : "bonds_" + std::to_string(word),
          state.bonds.storage()[word]);
  for (std::size_t kind = 0; kind < state.history.kinds.size(); ++kind)
  {
    BondHistory::Kind &history = state.history.kinds[kind];
    const std::string name = "memory_" + std::to_string(kind) + "_";
    for (std::size_t v = 0; v < history.variables.size(); ++v)
      visit(name + std::to_string(v), history.variables[v]);
    if (!history.variables.empty())
      visit(name + "stretch", history.stretch);
  }
}

/// Gives the images of a periodic sheet the positions and velocities of their sites, those in known rows. To be called
/// after a change of either from outside; what moves a sheet calls it itself.
void update_images(State &state, const RowPartition &band);

/// Property of a bond that disorder multiplies; the stiffness also contains the weights of scattered points.
enum class BondProperty
{
  strength,
  stiffness
};

/// Factors of a property in the rows that `band` knows, for the kinds of bonds that the material has (theory.md, eq.
/// (L.37)). The factor of a bond depends on the seed, the property and the bond alone, which is named by its row, its
/// column and its kind: the same bits for any number of ranks and threads, and whatever other shells there are.
BondFactors bond_factors(const RowPartition &band, const Material &material, BondProperty property);

/// Held edges of the sheet, where the motion of sites that lack a neighbour beyond the edge is prescribed.
/// With all held, homogeneous states are in equilibrium (theory.md, eq. (L.6)).
struct Edges
{
  bool left, right, bottom, top;
  static const Edges held; ///< all of them: every free site has all its bonds
  static const Edges free; ///< none of them
};
inline constexpr Edges Edges::held{true, true, true, true};
inline constexpr Edges Edges::free{false, false, false, false};

/// Sites of which a bond, in either sense, would end beyond one of these edges: those that homogeneous_state() holds.
std::vector<std::size_t> sites_at(const TriangularLattice &lattice, const Material &material, const Edges &edges);

/// The unbroken sheet at the homogeneous deformation x = F X, at rest, in the rows that `band` knows. Edges across
/// which the sheet is periodic do not exist, whatever `edges` says of them. Bonds are unbreakable; a Fracture sets at
/// which stretch they break.
State homogeneous_state(const RowPartition &band, const Material &material, const Eigen::Matrix2d &F, Edges edges);

/// Moves every site in the rows that `band` knows, where it is free, by a random displacement, uniform in [-amplitude,
/// amplitude] along x and y. The displacement of a site depends on (seed, place) alone, so it is the same on every
/// machine and in any order.
/// @param amplitude [m], >= 0
void add_noise(State &state, const RowPartition &band, double amplitude, std::uint64_t seed);

/// Puts the memory of all bonds at rest at their present stretches, as after a long time; a Simulation does so with a
/// state that remembers nothing yet. Positions that change from here on without time passing strain all memories at
/// once. Positions and images in the halo must be up to date.
void relax_memory(State &state, const RowPartition &band, const Material &material);

/// Current stretch |x_j - x_i| / l of a bond [-].
double stretch(const State &state, const TriangularLattice &lattice, const Bond &bond);

/// Its rate [1/s] with these velocities [m/s].
double stretch_rate(const State &state, const TriangularLattice &lattice, const Bond &bond,
                    const VectorField &velocity);

/// Calls operation(row) for each of some rows, which are shared out among threads. For operations that couple no two
/// sites, whose bits then cannot depend on how.
template <class RowOperation>
void for_each_row(const TriangularLattice &lattice, Rows rows, const RowOperation &operation)
{
#pragma omp parallel for schedule(static) if ((rows.end - rows.begin) * lattice.stride() >= min_places_for_threads)
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    operation(row);
}

/// Calls visit(bond) for every bond present that starts in a row of `rows`, row by row.
template <class Visitor>
void for_each_bond(const State &state, const TriangularLattice &lattice, Rows rows, Visitor &&visit)
{
  const std::size_t n_kinds = state.bonds.n_kinds();
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice.index(row, column);
      for (std::size_t kind = 0; kind < n_kinds; ++kind)
        if (state.bonds.present(place, kind))
          visit(Bond{place, kind, place + lattice.shift(kind, row)});
    }
}

/// Visits the bonds of all rows.
template <class Visitor>
void for_each_bond(const State &state, const TriangularLattice &lattice, Visitor &&visit)
{
  for_each_bond(state, lattice, {0, lattice.rows()}, visit);
}

/// Calls visit(bond) for each of the bonds present at a site, which start there or end there or at an image of it.
template <class Visitor>
void for_each_bond_of_site(const State &state, const TriangularLattice &lattice, std::size_t place, Visitor &&visit)
{
  for (std::size_t kind = 0; kind < state.bonds.n_kinds(); ++kind)
    for (const Bond &bond : {lattice.bond(place, kind), lattice.bond_into(place, kind)})
      if (state.bonds.present(bond.near, kind))
        visit(bond);
}

} // namespace latcon::lattice
