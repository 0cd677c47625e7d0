#include "verification/claims/damage/damaged_bar.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "verification/bridge/affine_displacement.h"

namespace latcon::claims
{
namespace
{

continuum::DamageSettings settings()
{
  continuum::DamageSettings settings;
  settings.statics.degree = 2;
  return settings;
}

} // namespace

dealii::Tensor<2, 2> uniaxial(double stretch)
{
  dealii::Tensor<2, 2> F;
  F[0][0] = stretch;
  F[1][1] = 1.;
  return F;
}

double stretch_of_energy(const continuum::Material &law, double energy)
{
  double low = 0., high = 1e-6; // strain
  while (law.energy(uniaxial(1. + high)) < energy)
  {
    low = high;
    high *= 2.;
    if (high > 1e6)
      throw std::domain_error("no uniaxial strain reaches the threshold of damage");
  }
  while (high - low > 1e-15 * high && low < 0.5 * (low + high) && 0.5 * (low + high) < high)
  {
    const double middle = 0.5 * (low + high);
    (law.energy(uniaxial(1. + middle)) < energy ? low : high) = middle;
  }
  return 1. + 0.5 * (low + high);
}

DamagedBar::DamagedBar(const continuum::Constitution &laws, const continuum::DamageLaw &damage, double size,
                       unsigned int cells, double last)
  : mesh_(MPI_COMM_WORLD), length_(cells * size), height_(size), last_(last)
{
  continuum::make_rectangle(mesh_, {length_, height_, cells, 1});
  Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  F(0, 0) = last;
  std::vector<continuum::PrescribedDisplacement> held = bridge::affine_boundary(F);
  for (continuum::PrescribedDisplacement &edge : held)
    if (edge.boundary == continuum::edge::bottom || edge.boundary == continuum::edge::top)
      edge.components = dealii::ComponentMask(std::vector<bool>{false, true});
  solver_ = std::make_unique<continuum::DamageSolver>(mesh_, laws, continuum::BoundaryConditions(held), damage,
                                                      std::set<dealii::types::boundary_id>(), settings());
}

void DamagedBar::weaken_middle(double amount)
{
  // The column ends half an element from the centre; 0.75 selects its nodes only.
  solver_->set_damage([this, amount](const dealii::Point<2> &X)
                      { return std::abs(X[0] - 0.5 * length_) < 0.75 * height_ ? amount : 0.; });
}

double DamagedBar::stress() const
{
  return solver_->statics().reactions().at(continuum::edge::right)[0] / height_;
}

std::vector<double> DamagedBar::profile() const
{
  const auto cells = static_cast<unsigned int>(std::lround(length_ / height_));
  std::vector<dealii::Point<2>> points;
  for (unsigned int i = 0; i <= cells; ++i)
    points.emplace_back(length_ * i / cells, 0.);
  return solver_->field().evaluate(points);
}

} // namespace latcon::claims
