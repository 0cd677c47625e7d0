// Detection of ranks of a job.
#include "support/mpi_session.h"

#include <gtest/gtest.h>

namespace mpi_session_test
{

using latcon::support::is_launcher_variable;

TEST(MpiSession, KnowsTheVariablesOfLaunchers)
{
  for (const char *variable :
       {"PMI_RANK=0", "PMI2_JOBID", "PMIX_RANK=0", "PMIX_NAMESPACE=x", "PMIX_SERVER_URI2", "OMPI_COMM_WORLD_SIZE=2"})
    EXPECT_TRUE(is_launcher_variable(variable)) << variable;
  for (const char *variable :
       {"SLURM_PROCID=0", "OMPI_MCA_btl=self", "PMIX_MCA_gds=hash", "XPMI_RANK=0", "PATH=PMI_", ""})
    EXPECT_FALSE(is_launcher_variable(variable)) << variable;
}

} // namespace mpi_session_test
