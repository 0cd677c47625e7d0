#pragma once

#include <omp.h>

namespace latcon::support
{

/// Limits OpenMP to one thread in its scope, for lattices so small that synchronisation costs more than threads save.
/// Results do not depend on the number of threads.
class OneThread
{
public:
  OneThread() : threads_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(threads_); }
  OneThread(const OneThread &) = delete;
  OneThread &operator=(const OneThread &) = delete;

private:
  int threads_;
};

} // namespace latcon::support
