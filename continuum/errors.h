#pragma once

#include <stdexcept>
#include <string>

namespace latcon::continuum
{
/// Equations that have no solution, or whose solution was not found: NonPhysicalState, LinearSolverFailed,
/// SolverFailed.
class NoSolution : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Deformation outside the domain of the law: det F <= 0, or no equilibrium thickness. A solver may retry with a
/// smaller step.
class NonPhysicalState : public NoSolution
{
public:
  using NoSolution::NoSolution;
};

/// Invalid arguments: material constants, sizes, boundaries, settings, points outside the sheet.
class InvalidInput : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// Throws InvalidInput with the text `rule` unless it `holds`.
inline void require(const bool holds, const std::string &rule)
{
  if (!holds)
    throw InvalidInput(rule);
}

/// Linear system that could not be solved to its tolerance.
class LinearSolverFailed : public NoSolution
{
public:
  using NoSolution::NoSolution;
};

/// File that could not be written completely.
class OutputFailed : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
} // namespace latcon::continuum
