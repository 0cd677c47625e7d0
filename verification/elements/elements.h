/// The part of the program that computes with finite elements.
#pragma once

#include <memory>

#include "support/errors.h"
#include "verification/claims/claim_inputs.h"
#include "verification/input/options.h"

namespace latcon::elements
{

/// Functions that need finite elements. They are reached through this table because they live in a module,
/// latcon_elements.so, which the program loads when it calls elements() first: its 150 libraries (deal.II, Trilinos and
/// what these need) take 0.4 s of processor time, more than most commands.
struct Elements
{
  decltype(claims::run_claims) *run_claims;
  support::ExitCode (*run_continuum)(const input::Options &options); ///< `latcon continuum`
  /// Initialises the libraries of the finite elements; the object finalises them on destruction.
  std::shared_ptr<void> (*start)();
};

/// Returns the functions of the module, which is loaded and started with the first call, on every rank that calls.
/// @throws support::OutputError if it cannot be loaded
[[nodiscard]] const Elements &elements();

/// Finalises the libraries of the finite elements, if they were started: to be called once, before MPI ends.
void finish();

} // namespace latcon::elements

/// Entry point of the module.
extern "C" const latcon::elements::Elements *latcon_elements();
