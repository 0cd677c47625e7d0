// No #pragma once: see below.

/// @file
/// Namespace of the formulas of bond laws, LATCON_FORMULAS.
///
/// A formula is a template over the type of its numbers: double, or the vectors of an instruction set. A compiler fixes
/// the instruction set of a function where the function is defined. The kernels therefore include the laws once more
/// for each set, with LATCON_VECTORS defined and LATCON_FORMULAS a namespace of that set (formulas_for_vectors.inc). A
/// formula may use +, -, * and the numbers given to it. It may not use exp or log, whose bits differ between
/// instruction sets.
#ifndef LATCON_FORMULAS
/// Namespace of the formulas for one double.
#define LATCON_FORMULAS formulas
#endif
