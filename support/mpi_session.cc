#include "support/mpi_session.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <utility>
#include <vector>

#include <mpi.h>
#include <unistd.h>

namespace latcon::support
{

MpiSession::MpiSession()
{
  // A process that is alone needs few of Open MPI's modules, and none of hwloc's, which look for displays and devices.
  std::vector<const char *> own;
  if (!is_started_by_launcher())
    for (const auto &[name, value] :
         {std::pair("OMPI_MCA_ess_singleton_isolated", "1"), std::pair("OMPI_MCA_orte_create_session_dirs", "0"),
          std::pair("OMPI_MCA_pml", "ob1"), std::pair("OMPI_MCA_btl", "self"),
          std::pair("OMPI_MCA_coll", "basic,self,libnbc"), std::pair("HWLOC_PLUGINS_PATH", ""),
          std::pair("HWLOC_COMPONENTS", "-linuxio")})
      if (std::getenv(name) == nullptr) // values set by the user stay
      {
        setenv(name, value, 1);
        own.push_back(name);
      }
  int provided = MPI_THREAD_SINGLE;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    throw std::runtime_error("MPI cannot be initialised");
  for (const char *name : own) // ranks that this process starts need others
    unsetenv(name);
  if (provided < MPI_THREAD_FUNNELED) // the main thread makes all calls
    throw std::runtime_error("this MPI library does not support programs with threads (MPI_THREAD_FUNNELED)");
}

MpiSession::~MpiSession()
{
  if (std::uncaught_exceptions() == 0)
    MPI_Finalize();
}

bool is_launcher_variable(const std::string &variable)
{
  constexpr std::array prefixes{"PMIX_NAMESPACE", "PMIX_RANK",        "PMIX_SERVER_", "PMI_",
                                "PMI2_",          "OMPI_COMM_WORLD_", "FLUX_JOB_ID"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char *prefix) { return variable.rfind(prefix, 0) == 0; });
}

bool is_started_by_launcher()
{
  bool found = false;
  for (char **variable = environ; *variable != nullptr; ++variable)
    found = found || is_launcher_variable(*variable);
  return found;
}

} // namespace latcon::support
