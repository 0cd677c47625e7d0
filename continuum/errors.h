#pragma once

#include <stdexcept>
#include <string>

namespace latcon::continuum
{
/// A deformation that no sheet can have: det F <= 0, or no thickness in equilibrium. A solver may retry with a
/// smaller step.
class NonPhysicalState : public std::domain_error
{
public:
  using std::domain_error::domain_error;
};

/// Constants that make no elastic material.
class InvalidMaterial : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// A problem that cannot be set up as stated: sizes, boundaries, settings, points outside the sheet.
class InvalidInput : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// The linear system could not be solved to its tolerance.
class LinearSolverFailed : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A file could not be written whole.
class OutputFailed : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
} // namespace latcon::continuum
