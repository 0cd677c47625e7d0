#include "lattice/chebyshev_stages.h"

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

constexpr double damping = 2.; // epsilon

// Chebyshev polynomials of the first kind, T_j(w) for j = 0 ... n, and their first two derivatives.
struct Chebyshev
{
  Chebyshev(unsigned int n, double w) : T{1., w}, first{0., 1.}, second{0., 0.}
  {
    for (std::size_t j = 2; j <= n; ++j)
    {
      T.push_back(2. * w * T[j - 1] - T[j - 2]);
      first.push_back(2. * T[j - 1] + 2. * w * first[j - 1] - first[j - 2]);
      second.push_back(4. * first[j - 1] + 2. * w * second[j - 1] - second[j - 2]);
    }
  }
  std::vector<double> T, first, second;
};

} // namespace

ChebyshevStages::ChebyshevStages(unsigned int stages)
{
  support::require(stages >= 2, "a Runge-Kutta-Chebyshev method of second order has two stages or more");
  const double w0 = 1. + damping / (static_cast<double>(stages) * stages);
  const Chebyshev at(stages, w0);
  const double w1 = at.first[stages] / at.second[stages];
  std::vector<double> b(stages + 1);
  for (unsigned int j = 2; j <= stages; ++j)
    b[j] = at.second[j] / (at.first[j] * at.first[j]);
  b[0] = b[1] = b[2];

  first_ = b[1] * w1;
  double elapsed_before = 0., elapsed = first_; // as for y' = 1
  real_limit_ = (1. + w0) / w1;
  for (unsigned int j = 2; j <= stages; ++j)
  {
    const double now = 2. * b[j] / b[j - 1] * w1;
    const Stage stage{2. * b[j] / b[j - 1] * w0, -b[j] / b[j - 2], now, -(1. - b[j - 1] * at.T[j - 1]) * now, elapsed};
    stages_.push_back(stage);
    const double next = stage.mu * elapsed + stage.nu * elapsed_before + (stage.now + stage.start);
    elapsed_before = elapsed;
    elapsed = next;
  }
}

std::complex<double> ChebyshevStages::amplification(std::complex<double> z) const
{
  std::complex<double> before = 0., last = first_ * z; // Y - Y_0
  for (const Stage &stage : stages_)
  {
    const std::complex<double> next = stage.mu * last + stage.nu * before + z * (stage.now * (1. + last) + stage.start);
    before = last;
    last = next;
  }
  return 1. + last;
}

unsigned int ChebyshevStages::needed(double limit)
{
  unsigned int stages = 2;
  while (ChebyshevStages(stages).real_limit() < limit)
    ++stages;
  return stages;
}

} // namespace latcon::lattice
