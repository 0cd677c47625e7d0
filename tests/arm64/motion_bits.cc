// Prints a hash of the bits of cracks in motion, for comparison between processors.
#include <cstdio>
#include <cstring>

#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

using namespace latcon;

namespace
{

/// FNV-1a hash of the bits of numbers.
class Hash
{
public:
  void add(const lattice::Field &field)
  {
    for (const double value : field)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      for (unsigned int byte = 0; byte < 8; ++byte)
        hash_ = (hash_ ^ (bits >> 8 * byte & 0xff)) * 0x100000001b3ULL;
    }
  }
  unsigned long long value() const { return hash_; }

private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

/// A crack from a slit in a stretched sheet with noise, whose sites touch where bonds broke.
void print_crack(const char *name, lattice::Orientation orientation, const lattice::Material &material,
                 const lattice::TimeStepping &time_stepping, int steps)
{
  const double breaking_stretch = 3.05;
  const lattice::TriangularLattice sheet = sheets::square(70, orientation); // more places than are left to one thread
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::held);
  lattice::add_noise(state, sheet, 0.01 * sheets::spacing, 1);
  lattice::Simulation simulation(
    sheet, material, std::move(state), time_stepping,
    lattice::Fracture(sheet, material, breaking_stretch, lattice::BehindTipToughening{8. * sheets::spacing, 1000.}, F));
  simulation.enable_contact(lattice::contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 1.));
  simulation.cut(sheets::middle_row(sheet, 6, 8));
  for (int part = 1; part <= 4; ++part)
  {
    for (int step = 0; step < steps / 4; ++step)
      simulation.step();
    const lattice::State &now = simulation.state();
    Hash hash;
    for (const lattice::Field *field : {&now.x, &now.y, &now.vx, &now.vy})
      hash.add(*field);
    std::printf("%-28s step %4d  %4zu bonds broken  %016llx\n", name, part * steps / 4, simulation.n_broken(),
                hash.value());
  }
}

} // namespace

int main()
{
  using lattice::Orientation;
  const lattice::TimeStepping verlet{1e-7}, stages{4e-6, 7};
  print_crack("velocity Verlet", Orientation::rows_along_crack, sheets::rubber(), verlet, 4000);
  print_crack("rows across the crack", Orientation::rows_across_crack, sheets::rubber(), verlet, 4000);
  print_crack("six neighbours", Orientation::rows_along_crack, sheets::nearest_only(), verlet, 4000);
  print_crack("laws from outside", Orientation::rows_along_crack, sheets::rubber_from_outside(), verlet, 400);
  print_crack("Runge-Kutta-Chebyshev", Orientation::rows_along_crack, sheets::rubber(), stages, 400);
}
