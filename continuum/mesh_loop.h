#pragma once

#include <deal.II/base/config.h>
#include <deal.II/base/template_constraints.h>
#include <deal.II/base/types.h>
#include <deal.II/base/work_stream.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/meshworker/assemble_flags.h>
#include <deal.II/meshworker/dof_info.h>
#include <deal.II/meshworker/integration_info.h>
#include <deal.II/meshworker/local_integrator.h>
#include <deal.II/meshworker/loop.h>

/// @file
/// deal.II's MeshWorker::mesh_loop, which continuum/ includes from here.
///
/// Where deal.II checks itself, version 9.4 asserts `!cell->neighbor_is_coarser(face)` of cells of one level, also on
/// periodic faces. There the cell has a periodic neighbour and no other, so the question itself is refused. The loop is
/// therefore compiled without its own assertions; those of all that it calls stay, since what it includes comes before.

#pragma push_macro("Assert")
#undef Assert
#define Assert(condition, exception)                                                                                   \
  {                                                                                                                    \
  }
#include <deal.II/meshworker/mesh_loop.h>
#pragma pop_macro("Assert")
