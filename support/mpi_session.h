/// Start and end of MPI.
#pragma once

#include <string>

namespace latcon::support
{

/// MPI, from construction to destruction: MPI_Init_thread at the level MPI_THREAD_SERIALIZED, and MPI_Finalize.
///
/// A process that no launcher started is a job of its own, and shares nothing with other such processes: Open MPI makes
/// neither a daemon nor a session folder for it. By default all such processes of a user on a machine use one folder,
/// `ompi.HOST.UID/jf.0/0/0` in $TMPDIR. Each makes the levels that are missing and removes those that are empty when it
/// ends, so that one fails to start if another ends between its calls of mkdir. Variables that the user has set
/// (OMPI_MCA_ess_singleton_isolated, OMPI_MCA_orte_create_session_dirs) take precedence. Ranks of `mpirun` and `srun`
/// are left as the launcher set them up.
///
/// MPI does not see the arguments of the program. To be made once, before other threads.
class MpiSession
{
public:
  /// @throws std::runtime_error if MPI cannot be started; Open MPI ends the process itself in most such cases
  MpiSession();

  /// Does not finalize MPI while an exception unwinds the stack: other ranks may never arrive.
  ~MpiSession();

  MpiSession(const MpiSession &) = delete;
  MpiSession &operator=(const MpiSession &) = delete;
};

/// Returns whether a variable marks a process as a rank of a job: those of PMI and PMIx, OMPI_COMM_WORLD_*, and
/// FLUX_JOB_ID. `SLURM_PROCID` does not: scripts of `sbatch` have it as well.
/// @param variable name, or name and value as in `environ`
[[nodiscard]] bool is_launcher_variable(const std::string &variable);

/// Returns whether `mpirun`, `srun` or another launcher started this process as a rank.
[[nodiscard]] bool is_started_by_launcher();

} // namespace latcon::support
