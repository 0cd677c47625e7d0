#pragma once

#include <deal.II/base/types.h>
#include <deal.II/dofs/dof_handler.h>

#include <tuple>

namespace latcon::continuum
{
/// Cell beyond a face between cells. `subface` is the half of its face that the face is if the cell is coarser, and
/// otherwise numbers::invalid_unsigned_int.
struct CellBeyond
{
  dealii::DoFHandler<2>::cell_iterator cell;
  unsigned int face;
  unsigned int subface = dealii::numbers::invalid_unsigned_int;
};

/// Returns the cell beyond a face that is not on the boundary, also of a periodic mesh; it may have children.
inline CellBeyond cell_beyond(const dealii::DoFHandler<2>::active_cell_iterator &cell, const unsigned int face)
{
  const bool periodic = cell->has_periodic_neighbor(face);
  CellBeyond beyond{cell->neighbor_or_periodic_neighbor(face), 0};
  if (periodic ? cell->periodic_neighbor_is_coarser(face) : cell->neighbor_is_coarser(face))
    std::tie(beyond.face, beyond.subface) =
      periodic ? cell->periodic_neighbor_of_coarser_periodic_neighbor(face) : cell->neighbor_of_coarser_neighbor(face);
  else
    beyond.face = periodic ? cell->periodic_neighbor_face_no(face) : cell->neighbor_face_no(face);
  return beyond;
}

/// Calls `visit.cell(cell)` for each locally owned active cell and then, for each of its faces in turn,
///     visit.boundary(cell, face)     on the boundary, except on periodic edges;
///     visit.interior(cell, face, subface, neighbor, neighbor_face, neighbor_subface)     otherwise,
/// and `visit.cell_end()` after the last face. Each face between cells is visited once over all ranks: from the finer
/// cell; between equally fine cells, from the cell of the lower rank or, on one rank, from the first cell.
///
/// `subface` is numbers::invalid_unsigned_int, and so is `neighbor_subface` unless the neighbor is coarser. The order
/// of calls is that of deal.II's MeshWorker::mesh_loop, which cannot be used: in debug mode of version 9.4 an internal
/// assertion fails on periodic faces.
template <class Visitor>
void for_each_cell_and_face(const dealii::DoFHandler<2> &dofs, Visitor &visit)
{
  constexpr unsigned int whole = dealii::numbers::invalid_unsigned_int;
  for (const auto &cell : dofs.active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    visit.cell(cell);
    for (const unsigned int face : cell->face_indices())
    {
      if (cell->at_boundary(face) && !cell->has_periodic_neighbor(face))
      {
        visit.boundary(cell, face);
        continue;
      }
      const CellBeyond beyond = cell_beyond(cell, face);
      const auto &neighbor = beyond.cell;
      const bool from_beyond =
        beyond.subface == whole &&
        (neighbor->has_children() ||
         (neighbor->is_locally_owned() ? neighbor < cell : neighbor->subdomain_id() < cell->subdomain_id()));
      if (!from_beyond)
        visit.interior(cell, face, whole, neighbor, beyond.face, beyond.subface);
    }
    visit.cell_end();
  }
}
} // namespace latcon::continuum
