#pragma once

namespace latcon::support
{

/// Lets the threads of OpenMP sleep after they have waited for a fifth of a millisecond. By default they wait busily for
/// up to milliseconds, which takes the cores from the threads that they wait for wherever other programs run. Asks for
/// memory in huge pages too, unless GLIBC_TUNABLES is set: equilibria of finite elements fill matrices for the first
/// time, and are 6 % faster where the kernel gives such pages only to programs that ask. Both are read from the
/// environment while libraries are loaded, so the program starts anew, once. Does nothing where OMP_WAIT_POLICY or
/// GOMP_SPINCOUNT is set, or where the program cannot start anew. To be called first in main.
/// @param arguments those of main
void let_waiting_threads_sleep(char **arguments);

} // namespace latcon::support
