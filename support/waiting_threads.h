#pragma once

namespace latcon::support
{

/// Lets the threads of OpenMP sleep after they have waited for some microseconds. By default they wait busily for up to
/// milliseconds, which takes the cores from the threads that they wait for wherever other programs run. OpenMP reads
/// its settings from the environment while it is loaded, so the program starts anew, once. Does nothing where OMP_WAIT_POLICY or
/// GOMP_SPINCOUNT is set, or where the program cannot start anew. To be called first in main.
/// @param arguments those of main
void let_waiting_threads_sleep(char **arguments);

} // namespace latcon::support
