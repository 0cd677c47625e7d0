#include "verification/claims/continuum_waves.h"

#include <algorithm>
#include <cmath>

#include "verification/bridge/homogenisation.h"

namespace latcon::claims
{
namespace
{

// Of the forces of a law on a sheet at rest, per rate of displacement.
Eigen::Matrix2d damping(const continuum::Viscosity &law, const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  continuum::PointIntegrand density;
  continuum::clear(density, continuum::Order::second);
  law.add_density(continuum::field_derivatives(bridge::to_continuum(F)), {}, continuum::Order::second, 1., density);
  const double derivatives[] = {K[0], K[1], K[0] * K[0], K[1] * K[1], K[0] * K[1]};
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      for (unsigned int c = 0; c < continuum::n_derivatives; ++c)
        for (unsigned int e = 0; e < continuum::n_derivatives; ++e)
          sum(i, k) += derivatives[c] * derivatives[e] * density.second[i][k][c][e];
  return sum;
}

} // namespace

SubjectContinua::SubjectContinua(const bridge::Subject &subject)
  : local{{subject.cauchy_born}, {subject.material.density}}, gradient{{subject.cauchy_born, *subject.lattice_gradient},
                                                                       {local.inertia.density,
                                                                        subject.lengths.lattice}},
    isotropic{{subject.cauchy_born, *subject.isotropic_gradient},
              {local.inertia.density, subject.lengths.isotropic_inertia}},
    network{{subject.network}, local.inertia}, network_gradient{{subject.network, *subject.network_gradient},
                                                                gradient.inertia}
{
}

bridge::WaveMatrices continuum_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  const dealii::Tensor<2, 2> state = bridge::to_continuum(F);
  const dealii::Tensor<4, 2> T = medium.constitution.local->tangent(state);
  dealii::Tensor<6, 2> C;
  if (medium.constitution.gradient != nullptr)
    C = medium.constitution.gradient->double_stress_by_G(state);
  bridge::WaveMatrices matrices{Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int L = 0; L < 2; ++L)
        {
          matrices.stiffness(i, k) += T[i][J][k][L] * K[J] * K[L];
          for (unsigned int M = 0; M < 2; ++M)
            for (unsigned int N = 0; N < 2; ++N)
              matrices.stiffness(i, k) += C[i][J][L][k][M][N] * K[J] * K[L] * K[M] * K[N];
        }
  for (const continuum::Viscosity *law = medium.viscosity.get(); law != nullptr; law = law->gradient())
    matrices.damping += damping(*law, F, K);
  const double mass = medium.inertia.density * (1. + medium.inertia.length * medium.inertia.length * K.squaredNorm());
  matrices.stiffness /= mass;
  matrices.damping /= mass;
  return matrices;
}

double discretisation_bound(const WaveMesh &mesh)
{
  const double p = mesh.degree - 1., kh = 2. * M_PI / mesh.cells;
  return std::pow(std::tgamma(p + 1.) / std::tgamma(2. * p + 1.), 2) * std::pow(kh, 2. * p) / (4. * p + 2.);
}

std::array<bridge::PlaneWave, 2> continuum_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                 const Eigen::Vector2d &K)
{
  return bridge::named_waves([&](const Eigen::Vector2d &k) { return continuum_matrices(medium, F, k); }, F, K);
}

std::vector<bridge::BranchMatrix> branch_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                  const Eigen::Vector2d &K)
{
  const double mass = medium.inertia.density * (1. + medium.inertia.length * medium.inertia.length * K.squaredNorm());
  std::vector<bridge::BranchMatrix> branches;
  for (const continuum::MaxwellFibres &fibres : medium.memory->families())
  {
    const Eigen::Vector2d N(fibres.direction[0], fibres.direction[1]), n = (F * N).normalized();
    const double l_d = medium.memory->gradient_length(), along = std::pow(N.dot(K), 2);
    const double gradient = l_d == 0. ? 0. : l_d * l_d * K.squaredNorm() - fibres.length * fibres.length / 12. * along;
    const Eigen::Matrix2d per_modulus = fibres.weight * along * (1. + gradient) / mass * n * n.transpose();
    for (const auto &[modulus, time] : fibres.branches)
    {
      const auto same =
        std::find_if(branches.begin(), branches.end(),
                     [time = time](const bridge::BranchMatrix &b) { return b.relaxation_time == time; });
      if (same == branches.end())
        branches.push_back({modulus * per_modulus, time});
      else
        same->stiffness += modulus * per_modulus;
    }
  }
  return branches;
}

std::array<bridge::MemoryWave, 2> continuum_memory_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                         const Eigen::Vector2d &K)
{
  return bridge::memory_waves(continuum_matrices(medium, F, K), branch_matrices(medium, F, K),
                              bridge::wave_normal(F, K));
}

} // namespace latcon::claims
