#include "continuum/parallel_session.h"

#include <stdexcept>

#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/lac/vector_memory.h>

#include <p4est.h>
#include <zoltan.h>

namespace latcon::continuum
{
namespace
{
// Releases the vectors that deal.II pools for reuse. They hold MPI resources, so they must be freed before MPI is
// finalised.
template <class... Vectors>
void release_kept_vectors()
{
  (dealii::GrowingVectorMemory<Vectors>::release_unused_memory(), ...);
}
} // namespace

ParallelSession::ParallelSession()
{
  int is_initialised = 0;
  MPI_Initialized(&is_initialised);
  if (is_initialised == 0)
    mpi_.emplace();
  float version = 0.f;
  if (Zoltan_Initialize(0, nullptr, &version) != ZOLTAN_OK)
    throw std::runtime_error("Zoltan cannot be initialised");
  p4est_init(nullptr, SC_LP_SILENT);
  dealii::MultithreadInfo::set_thread_limit(1);
  dealii::Utilities::MPI::MPI_InitFinalize::signals.at_mpi_init();
}

ParallelSession::~ParallelSession()
{
  namespace distributed = dealii::LinearAlgebra::distributed;
  namespace trilinos = dealii::TrilinosWrappers::MPI;
  dealii::Utilities::MPI::MPI_InitFinalize::signals.at_mpi_finalize();
  release_kept_vectors<distributed::Vector<double>, distributed::BlockVector<double>, distributed::Vector<float>,
                       distributed::BlockVector<float>, trilinos::Vector, trilinos::BlockVector>();
  sc_finalize();
}
} // namespace latcon::continuum
