#pragma once

#include "verification/bridge/subject.h"

/// Subjects that several tests share.
namespace subjects
{

/// The rubber of the source paper's Fig. 1 with s = 2/3, at strains (1.3, 1.8).
inline latcon::input::Case paper_case()
{
  latcon::input::Case input;
  input.spacing = 0.625e-3;
  input.length = 0.03;
  input.height = 0.02;
  input.density = 944.;
  input.nearest = {latcon::input::ShellCase::Law::mooney_rivlin, 1e5, 1.5e5, 1., 2. / 3., 65.625};
  input.next_nearest = {latcon::input::ShellCase::Law::mooney_rivlin, 1e5, 1.5e5, 1., 2. / 3., 196.875};
  input.strain_x = 1.3;
  input.strain_y = 1.8;
  return input;
}

/// The same with a tenth of its viscosity: waves that are damped measurably are short then, and run in small sheets.
inline latcon::input::Case weakly_damped_case()
{
  latcon::input::Case input = paper_case();
  input.nearest.viscosity *= 0.1;
  input.next_nearest.viscosity *= 0.1;
  return input;
}

/// A case with third-nearest neighbours too.
inline latcon::input::Case with_third_shell(latcon::input::Case input)
{
  input.has_third_nearest = true;
  input.third_nearest = {latcon::input::ShellCase::Law::mooney_rivlin, 1e5, 1.5e5, 1., 2. / 3., 100.};
  return input;
}

inline latcon::lattice::Material nearest_only(const latcon::input::Case &input)
{
  latcon::lattice::Material material = input.material();
  material.next_nearest.reset();
  return material;
}

} // namespace subjects
