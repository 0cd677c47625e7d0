/// Initialisation of MPI.
#pragma once

#include <string>

namespace latcon::support
{

/// Initialises MPI on construction (MPI_Init_thread with MPI_THREAD_SERIALIZED) and finalises it on destruction.
///
/// A process that was not started by a launcher is isolated: Open MPI creates neither a daemon nor a session folder for
/// it. By default all such processes of a user on a machine share the folder `ompi.HOST.UID/jf.0/0/0` in $TMPDIR. Each
/// process creates missing levels of the folder and removes empty levels when it ends, so a process fails to start if
/// another one ends between its calls of mkdir. It does not look for networks either, which takes 0.2 s, nor for
/// devices and displays. Variables set by the user (OMPI_MCA_ess_singleton_isolated, OMPI_MCA_orte_create_session_dirs,
/// OMPI_MCA_pml, OMPI_MCA_btl, OMPI_MCA_coll, HWLOC_PLUGINS_PATH, HWLOC_COMPONENTS) take precedence. Ranks of `mpirun`
/// and `srun` are left as the launcher set them up.
///
/// MPI does not get the arguments of the program. To be created once, before other threads start.
class MpiSession
{
public:
  /// @throws std::runtime_error if MPI cannot be initialised; in most such cases Open MPI ends the process itself
  MpiSession();

  /// Does not finalise MPI while an exception unwinds the stack, because other ranks may never call MPI_Finalize.
  ~MpiSession();

  MpiSession(const MpiSession &) = delete;
  MpiSession &operator=(const MpiSession &) = delete;
};

/// Returns true if an environment variable indicates that the process is a rank of a job: variables of PMI and PMIx,
/// OMPI_COMM_WORLD_*, and FLUX_JOB_ID. `SLURM_PROCID` does not, because it is also set in scripts of `sbatch`.
/// @param variable name, or name and value as in `environ`
[[nodiscard]] bool is_launcher_variable(const std::string &variable);

/// Returns true if `mpirun`, `srun` or another launcher started this process as a rank.
[[nodiscard]] bool is_started_by_launcher();

} // namespace latcon::support
